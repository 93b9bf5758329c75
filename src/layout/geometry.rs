//! Geometry as the traversal and the shading steps see it.

use bytemuck::{Pod, Zeroable};
use glam::{Vec3, Vec4};

/// One node of the compressed eight-wide BVH (Ylitie, Karras and Laine 2017,
/// "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs"),
/// in obvhs's order, min and max planes interleaved per axis, but for where children stand. 80 bytes.
/// Boxes are conservative: bake has grown each child (DESIGN: strict rule 6).
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Node {
    /// Minimum corner of the node's box, object space of its mesh (or world, for the top level).
    pub origin: Vec3,
    /// Bytes 0-2: raw float exponents of the child grid per axis; byte 3: bit mask of inner children.
    pub exponents_imask: u32,
    /// Where inner children stand: that of slot s at index root - 7 + (`children` >> 8) + s, with the root of this hierarchy.
    /// The lowest byte is 0: there a walk keeps which of them it has yet to visit.
    pub children: u32,
    /// Index of the first primitive: into `triangles` (absolute) for a mesh, into `top_instances` for the top level.
    pub primitive_base: u32,
    /// Eight bytes: 0 empty; leaf = unary count in the top 3 bits + offset 0..23; inner = 001 and slot + 24.
    pub child_meta: [u32; 2],
    /// Eight quantised planes each, in units of the grid, child 0 in the lowest byte.
    pub min_x: [u32; 2],
    pub max_x: [u32; 2],
    pub min_y: [u32; 2],
    pub max_y: [u32; 2],
    pub min_z: [u32; 2],
    pub max_z: [u32; 2],
}

impl Node {
    /// Slots of the inner children and where these stand. `root`: index of the hierarchy's root. Rust only.
    pub fn inner_children(&self, root: u32) -> impl Iterator<Item = (u32, u32)> + use<> {
        let (mask, first) = (self.exponents_imask >> 24, root.wrapping_sub(7).wrapping_add(self.children >> 8));
        (0..8).filter(move |slot| mask >> slot & 1 != 0).map(move |slot| (slot, first.wrapping_add(slot)))
    }
}

/// Entries of a traversal stack, one for the top level and one for meshes; bake builds no hierarchy that needs more.
pub const STACK_SIZE: u32 = 32;

/// A triangle in traversal order: what the watertight test needs, nothing else. 48 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Triangle {
    /// Corners, object space.
    pub v0: Vec3,
    /// Index of this triangle in its mesh as written (ties and `skip` use it; it does not depend on the BVH).
    pub primitive: u32,
    pub v1: Vec3,
    pub _pad0: u32,
    pub v2: Vec3,
    pub _pad1: u32,
}

/// What an instance holds.
pub const KIND_MESH: u32 = 0;
/// The analytic unit sphere at the object-space origin.
pub const KIND_SPHERE: u32 = 1;

/// Instance flag: shadow rays pass through it.
pub const INSTANCE_NO_SHADOW: u32 = 1;
/// Instance flag: the transform mirrors (negative determinant), so winding is reversed in world space.
pub const INSTANCE_MIRRORED: u32 = 2;
/// Instance flag: its triangles are shaded at their centroid (row 8).
pub const INSTANCE_FLAT: u32 = 4;
/// Instance flag: its triangles are shaded at their corners (row 8).
pub const INSTANCE_GOURAUD: u32 = 8;

/// One placed object. 128 bytes. Matrices are three rows of four: `p' = (dot(row_i.xyz, p) + row_i.w)`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Instance {
    pub to_world: [Vec4; 3],
    pub to_object: [Vec4; 3],
    /// `KIND_*`.
    pub kind: u32,
    /// Root node of the mesh in the node array (mesh only).
    pub root: u32,
    /// First face of the mesh in the face array (mesh only).
    pub first_face: u32,
    /// Material of the whole instance, or `INVALID`: then each face names its own.
    pub material: u32,
    /// `INSTANCE_*` bits.
    pub flags: u32,
    /// Object id for the AOV: index of the object in the scene file, from 0.
    pub object: u32,
    /// Density of light samples on it, as `Emitter.density`, divided by the luminance of the material's emission.
    pub light_density: f32,
    pub _pad0: u32,
}

/// Vertex indices (absolute, into the vertex array) and material of one face, in mesh order. 16 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Face {
    pub i0: u32,
    pub i1: u32,
    pub i2: u32,
    pub material: u32,
}

/// One vertex, object space. 48 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Vertex {
    pub position: Vec3,
    pub u: f32,
    /// Unit shading normal.
    pub normal: Vec3,
    pub v: f32,
    /// Linear Rec. 709 factor on the base colour; 1 where the file has none.
    pub color: Vec3,
    pub _pad0: u32,
}
