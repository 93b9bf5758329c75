//! Distributions of microfacets along two axes: how many face a way, how many of those are seen, and one at random.
//!
//! Directions are in the local frame; alpha_u is the roughness along x, alpha_v along y. `kind`: `DISTRIBUTION_*`; the
//! Gaussian and Phong's are isotropic and take alpha_u. `scale`: the Gaussian's constant c, from bake; the others know theirs.

use crate::layout::{DISTRIBUTION_BECKMANN, DISTRIBUTION_GAUSSIAN, DISTRIBUTION_PHONG, DISTRIBUTION_TROWBRIDGE_REITZ};
use crate::shading::lobe::{COS_MIN, cos_power, pdf_cos_power, sample_cos_power};
use crate::shading::math::{
    HALF_PI, INV_PI, INV_TWO_PI, PI, atan2_, clamp_, cos_, cos_turns, div, dot3, exp_, log_, max_, min_, mix_,
    normalize3, rcp, rsqrt, sin_, sin_turns, sqrt_,
};
use crate::shading::microfacet::{EXPONENT_MAX, M_MIN};
use glam::{Vec2, Vec3};

/// 1 / sqrt(pi), and half of it.
pub const INV_SQRT_PI: f32 = 0.564189584;
pub const INV_TWO_SQRT_PI: f32 = 0.282094792;
/// Visible slopes of a Beckmann surface of unit roughness end here: e^-16 of the density is left.
pub const SLOPE_MAX: f32 = 4.0;
/// Steps of the search for a visible slope; each halves the interval at least.
pub const SLOPE_STEPS: u32 = 16;

/// The error function within 3e-7. Source: Abramowitz and Stegun 1964, equation 7.1.26.
#[inline]
pub fn erf_(x: f32) -> f32 {
    let size = min_(x.abs(), 9.0);
    let t = rcp(1.0 + 0.3275911 * size);
    let p = t * (0.254829592 + t * (-0.284496736 + t * (1.42141374 + t * (-1.45315203 + t * 1.06140543))));
    let value = 1.0 - p * exp_(-(size * size));
    if x < 0.0 { -value } else { value }
}

/// The inverse of the error function for |x| < 1 (clamped to .999999), relative error 4e-7.
/// Source: Giles 2010, "Approximating the erfinv function", table 5 (single precision).
#[inline]
pub fn erf_inverse(x: f32) -> f32 {
    let inside = clamp_(x, -0.999999, 0.999999);
    let w = -log_((1.0 - inside) * (1.0 + inside));
    if w < 5.0 {
        let s = w - 2.5;
        let p = 3.43273939e-07 + s * 2.81022636e-08;
        let q = -4.39150654e-06 + s * (-3.5233877e-06 + s * p);
        let r = -0.00125372503 + s * (0.00021858087 + s * q);
        return inside * (1.50140941 + s * (0.246640727 + s * (-0.00417768164 + s * r)));
    }
    let s = sqrt_(w) - 3.0;
    let p = 0.00134934322 + s * (0.000100950558 + s * -0.000200214257);
    let q = -0.0076224613 + s * (0.00573950773 + s * (-0.00367342844 + s * p));
    inside * (2.83297682 + s * (1.00167406 + s * (0.00943887047 + s * q)))
}

/// Blinn's exponent of a roughness: 2 / alpha^2 - 2, at least 0 (Walter et al. 2007, section 5.2: equal at small angles).
#[inline]
pub fn phong_exponent(alpha: f32) -> f32 {
    let a = max_(alpha, M_MIN);
    max_(div(2.0, a * a) - 2.0, 0.0)
}

