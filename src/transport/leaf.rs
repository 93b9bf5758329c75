//! Which material of a blend a path meets.

use super::DIMENSION_LEAF;
use crate::layout::{MAX_LEAVES, MODEL_BLEND, SceneView, load_material};
use crate::shading::math::{clamp_, div};
use crate::shading::sampling::{SampleKey, sample_1d};

/// The material itself, or of a blend one that is none, drawn by the weights: (1 - extra) of the first, extra of the second.
/// `index`: into the materials. `key`: of the path, which meets one surface at most.
pub fn leaf_material(scene: &SceneView, index: u32, key: SampleKey) -> u32 {
    let mut leaf = index;
    let mut material = load_material(scene, leaf);
    if material.model != MODEL_BLEND {
        return leaf;
    }
    let mut u = sample_1d(key, DIMENSION_LEAF);
    for _ in 0..MAX_LEAVES {
        if material.model == MODEL_BLEND {
            let weight = clamp_(material.extra, 0.0, 1.0);
            let second = u < weight;
            // What is left of u is as random again.
            u = if second { div(u, weight) } else { div(u - weight, 1.0 - weight) };
            leaf = if second { material.table + 1 } else { material.table };
            material = load_material(scene, leaf);
        }
    }
    leaf
}
