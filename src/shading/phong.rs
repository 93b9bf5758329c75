//! Phong's model (row 2). As printed: I = k_d I_p (N.L) + k_s I_p (V.R)^n with I_p = intensity / pi; the specular
//! term has no cosine, so as a BRDF it is not reciprocal and its albedo has no bound.
//! With `MATERIAL_LAFORTUNE` the lobe is f = k_s O_s (n + 2) / (2 pi) (V.R)^n: reciprocal, albedo at most k_s O_s.
//! Source: Phong 1975, "Illumination for Computer Generated Pictures"; Lafortune and Willems 1994.

use crate::layout::MATERIAL_LAFORTUNE;
use crate::shading::closure::Closure;
use crate::shading::lobe::{
    DirectionSample, cos_power, no_direction, on_upper_side, pdf_cos_power, reflect_local, sample_cos_power,
    specular_probability, turn_to,
};
use crate::shading::math::{INV_PI, INV_TWO_PI, dot3};
use crate::shading::spectrum::{Spectrum, spectrum_from_rgb, spectrum_zero};
use crate::shading::warp::square_to_cosine_hemisphere;
use glam::{Vec2, Vec3};

/// Diffuse and specular reflection times cosine (as printed the specular part carries none), per steradian.
/// Local frame; zero unless both directions are on the upper side.
#[inline]
pub fn eval_phong(closure: &Closure, wo: Vec3, wi: Vec3) -> Spectrum {
    if !on_upper_side(wo, wi) {
        return spectrum_zero();
    }
    let lobe = cos_power(dot3(wo, reflect_local(wi)), closure.exponent);
    let scale =
        if (closure.flags & MATERIAL_LAFORTUNE) != 0 { ((closure.exponent + 2.0) * INV_TWO_PI) * wi.z } else { INV_PI };
    let diffuse = closure.color * ((closure.k_d * INV_PI) * wi.z);
    let specular = closure.specular_color * ((closure.k_s * scale) * lobe);
    spectrum_from_rgb(diffuse + specular)
}

/// Density of `sample_phong`; its integral over the upper side is below 1 by the lobe's part under the horizon.
#[inline]
pub fn pdf_phong(closure: &Closure, wo: Vec3, wi: Vec3) -> f32 {
    if !on_upper_side(wo, wi) {
        return 0.0;
    }
    let p = specular_probability(closure);
    let specular = pdf_cos_power(dot3(wo, reflect_local(wi)), closure.exponent);
    (1.0 - p) * (wi.z * INV_PI) + p * specular
}

/// Cosine-weighted, or cos^n about the mirror direction of `wo`; the part of the lobe below the horizon is dropped.
/// `u`: 0..1 each, excluding 1. `u_lobe`: 0..1, chooses the lobe.
#[inline]
pub fn sample_phong(closure: &Closure, wo: Vec3, u: Vec2, u_lobe: f32) -> DirectionSample {
    let wi = if u_lobe < specular_probability(closure) {
        turn_to(reflect_local(wo), sample_cos_power(u, closure.exponent))
    } else {
        square_to_cosine_hemisphere(u)
    };
    if !on_upper_side(wo, wi) {
        return no_direction();
    }
    DirectionSample { wi, pdf: pdf_phong(closure, wo, wi) }
}
