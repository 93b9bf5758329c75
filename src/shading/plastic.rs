//! A diffuse base under a coat of index eta, smooth or rough.
//!
//! What enters is refracted in and out and scattered by the base any number of times: the diffuse part is
//! O_d / (1 - O_d R) T(o) T(i) / (pi eta^2), R the coat's diffuse reflectance from inside, or without `MATERIAL_NONLINEAR`
//! O_d / (1 - R) ..., which keeps the base's hue. A smooth coat's T is 1 - F and its reflection a lobe of zero width; a rough one
//! has facets, and T and R are tables of its transmittance (bake). `specular_color` is a factor on the coat's reflection.
//! Source: Jakob et al. 2022, "Mitsuba 3", plugins `plastic` and `roughplastic`, whose parameters these are; the coat after
//! Walter et al. 2007.

use crate::layout::{MATERIAL_NONLINEAR, SceneView, load_table};
use crate::shading::albedo::albedo_at;
use crate::shading::bsdf::{BsdfSample, SAMPLE_DELTA, finish_sample, make_sample, no_sample};
use crate::shading::closure::Closure;
use crate::shading::distribution::{facet_d, pdf_reflecting, sample_reflecting, smith_g_separable};
use crate::shading::fresnel::fresnel_dielectric;
use crate::shading::lobe::{
    COS_MIN, DirectionSample, make_direction, no_direction, on_upper_side, reflect_about, reflect_local,
};
use crate::shading::math::{INV_PI, div, dot3, max_, min_, normalize3, rcp};
use crate::shading::rough_conductor::first_scale;
use crate::shading::spectrum::{Spectrum, spectrum_from_rgb, spectrum_zero};
use crate::shading::warp::square_to_cosine_hemisphere;
use glam::{Vec2, Vec3};

/// One channel of the base as seen through the coat, without T: `inner` is the coat's reflectance from inside.
#[inline]
pub fn coated_channel(color: f32, inner: f32, nonlinear: bool) -> f32 {
    div(color, max_(1.0 - (if nonlinear { color * inner } else { inner }), 1.0e-6))
}

/// The base's part times cosine, per steradian. `transmitted`: T(o) T(i). `inner`: the coat's reflectance from inside.
#[inline]
pub fn coated_diffuse(closure: &Closure, transmitted: f32, inner: f32, cos_i: f32) -> Vec3 {
    let nonlinear = (closure.flags & MATERIAL_NONLINEAR) != 0;
    let inv_eta = rcp(closure.eta);
    let scale = ((INV_PI * cos_i) * (inv_eta * inv_eta)) * transmitted;
    Vec3::new(
        coated_channel(closure.color.x, inner, nonlinear),
        coated_channel(closure.color.y, inner, nonlinear),
        coated_channel(closure.color.z, inner, nonlinear),
    ) * scale
}

/// Probability of sampling the coat, which reflects the share `reflected` of what comes, rather than the base.
#[inline]
pub fn coat_probability(closure: &Closure, reflected: f32) -> f32 {
    let s = (closure.specular_color.x + closure.specular_color.y) + closure.specular_color.z;
    let d = (closure.color.x + closure.color.y) + closure.color.z;
    let coat = reflected * s;
    let base = (1.0 - reflected) * d;
    if coat + base > 1.0e-20 { div(coat, coat + base) } else { 0.0 }
}

/// The base's part times cosine, per steradian; zero unless both directions are on the upper side.
#[inline]
pub fn eval_plastic(closure: &Closure, wo: Vec3, wi: Vec3) -> Spectrum {
    if !on_upper_side(wo, wi) {
        return spectrum_zero();
    }
    let t_o = 1.0 - fresnel_dielectric(wo.z, closure.eta);
    let t_i = 1.0 - fresnel_dielectric(wi.z, closure.eta);
    spectrum_from_rgb(coated_diffuse(closure, t_o * t_i, closure.inner_reflectance, wi.z))
}

