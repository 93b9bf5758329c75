//! Triangle meshes as loaded or tessellated.

use super::MaterialId;
use glam::{Vec2, Vec3};

/// Indexed triangles. `normals`, `uvs` and `colors` are empty or as long as `positions`;
/// `face_materials` is empty or as long as `triangles`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    pub name: String,
    pub positions: Vec<Vec3>,
    /// Unit; empty: each face is flat.
    pub normals: Vec<Vec3>,
    /// v = 0 at the bottom of an image.
    pub uvs: Vec<Vec2>,
    /// Linear factor on the base colour.
    pub colors: Vec<Vec3>,
    /// Counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    pub face_materials: Vec<MaterialId>,
}
