//! Distributions and shadowing of microfacets.
//!
//! Directions are in the local frame; wm is a facet's normal. Slopes: tan^2 of the angle between wm and N.

use crate::shading::math::{INV_PI, cos_turns, div, exp_, log_, max_, min_, rsqrt, sin_turns, sqrt_};
use glam::{Vec2, Vec3};

/// The smallest rms slope; smaller values are taken as this. Below it one ULP of a half vector moves D visibly, and
/// D(0) = 1 / (pi m^2) = 3.2e5 would outgrow the film; a mirror is `MODEL_MIRROR`.
pub const M_MIN: f32 = 1.0e-3;

/// Beyond e^-60 a distribution counts as zero, so that no subnormal appears further on.
const EXPONENT_MAX: f32 = 60.0;

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
