//! Rough metal: f = O_s D G F / (4 (N.L)(N.V)), G Smith's of independent masking and shadowing.
//!
//! With `MATERIAL_COMPENSATE` what the facets reflect among each other is added as a lobe of its own, so that a surface
//! that absorbs nothing reflects everything; its albedo table is at `table`.
//! Sources: Walter et al. 2007, "Microfacet Models for Refraction through Rough Surfaces"; Kulla and Conty 2017,
//! "Revisiting Physically Based Shading at Imageworks" (compensation).

use crate::layout::{DISTRIBUTION_GAUSSIAN, MATERIAL_COMPENSATE, SceneView, load_table};
use crate::shading::albedo::albedo_at;
use crate::shading::closure::Closure;
use crate::shading::distribution::{facet_d, pdf_reflecting, sample_reflecting, smith_g_separable};
use crate::shading::fresnel::fresnel_closure;
use crate::shading::lobe::{COS_MIN, DirectionSample, make_direction, no_direction, on_upper_side, reflect_about};
use crate::shading::math::{INV_PI, PI, clamp_, div, dot3, max_, min_, normalize3};
use crate::shading::spectrum::{Spectrum, spectrum_from_rgb, spectrum_zero};
use crate::shading::warp::square_to_cosine_hemisphere;
use glam::{Vec2, Vec3};

/// The Gaussian's constant of lobe 0; 1 for the other distributions, which know theirs.
#[inline]
pub fn first_scale(scene: &SceneView, closure: &Closure) -> f32 {
    if closure.distribution != DISTRIBUTION_GAUSSIAN {
        return 1.0;
    }
    load_table(scene, closure.table)
}

/// Light that leaves after several reflections between facets, times cosine, per steradian and colour channel:
/// (1 - E(o)) (1 - E(i)) / (pi (1 - E_mean)) F_mean^2 E_mean / (1 - F_mean (1 - E_mean)).
#[inline]
pub fn multiple_scattering(scene: &SceneView, closure: &Closure, cos_o: f32, cos_i: f32) -> Vec3 {
    let mean = load_table(scene, closure.table + 2);
    let lost = (1.0 - albedo_at(scene, closure.table, cos_o)) * (1.0 - albedo_at(scene, closure.table, cos_i));
    let share = div(lost * cos_i, PI * max_(1.0 - mean, 1.0e-6));
    let f_r = load_table(scene, closure.table + 3);
    let f_g = load_table(scene, closure.table + 4);
    let f_b = load_table(scene, closure.table + 5);
    let rest = 1.0 - mean;
    let f = Vec3::new(
        div((f_r * f_r) * mean, 1.0 - f_r * rest),
        div((f_g * f_g) * mean, 1.0 - f_g * rest),
        div((f_b * f_b) * mean, 1.0 - f_b * rest),
    );
    f * share
}

/// Reflection times cosine, per steradian. Local frame; zero unless both directions are on the upper side.
#[inline]
pub fn eval_rough_conductor(scene: &SceneView, closure: &Closure, wo: Vec3, wi: Vec3) -> Spectrum {
    if !on_upper_side(wo, wi) {
        return spectrum_zero();
    }
    let kind = closure.distribution;
    let wm = normalize3(wo + wi);
    let d = facet_d(kind, closure.alpha_u, closure.alpha_v, first_scale(scene, closure), wm);
    let g = smith_g_separable(kind, closure.alpha_u, closure.alpha_v, wo, wi);
    let f = fresnel_closure(closure, min_(dot3(wo, wm), 1.0));
    let mut reflected = f * div(d * g, 4.0 * wo.z);
    if (closure.flags & MATERIAL_COMPENSATE) != 0 {
        reflected += multiple_scattering(scene, closure, wo.z, wi.z);
    }
    spectrum_from_rgb(closure.specular_color * reflected)
}

/// Probability of sampling what scatters more than once: its share of the light, if nothing is absorbed.
#[inline]
pub fn multiple_probability(scene: &SceneView, closure: &Closure, cos_o: f32) -> f32 {
    if (closure.flags & MATERIAL_COMPENSATE) == 0 {
        return 0.0;
    }
    clamp_(1.0 - albedo_at(scene, closure.table, cos_o), 0.0, 1.0)
}

/// Density of `sample_rough_conductor`; its integral over the upper side is below 1 by what falls under the horizon.
#[inline]
pub fn pdf_rough_conductor(scene: &SceneView, closure: &Closure, wo: Vec3, wi: Vec3) -> f32 {
    if !on_upper_side(wo, wi) {
        return 0.0;
    }
    let p = multiple_probability(scene, closure, wo.z);
    let wm = normalize3(wo + wi);
    let facets = pdf_reflecting(closure.distribution, closure.alpha_u, closure.alpha_v, wo, wm);
    // d omega_i = 4 (V.H) d omega_h
    let single = div(facets, 4.0 * max_(dot3(wo, wm), 1.0e-7));
    p * (wi.z * INV_PI) + (1.0 - p) * single
}

/// `wo` mirrored about a visible facet, or cosine-weighted for what scatters more than once; what falls below the horizon
/// is dropped. `u`: 0..1 each, excluding 1. `u_lobe`: 0..1, chooses.
#[inline]
pub fn sample_rough_conductor(scene: &SceneView, closure: &Closure, wo: Vec3, u: Vec2, u_lobe: f32) -> DirectionSample {
    if wo.z <= COS_MIN {
        return no_direction();
    }
    let mut wi = square_to_cosine_hemisphere(u);
    if u_lobe >= multiple_probability(scene, closure, wo.z) {
        wi = reflect_about(wo, sample_reflecting(closure.distribution, closure.alpha_u, closure.alpha_v, wo, u));
    }
    if !on_upper_side(wo, wi) {
        return no_direction();
    }
    make_direction(wi, pdf_rough_conductor(scene, closure, wo, wi))
}
