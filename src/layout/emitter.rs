//! What `path` samples light from.

use bytemuck::{Pod, Zeroable};
use glam::{Vec3, Vec4};

pub const EMITTER_TRIANGLE: u32 = 0;
/// The unit sphere under the instance's transform.
pub const EMITTER_SPHERE: u32 = 1;
/// A light of no size: `instance` is its index.
pub const EMITTER_LIGHT: u32 = 2;
/// Whatever a ray that leaves the scene sees.
pub const EMITTER_ENVIRONMENT: u32 = 3;

/// Emitter flag: it shines from the outside only.
pub const EMITTER_ONE_SIDED: u32 = 1;
/// Emitter flag: `radiance` does not hold everywhere, the material's textures have to be asked.
pub const EMITTER_TEXTURED: u32 = 2;

/// One emitter. 80 bytes. World space.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Emitter {
    /// First corner of a triangle.
    pub corner: Vec3,
    /// `EMITTER_*`.
    pub kind: u32,
    /// From the first corner to the others.
    pub edge1: Vec3,
    pub instance: u32,
    pub edge2: Vec3,
    pub primitive: u32,
    /// Unit, leaves the outside of a triangle.
    pub normal: Vec3,
    /// Probability of choosing this emitter; of a triangle per unit of its area.
    pub density: f32,
    /// Of every point in every direction (triangles and spheres).
    pub radiance: Vec3,
    /// `EMITTER_ONE_SIDED`, `EMITTER_TEXTURED`.
    pub flags: u32,
}

/// An equirectangular image around the scene and what is needed to draw directions from it. 80 bytes.
/// The image's top row is +y, its centre +z, a quarter from the left +x, all in the environment's own space.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct EnvironmentMap {
    /// Rotation from world space; the fourth column is 0.
    pub to_local: [Vec4; 3],
    /// Factor on the image.
    pub scale: Vec3,
    /// Index of the image.
    pub texture: u32,
    /// Size of the image, texels.
    pub width: u32,
    pub height: u32,
    /// First float in the table array: density at each vertex of the grid, (height + 2) rows of width, then the CDFs of
    /// its cells within each of (height + 1) rows (width + 1 floats each), then the CDF of rows (height + 2 floats).
    pub first_table: u32,
    pub _pad0: u32,
}
