//! How much light an interface reflects.
//!
//! Both functions are exact for unpolarised light. Source: Born and Wolf 1999, "Principles of Optics", section 1.5.2
//! (dielectrics) and 14.2 (metals), written without complex numbers.

use crate::layout::{MATERIAL_CONDUCTOR, MATERIAL_SCHLICK};
use crate::shading::closure::Closure;
use crate::shading::math::{clamp_, div, max_, min_, sqrt_};
use glam::Vec3;

/// (eta cos theta_t)^2 = eta^2 - sin^2 theta_i; zero or less is total internal reflection.
/// `cos_i`: 0..1. `eta`: transmitted over incident index. The one place that decides it, for reflection and refraction.
#[inline]
pub fn refraction_root(cos_i: f32, eta: f32) -> f32 {
    // (eta - 1)(eta + 1) instead of eta^2 - 1 keeps the digits of an index near 1.
    (eta - 1.0) * (eta + 1.0) + cos_i * cos_i
}

/// Reflectance of a dielectric interface for unpolarised light, 0..1.
/// `cos_i`: cosine between normal and incident direction, 0..1.
/// `eta`: index on the transmitted side over index on the incident side, > 0.
/// 1 on total internal reflection. Absolute error below 2e-6 (not within .5 degree of the critical angle,
/// whose slope is infinite).
#[inline]
pub fn fresnel_dielectric(cos_i: f32, eta: f32) -> f32 {
    // No interface; at grazing incidence the formula would be 0 / 0.
    if eta == 1.0 {
        return 0.0;
    }
    let c = clamp_(cos_i, 0.0, 1.0);
    let root = refraction_root(c, eta);
    if root <= 0.0 {
        return 1.0;
    }
    let g = sqrt_(root);
    let r_s = div(c - g, c + g);
    let eta2_c = (eta * eta) * c;
    let r_p = div(eta2_c - g, eta2_c + g);
    min_(0.5 * (r_s * r_s + r_p * r_p), 1.0)
}

/// Reflectance of a conductor for unpolarised light, 0..1.
/// `cos_i`: 0..1. `eta` + i `k`: complex index relative to the outside, eta > 0, k >= 0, both below 1000.
/// With k = 0 it is `fresnel_dielectric`. Absolute error below 2e-5.
#[inline]
pub fn fresnel_conductor(cos_i: f32, eta: f32, k: f32) -> f32 {
    let c = clamp_(cos_i, 0.0, 1.0);
    let c2 = c * c;
    let s2 = (1.0 - c) * (1.0 + c);
    let eta_k = eta * k;
    let t0 = refraction_root(c, eta) - k * k;
    let a2_b2 = sqrt_(t0 * t0 + 4.0 * (eta_k * eta_k));
    // a^2 = (a2_b2 + t0) / 2; for t0 < 0 the sum cancels, so it is taken from a^2 b^2 = (eta k)^2.
    let a2 = if t0 >= 0.0 { 0.5 * (a2_b2 + t0) } else { div(2.0 * (eta_k * eta_k), a2_b2 - t0) };
    let two_a_c = 2.0 * (sqrt_(max_(a2, 0.0)) * c);
    let r_s = div(max_((a2_b2 + c2) - two_a_c, 0.0), (a2_b2 + c2) + two_a_c);
    let p = c2 * a2_b2 + s2 * s2;
    let q = two_a_c * s2;
    let r_p = r_s * div(max_(p - q, 0.0), p + q);
    min_(0.5 * (r_s + r_p), 1.0)
}

/// `fresnel_conductor` for each colour channel.
#[inline]
pub fn fresnel_conductor3(cos_i: f32, eta: Vec3, k: Vec3) -> Vec3 {
    Vec3::new(
        fresnel_conductor(cos_i, eta.x, k.x),
        fresnel_conductor(cos_i, eta.y, k.y),
        fresnel_conductor(cos_i, eta.z, k.z),
    )
}

