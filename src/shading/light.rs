//! Lights of zero size: point, directional, spot (rows 5, 11, 21).

use crate::layout::{
    ATTENUATION_INVERSE_SQUARE, ATTENUATION_POLYNOMIAL, LIGHT_DIRECTIONAL, LIGHT_SPOT, Light, T_INFINITE,
};
use crate::shading::lobe::cos_power;
use crate::shading::math::{clamp_, div, dot3, rcp, rsqrt};
use crate::shading::spectrum::{Spectrum, spectrum_from_rgb, spectrum_zero};
use glam::Vec3;

/// Squared distance below which a light is on the surface, where it has no direction.
const DISTANCE2_MIN: f32 = 1.0e-24;
/// Squared distance above which a light is taken as out of reach: keeps every product below finite.
const DISTANCE2_MAX: f32 = 1.0e30;
/// Penumbrae narrower than this difference of cosines are hard edges.
const EDGE_MIN: f32 = 1.0e-6;

/// One light as seen from a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightSample {
    /// Unit, world, to the light.
    pub wi: Vec3,
    /// World units; `T_INFINITE` for a directional light.
    pub distance: f32,
    /// Outgoing radiance is `eval` times this: of a light of no size intensity (directional: irradiance) times attenuation
    /// and cone; of another, and where the light was chosen at random, divided by the density of that choice.
    pub radiance: Spectrum,
    /// With which `wi` was drawn; 0 for a light of no size, which no other ray meets.
    pub pdf_solid_angle: f32,
}

/// No light, from a valid direction.
#[inline]
pub fn no_light() -> LightSample {
    LightSample { wi: Vec3::new(0.0, 0.0, 1.0), distance: 0.0, radiance: spectrum_zero(), pdf_solid_angle: 0.0 }
}

/// Fall-off with distance, 0.. : 1/d^2, or the lecture's min(1, 1/(c1 + c2 d + c3 d^2)), or 1.
/// `distance2`: its square, within `DISTANCE2_MIN` and `DISTANCE2_MAX`.
#[inline]
pub fn attenuate(light: &Light, distance: f32, distance2: f32) -> f32 {
    match light.attenuation {
        ATTENUATION_INVERSE_SQUARE => rcp(distance2),
        ATTENUATION_POLYNOMIAL => {
            let polynomial = (light.c.x + light.c.y * distance) + light.c.z * distance2;
            if polynomial <= 1.0 { 1.0 } else { rcp(polynomial) }
        }
        // ATTENUATION_NONE
        _ => 1.0,
    }
}

/// A spot's factor, 0..1: cos^p of the angle off the axis (Warn 1983, "Lighting Controls for Synthetic Images"),
/// zero beyond the cone, with a smooth step 3 t^2 - 2 t^3 in the cosine between its inner and outer edge.
/// `cos_axis`: cosine between the axis and the direction from the light.
#[inline]
pub fn spot_factor(light: &Light, cos_axis: f32) -> f32 {
    if cos_axis < light.cos_outer {
        return 0.0;
    }
    let edge = light.cos_inner - light.cos_outer;
    let t = if edge < EDGE_MIN { 1.0 } else { clamp_(div(cos_axis - light.cos_outer, edge), 0.0, 1.0) };
    ((t * t) * (3.0 - 2.0 * t)) * cos_power(cos_axis, light.exponent)
}

/// Whether Warn's flaps, planes of constant x, y or z of the world, let the light reach `position`: it is between them on
/// every axis (Warn 1983, "Lighting Controls for Synthetic Images": barn doors).
#[inline]
#[allow(clippy::manual_range_contains, reason = "to read like its twin")]
pub fn within_flaps(light: &Light, position: Vec3) -> bool {
    let (low, high) = (light.flaps_min, light.flaps_max);
    (position.x >= low.x && position.x <= high.x)
        && (position.y >= low.y && position.y <= high.y)
        && (position.z >= low.z && position.z <= high.z)
}

/// The light as seen from `position` (world). Zero radiance, but a valid direction, if the two coincide or flaps are between.
#[inline]
#[allow(clippy::manual_range_contains, reason = "to read like its twin")]
pub fn sample_light(light: &Light, position: Vec3) -> LightSample {
    if !within_flaps(light, position) {
        return no_light();
    }
    if light.kind == LIGHT_DIRECTIONAL {
        return LightSample {
            wi: -light.direction,
            distance: T_INFINITE,
            radiance: spectrum_from_rgb(light.intensity),
            pdf_solid_angle: 0.0,
        };
    }
    let to_light = light.position - position;
    let distance2 = dot3(to_light, to_light);
    if distance2 < DISTANCE2_MIN || distance2 > DISTANCE2_MAX {
        return no_light();
    }
    let inverse = rsqrt(distance2);
    let wi = to_light * inverse;
    let distance = distance2 * inverse;
    let mut factor = attenuate(light, distance, distance2);
    if light.kind == LIGHT_SPOT {
        factor *= spot_factor(light, -dot3(wi, light.direction));
    }
    LightSample { wi, distance, radiance: spectrum_from_rgb(light.intensity * factor), pdf_solid_angle: 0.0 }
}
