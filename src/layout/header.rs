//! What every kernel knows of the scene and of the batch in hand.

use bytemuck::{Pod, Zeroable};
use glam::Vec3;

use super::camera::Camera;

/// Where each array of the data heap begins, in 16-byte words. The heap has the arrays in this order; they are those of
/// `SceneView` with the same names. 48 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct HeapStarts {
    pub instances: u32,
    pub top_instances: u32,
    pub faces: u32,
    pub vertices: u32,
    pub materials: u32,
    pub parameters: u32,
    pub lights: u32,
    pub textures: u32,
    pub texels: u32,
    pub tables: u32,
    pub emitters: u32,
    pub environments: u32,
}

/// Scene-wide values. 256 bytes. What the scene asks for by kind is in `Features`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct SceneHeader {
    pub camera: Camera,
    /// I_a of the ambient term (radiance).
    pub ambient: Vec3,
    pub max_depth: u32,
    /// Radiance where a ray leaves the scene, towards -up and +up of the world (equal for a flat background).
    pub background_bottom: Vec3,
    /// Branches whose largest |throughput| falls below this are cut.
    pub min_weight: f32,
    pub background_top: Vec3,
    pub seed: u32,
    pub first: HeapStarts,
    /// For the stratified sampler: strata per axis, >= 1.
    pub strata: u32,
    /// Half width of the film's filter in pixels.
    pub filter_radius: f32,
    /// Integral of |filter| over integral of filter, both axes: the weight of every sample before its sign.
    pub filter_norm: f32,
    /// First float of the filter's inverse CDF in the table array; FILTER_KNOTS + 1 positions, then FILTER_KNOTS signs.
    pub filter_table: u32,
    /// Root of the top-level BVH, or INVALID for an empty scene.
    pub top_root: u32,
    pub instance_count: u32,
    pub light_count: u32,
    pub material_count: u32,
    pub emitter_count: u32,
    /// 2^film scale: k + e of the fixed-point film (strict rule 8), as a float power of two.
    pub film_scale: f32,
    /// Relative widening of the top level's box test (`approx_intersect_node`): covers the rounding of rays in object space.
    pub top_margin: f32,
    /// First float in the table array of the emitters' alias table: threshold and other emitter's index of each.
    pub emitter_table: u32,
    /// Probability of choosing the environment among the emitters; 0 if it is none.
    pub environment_density: f32,
    /// Rays that have scattered this often or more take part in Russian roulette (path).
    pub rr_depth: u32,
    /// Largest |lane| of light that has been scattered, per contribution; 0 for no limit (path).
    pub clamp: f32,
    /// Levels of pending rays: one per depth where rays branch, else one.
    pub level_count: u32,
    /// Shadow rays that one shaded ray sends, at most.
    pub shadow_rays: u32,
    /// First float in the table array of the media that have a rank: index and Beer coefficient of each, from rank 1 on.
    pub media_table: u32,
    pub _pad0: u32,
    pub _pad1: u32,
}

/// Intervals in the tabulated filter's inverse CDF.
pub const FILTER_KNOTS: u32 = 256;

/// What one batch of samples covers. 48 bytes.
/// Slot i is pixel `first_pixel + i / sample_count` of the crop (row by row) and sample `first_sample + i % sample_count`:
/// what runs side by side looks the same way.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Batch {
    /// Corner and size of the crop, pixels of the full frame.
    pub crop_x: u32,
    pub crop_y: u32,
    pub crop_width: u32,
    pub crop_height: u32,
    pub first_pixel: u32,
    pub pixel_count: u32,
    pub first_sample: u32,
    pub sample_count: u32,
    pub slot_count: u32,
    /// 1 if the film holds nothing yet of these pixels.
    pub is_first: u32,
    pub _pad0: u32,
    pub _pad1: u32,
}
