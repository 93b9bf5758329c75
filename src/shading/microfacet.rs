//! Distributions and shadowing of microfacets.
//!
//! Directions are in the local frame; wm is a facet's normal. Slopes: tan^2 of the angle between wm and N.

use crate::shading::math::{INV_PI, cos_turns, div, exp_, log_, max_, min_, rsqrt, sin_turns, sqrt_};
use glam::{Vec2, Vec3};

/// The smallest rms slope; smaller values are taken as this. Below it one ULP of a half vector moves D visibly, and
/// D(0) = 1 / (pi m^2) = 3.2e5 would outgrow the film; a mirror is `MODEL_MIRROR`.
pub const M_MIN: f32 = 1.0e-3;

/// Beyond e^-60 a distribution counts as zero, so that no subnormal appears further on.
pub const EXPONENT_MAX: f32 = 60.0;

/// tan^2 of the angle between w (any length) and z. `w.z` > 0.
#[inline]
pub fn tan2_theta(w: Vec3) -> f32 {
    div(w.x * w.x + w.y * w.y, w.z * w.z)
}

/// Beckmann's distribution from the squared slope, per steradian:
/// e^(-tan^2 a / m^2) / (pi m^2 cos^4 a), so that the integral of D cos a over the hemisphere is 1.
/// `tan2`: >= 0. `m`: rms slope, >= `M_MIN` (clamped).
/// Source: Cook and Torrance 1982, equation for D, with the pi of Walter et al. 2007, equation 25.
/// Relative error below 2e-5, for the slope as given.
#[inline]
pub fn beckmann_d_slope(tan2: f32, m: f32) -> f32 {
    let m_clamped = max_(m, M_MIN);
    let inv_m2 = div(1.0, m_clamped * m_clamped);
    let x = tan2 * inv_m2;
    if x > EXPONENT_MAX {
        return 0.0;
    }
    // 1 / cos^2 a = 1 + tan^2 a
    let inv_c2 = 1.0 + tan2;
    ((exp_(-x) * INV_PI) * inv_m2) * (inv_c2 * inv_c2)
}

/// Beckmann's distribution from cos a = N.H; zero below the horizon. `cos_h`: -1..1. See `beckmann_d_slope`.
#[inline]
pub fn beckmann_d(cos_h: f32, m: f32) -> f32 {
    if cos_h <= 1.0e-6 {
        return 0.0;
    }
    let s2 = max_((1.0 - cos_h) * (1.0 + cos_h), 0.0);
    beckmann_d_slope(div(s2, cos_h * cos_h), m)
}

/// Weighted sum of two Beckmann lobes (Cook and Torrance 1982, section "facet slope distribution").
/// Normalised if w0 + w1 = 1; a lobe of weight 0 costs nothing.
#[inline]
pub fn beckmann_lobes_d_slope(tan2: f32, m0: f32, m1: f32, w0: f32, w1: f32) -> f32 {
    let mut d = 0.0;
    if w0 > 0.0 {
        d += w0 * beckmann_d_slope(tan2, m0);
    }
    if w1 > 0.0 {
        d += w1 * beckmann_d_slope(tan2, m1);
    }
    d
}

/// Masking and shadowing in a V-shaped groove: min(1, 2 (N.H)(N.V)/(V.H), 2 (N.H)(N.L)/(V.H)), 0..1.
/// Arguments are those cosines, 0..1. Source: Torrance and Sparrow 1967; Cook and Torrance 1982.
#[inline]
pub fn v_cavity_g(n_h: f32, n_v: f32, v_h: f32, n_l: f32) -> f32 {
    let groove = (2.0 * n_h) * min_(n_v, n_l);
    max_(min_(div(groove, max_(v_h, 1.0e-7)), 1.0), 0.0)
}

/// A facet normal with density `pdf_beckmann`. `u`: 0..1 each, excluding 1.
/// Source: Walter et al. 2007, "Microfacet Models for Refraction", equations 28 and 29.
#[inline]
pub fn sample_beckmann(u: Vec2, m: f32) -> Vec3 {
    let m_clamped = max_(m, M_MIN);
    // 1 - u is in (0, 1], where the logarithm is finite.
    let tan2 = (m_clamped * m_clamped) * max_(-log_(1.0 - u.x), 0.0);
    let cos_h = rsqrt(1.0 + tan2);
    let sin_h = sqrt_(tan2) * cos_h;
    Vec3::new(sin_h * cos_turns(u.y), sin_h * sin_turns(u.y), cos_h)
}

