//! What becomes of a shadow ray.

use super::generate::sample_key;
use super::limit::add_light;
use super::local::SHADOW_END;
use super::resolve::resolve_material;
use super::{DIMENSION_LEAF, Queues, push_shadow};
use crate::layout::{Hit, INVALID, SHADOWS_FILTERED, SceneView, ShadowRay};
use crate::shading::material::pane_tint;
use crate::shading::spectrum::{spectrum_flush, spectrum_max};
use crate::trace::spawn::spawn_through;
use crate::trace::surface::surface_at;
use crate::trace::traverse::{trace_any, trace_barrier, trace_occluder};

/// A shadow ray that is longer leads out of the scene.
const FAR: f32 = 1.0e29;

/// The weight of a shadow ray over the free way from its origin to `t`. Where an object that casts no shadow is in the way, no
/// ray that a surface scatters could have found the light: it counts in full. Light from outside the scene is looked for behind
/// such objects, too (`shade_beyond`).
pub fn way_weight(scene: &SceneView, shadow: &ShadowRay, t: f32) -> f32 {
    if !scene.features.has_shadowless || shadow.weight >= 1.0 || shadow.ray.t_max > FAR {
        return shadow.weight;
    }
    let mut way = shadow.ray;
    way.t_max = t;
    if trace_barrier(scene, &way) { 1.0 } else { shadow.weight }
}

/// Lets a shadow ray go on behind `hit`, the nearest thing in its way, with what that lets through: tints are multiplied in the
/// order of distance, whatever the order in which rays are traced (row 22 without the lecture's assumption). A blend's material
/// is drawn anew for each pane and light.
pub fn filter_shadow(scene: &SceneView, shadow: &ShadowRay, hit: &Hit, queues: &mut Queues) {
    // Every layer has a sequence of its own: indices of one sequence are strata of each other.
    let key = sample_key(scene, shadow.dither, 0, shadow.layer);
    let mut surface = surface_at(scene, &shadow.ray, hit);
    let closure = resolve_material(scene, shadow.ray.direction, hit, key, DIMENSION_LEAF, &mut surface);
    let mut beyond = *shadow;
    beyond.contribution = spectrum_flush(shadow.contribution * pane_tint(&closure));
    if spectrum_max(beyond.contribution) <= 0.0 {
        return;
    }
    beyond.ray = spawn_through(&surface, shadow.ray.direction, shadow.ray.t_max - hit.t);
    beyond.layer = shadow.layer + 1;
    push_shadow(queues, beyond);
}

/// Traces a shadow ray: adds its light where nothing is in the way; with filtered shadows it may go on behind a pane.
pub fn trace_shadow(scene: &SceneView, shadow: &ShadowRay, queues: &mut Queues) {
    let mut seen = *shadow;
    if scene.features.shadows == SHADOWS_FILTERED {
        let hit = trace_occluder(scene, &shadow.ray);
        if hit.instance != INVALID {
            seen.weight = way_weight(scene, shadow, hit.t * SHADOW_END);
            filter_shadow(scene, &seen, &hit, queues);
            return;
        }
    } else if trace_any(scene, &shadow.ray) {
        return;
    }
    seen.weight = way_weight(scene, shadow, shadow.ray.t_max);
    add_light(scene, &seen, queues);
}
