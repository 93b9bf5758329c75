//! `Scene` to `SceneData`: the only folder that knows obvhs.
//!
//! Whatever reaches a pixel is computed in f64 with libm and rounded once, so that every machine bakes the same bits.
//! Only the shape of the hierarchies may differ; it never decides what is hit.

mod albedo;
mod alias;
mod bvh;
pub mod data;
mod emitter;
mod environment;
pub mod filter;
mod geometry;
mod instance;
mod light;
mod measured;
mod media;
mod mip;
mod model;
mod places;
mod ploc;
mod scene;
pub mod shapes;
mod split;
pub mod srgb;
mod tabulated;
mod texture;
mod wide;

pub use albedo::gaussian_scale;
pub use data::{BakeTimes, SceneArrays, SceneData};
pub use scene::{Baker, bake, bake_watched};

use crate::watch::Watch;

/// Gives up where the watch is cancelled. Its steps are primitives that have been dealt with, each of them twice: in the binary
/// tree and in the wide one.
fn check(watch: &Watch) -> Result<(), BakeError> {
    if watch.is_cancelled() { Err(BakeError::Aborted) } else { Ok(()) }
}

/// Why a scene cannot be baked: exit code 65.
#[derive(Debug, thiserror::Error)]
pub enum BakeError {
    /// An index would not fit into 32 bits.
    #[error("the scene has {count} {what}; at most 4294967295 are possible")]
    TooLarge { what: &'static str, count: u64 },
    /// A node would not find its children.
    #[error("a hierarchy of {count} nodes is needed; at most {most} are possible in a mesh", most = places::NODES_MOST)]
    Nodes { count: usize },
    /// A transform that single precision cannot carry.
    #[error("object \"{name}\" {limits}", limits = crate::scene::OUT_OF_LIMITS)]
    Placement { name: String },
    /// Cook-Torrance has one or two lobes.
    #[error("material \"{name}\" has {count} lobes; one or two are possible")]
    Lobes { name: String, count: usize },
    /// The loop over a material's textures has a bound.
    #[error("material \"{name}\" has {count} textures; 16 are possible")]
    Textures { name: String, count: usize },
    /// More than a random number can tell apart.
    #[error("{count} triangles and lights glow; at most {most} are possible under direct and path")]
    Emitters { count: usize, most: usize },
    /// Ranks are bytes.
    #[error("{count} clear materials nest by priority; at most {most} are possible")]
    Media { count: usize, most: usize },
    /// A blend of blends of blends.
    #[error("material \"{name}\" blends more than 8 materials, or itself")]
    Blend { name: String },
    /// Flat or Gouraud shading of what has no triangles.
    #[error(
        "object \"{name}\" is an analytic sphere: it has no triangles to shade flat or by Gouraud's method; a sphere of a TOML scene gets them from \"segments\""
    )]
    Faceted { name: String },
    /// The eye is its own target, or the like.
    #[error("the camera {0}")]
    Camera(&'static str),
    /// `film.unit` outside the range of floats.
    #[error("film.unit is 2^{0}; exponents from -100 to 100 are possible")]
    FilmUnit(i32),
    /// No hierarchy is shallow enough.
    #[error("the scene's hierarchy needs a stack of {0} entries; at most 32 are possible")]
    Deep(u32),
    /// The watch was cancelled.
    #[error("interrupted before the scene was ready")]
    Aborted,
}