/// Density of `sample_beckmann` per solid angle of the facet normal: D(wm) cos a. Zero below the horizon.
#[inline]
pub fn pdf_beckmann(wm: Vec3, m: f32) -> f32 {
    if wm.z <= 1.0e-6 {
        return 0.0;
    }
    beckmann_d_slope(tan2_theta(wm), m) * wm.z
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn beckmann_has_the_lectures_values() {
        assert!((beckmann_d(1.0, 0.1) - 31.830_988).abs() < 4e-6 * 31.8);
        let cos_h = libm::cos(std::f64::consts::PI / 19.0) as f32;
        assert!((beckmann_d(cos_h, 0.1) - 2.076_730_7).abs() < 1e-5 * 2.08);
        // Two lobes of the same slope are one; D(0) of the paper's copper is (.4/.16 + .6/.04) / pi.
        let copper = beckmann_lobes_d_slope(0.0, 0.4, 0.2, 0.4, 0.6);
        assert!((copper - 5.570_423).abs() < 1e-5);
        assert_eq!(beckmann_lobes_d_slope(0.3, 0.4, 0.2, 1.0, 0.0), beckmann_d_slope(0.3, 0.4));
    }

    #[test]
    fn the_projected_area_of_all_facets_is_one() {
        // Integral of D cos a over the hemisphere = 2 pi times the integral of D cos a sin a over a, by Simpson's rule.
        for m in [M_MIN, 0.01, 0.1, 0.3, 1.0] {
            let steps = 4000;
            let end = f64::min(libm::atan(8.0 * f64::from(m)), 1.57);
            let width = end / f64::from(steps);
            let mut sum = 0.0;
            for i in 0..=steps {
                let a = width * f64::from(i);
                let tan = libm::tan(a);
                let d = f64::from(beckmann_d_slope((tan * tan) as f32, m));
                let weight = if i == 0 || i == steps { 1.0 } else { 2.0 + 2.0 * f64::from(i % 2) };
                sum += weight * d * libm::cos(a) * libm::sin(a);
            }
            let area = 2.0 * std::f64::consts::PI * sum * width / 3.0;
            assert!((area - 1.0).abs() < 1e-4, "m {m}: {area}");
        }
    }

    #[test]
    fn slopes_below_the_minimum_are_the_minimum_and_facets_below_the_horizon_are_none() {
        assert_eq!(beckmann_d(1.0, 0.0), beckmann_d(1.0, M_MIN));
        assert!(beckmann_d(1.0, 0.0).is_finite());
        assert_eq!(beckmann_d(0.0, 0.3), 0.0);
        assert_eq!(beckmann_d(-0.5, 0.3), 0.0);
        assert_eq!(pdf_beckmann(Vec3::new(0.6, 0.0, -0.8), 0.3), 0.0);
    }

    #[test]
    fn the_v_cavity_is_one_at_normal_incidence_and_falls_at_grazing() {
        assert_eq!(v_cavity_g(1.0, 1.0, 1.0, 1.0), 1.0);
        // 2 * .9 * .1 / .6 = .3, by masking and by shadowing alike.
        assert!((v_cavity_g(0.9, 0.1, 0.6, 0.8) - 0.3).abs() < 1e-7);
        assert!((v_cavity_g(0.9, 0.8, 0.6, 0.1) - 0.3).abs() < 1e-7);
        // The kink: just inside and outside of 2 (N.H)(N.V) = V.H.
        assert_eq!(v_cavity_g(0.5, 0.700_1, 0.7, 0.9), 1.0);
        assert!(v_cavity_g(0.5, 0.699, 0.7, 0.9) < 1.0);
        assert_eq!(v_cavity_g(0.5, 0.0, 0.0, 0.0), 0.0);
    }

    #[test]
    fn sampled_facets_are_unit_and_upright_for_every_random_number() {
        for x in [0.0, 1e-7, 0.3, 0.999_999_94] {
            for y in [0.0, 0.25, 0.7, 0.999_999_94] {
                for m in [0.0, 0.1, 1.0, 5.0] {
                    let wm = sample_beckmann(Vec2::new(x, y), m);
                    assert!((wm.length() - 1.0).abs() < 1e-6 && wm.z > 0.0, "{x} {y} {m}: {wm}");
                }
            }
        }
    }
}
