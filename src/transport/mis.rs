//! Multiple importance sampling where things are in the way: what the two ways to find light could both have found.

use super::weight::power_heuristic;
use crate::layout::{INSTANCE_NO_SHADOW, PATH_BEHIND_SHADOWLESS, PathState, SceneView, load_instance};
use crate::trace::surface::Surface;

/// Weight of light that `path` has met where light samples would have had density `sampled`; `path.pdf` > 0.
pub fn met_weight(scene: &SceneView, path: &PathState, sampled: f32) -> f32 {
    if scene.features.has_shadowless && (path.flags & PATH_BEHIND_SHADOWLESS) != 0 && sampled > 0.0 {
        return 0.0;
    }
    power_heuristic(path.pdf, sampled)
}

/// Notes that `path` goes straight on through `surface`, which it has met at `t`. `filtered`: shadow rays go through it as well,
/// with what it lets through.
pub fn pass_surface(scene: &SceneView, surface: &Surface, t: f32, filtered: bool, path: &mut PathState) {
    if scene.features.has_shadowless && (load_instance(scene, surface.instance).flags & INSTANCE_NO_SHADOW) != 0 {
        path.flags |= PATH_BEHIND_SHADOWLESS;
        path.passed += t;
    } else if filtered {
        path.passed += t;
    } else {
        path.pdf = 0.0;
    }
}
