//! From a ray's birth to its sum: pure steps over one path record, scheduled by `render`.
//!
//! `generate` makes the camera ray of a sample, `shade` turns a ray and its hit into contributions, shadow rays and
//! further rays, `film` converts contributions to the film's integers and resolves a sample into its pixel.
//! Twins in `shaders/transport/`. What a step appends goes through `push_path`, `push_shadow`, `add_contribution`,
//! `miss_aov` and `add_aov`; on the device these are the kernels' queues (`shaders/kernels/queues.glsl`).

pub mod area_light;
pub mod begin;
pub mod blend;
pub mod emitter;
pub mod faceted;
pub mod film;
pub mod generate;
pub mod limit;
pub mod local;
pub mod mis;
pub mod nested;
pub mod path;
pub mod resolve;
pub mod shade;
pub mod shadow;

pub mod weight;
pub mod whitted;

use crate::layout::{AovPixel, FilmSum, INVALID, PathState, ShadowRay, T_INFINITE};
use glam::{Vec3, Vec4};

/// Dimensions of a sample's random numbers: pairs drawn for the named purpose.
pub const DIMENSION_FILTER: u32 = 0;
pub const DIMENSION_LENS: u32 = 1;
pub const DIMENSION_LIGHT_CHOICE: u32 = 16;
pub const DIMENSION_LIGHT: u32 = 17;
pub const DIMENSION_BSDF: u32 = 18;
pub const DIMENSION_LOBE: u32 = 19;
pub const DIMENSION_ROULETTE: u32 = 20;
pub const DIMENSION_PANE: u32 = 21;
pub const DIMENSION_LIGHT_LEAF: u32 = 22;
pub const DIMENSION_LEAF: u32 = 32;
/// Dither of contributions: emission and ambient, background, alpha; light i takes `DITHER_LIGHT + i`.
pub const DITHER_SURFACE: u32 = 0x1000_0000;
pub const DITHER_BACKGROUND: u32 = 0x1000_0001;
pub const DITHER_LIGHT: u32 = 0x2000_0000;
/// Added to both for each further point at which one hit is shaded.
pub const DITHER_CORNER: u32 = 0x0400_0000;

/// Branches of a path: hashed into the child's path id.
pub const LOBE_THROUGH: u32 = 1;
pub const LOBE_MIRROR: u32 = 2;
pub const LOBE_REFRACT: u32 = 3;
/// The one continuation of a traced path.
pub const LOBE_SCATTER: u32 = 4;

/// Where the steps of one sample put what they make. The backend empties it.
#[derive(Debug, Default)]
pub struct Queues {
    /// The sample's sum so far (the device keeps one per slot).
    pub sum: FilmSum,
    pub nan_count: u64,
    /// Contributions that the scene's `clamp` has limited.
    pub limited_count: u64,
    /// The sample's auxiliary values (only if the header asks for them).
    pub aov: AovPixel,
    pub paths: Vec<PathState>,
    pub shadows: Vec<ShadowRay>,
}

/// Appends a ray to trace.
pub fn push_path(queues: &mut Queues, path: PathState) {
    queues.paths.push(path);
}

/// Appends a shadow ray.
pub fn push_shadow(queues: &mut Queues, shadow: ShadowRay) {
    queues.shadows.push(shadow);
}

/// Notes that a contribution which reaches the film was limited.
pub fn count_limited(queues: &mut Queues) {
    queues.limited_count += 1;
}

/// Adds `value` (radiance and alpha, throughput included) to the sample in `slot`.
pub fn add_contribution(queues: &mut Queues, scale: f32, slot: u32, value: Vec4, dither: u32) {
    let _ = slot; // one sample at a time here; the device keeps a sum per slot
    let values = value.to_array();
    for lane in 0..4 {
        let lane_scale = film::lane_scale(scale, lane);
        let fixed = film::to_fixed(values[lane as usize], lane_scale, film::dither_lane(dither, lane));
        film::add_fixed(&mut queues.sum, lane, fixed);
        queues.nan_count += u64::from(film::is_nan(values[lane as usize]));
    }
}

/// Records for the auxiliary channels that a camera ray has met nothing; its first hit takes the place of that.
pub fn miss_aov(queues: &mut Queues, path: &PathState) {
    if path.sample_index == 0 {
        queues.aov.depth = T_INFINITE;
        queues.aov.object = INVALID;
        queues.aov.material = INVALID;
    }
}

/// Records the first hit of a camera ray for the auxiliary channels.
pub fn add_aov(
    queues: &mut Queues,
    path: &PathState,
    depth: f32,
    normal: Vec3,
    albedo: Vec3,
    object: u32,
    material: u32,
) {
    for lane in 0..3 {
        film::add_fixed(&mut queues.aov.normal, lane, film::to_fixed(normal[lane as usize], film::AOV_SCALE, 0.5));
        film::add_fixed(&mut queues.aov.albedo, lane, film::to_fixed(albedo[lane as usize], film::AOV_SCALE, 0.5));
    }
    if path.sample_index == 0 {
        queues.aov.depth = depth;
        queues.aov.object = object;
        queues.aov.material = material;
    }
}