/// The density D of facet normals, per steradian: the integral of D cos over the hemisphere is 1. `wm`: unit, z > 0.
/// Sources: Cook and Torrance 1982 (Beckmann); Torrance and Sparrow 1967 (Gaussian in the angle itself); Trowbridge and
/// Reitz 1975, as Walter et al. 2007; Blinn 1977 (Phong's); along two axes: Heitz 2014, appendix A.
#[inline]
pub fn facet_d(kind: u32, alpha_u: f32, alpha_v: f32, scale: f32, wm: Vec3) -> f32 {
    let a_u = max_(alpha_u, M_MIN);
    let a_v = max_(alpha_v, M_MIN);
    let z2 = wm.z * wm.z;
    if wm.z <= COS_MIN {
        return 0.0;
    }
    if kind == DISTRIBUTION_PHONG {
        let n = phong_exponent(a_u);
        return ((n + 2.0) * INV_TWO_PI) * cos_power(wm.z, n);
    }
    if kind == DISTRIBUTION_GAUSSIAN {
        let angle = atan2_(sqrt_(wm.x * wm.x + wm.y * wm.y), wm.z);
        let x = div(angle, a_u);
        return if x * x > EXPONENT_MAX { 0.0 } else { scale * exp_(-(x * x)) };
    }
    let x = div(wm.x, a_u);
    let y = div(wm.y, a_v);
    let slope2 = x * x + y * y;
    let area = PI * (a_u * a_v);
    if kind == DISTRIBUTION_TROWBRIDGE_REITZ {
        let s = slope2 + z2;
        return div(1.0, (area * s) * s);
    }
    let t = div(slope2, z2);
    if t > EXPONENT_MAX { 0.0 } else { div(exp_(-t), (area * z2) * z2) }
}

/// sqrt((alpha_u x)^2 + (alpha_v y)^2): the roughness in the direction of `w` times its sine.
#[inline]
pub fn stretched_sine(alpha_u: f32, alpha_v: f32, w: Vec3) -> f32 {
    let x = max_(alpha_u, M_MIN) * w.x;
    let y = max_(alpha_v, M_MIN) * w.y;
    sqrt_(x * x + y * y)
}

/// Smith's Lambda of a direction, >= 0: 1 / (1 + Lambda) of the facets that face `w` are seen from there. |w.z| > 0.
/// Exact for Trowbridge and Reitz; for Beckmann (and the Gaussian, whose own has no closed form) the rational fit, within .35 %.
/// Phong's slopes are Student's (Ribardiere et al. 2017) with Lambda = C (tan sin^(n+1) / (n+1) - the integral of sin^(n+1) up
/// to theta), C its inverse over 0..pi: Trowbridge and Reitz's at n = 0, Beckmann's for n without bound, and between the two
/// their mean by 1 / (n + 1), whose 1 / (1 + Lambda) is within 1 %.
/// Source: Walter et al. 2007, equations 15 and 34; Heitz 2014.
#[inline]
pub fn smith_lambda(kind: u32, alpha_u: f32, alpha_v: f32, w: Vec3) -> f32 {
    let cos_w = w.z.abs();
    let a_u = if kind == DISTRIBUTION_PHONG { min_(alpha_u, 1.0) } else { alpha_u };
    let along_both = kind == DISTRIBUTION_BECKMANN || kind == DISTRIBUTION_TROWBRIDGE_REITZ;
    let across = stretched_sine(a_u, if along_both { alpha_v } else { a_u }, w);
    let t = div(across, max_(cos_w, COS_MIN));
    let long_tailed = 0.5 * (sqrt_(1.0 + t * t) - 1.0);
    if kind == DISTRIBUTION_TROWBRIDGE_REITZ {
        return long_tailed;
    }
    let mut short_tailed: f32 = 0.0;
    if cos_w < 1.6 * across {
        let a = div(max_(cos_w, COS_MIN), across);
        short_tailed = div(1.0 + a * (-1.259 + a * 0.396), a * (3.535 + a * 2.181));
    }
    if kind != DISTRIBUTION_PHONG {
        return short_tailed;
    }
    mix_(short_tailed, long_tailed, rcp(1.0 + phong_exponent(a_u)))
}

