//! Rough glass: facets that reflect and refract. Local frame; z leaves the outside.
//!
//! f_r = O_d D G F / (4 |N.L||N.V|), f_t = O_s |L.H||V.H| (1 - F) D G / (|N.L||N.V| (V.H + eta L.H)^2) with eta the index on
//! the side of L over that of V: radiance is carried, so the eta^2 of the change of solid angle is cancelled.
//! Source: Walter et al. 2007, "Microfacet Models for Refraction through Rough Surfaces", equations 20 and 21.

use crate::shading::bsdf::{BsdfSample, SAMPLE_TRANSMIT, finish_sample, no_sample};
use crate::shading::closure::Closure;
use crate::shading::distribution::{facet_d, pdf_facet, sample_facet, smith_g_separable};
use crate::shading::fresnel::{fresnel_dielectric, refraction_root};
use crate::shading::lobe::{COS_MIN, reflect_about};
use crate::shading::math::{div, dot3, max_, min_, normalize3, rcp, sqrt_};
use crate::shading::spectrum::{Spectrum, spectrum_from_rgb, spectrum_zero};
use glam::{Vec2, Vec3};

/// Index on the other side of `wo` over that on its own.
#[inline]
pub fn eta_across(closure: &Closure, wo: Vec3) -> f32 {
    if wo.z >= 0.0 { closure.eta } else { rcp(closure.eta) }
}

/// The facet that takes `wo` to `wi`, on the outside (z > 0); the zero vector if none does. `eta`: `eta_across`.
#[inline]
pub fn half_vector(wo: Vec3, wi: Vec3, eta: f32) -> Vec3 {
    let reflects = wo.z * wi.z > 0.0;
    let h = normalize3(wo + wi * (if reflects { 1.0 } else { eta }));
    let wm = if h.z < 0.0 { -h } else { h };
    // Both see the facet from the side on which they are.
    let seen = dot3(wo, wm) * wo.z > 0.0 && dot3(wi, wm) * wi.z > 0.0;
    if seen && wo.z.abs() > COS_MIN && wi.z.abs() > COS_MIN { wm } else { Vec3::splat(0.0) }
}

/// |d omega_h / d omega_i| of refraction (equation 17). `o_h`, `i_h`: signed cosines of V and L to the facet.
#[inline]
pub fn refraction_jacobian(o_h: f32, i_h: f32, eta: f32) -> f32 {
    let root = o_h + eta * i_h;
    div((eta * eta) * i_h.abs(), max_(root * root, 1.0e-12))
}

/// Reflection or transmission times cosine, per steradian.
#[inline]
pub fn eval_rough_dielectric(closure: &Closure, wo: Vec3, wi: Vec3) -> Spectrum {
    let eta = eta_across(closure, wo);
    let wm = half_vector(wo, wi, eta);
    if wm.z <= COS_MIN {
        return spectrum_zero();
    }
    let kind = closure.distribution;
    let o_h = dot3(wo, wm);
    let i_h = dot3(wi, wm);
    let d = facet_d(kind, closure.alpha_u, closure.alpha_v, 1.0, wm);
    let g = smith_g_separable(kind, closure.alpha_u, closure.alpha_v, wo, wi);
    let f = fresnel_dielectric(min_(o_h.abs(), 1.0), eta);
    if wo.z * wi.z > 0.0 {
        return spectrum_from_rgb(closure.color * div((f * d) * g, 4.0 * wo.z.abs()));
    }
    let root = o_h + eta * i_h;
    let through = div(((1.0 - f) * d) * (g * (o_h * i_h).abs()), wo.z.abs() * max_(root * root, 1.0e-12));
    spectrum_from_rgb(closure.specular_color * through)
}

/// Density of `sample_rough_dielectric` over the sphere.
#[inline]
pub fn pdf_rough_dielectric(closure: &Closure, wo: Vec3, wi: Vec3) -> f32 {
    let eta = eta_across(closure, wo);
    let wm = half_vector(wo, wi, eta);
    if wm.z <= COS_MIN {
        return 0.0;
    }
    let o_h = dot3(wo, wm);
    // Seen from inside: the view through the surface's mirror, whose facets are the same.
    let view = Vec3::new(wo.x, wo.y, wo.z.abs());
    let facing = if wo.z < 0.0 { Vec3::new(-wm.x, -wm.y, wm.z) } else { wm };
    let facets = pdf_facet(closure.distribution, closure.alpha_u, closure.alpha_v, view, facing);
    let f = fresnel_dielectric(min_(o_h.abs(), 1.0), eta);
    if wo.z * wi.z > 0.0 {
        return div(f * facets, 4.0 * o_h.abs());
    }
    ((1.0 - f) * facets) * refraction_jacobian(o_h, dot3(wi, wm), eta)
}

/// Reflected or refracted by a visible facet, by Fresnel's probability. `u`: 0..1 each, excluding 1. `u_lobe`: 0..1, chooses.
#[inline]
pub fn sample_rough_dielectric(closure: &Closure, wo: Vec3, u: Vec2, u_lobe: f32) -> BsdfSample {
    if wo.z.abs() <= COS_MIN {
        return no_sample();
    }
    let side = if wo.z < 0.0 { -1.0 } else { 1.0 };
    let eta = eta_across(closure, wo);
    let view = Vec3::new(wo.x, wo.y, wo.z * side);
    let wm = sample_facet(closure.distribution, closure.alpha_u, closure.alpha_v, view, u);
    let o_h = dot3(view, wm);
    if o_h <= COS_MIN {
        return no_sample();
    }
    let f = fresnel_dielectric(min_(o_h, 1.0), eta);
    let mut upper = reflect_about(view, wm);
    let mut flags = 0;
    if u_lobe >= f {
        let root = refraction_root(min_(o_h, 1.0), eta);
        if root <= 0.0 {
            return no_sample();
        }
        let ratio = rcp(eta);
        upper = normalize3(wm * (ratio * o_h - sqrt_(root) * ratio) - view * ratio);
        flags = SAMPLE_TRANSMIT;
    }
    let kept = if flags == 0 { upper.z > COS_MIN } else { upper.z < -COS_MIN };
    if !kept {
        return no_sample();
    }
    let wi = Vec3::new(upper.x, upper.y, upper.z * side);
    let pdf = pdf_rough_dielectric(closure, wo, wi);
    finish_sample(wi, pdf, eval_rough_dielectric(closure, wo, wi), if flags == 0 { 1.0 } else { eta }, flags)
}
