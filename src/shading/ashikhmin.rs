//! Ashikhmin and Shirley's anisotropic Phong lobe with its coupled diffuse part (row 19): R_s = k_s O_s, R_d = k_d O_d,
//! exponents n_u (`exponent`) along the tangent and n_v (`exponent_v`) across.
//! Source: Ashikhmin and Shirley 2000, "An Anisotropic Phong BRDF Model", equations 4 to 9.

use crate::shading::closure::Closure;
use crate::shading::fresnel::fresnel_schlick3;
use crate::shading::lobe::{
    DirectionSample, cos_power, make_direction, no_direction, on_upper_side, reflect_about, sample_cos_power,
};
use crate::shading::math::{
    INV_PI, INV_TWO_PI, cos_turns, div, dot3, max_, max3_, min_, normalize3, rsqrt, sin_turns, sqrt_,
};
use crate::shading::spectrum::{Spectrum, spectrum_from_rgb, spectrum_zero};
use crate::shading::warp::square_to_cosine_hemisphere;
use glam::{Vec2, Vec3};

/// Density of the lobe's half vectors: sqrt((n_u + 1)(n_v + 1)) / (2 pi) (N.H)^(n_u cos^2 phi + n_v sin^2 phi).
#[inline]
pub fn ashikhmin_lobe(closure: &Closure, wm: Vec3) -> f32 {
    let x2 = wm.x * wm.x;
    let y2 = wm.y * wm.y;
    let across = x2 + y2;
    let mut n = closure.exponent;
    if across > 1.0e-12 {
        n = div(closure.exponent * x2 + closure.exponent_v * y2, across);
    }
    let norm = sqrt_((closure.exponent + 1.0) * (closure.exponent_v + 1.0));
    (norm * INV_TWO_PI) * cos_power(wm.z, n)
}

/// 1 - (1 - cos / 2)^5.
#[inline]
pub fn ashikhmin_falloff(cos_theta: f32) -> f32 {
    let c = 1.0 - 0.5 * cos_theta;
    let c2 = c * c;
    1.0 - (c2 * c2) * c
}

/// Diffuse and specular reflection times cosine, per steradian. Local frame; zero unless both are on the upper side.
#[inline]
pub fn eval_ashikhmin(closure: &Closure, wo: Vec3, wi: Vec3) -> Spectrum {
    if !on_upper_side(wo, wi) {
        return spectrum_zero();
    }
    let wm = normalize3(wo + wi);
    let v_h = min_(dot3(wo, wm), 1.0);
    let r_s = closure.specular_color * closure.k_s;
    // equation 4, whose 8 pi is 4 times the density's 2 pi
    let lobe = div(ashikhmin_lobe(closure, wm), (4.0 * max_(v_h, 1.0e-7)) * max_(wo.z, wi.z));
    let specular = fresnel_schlick3(v_h, r_s) * (lobe * wi.z);
    // equation 5: 28 / (23 pi)
    let falloff = (0.387507647 * ashikhmin_falloff(wo.z)) * ashikhmin_falloff(wi.z);
    let diffuse = (closure.color * (Vec3::splat(1.0) - r_s)) * ((closure.k_d * falloff) * wi.z);
    spectrum_from_rgb(diffuse + specular)
}

/// Probability of sampling the specular lobe: what Fresnel reflects at the viewer's angle against the rest.
#[inline]
pub fn ashikhmin_probability(closure: &Closure, cos_o: f32) -> f32 {
    let r_s = closure.k_s * max3_(closure.specular_color);
    let specular = max3_(fresnel_schlick3(cos_o, Vec3::splat(r_s)));
    let diffuse = (closure.k_d * max3_(closure.color)) * (1.0 - min_(r_s, 1.0));
    let sum = specular + diffuse;
    if sum > 1.0e-20 { div(specular, sum) } else { 0.0 }
}

/// Density of `sample_ashikhmin`; its integral over the upper side is below 1 by what falls under the horizon.
#[inline]
pub fn pdf_ashikhmin(closure: &Closure, wo: Vec3, wi: Vec3) -> f32 {
    if !on_upper_side(wo, wi) {
        return 0.0;
    }
    let p = ashikhmin_probability(closure, wo.z);
    let wm = normalize3(wo + wi);
    let specular = div(ashikhmin_lobe(closure, wm), 4.0 * max_(dot3(wo, wm), 1.0e-7));
    (1.0 - p) * (wi.z * INV_PI) + p * specular
}

/// Cosine-weighted, or `wo` mirrored about a half vector of the lobe; what falls below the horizon is dropped.
/// `u`: 0..1 each, excluding 1. `u_lobe`: 0..1, chooses the lobe.
#[inline]
pub fn sample_ashikhmin(closure: &Closure, wo: Vec3, u: Vec2, u_lobe: f32) -> DirectionSample {
    let mut wi = square_to_cosine_hemisphere(u);
    if u_lobe < ashikhmin_probability(closure, wo.z) {
        // equation 9: tan phi = sqrt((n_u + 1) / (n_v + 1)) tan(2 pi u)
        let x = sqrt_(closure.exponent_v + 1.0) * cos_turns(u.y);
        let y = sqrt_(closure.exponent + 1.0) * sin_turns(u.y);
        let inv = rsqrt(max_(x * x + y * y, 1.0e-20));
        let cos_phi = x * inv;
        let sin_phi = y * inv;
        let n = closure.exponent * (cos_phi * cos_phi) + closure.exponent_v * (sin_phi * sin_phi);
        let about = sample_cos_power(Vec2::new(u.x, 0.0), n);
        wi = reflect_about(wo, Vec3::new(about.x * cos_phi, about.x * sin_phi, about.z));
    }
    if !on_upper_side(wo, wi) {
        return no_direction();
    }
    make_direction(wi, pdf_ashikhmin(closure, wo, wi))
}
