//! Cook and Torrance's model (rows 14 to 18): f = k_d O_d / pi + k_s O_s D G F / (4 (N.L)(N.V)), k_d + k_s = 1.
//!
//! D is normalised, of one lobe or two: Beckmann's unless the flags name another; G the V-cavity's, or with `MATERIAL_SMITH`
//! Smith's of each lobe, correlated by height; F exact, or Schlick's. The 1982 paper writes D G F / (pi (N.L)(N.V)) with
//! D = e^-(tan a / m)^2 / (m^2 cos^4 a): with the normalised D that is D G F / ((N.L)(N.V)), four times the above;
//! `MATERIAL_D_1982` draws it so. Source: Cook and Torrance 1982, "A Reflectance Model for Computer Graphics".

use crate::layout::{
    DISTRIBUTION_GAUSSIAN, MATERIAL_D_1982, MATERIAL_GENERAL_LOBES, MATERIAL_SMITH, SceneView, load_table,
};
use crate::shading::closure::Closure;
use crate::shading::distribution::{facet_d, pdf_reflecting, sample_reflecting, smith_g_correlated};
use crate::shading::fresnel::fresnel_closure;
use crate::shading::lobe::{
    DirectionSample, make_direction, no_direction, on_upper_side, reflect_about, specular_probability,
};
use crate::shading::math::{INV_PI, div, dot3, min_, normalize3, rsqrt};
use crate::shading::microfacet::{beckmann_lobes_d_slope, sample_beckmann, tan2_theta, v_cavity_g};
use crate::shading::spectrum::{Spectrum, spectrum_from_rgb, spectrum_zero};
use crate::shading::warp::square_to_cosine_hemisphere;
use glam::{Vec2, Vec3};

/// `DISTRIBUTION_*` of a lobe, 0 or 1.
#[inline]
pub fn lobe_distribution(closure: &Closure, lobe: u32) -> u32 {
    if lobe == 0 { closure.distribution } else { closure.second_distribution }
}

/// D of a lobe for a unit facet normal, per steradian.
#[inline]
pub fn lobe_d(scene: &SceneView, closure: &Closure, lobe: u32, wm: Vec3) -> f32 {
    let kind = lobe_distribution(closure, lobe);
    // Of the tables only the Gaussian's constant is asked for.
    let mut scale: f32 = 1.0;
    if kind == DISTRIBUTION_GAUSSIAN {
        scale = load_table(scene, closure.table + lobe);
    }
    if lobe == 0 {
        return facet_d(kind, closure.alpha_u, closure.alpha_v, scale, wm);
    }
    facet_d(kind, closure.second_alpha_u, closure.second_alpha_v, scale, wm)
}

/// Smith's G of a lobe.
#[inline]
pub fn lobe_g(closure: &Closure, lobe: u32, wo: Vec3, wi: Vec3) -> f32 {
    let kind = lobe_distribution(closure, lobe);
    if lobe == 0 {
        return smith_g_correlated(kind, closure.alpha_u, closure.alpha_v, wo, wi);
    }
    smith_g_correlated(kind, closure.second_alpha_u, closure.second_alpha_v, wo, wi)
}

/// D of both lobes by their weights. `h`: any multiple of the facet normal.
#[inline]
pub fn both_lobes_d(scene: &SceneView, closure: &Closure, h: Vec3, w0: f32, w1: f32) -> f32 {
    if (closure.flags & MATERIAL_GENERAL_LOBES) == 0 {
        return beckmann_lobes_d_slope(tan2_theta(h), closure.alpha_u, closure.second_alpha_u, w0, w1);
    }
    let wm = normalize3(h);
    let mut d: f32 = 0.0;
    if w0 > 0.0 {
        d += w0 * lobe_d(scene, closure, 0, wm);
    }
    if w1 > 0.0 {
        d += w1 * lobe_d(scene, closure, 1, wm);
    }
    d
}

/// D G of both lobes by their weights. `h`: wo + wi; `n_h`, `v_h`: its cosines.
#[inline]
pub fn both_lobes(scene: &SceneView, closure: &Closure, wo: Vec3, wi: Vec3, h: Vec3, n_h: f32, v_h: f32) -> f32 {
    if (closure.flags & MATERIAL_SMITH) == 0 {
        return both_lobes_d(scene, closure, h, closure.weight, closure.second_weight)
            * v_cavity_g(n_h, wo.z, v_h, wi.z);
    }
    let wm = normalize3(h);
    let first = closure.weight * (lobe_d(scene, closure, 0, wm) * lobe_g(closure, 0, wo, wi));
    if closure.second_weight <= 0.0 {
        return first;
    }
    first + closure.second_weight * (lobe_d(scene, closure, 1, wm) * lobe_g(closure, 1, wo, wi))
}

