//! The records that travel through the wavefront's queues.

use bytemuck::{Pod, Zeroable};
use glam::{Vec3, Vec4};

/// A ray to trace, world space, and the cone around it that a pixel sees (Akenine-Moeller et al. 2021, "Improved Shader
/// and Texture Level of Detail Using Ray Cones"). 48 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Ray {
    pub origin: Vec3,
    /// Hits at t > t_max do not count; `T_INFINITE` for none. In units of `direction`.
    pub t_max: f32,
    /// Unit for camera and scattered rays.
    pub direction: Vec3,
    /// The flat triangle (or sphere) the ray leaves: it is not tested again. `INVALID` for none.
    pub skip_instance: u32,
    pub skip_primitive: u32,
    /// For a sphere that is left: 1 if the ray goes inward (only the far root counts), 0 outward (no root counts).
    pub skip_inward: u32,
    /// Width of the cone at the origin, world units, and what it grows by per unit of distance.
    pub cone_width: f32,
    pub cone_spread: f32,
}

/// Farther than any scene; finite so that no arithmetic meets an infinity.
pub const T_INFINITE: f32 = 1.0e30;

/// The closest hit of a ray. 32 bytes. A miss has `instance == INVALID`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Hit {
    /// In units of the ray's direction.
    pub t: f32,
    /// Barycentric weights of corners 1 and 2 (0 on a sphere).
    pub b1: f32,
    pub b2: f32,
    pub instance: u32,
    /// Index of the triangle in its mesh as written; 0 on a sphere.
    pub primitive: u32,
    pub _pad0: u32,
    pub _pad1: u32,
    pub _pad2: u32,
}

/// A pending ray and all that its shading will need to know. 128 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct PathState {
    pub ray: Ray,
    /// What a unit of radiance arriving along the ray adds to the sample; signed (negative filter lobes).
    pub throughput: Vec4,
    /// Where the sample's sum is kept in the batch.
    pub slot: u32,
    /// x | y << 16, in the full frame.
    pub pixel: u32,
    pub sample_index: u32,
    /// Hash of the branch history: `hash(parent, lobe)`; 0 for the camera ray.
    pub path_id: u32,
    /// Scattering events so far (passing straight through a pane is none).
    pub depth: u32,
    /// What is still uncovered in front of this ray, for alpha; 0 off the camera's straight line (depth > 0).
    pub coverage: f32,
    /// Relative index of the medium the ray travels in (1 outside everything).
    pub eta: f32,
    /// Density per solid angle with which the ray's direction was drawn where it left a surface; 0 if no light sample there
    /// could have had it: camera rays, directions of zero width, what has passed a pane that stops shadow rays (path).
    pub pdf: f32,
    /// Beer coefficient of that medium, per scene unit.
    pub absorption: Vec3,
    /// Media that the ray is inside of, where they have ranks (`shading/interior`).
    pub interior: u32,
    /// How far before the ray's origin its direction was drawn: the way through what it has passed since (path).
    /// Kept if `has_passing`.
    pub passed: f32,
    /// `PATH_*`. Kept if `has_passing`.
    pub flags: u32,
    pub _pad0: u32,
    pub _pad1: u32,
}

/// Since its direction was drawn the ray has passed an object that casts no shadow: light samples found all light beyond it.
pub const PATH_BEHIND_SHADOWLESS: u32 = 1;

/// A shadow ray with the light it carries if nothing is in the way. 80 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct ShadowRay {
    pub ray: Ray,
    /// Added to the sample, times `weight`, if nothing is in the way (throughput included).
    pub contribution: Vec4,
    pub slot: u32,
    /// Hash that dithers the conversion to fixed point (`film` in transport).
    pub dither: u32,
    /// Panes passed so far.
    pub layer: u32,
    /// What multiple importance sampling leaves of the contribution, 0..1.
    pub weight: f32,
}
