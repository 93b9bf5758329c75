//! A light meter for scenes whose lights are in absolute units, as a camera would have.

use super::bounds::Bounds;
use crate::scene::{LightKind, Scene};
use std::f64::consts::PI;

/// Radiance of a white surface at the scene's centre that faces all lights, as metered pictures show it.
const EXPOSED: f64 = 0.8;
/// Scenes metered within these are left as their author made them.
const ACCEPTED: std::ops::RangeInclusive<f64> = 0.1..=2.0;

/// Scales all lights of `scene` by one factor, if a white surface at its centre would be far too bright or too dark to see;
/// says so in a warning. Emission is not scaled: it is shown as it is.
pub(super) fn expose(scene: &mut Scene) {
    let metered = meter(scene);
    if ACCEPTED.contains(&metered) || !(metered > 0.0 && metered.is_finite()) {
        return;
    }
    let factor = EXPOSED / metered;
    for light in &mut scene.lights {
        light.intensity = (light.intensity.as_dvec3() * factor).as_vec3();
    }
    scene.warnings.push(format!("lights are scaled by {factor:.3e}, so that the picture is neither black nor white"));
}

/// Irradiance at the centre from all lights, shadows and cones aside, over pi.
fn meter(scene: &Scene) -> f64 {
    let bounds = Bounds::of(scene);
    let irradiance = |light: &crate::scene::Light| {
        let intensity = light.intensity.as_dvec3();
        let luminance = 0.2126 * intensity.x + 0.7152 * intensity.y + 0.0722 * intensity.z;
        match light.kind {
            LightKind::Directional { .. } => luminance,
            LightKind::Point { position } | LightKind::Spot { position, .. } => {
                // A lamp within the scene lights what is around it, not the centre.
                let distance = (position.as_dvec3() - bounds.centre()).length().max(bounds.radius() * 0.5);
                luminance / (distance * distance)
            }
        }
    };
    scene.lights.iter().map(irradiance).sum::<f64>() / PI
}