/// Diffuse and specular reflection times cosine, per steradian. Local frame; zero unless both are on the upper side.
/// Finite everywhere; the V-cavity's G lets the grazing mirror direction grow as 1 / (N.V).
#[inline]
pub fn eval_cook_torrance(scene: &SceneView, closure: &Closure, wo: Vec3, wi: Vec3) -> Spectrum {
    if !on_upper_side(wo, wi) {
        return spectrum_zero();
    }
    let h = wo + wi;
    let h2 = dot3(h, h);
    let inv_h = rsqrt(h2);
    let n_h = min_(h.z * inv_h, 1.0);
    // V.H = L.H = |V + L| / 2
    let v_h = min_((0.5 * h2) * inv_h, 1.0);
    let dg = both_lobes(scene, closure, wo, wi, h, n_h, v_h);
    let f = fresnel_closure(closure, v_h);
    // N.L of the cosine cancels the one below.
    let quarter = if (closure.flags & MATERIAL_D_1982) != 0 { 1.0 } else { 0.25 };
    let facets = (closure.k_s * quarter) * div(dg, wo.z);
    let diffuse = closure.color * ((closure.k_d * INV_PI) * wi.z);
    let specular = (closure.specular_color * f) * facets;
    spectrum_from_rgb(diffuse + specular)
}

/// Share of lobe 0 in w0 + w1; 1 if there is none.
#[inline]
pub fn first_lobe_share(closure: &Closure) -> f32 {
    let sum = closure.weight + closure.second_weight;
    if sum > 1.0e-20 { div(closure.weight, sum) } else { 1.0 }
}

/// Density of the facets that both lobes sample, per steradian of H. `h`: wo + wi; `inv_h`: one over its length.
#[inline]
pub fn pdf_lobes(scene: &SceneView, closure: &Closure, wo: Vec3, h: Vec3, inv_h: f32) -> f32 {
    let share = first_lobe_share(closure);
    if (closure.flags & MATERIAL_GENERAL_LOBES) == 0 {
        return both_lobes_d(scene, closure, h, share, 1.0 - share) * (h.z * inv_h);
    }
    let wm = h * inv_h;
    let first = pdf_reflecting(lobe_distribution(closure, 0), closure.alpha_u, closure.alpha_v, wo, wm);
    let second = pdf_reflecting(lobe_distribution(closure, 1), closure.second_alpha_u, closure.second_alpha_v, wo, wm);
    share * first + (1.0 - share) * second
}

/// Density of `sample_cook_torrance`; its integral over the upper side is below 1 by what falls under the horizon.
#[inline]
pub fn pdf_cook_torrance(scene: &SceneView, closure: &Closure, wo: Vec3, wi: Vec3) -> f32 {
    if !on_upper_side(wo, wi) {
        return 0.0;
    }
    let p = specular_probability(closure);
    let h = wo + wi;
    let h2 = dot3(h, h);
    let inv_h = rsqrt(h2);
    let v_h = (0.5 * h2) * inv_h;
    // d omega_i = 4 (V.H) d omega_h
    let facets = pdf_lobes(scene, closure, wo, h, inv_h);
    let specular = div(facets, 4.0 * v_h);
    (1.0 - p) * (wi.z * INV_PI) + p * specular
}

/// Cosine-weighted, or `wo` mirrored about a facet of either lobe; what falls below the horizon is dropped.
/// `u`: 0..1 each, excluding 1. `u_lobe`: 0..1, chooses diffuse, lobe 0 or lobe 1.
#[inline]
pub fn sample_cook_torrance(scene: &SceneView, closure: &Closure, wo: Vec3, u: Vec2, u_lobe: f32) -> DirectionSample {
    let p = specular_probability(closure);
    let first = u_lobe < p * first_lobe_share(closure);
    let m = if first { closure.alpha_u } else { closure.second_alpha_u };
    let mut wi = square_to_cosine_hemisphere(u);
    if u_lobe < p {
        let mut wm = sample_beckmann(u, m);
        if (closure.flags & MATERIAL_GENERAL_LOBES) != 0 {
            let kind = lobe_distribution(closure, if first { 0 } else { 1 });
            wm = sample_reflecting(kind, m, if first { closure.alpha_v } else { closure.second_alpha_v }, wo, u);
        }
        wi = reflect_about(wo, wm);
    }
    if !on_upper_side(wo, wi) {
        return no_direction();
    }
    make_direction(wi, pdf_cook_torrance(scene, closure, wo, wi))
}