/// Smith's masking of one direction, 0..1.
#[inline]
pub fn smith_g1(kind: u32, alpha_u: f32, alpha_v: f32, w: Vec3) -> f32 {
    rcp(1.0 + smith_lambda(kind, alpha_u, alpha_v, w))
}

/// Masking times shadowing as if they were independent (Walter et al. 2007, equation 23).
#[inline]
pub fn smith_g_separable(kind: u32, alpha_u: f32, alpha_v: f32, wo: Vec3, wi: Vec3) -> f32 {
    smith_g1(kind, alpha_u, alpha_v, wo) * smith_g1(kind, alpha_u, alpha_v, wi)
}

/// Masking and shadowing correlated by the height of the facets (Heitz 2014, equation 99).
#[inline]
pub fn smith_g_correlated(kind: u32, alpha_u: f32, alpha_v: f32, wo: Vec3, wi: Vec3) -> f32 {
    rcp((1.0 + smith_lambda(kind, alpha_u, alpha_v, wo)) + smith_lambda(kind, alpha_u, alpha_v, wi))
}

/// Area of the visible facets as seen along `w`: w.z (1 + Lambda), Beckmann's exact. `w.z` > 0.
#[inline]
pub fn visible_area(kind: u32, alpha_u: f32, alpha_v: f32, w: Vec3) -> f32 {
    let across = stretched_sine(alpha_u, alpha_v, w);
    if kind == DISTRIBUTION_TROWBRIDGE_REITZ {
        return 0.5 * (w.z + sqrt_(w.z * w.z + across * across));
    }
    if w.z >= 6.0 * across {
        return w.z;
    }
    let a = div(w.z, across);
    0.5 * (w.z * (1.0 + erf_(a))) + INV_TWO_SQRT_PI * (across * exp_(-(a * a)))
}

/// A slope of a Beckmann surface of unit roughness seen at an angle, along the direction of sight.
/// `cos_v`, `sin_v`: of that angle, both >= 0. `u`: 0..1. Density proportional to (cos_v - x sin_v) e^(-x^2): its integral
/// is inverted by bisection and Newton's steps, within 1e-6. Source: Heitz and d'Eon 2014, supplemental 1.
#[inline]
pub fn visible_slope(cos_v: f32, sin_v: f32, u: f32) -> f32 {
    let cot = if sin_v > 1.0e-6 { div(cos_v, sin_v) } else { SLOPE_MAX };
    let mut high = min_(cot, SLOPE_MAX);
    let mut low = -SLOPE_MAX;
    let whole = 0.5 * (cos_v * (1.0 + erf_(high))) + INV_TWO_SQRT_PI * (sin_v * exp_(-(high * high)));
    let target = u * whole;
    let mut x: f32 = 0.0;
    if x >= high {
        x = 0.5 * (low + high);
    }
    for _ in 0..SLOPE_STEPS {
        let bell = exp_(-(x * x));
        let reached = 0.5 * (cos_v * (1.0 + erf_(x))) + INV_TWO_SQRT_PI * (sin_v * bell);
        if reached < target {
            low = x;
        } else {
            high = x;
        }
        let steepness = INV_SQRT_PI * ((cos_v - x * sin_v) * bell);
        let next = x + div(target - reached, max_(steepness, 1.0e-12));
        x = if next > low && next < high { next } else { 0.5 * (low + high) };
    }
    x
}

