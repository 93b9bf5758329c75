//! The rays that are measured: those a renderer traces, made once and the same for every backend.

use super::hierarchy::diagonal;
use crate::bake::SceneData;
use crate::layout::{
    Batch, Hit, INVALID, LIGHT_DIRECTIONAL, LIGHT_POINT, LIGHT_SPOT, Light, Ray, SceneView, T_INFINITE,
};
use crate::shading::frame::{frame_from_normal, to_world};
use crate::shading::math::{dot3, length3, normalize3};
use crate::shading::sampling::sample_2d;
use crate::shading::warp::square_to_cosine_hemisphere;
use crate::trace::spawn::spawn_ray;
use crate::trace::surface::{Surface, surface_at};
use crate::trace::traverse::{trace_any, trace_closest};
use crate::transport::generate::{generate, sample_key};
use crate::transport::local::SHADOW_END;
use glam::Vec3;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Samples a pixel that may be used up to collect the secondary rays of a scene that fills little of its frame.
const MAX_PASSES: u32 = 16;
/// Length of an ambient occlusion ray over the diagonal of the scene's box.
const OCCLUSION_REACH: f64 = 0.05;

/// Dimensions of the random numbers drawn here; `transport` uses none of them.
const DIMENSION_FIRST: u32 = 0x4000_0000;
const DIMENSION_SECOND: u32 = 0x4000_0001;
const DIMENSION_OCCLUSION: u32 = 0x4000_0002;

/// What a set of rays is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum RayKind {
    /// From the camera, one a pixel, row by row. Closest hit.
    Primary,
    /// From what primary rays hit, over the cosine hemisphere. Closest hit.
    Diffuse,
    /// From what those hit, likewise. Closest hit.
    Second,
    /// From what primary rays hit, over the cosine hemisphere, 5 % of the scene's diagonal long. Any hit.
    Occlusion,
    /// From what primary rays hit to one light. Any hit.
    Shadow,
}

impl RayKind {
    pub const ALL: [Self; 5] = [Self::Primary, Self::Diffuse, Self::Second, Self::Occlusion, Self::Shadow];

    /// Whether any hit will do.
    pub fn is_any(self) -> bool {
        matches!(self, Self::Occlusion | Self::Shadow)
    }

    pub fn name(self) -> &'static str {
        match self {
            Self::Primary => "primary",
            Self::Diffuse => "diffuse",
            Self::Second => "second",
            Self::Occlusion => "occlusion",
            Self::Shadow => "shadow",
        }
    }
}

/// Rays of one kind and what they hit, by the CPU's twins.
#[derive(Clone, Debug)]
pub struct RaySet {
    pub kind: RayKind,
    pub rays: Vec<Ray>,
    /// Closest hits; of any-hit rays `instance` alone counts: 0, or `INVALID` for a miss.
    pub hits: Vec<Hit>,
}

impl RaySet {
    fn new(kind: RayKind) -> Self {
        Self { kind, rays: Vec::new(), hits: Vec::new() }
    }

    /// Rays that hit something.
    pub fn hit_count(&self) -> usize {
        self.hits.iter().filter(|hit| hit.instance != INVALID).count()
    }
}

/// The answer of one ray, as `RaySet::hits` holds it.
#[inline]
pub fn answer(scene: &SceneView, kind: RayKind, ray: &Ray) -> Hit {
    if kind.is_any() {
        return Hit { instance: if trace_any(scene, ray) { 0 } else { INVALID }, ..Hit::default() };
    }
    trace_closest(scene, ray)
}

/// A ray and where its random numbers come from.
#[derive(Clone, Copy)]
struct Seeded {
    ray: Ray,
    pixel: u32,
    sample: u32,
}

/// What a batch of rays hit, in their order; misses are left out.
fn surfaces(scene: &SceneView, rays: &[Seeded]) -> Vec<(Seeded, Surface)> {
    let hit = |seeded: &Seeded| {
        let hit = trace_closest(scene, &seeded.ray);
        (hit.instance != INVALID).then(|| (*seeded, surface_at(scene, &seeded.ray, &hit)))
    };
    rays.par_iter().filter_map(hit).collect()
}

/// A cosine-distributed ray from the viewer's side of a surface.
fn scatter(scene: &SceneView, seeded: &Seeded, surface: &Surface, dimension: u32, t_max: f32) -> Seeded {
    let seen_inside = dot3(surface.normal_geometric, seeded.ray.direction) > 0.0;
    let normal = if seen_inside { -surface.normal_geometric } else { surface.normal_geometric };
    let key = sample_key(scene, seeded.pixel, seeded.sample, 0);
    let direction = square_to_cosine_hemisphere(sample_2d(key, dimension));
    Seeded { ray: spawn_ray(surface, to_world(frame_from_normal(normal), direction), t_max), ..*seeded }
}