/// Schlick's approximation f0 + (1 - f0) (1 - cos)^5 for each colour channel. `cos_i`: 0..1. `f0`: at normal incidence.
/// Source: Schlick 1994, "An Inexpensive BRDF Model for Physically-based Rendering", equation 15.
#[inline]
pub fn fresnel_schlick3(cos_i: f32, f0: Vec3) -> Vec3 {
    let c = 1.0 - clamp_(cos_i, 0.0, 1.0);
    let c2 = c * c;
    let c5 = (c2 * c2) * c;
    f0 + (Vec3::splat(1.0) - f0) * c5
}

/// Fresnel reflectance of a material's interface seen from outside, linear Rec. 709: conductor, Schlick or dielectric by
/// its flags. `cos_i`: cosine between the interface's or the facet's normal and the direction, 0..1.
#[inline]
pub fn fresnel_closure(closure: &Closure, cos_i: f32) -> Vec3 {
    if (closure.flags & MATERIAL_CONDUCTOR) != 0 {
        return fresnel_conductor3(cos_i, closure.metal_eta, closure.metal_k);
    }
    if (closure.flags & MATERIAL_SCHLICK) != 0 {
        return fresnel_schlick3(cos_i, closure.f0);
    }
    Vec3::splat(fresnel_dielectric(cos_i, closure.eta))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cos_degrees(degrees: f64) -> f32 {
        libm::cos(degrees.to_radians()) as f32
    }

    /// The same reflectance in double precision, with complex numbers written out: cos_t^2 = 1 - sin^2 / (eta + i k)^2.
    fn reflectance(cos_i: f32, eta: f32, k: f32) -> f64 {
        type Complex = (f64, f64);
        let mul = |a: Complex, b: Complex| (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0);
        let norm2 = |a: Complex| a.0 * a.0 + a.1 * a.1;
        let over = |a: Complex, b: Complex| {
            let n = mul(a, (b.0, -b.1));
            (n.0 / norm2(b), n.1 / norm2(b))
        };
        let c = f64::from(cos_i);
        let index = (f64::from(eta), f64::from(k));
        let ratio2 = over((1.0 - c * c, 0.0), mul(index, index));
        let square = (1.0 - ratio2.0, -ratio2.1);
        let size = libm::sqrt(libm::sqrt(norm2(square)));
        let half_angle = 0.5 * libm::atan2(square.1, square.0);
        let cos_t = (size * libm::cos(half_angle), size * libm::sin(half_angle));
        let m_cos_t = mul(index, cos_t);
        let m_cos_i = mul(index, (c, 0.0));
        let r_s = over((c - m_cos_t.0, -m_cos_t.1), (c + m_cos_t.0, m_cos_t.1));
        let r_p = over((m_cos_i.0 - cos_t.0, m_cos_i.1 - cos_t.1), (m_cos_i.0 + cos_t.0, m_cos_i.1 + cos_t.1));
        0.5 * (norm2(r_s) + norm2(r_p))
    }

    #[test]
    fn the_dielectric_has_the_lectures_values() {
        assert!((fresnel_dielectric(cos_degrees(45.0), 1.5) - 0.050_239_9).abs() < 1e-7);
        assert!((fresnel_dielectric(cos_degrees(10.0), 1.0 / 1.5) - 0.040_083_0).abs() < 1e-7);
        assert!((fresnel_dielectric(1.0, 1.5) - 0.04).abs() < 1e-7);
    }

    #[test]
    fn at_brewsters_angle_only_the_perpendicular_half_is_reflected() {
        // tan theta_B = 1.5 = tan 56.310 deg; there F = r_s^2 / 2 and r_s = (1 - eta^2) / (1 + eta^2).
        let brewster = cos_degrees(56.309_932_474);
        assert!((fresnel_dielectric(brewster, 1.5) - 0.073_964_5).abs() < 2e-7);
    }

    #[test]
    fn beyond_the_critical_angle_everything_is_reflected() {
        assert_eq!(fresnel_dielectric(cos_degrees(41.82), 1.0 / 1.5), 1.0);
        assert_eq!(fresnel_dielectric(cos_degrees(80.0), 1.0 / 1.5), 1.0);
        assert!(fresnel_dielectric(cos_degrees(41.80), 1.0 / 1.5) < 0.95);
    }

    #[test]
    fn copper_has_the_values_of_johnson_and_christy() {
        // Johnson and Christy 1972, interpolated at 450, 550 and 650 nm.
        let eta = Vec3::new(1.240_441_2, 1.006_626_9, 0.237_797_85);
        let k = Vec3::new(2.392_941_2, 2.582_307_5, 3.626_414_5);
        let normal = fresnel_conductor3(1.0, eta, k);
        assert!((normal - Vec3::new(0.538_258, 0.623_510, 0.935_218)).abs().max_element() < 1e-5, "{normal}");
        let grazing = fresnel_conductor3(cos_degrees(85.0), eta, k);
        assert!((grazing - Vec3::new(0.796_690, 0.831_849, 0.959_546)).abs().max_element() < 1e-5, "{grazing}");
    }

    #[test]
    fn both_functions_keep_their_stated_error() {
        for step in 0..=2000 {
            let cos_i = step as f32 / 2000.0;
            for eta in [0.05f32, 0.2, 0.5, 1.0 / 1.5, 0.9, 1.000_3, 1.33, 1.5, 2.417, 4.0] {
                // At the critical angle the slope is infinite, so one ULP of eta shows.
                let near_critical = refraction_root(cos_i, eta).abs() < 1e-2;
                if !near_critical {
                    let error = (f64::from(fresnel_dielectric(cos_i, eta)) - reflectance(cos_i, eta, 0.0)).abs();
                    assert!(error < 2e-6, "cos {cos_i} eta {eta} error {error:e}");
                }
                for k in [0.1f32, 1.0, 3.0, 7.5, 100.0] {
                    let error = (f64::from(fresnel_conductor(cos_i, eta, k)) - reflectance(cos_i, eta, k)).abs();
                    assert!(error < 2e-5, "cos {cos_i} eta {eta} k {k} error {error:e}");
                }
            }
        }
    }

    #[test]
    fn a_conductor_that_does_not_absorb_is_a_dielectric() {
        for step in 1..=1000 {
            let cos_i = step as f32 / 1000.0;
            for eta in [0.7f32, 1.0, 1.5, 2.4] {
                let difference = (fresnel_conductor(cos_i, eta, 0.0) - fresnel_dielectric(cos_i, eta)).abs();
                assert!(difference < 2e-5, "cos {cos_i} eta {eta} difference {difference:e}");
            }
        }
    }

    #[test]
    fn both_sides_of_an_interface_reflect_the_same_share() {
        // Closer to grazing the way back is near the critical angle, where one ULP of cos_t shows.
        for step in 100..=1000 {
            let cos_i = step as f32 / 1000.0;
            let cos_t = libm::sqrtf(refraction_root(cos_i, 1.5)) / 1.5;
            let difference = (fresnel_dielectric(cos_i, 1.5) - fresnel_dielectric(cos_t, 1.0 / 1.5)).abs();
            assert!(difference < 1e-5, "cos {cos_i} difference {difference:e}");
        }
    }

    #[test]
    fn grazing_light_is_reflected_whole_and_a_matched_index_reflects_nothing() {
        assert!(fresnel_dielectric(0.0, 1.5) > 0.999_99);
        assert!(fresnel_conductor(0.0, 0.2, 3.6) > 0.999_99);
        for cos_i in [0.0f32, 1e-30, 1e-7, 1e-3, 0.5, 1.0] {
            assert!(fresnel_dielectric(cos_i, 1.0) < 1e-9);
        }
    }
}