/// A facet normal of Beckmann or of Trowbridge and Reitz as seen from `wo`, with density `pdf_facet`. `wo.z` > 0.
/// Source: Heitz 2018, "Sampling the GGX Distribution of Visible Normals", listing 1; Heitz and d'Eon 2014 (Beckmann).
#[inline]
pub fn sample_visible(kind: u32, alpha_u: f32, alpha_v: f32, wo: Vec3, u: Vec2) -> Vec3 {
    let a_u = max_(alpha_u, M_MIN);
    let a_v = max_(alpha_v, M_MIN);
    // section 3.2: stretch the view
    let view = normalize3(Vec3::new(a_u * wo.x, a_v * wo.y, wo.z));
    let across2 = view.x * view.x + view.y * view.y;
    let inv_across = rsqrt(max_(across2, 1.0e-20));
    let upright = across2 <= 1.0e-14;
    let cos_a = if upright { 1.0 } else { view.x * inv_across };
    let sin_a = if upright { 0.0 } else { view.y * inv_across };
    if kind == DISTRIBUTION_TROWBRIDGE_REITZ {
        // section 4.2: half a disk and half an ellipse
        let radius = sqrt_(u.x);
        let t1 = radius * cos_turns(u.y);
        let mut t2 = radius * sin_turns(u.y);
        let s = view.z * 0.5 + 0.5;
        t2 = (1.0 - s) * sqrt_(max_(1.0 - t1 * t1, 0.0)) + s * t2;
        let t3 = sqrt_(max_((1.0 - t1 * t1) - t2 * t2, 0.0));
        // section 4.3: back onto the hemisphere, T1 = (-sin, cos, 0), T2 = view x T1
        let x = (t3 * view.x - t1 * sin_a) - (t2 * view.z) * cos_a;
        let y = (t3 * view.y + t1 * cos_a) - (t2 * view.z) * sin_a;
        let z = t3 * view.z + t2 * (view.x * cos_a + view.y * sin_a);
        // section 3.4: unstretch
        return normalize3(Vec3::new(a_u * x, a_v * y, max_(z, 1.0e-6)));
    }
    let along = visible_slope(view.z, sqrt_(across2), u.x);
    let across = erf_inverse(2.0 * u.y - 1.0);
    let slope_x = along * cos_a - across * sin_a;
    let slope_y = along * sin_a + across * cos_a;
    normalize3(Vec3::new(-(a_u * slope_x), -(a_v * slope_y), 1.0))
}

/// The Gaussian's e^(-(pi / 2 alpha)^2): what lies beyond the horizon.
#[inline]
pub fn gaussian_rest(alpha: f32) -> f32 {
    let x = div(HALF_PI, alpha);
    if x * x > EXPONENT_MAX { 0.0 } else { exp_(-(x * x)) }
}

/// A facet normal with density `pdf_facet`: of those seen from `wo` (Beckmann, Trowbridge and Reitz), else of all.
/// `u`: 0..1 each, excluding 1.
#[inline]
pub fn sample_facet(kind: u32, alpha_u: f32, alpha_v: f32, wo: Vec3, u: Vec2) -> Vec3 {
    if kind == DISTRIBUTION_PHONG {
        return sample_cos_power(u, phong_exponent(alpha_u) + 1.0);
    }
    if kind == DISTRIBUTION_GAUSSIAN {
        let a = max_(alpha_u, M_MIN);
        let angle = min_(a * sqrt_(max_(-log_(1.0 - u.x * (1.0 - gaussian_rest(a))), 0.0)), HALF_PI);
        let sin_h = sin_(angle);
        return Vec3::new(sin_h * cos_turns(u.y), sin_h * sin_turns(u.y), cos_(angle));
    }
    sample_visible(kind, alpha_u, alpha_v, wo, u)
}

/// Density of `sample_facet` per steradian of the facet normal. `wm`: unit. `wo.z` > 0.
#[inline]
pub fn pdf_facet(kind: u32, alpha_u: f32, alpha_v: f32, wo: Vec3, wm: Vec3) -> f32 {
    if wm.z <= COS_MIN {
        return 0.0;
    }
    if kind == DISTRIBUTION_PHONG {
        return pdf_cos_power(wm.z, phong_exponent(alpha_u) + 1.0);
    }
    if kind == DISTRIBUTION_GAUSSIAN {
        let a = max_(alpha_u, M_MIN);
        let sin_h = sqrt_(wm.x * wm.x + wm.y * wm.y);
        let angle = atan2_(sin_h, wm.z);
        let x = div(angle, a);
        if x * x > EXPONENT_MAX {
            return 0.0;
        }
        // 2 t / a^2 e^(-t^2 / a^2) of the angle t, over 2 pi sin t
        let ring = if sin_h > 1.0e-7 { div(angle, sin_h) } else { 1.0 };
        return div((INV_PI * ring) * exp_(-(x * x)), (a * a) * (1.0 - gaussian_rest(a)));
    }
    let d = facet_d(kind, alpha_u, alpha_v, 1.0, wm);
    div(d * max_(dot3(wo, wm), 0.0), visible_area(kind, alpha_u, alpha_v, wo))
}