/// Density of the base's part of `sample_plastic`.
#[inline]
pub fn pdf_plastic(closure: &Closure, wo: Vec3, wi: Vec3) -> f32 {
    if !on_upper_side(wo, wi) {
        return 0.0;
    }
    let p = coat_probability(closure, fresnel_dielectric(wo.z, closure.eta));
    (1.0 - p) * (wi.z * INV_PI)
}

/// Mirrored by the coat, or cosine-weighted. `u`: 0..1 each, excluding 1. `u_lobe`: 0..1, chooses.
#[inline]
pub fn sample_plastic(closure: &Closure, wo: Vec3, u: Vec2, u_lobe: f32) -> BsdfSample {
    if wo.z <= COS_MIN {
        return no_sample();
    }
    let f = fresnel_dielectric(wo.z, closure.eta);
    let p = coat_probability(closure, f);
    if u_lobe < p {
        let weight = spectrum_from_rgb(closure.specular_color * div(f, p));
        return make_sample(reflect_local(wo), p, weight, 1.0, SAMPLE_DELTA);
    }
    let wi = square_to_cosine_hemisphere(u);
    finish_sample(wi, pdf_plastic(closure, wo, wi), eval_plastic(closure, wo, wi), 1.0, 0)
}

/// Both parts times cosine, per steradian; zero unless both directions are on the upper side.
#[inline]
pub fn eval_rough_plastic(scene: &SceneView, closure: &Closure, wo: Vec3, wi: Vec3) -> Spectrum {
    if !on_upper_side(wo, wi) {
        return spectrum_zero();
    }
    let kind = closure.distribution;
    let wm = normalize3(wo + wi);
    let d = facet_d(kind, closure.alpha_u, closure.alpha_u, first_scale(scene, closure), wm);
    let g = smith_g_separable(kind, closure.alpha_u, closure.alpha_u, wo, wi);
    let f = fresnel_dielectric(min_(dot3(wo, wm), 1.0), closure.eta);
    let coat = closure.specular_color * div((f * d) * g, 4.0 * wo.z);
    let through = albedo_at(scene, closure.table, wo.z) * albedo_at(scene, closure.table, wi.z);
    spectrum_from_rgb(coat + coated_diffuse(closure, through, load_table(scene, closure.table + 6), wi.z))
}

/// Density of `sample_rough_plastic`; its integral over the upper side is below 1 by what falls under the horizon.
#[inline]
pub fn pdf_rough_plastic(scene: &SceneView, closure: &Closure, wo: Vec3, wi: Vec3) -> f32 {
    if !on_upper_side(wo, wi) {
        return 0.0;
    }
    let p = coat_probability(closure, 1.0 - albedo_at(scene, closure.table, wo.z));
    let wm = normalize3(wo + wi);
    let facets = pdf_reflecting(closure.distribution, closure.alpha_u, closure.alpha_u, wo, wm);
    let coat = div(facets, 4.0 * max_(dot3(wo, wm), 1.0e-7));
    p * coat + (1.0 - p) * (wi.z * INV_PI)
}

/// `wo` mirrored about a visible facet of the coat, or cosine-weighted. `u`: 0..1 each, excluding 1. `u_lobe`: chooses.
#[inline]
pub fn sample_rough_plastic(scene: &SceneView, closure: &Closure, wo: Vec3, u: Vec2, u_lobe: f32) -> DirectionSample {
    if wo.z <= COS_MIN {
        return no_direction();
    }
    let mut wi = square_to_cosine_hemisphere(u);
    if u_lobe < coat_probability(closure, 1.0 - albedo_at(scene, closure.table, wo.z)) {
        wi = reflect_about(wo, sample_reflecting(closure.distribution, closure.alpha_u, closure.alpha_u, wo, u));
    }
    if !on_upper_side(wo, wi) {
        return no_direction();
    }
    make_direction(wi, pdf_rough_plastic(scene, closure, wo, wi))
}