/// Where shadow rays go.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Target {
    Point(Vec3),
    /// Unit, towards the light.
    Direction(Vec3),
}

/// The first light at a point or at infinity that casts shadows; without one, a point above the camera by a tenth of the
/// scene's diagonal.
fn shadow_target(data: &SceneData, diagonal: f64) -> Target {
    let of = |light: &Light| match light.kind {
        LIGHT_POINT | LIGHT_SPOT => Some(Target::Point(light.position)),
        LIGHT_DIRECTIONAL => Some(Target::Direction(-light.direction)),
        _ => None,
    };
    let camera = &data.header.camera;
    let above = || Target::Point(camera.eye + normalize3(camera.up) * (diagonal * 0.1) as f32);
    data.lights.iter().filter(|light| light.casts_shadow != 0).find_map(of).unwrap_or_else(above)
}

fn shadow_ray(surface: &Surface, target: Target) -> Ray {
    match target {
        Target::Direction(direction) => spawn_ray(surface, direction, T_INFINITE),
        Target::Point(point) => {
            let way = point - surface.position;
            spawn_ray(surface, normalize3(way), length3(way) * SHADOW_END)
        }
    }
}

/// All sets for a frame of `data`'s camera: primary rays one a pixel, of the others as many, or what `MAX_PASSES` samples
/// a pixel give. `width`, `height`: those the scene was baked for.
pub fn make_rays(data: &SceneData, width: u32, height: u32) -> Vec<RaySet> {
    let scene = data.view();
    let wanted = width as usize * height as usize;
    let diagonal = diagonal(data);
    let target = shadow_target(data, diagonal);
    let mut sets = RayKind::ALL.map(RaySet::new);
    let [primary, diffuse, second, occlusion, shadow] = &mut sets;
    for sample in 0..MAX_PASSES {
        let camera = camera_rays(&scene, width, height, sample);
        if sample == 0 {
            primary.rays = camera.iter().map(|seeded| seeded.ray).collect();
        }
        let seen = surfaces(&scene, &camera);
        let reach = (diagonal * OCCLUSION_REACH) as f32;
        let scattered = |from: &[(Seeded, Surface)], dimension, t_max| -> Vec<Seeded> {
            from.par_iter().map(|(seeded, surface)| scatter(&scene, seeded, surface, dimension, t_max)).collect()
        };
        let first = scattered(&seen, DIMENSION_FIRST, T_INFINITE);
        let found = surfaces(&scene, &first);
        take(&mut diffuse.rays, wanted, first.iter().map(|seeded| seeded.ray));
        let next = scattered(&found, DIMENSION_SECOND, T_INFINITE);
        take(&mut second.rays, wanted, next.iter().map(|seeded| seeded.ray));
        let near = scattered(&seen, DIMENSION_OCCLUSION, reach);
        take(&mut occlusion.rays, wanted, near.iter().map(|seeded| seeded.ray));
        take(&mut shadow.rays, wanted, seen.iter().map(|(_, surface)| shadow_ray(surface, target)));
        // `second` fills last: of each ray a bounce may leave the scene.
        if second.rays.len() == wanted || seen.is_empty() {
            break;
        }
    }
    for set in &mut sets {
        let kind = set.kind;
        set.hits = set.rays.par_iter().map(|ray| answer(&scene, kind, ray)).collect();
    }
    sets.into()
}

/// One ray for each pixel of the frame.
fn camera_rays(scene: &SceneView, width: u32, height: u32, sample: u32) -> Vec<Seeded> {
    let pixels = width * height;
    let batch = Batch {
        crop_width: width,
        crop_height: height,
        pixel_count: pixels,
        first_sample: sample,
        sample_count: 1,
        slot_count: pixels,
        ..Batch::default()
    };
    let one = |slot| {
        let path = generate(scene, &batch, slot);
        Seeded { ray: path.ray, pixel: path.pixel, sample }
    };
    (0..pixels).into_par_iter().map(one).collect()
}

/// Appends until there are `wanted`.
fn take(rays: &mut Vec<Ray>, wanted: usize, more: impl Iterator<Item = Ray>) {
    let room = wanted - rays.len();
    rays.extend(more.take(room));
}