/// Part of the sphere cap of visible facets that reflection needs, as a factor on the stretched view's cosine, 0..1: facets
/// further down mirror `wo` below the horizon. `wo.z` > 0.
/// Source: Eto and Tokuyoshi 2023, "Bounded VNDF Sampling for Smith-GGX Reflections", equation 5; Tokuyoshi and Eto 2024, "Bounded
/// VNDF Sampling for the Smith-GGX BRDF" (two roughnesses).
#[inline]
pub fn reflection_bound(alpha_u: f32, alpha_v: f32, wo: Vec3) -> f32 {
    let a = min_(min_(max_(alpha_u, M_MIN), max_(alpha_v, M_MIN)), 1.0);
    let a2 = a * a;
    let s = 1.0 + sqrt_(wo.x * wo.x + wo.y * wo.y);
    let s2 = s * s;
    div((1.0 - a2) * s2, s2 + a2 * (wo.z * wo.z))
}

/// A facet normal to mirror `wo` about, with density `pdf_reflecting`: of Trowbridge and Reitz only of those that are seen and may
/// send it above the horizon, else as `sample_facet`. `wo.z` > 0. `u`: 0..1 each, excluding 1.
/// Source: Dupuy and Benyoub 2023, "Sampling Visible GGX Normals with Spherical Caps", listing 3, and `reflection_bound`.
#[inline]
pub fn sample_reflecting(kind: u32, alpha_u: f32, alpha_v: f32, wo: Vec3, u: Vec2) -> Vec3 {
    if kind != DISTRIBUTION_TROWBRIDGE_REITZ {
        return sample_facet(kind, alpha_u, alpha_v, wo, u);
    }
    let a_u = max_(alpha_u, M_MIN);
    let a_v = max_(alpha_v, M_MIN);
    let view = normalize3(Vec3::new(a_u * wo.x, a_v * wo.y, wo.z));
    let lowest = reflection_bound(alpha_u, alpha_v, wo) * view.z;
    let z = (1.0 - u.x) * (1.0 + lowest) - lowest;
    let sin_c = sqrt_(max_((1.0 - z) * (1.0 + z), 0.0));
    let h = Vec3::new(sin_c * cos_turns(u.y), sin_c * sin_turns(u.y), z) + view;
    normalize3(Vec3::new(a_u * h.x, a_v * h.y, max_(h.z, 1.0e-6)))
}

/// Density of `sample_reflecting` per steradian of the facet normal, for those that mirror `wo` above the horizon. `wm`: unit.
/// `wo.z` > 0.
#[inline]
pub fn pdf_reflecting(kind: u32, alpha_u: f32, alpha_v: f32, wo: Vec3, wm: Vec3) -> f32 {
    if kind != DISTRIBUTION_TROWBRIDGE_REITZ {
        return pdf_facet(kind, alpha_u, alpha_v, wo, wm);
    }
    let across = stretched_sine(alpha_u, alpha_v, wo);
    let seen = sqrt_(wo.z * wo.z + across * across);
    let area = 0.5 * (reflection_bound(alpha_u, alpha_v, wo) * wo.z + seen);
    div(facet_d(kind, alpha_u, alpha_v, 1.0, wm) * max_(dot3(wo, wm), 0.0), area)
}
