//! How bright the lights of a scene are that come in absolute units.

use super::bounds::Bounds;
use crate::scene::{Light, LightKind, Scene};
use std::f64::consts::PI;

/// Radiance of a white surface at the scene's centre that faces all lights, shadows and cones aside.
pub(super) fn light_level(scene: &Scene) -> f64 {
    let bounds = Bounds::of(scene);
    let irradiance = |light: &Light| {
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

/// The film's unit for a scene of this light level: 2^0 where the film holds it well, so that most scenes have the same.
pub(super) fn unit_exponent(level: f64) -> i32 {
    let (_, exponent) = libm::frexp(level);
    if (-6..=8).contains(&exponent) { 0 } else { exponent.clamp(-40, 40) }
}
