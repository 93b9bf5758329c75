//! What becomes of a shadow ray that panes colour on its way (row 22 without the lecture's assumption).

use super::generate::sample_key;
use super::textured::material_at;
use super::{DIMENSION_LEAF, Queues, add_contribution, count_limited, push_shadow};
use crate::layout::{Hit, INVALID, SceneView, ShadowRay};
use crate::shading::material::pane_tint;
use crate::shading::spectrum::{spectrum_flush, spectrum_max};
use crate::trace::spawn::spawn_through;
use crate::trace::surface::surface_at;

/// Adds the light of a shadow ray whose way is free. Where `hit`, the nearest thing in its way, is a pane, the ray goes on
/// behind it with what the pane lets through: tints are multiplied in the order of distance, whatever the order in which
/// rays are traced. A blend's material is drawn anew for each pane and light.
pub fn shade_shadow(scene: &SceneView, shadow: &ShadowRay, hit: &Hit, queues: &mut Queues) {
    if hit.instance == INVALID {
        if shadow.limited != 0 {
            count_limited(queues);
        }
        add_contribution(queues, scene.header.film_scale, shadow.slot, shadow.contribution, shadow.dither);
        return;
    }
    let key = sample_key(scene.header, shadow.dither, shadow.layer, 0);
    let mut surface = surface_at(scene, &shadow.ray, hit);
    let material = material_at(scene, shadow.ray.direction, hit, key, DIMENSION_LEAF, &mut surface);
    let mut beyond = *shadow;
    beyond.contribution = spectrum_flush(shadow.contribution * pane_tint(&material));
    if spectrum_max(beyond.contribution) <= 0.0 {
        return;
    }
    beyond.ray = spawn_through(&surface, shadow.ray.direction, shadow.ray.t_max - hit.t);
    beyond.layer = shadow.layer + 1;
    push_shadow(queues, beyond);
}
