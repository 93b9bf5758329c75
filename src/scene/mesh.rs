//! Triangle meshes as loaded or tessellated.

use super::MaterialId;
use glam::{Vec2, Vec3};
use rayon::prelude::*;

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

impl Mesh {
    /// The power of two that is at most its largest coordinate, and more than half of it; 1 if all are 0. Corners of
    /// triangles count whose coordinates are all finite.
    pub fn unit(&self) -> f64 {
        let finite = |corners: &&[u32; 3]| corners.iter().all(|&i| self.positions[i as usize].is_finite());
        let used = self.triangles.par_iter().filter(finite).flatten_iter();
        let largest = used.map(|&i| self.positions[i as usize].abs().max_element()).reduce(|| 0.0, f32::max);
        if !(largest > 0.0) {
            return 1.0;
        }
        let (_, exponent) = libm::frexp(f64::from(largest));
        libm::ldexp(1.0, exponent - 1)
    }
}
