//! Which material of a blend a path meets.

use super::DIMENSION_LEAF;
use super::textured::material_at;
use crate::layout::{Hit, MAX_LEAVES, MODEL_BLEND, Material, SceneView};
use crate::shading::math::{clamp_, div};
use crate::shading::sampling::{SampleKey, sample_1d};
use crate::trace::surface::Surface;
use glam::Vec3;

/// The material of `surface`, found for `hit` along `direction` (`material_at`), and of a blend one that is none, drawn by
/// the weights: (1 - extra) of the first, extra of the second. `surface` becomes that material's.
/// `key`: of the path, which meets one surface at most.
pub fn leaf_material(scene: &SceneView, direction: Vec3, hit: &Hit, key: SampleKey, surface: &mut Surface) -> Material {
    let bare = *surface;
    let mut leaf = bare.material;
    let mut u = sample_1d(key, DIMENSION_LEAF);
    let mut depth = 0;
    loop {
        *surface = bare;
        surface.material = leaf;
        let material = material_at(scene, direction, hit, surface);
        if material.model != MODEL_BLEND || depth == MAX_LEAVES {
            return material;
        }
        let weight = clamp_(material.extra, 0.0, 1.0);
        let second = u < weight;
        // What is left of u is as random again.
        u = if second { div(u, weight) } else { div(u - weight, 1.0 - weight) };
        leaf = if second { material.table + 1 } else { material.table };
        depth += 1;
    }
}
