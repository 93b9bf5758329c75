//! What the reflection models share: samples, mirror directions, cosine powers, the choice between two lobes.

use crate::shading::closure::Closure;
use crate::shading::frame::{frame_from_normal, to_world};
use crate::shading::math::{INV_TWO_PI, TINY, cos_turns, div, dot3, max_, max3_, pow_, rcp, sin_turns, sqrt_};
use glam::{Vec2, Vec3};

/// Directions closer to the horizon than this cosine count as below it, so that nothing divides by zero.
pub const COS_MIN: f32 = 1.0e-6;

/// What `sample_x` returns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DirectionSample {
    /// Unit, local frame, leaving the surface.
    pub wi: Vec3,
    /// Per solid angle; 0 if the sample is to be dropped.
    pub pdf: f32,
}

/// A sample of both its parts.
#[inline]
pub fn make_direction(wi: Vec3, pdf: f32) -> DirectionSample {
    DirectionSample { wi, pdf }
}

/// The sample that is to be dropped.
#[inline]
pub fn no_direction() -> DirectionSample {
    DirectionSample { wi: Vec3::new(0.0, 0.0, 1.0), pdf: 0.0 }
}

/// True if both directions are above the horizon.
#[inline]
pub fn on_upper_side(wo: Vec3, wi: Vec3) -> bool {
    wo.z > COS_MIN && wi.z > COS_MIN
}

/// Mirror direction about the normal, local frame: R = 2 N (N.L) - L.
#[inline]
pub fn reflect_local(w: Vec3) -> Vec3 {
    Vec3::new(-w.x, -w.y, w.z)
}

/// Mirror direction of `w` about the unit vector `m`: 2 m (m.w) - w.
#[inline]
pub fn reflect_about(w: Vec3, m: Vec3) -> Vec3 {
    m * (2.0 * dot3(w, m)) - w
}

/// max(0, x)^n with 0^0 = 1. `x`: a cosine, at most 1. `n`: >= 0. Below 2^-100 it is 0.
#[inline]
pub fn cos_power(x: f32, n: f32) -> f32 {
    if n == 0.0 {
        return 1.0;
    }
    if x <= 0.0 {
        return 0.0;
    }
    // Rounded unit vectors have products a few ULP above 1, which a large n would amplify.
    if x >= 1.0 {
        return 1.0;
    }
    let power = pow_(x, n);
    if power < TINY { 0.0 } else { power }
}

/// A direction about z with density `pdf_cos_power`. `u`: 0..1 each, excluding 1. `n`: >= 0.
/// Source: Lafortune and Willems 1994, "Using the Modified Phong Reflectance Model for Physically Based Rendering".
#[inline]
pub fn sample_cos_power(u: Vec2, n: f32) -> Vec3 {
    // 1 - u is in (0, 1]: no power of zero.
    let cos_a = cos_power(1.0 - u.x, rcp(n + 1.0));
    let sin_a = sqrt_(max_((1.0 - cos_a) * (1.0 + cos_a), 0.0));
    Vec3::new(sin_a * cos_turns(u.y), sin_a * sin_turns(u.y), cos_a)
}

/// Density (n + 1) / (2 pi) cos^n a of `sample_cos_power`, per solid angle of the hemisphere.
#[inline]
pub fn pdf_cos_power(cos_a: f32, n: f32) -> f32 {
    if cos_a <= 0.0 {
        return 0.0;
    }
    ((n + 1.0) * INV_TWO_PI) * cos_power(cos_a, n)
}

/// `w`, given about z, turned so that z becomes the unit vector `axis`.
#[inline]
pub fn turn_to(axis: Vec3, w: Vec3) -> Vec3 {
    to_world(frame_from_normal(axis), w)
}

/// Probability of sampling the specular lobe rather than the diffuse one, 0..1: by weight and brightest channel.
/// Zero if the material reflects nothing.
#[inline]
pub fn specular_probability(closure: &Closure) -> f32 {
    let diffuse = closure.k_d * max3_(closure.color);
    let specular = closure.k_s * max3_(closure.specular_color);
    let sum = diffuse + specular;
    if sum > 1.0e-20 { div(specular, sum) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_power_of_zero_is_one_for_exponent_zero_only() {
        assert_eq!(cos_power(0.0, 0.0), 1.0);
        assert_eq!(cos_power(-0.5, 0.0), 1.0);
        assert_eq!(cos_power(0.0, 2.0), 0.0);
        assert_eq!(cos_power(-0.5, 2.0), 0.0);
        assert_eq!(cos_power(1.000_000_2, 1e9), 1.0);
        assert_eq!(cos_power(0.01, 1000.0), 0.0);
        assert!((cos_power(0.5, 8.0) - 0.003_906_25).abs() < 1e-8);
    }

    #[test]
    fn turning_takes_z_to_the_axis_and_keeps_angles() {
        let axis = Vec3::new(-0.48, 0.6, 0.64);
        assert!((turn_to(axis, Vec3::Z) - axis).length() < 1e-6);
        let w = Vec3::new(0.36, -0.48, 0.8);
        assert!((turn_to(axis, w).dot(axis) - 0.8).abs() < 1e-6);
        assert!((turn_to(axis, w).length() - 1.0).abs() < 1e-6);
    }

    #[test]
    fn the_specular_share_follows_weights_and_colours() {
        let mut closure =
            Closure { k_d: 0.25, k_s: 0.75, color: Vec3::ONE, specular_color: Vec3::ONE, ..Closure::default() };
        assert_eq!(specular_probability(&closure), 0.75);
        closure.color = Vec3::ZERO;
        assert_eq!(specular_probability(&closure), 1.0);
        closure.k_s = 0.0;
        assert_eq!(specular_probability(&closure), 0.0);
    }

    #[test]
    fn reflection_about_a_facet_halves_the_angle() {
        let (wo, m) = (Vec3::new(0.6, 0.0, 0.8), Vec3::Z);
        assert!((reflect_about(wo, m) - reflect_local(wo)).length() < 1e-6);
        assert!((reflect_about(wo, wo) - wo).length() < 1e-6);
    }
}
