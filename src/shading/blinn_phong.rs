//! Blinn's form of Phong's model (row 3): (N.H)^n with H = (L + V) / |L + V|; as printed, without a cosine.
//! Source: Blinn 1977, "Models of Light Reflection for Computer Synthesized Pictures".

use crate::shading::closure::Closure;
use crate::shading::lobe::{
    DirectionSample, cos_power, no_direction, on_upper_side, pdf_cos_power, reflect_about, sample_cos_power,
    specular_probability,
};
use crate::shading::math::{INV_PI, div, dot3, rsqrt};
use crate::shading::spectrum::{Spectrum, spectrum_from_rgb, spectrum_zero};
use crate::shading::warp::square_to_cosine_hemisphere;
use glam::{Vec2, Vec3};

/// (k_d O_d (N.L) + k_s O_s (N.H)^n) / pi, per steradian. Local frame; zero unless both directions are on the upper side.
/// The specular term is symmetric in the two directions, so divided by the cosine it is not reciprocal.
#[inline]
pub fn eval_blinn_phong(closure: &Closure, wo: Vec3, wi: Vec3) -> Spectrum {
    if !on_upper_side(wo, wi) {
        return spectrum_zero();
    }
    let h = wo + wi;
    let lobe = cos_power(h.z * rsqrt(dot3(h, h)), closure.exponent);
    let diffuse = closure.color * ((closure.k_d * INV_PI) * wi.z);
    let specular = closure.specular_color * ((closure.k_s * INV_PI) * lobe);
    spectrum_from_rgb(diffuse + specular)
}

/// Density of `sample_blinn_phong`; its integral over the upper side is below 1 by what falls under the horizon.
#[inline]
pub fn pdf_blinn_phong(closure: &Closure, wo: Vec3, wi: Vec3) -> f32 {
    if !on_upper_side(wo, wi) {
        return 0.0;
    }
    let p = specular_probability(closure);
    let h = wo + wi;
    let h2 = dot3(h, h);
    let inv_h = rsqrt(h2);
    // V.H = |V + L| / 2, and d omega_i = 4 (V.H) d omega_h.
    let v_h = (0.5 * h2) * inv_h;
    let specular = div(pdf_cos_power(h.z * inv_h, closure.exponent), 4.0 * v_h);
    (1.0 - p) * (wi.z * INV_PI) + p * specular
}

/// Cosine-weighted, or `wo` mirrored about an H of density (n + 1) / (2 pi) cos^n; what falls below the horizon is dropped.
/// `u`: 0..1 each, excluding 1. `u_lobe`: 0..1, chooses the lobe.
#[inline]
pub fn sample_blinn_phong(closure: &Closure, wo: Vec3, u: Vec2, u_lobe: f32) -> DirectionSample {
    let wi = if u_lobe < specular_probability(closure) {
        reflect_about(wo, sample_cos_power(u, closure.exponent))
    } else {
        square_to_cosine_hemisphere(u)
    };
    if !on_upper_side(wo, wi) {
        return no_direction();
    }
    DirectionSample { wi, pdf: pdf_blinn_phong(closure, wo, wi) }
}
