//! Materials with their textures.

use crate::layout::{INVALID, Material, SceneView, load_material, load_texture};
use crate::shading::texture::sample_texture;
use crate::trace::surface::Surface;
use glam::Vec3;

/// The surface's material with its texture and vertex colour applied.
pub fn material_at(scene: &SceneView, surface: &Surface) -> Material {
    let mut material = load_material(scene, surface.material);
    material.color *= surface.color;
    if material.color_texture != INVALID {
        let texel = sample_texture(scene, &load_texture(scene, material.color_texture), surface.uv);
        material.color *= Vec3::new(texel.x, texel.y, texel.z);
    }
    material
}
