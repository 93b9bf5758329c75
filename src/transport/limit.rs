//! The scene's limit on light that has been scattered (`clamp`).

use super::{Queues, add_contribution, count_limited};
use crate::layout::{SceneView, ShadowRay};
use crate::shading::math::div;
use crate::shading::spectrum::{Spectrum, spectrum_max};
use glam::Vec4;

/// Adds light that has been scattered `depth` times to the sample in `slot`, within the scene's limit; how often that bites is
/// counted. `coverage`: what it adds to alpha.
pub fn add_limited(
    scene: &SceneView,
    slot: u32,
    depth: u32,
    value: Spectrum,
    coverage: f32,
    dither: u32,
    queues: &mut Queues,
) {
    let largest = spectrum_max(value);
    let mut factor = 1.0;
    if scene.features.has_clamp && depth != 0 && largest > scene.header.clamp {
        factor = div(scene.header.clamp, largest);
        count_limited(queues);
    }
    let seen = value * factor;
    add_contribution(queues, scene.header.film_scale, slot, Vec4::new(seen.x, seen.y, seen.z, coverage), dither);
}

/// Adds the light of a shadow ray whose way is free. It has been scattered once at least.
pub fn add_light(scene: &SceneView, shadow: &ShadowRay, queues: &mut Queues) {
    add_limited(scene, shadow.slot, 1, shadow.contribution * shadow.weight, 0.0, shadow.dither, queues);
}
