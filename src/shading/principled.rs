//! Disney's material (Burley 2012 and 2015) with the parameters of Mitsuba 3's `principled`: diffuse with retro-reflection, sheen,
//! GGX facets between metal and glass, a clear coat.
//!
//! The base colour is `color`; the other parameters have their own names. With spec_trans the frame's z leaves the outside.
//! Sources: Burley 2012, "Physically Based Shading at Disney"; Burley 2015, "Extending the Disney BRDF to a BSDF"; Jakob et al. 2022,
//! "Mitsuba 3", plugin `principled` (how the lobes are put together).

use crate::layout::DISTRIBUTION_TROWBRIDGE_REITZ;
use crate::shading::bsdf::{BsdfSample, SAMPLE_TRANSMIT, finish_sample, no_sample};
use crate::shading::closure::Closure;
use crate::shading::distribution::{facet_d, pdf_facet, sample_facet, smith_g_separable};
use crate::shading::fresnel::{fresnel_dielectric, refraction_root};
use crate::shading::lobe::{COS_MIN, reflect_about};
use crate::shading::math::{
    INV_PI, PI, clamp_, cos_turns, div, dot3, log_, max_, min_, mix_, normalize3, pow_, rcp, sin_turns, sqrt_,
};
use crate::shading::microfacet::M_MIN;
use crate::shading::rough_dielectric::{eta_across, half_vector, refraction_jacobian};
use crate::shading::spectrum::{Spectrum, spectrum_from_rgb, spectrum_luminance, spectrum_zero};
use crate::shading::warp::square_to_cosine_hemisphere;
use glam::{Vec2, Vec3};

/// Roughness of the clear coat's masking (Burley 2012, section 5.4).
pub const CLEARCOAT_MASKING: f32 = 0.25;

/// (1 - cos)^5 of a cosine, either sign.
#[inline]
pub fn schlick_weight(cos_theta: f32) -> f32 {
    let c = clamp_(1.0 - cos_theta.abs(), 0.0, 1.0);
    let c2 = c * c;
    (c2 * c2) * c
}

/// Roughness alpha along and across the tangent (Burley 2012, section 5.4).
#[inline]
pub fn principled_alpha(closure: &Closure) -> Vec2 {
    let aspect = sqrt_(1.0 - 0.9 * closure.anisotropic);
    let r2 = closure.roughness * closure.roughness;
    Vec2::new(max_(div(r2, aspect), M_MIN), max_(r2 * aspect, M_MIN))
}

/// The base colour with luminance 1; white for black.
#[inline]
pub fn principled_tint(closure: &Closure) -> Vec3 {
    let luminance = spectrum_luminance(spectrum_from_rgb(closure.color));
    if luminance > 1.0e-6 { closure.color * rcp(luminance) } else { Vec3::splat(1.0) }
}

/// What the facets reflect of light on the outside: glass, tinted glass and metal. `f`: the glass's exact reflectance;
/// `o_h`: cosine to the facet.
#[inline]
pub fn principled_fresnel(closure: &Closure, f: f32, o_h: f32) -> Vec3 {
    let tint = closure.spec_tint;
    let metallic = closure.metallic;
    let root = div(closure.eta - 1.0, closure.eta + 1.0);
    let weight = schlick_weight(o_h);
    let metal = closure.color + (Vec3::splat(1.0) - closure.color) * weight;
    let f0 = principled_tint(closure) * (root * root);
    let tinted = f0 + (Vec3::splat(1.0) - f0) * weight;
    let glass = 1.0 - metallic;
    (Vec3::splat(f * (1.0 - tint)) + tinted * tint) * glass + metal * metallic
}

/// The clear coat's distribution (generalised Trowbridge and Reitz with exponent 1), per steradian of the facet normal.
/// `alpha`: 0.001 to 0.1. Source: Burley 2012, equation 4.
#[inline]
pub fn clearcoat_d(alpha: f32, cos_h: f32) -> f32 {
    let a2 = alpha * alpha;
    div(a2 - 1.0, (PI * log_(a2)) * (1.0 + (a2 - 1.0) * (cos_h * cos_h)))
}

/// Roughness alpha of the clear coat.
#[inline]
pub fn clearcoat_alpha(closure: &Closure) -> f32 {
    mix_(0.1, 0.001, closure.clearcoat_gloss)
}

/// Diffuse part, retro-reflection and sheen times cosine, for light and viewer outside.
#[inline]
pub fn principled_diffuse(closure: &Closure, wo: Vec3, wi: Vec3, i_h: f32) -> Vec3 {
    let brdf = (1.0 - closure.metallic) * (1.0 - closure.spec_trans);
    let f_o = schlick_weight(wo.z);
    let f_i = schlick_weight(wi.z);
    let smooth_part = (1.0 - 0.5 * f_o) * (1.0 - 0.5 * f_i);
    let retro = (2.0 * closure.roughness) * (i_h * i_h);
    let retro_part = retro * ((f_o + f_i) + (f_o * f_i) * (retro - 1.0));
    // Hanrahan and Krueger's flat look, Burley 2012, section 5.3
    let flatness = closure.flatness;
    let f_ss = mix_(1.0, 0.5 * retro, f_o) * mix_(1.0, 0.5 * retro, f_i);
    let flat_part = 1.25 * (f_ss * (rcp(wo.z + wi.z) - 0.5) + 0.5);
    let base = closure.color * ((brdf * INV_PI) * mix_(smooth_part + retro_part, flat_part, flatness));
    let sheen_tint = closure.sheen_tint;
    let sheen_color = Vec3::splat(1.0 - sheen_tint) + principled_tint(closure) * sheen_tint;
    let sheen = (closure.sheen * (1.0 - closure.metallic)) * schlick_weight(i_h);
    (base + sheen_color * sheen) * wi.z
}

/// All lobes times cosine, per steradian.
#[inline]
pub fn eval_principled(closure: &Closure, wo: Vec3, wi: Vec3) -> Spectrum {
    let eta = eta_across(closure, wo);
    let outside = wo.z > 0.0;
    let reflects = wo.z * wi.z > 0.0;
    let bsdf = (1.0 - closure.metallic) * closure.spec_trans;
    let wm = half_vector(wo, wi, eta);
    if wm.z <= COS_MIN {
        return spectrum_zero();
    }
    let o_h = dot3(wo, wm);
    let i_h = dot3(wi, wm);
    let f = fresnel_dielectric(min_(o_h.abs(), 1.0), eta);
    let alpha = principled_alpha(closure);
    let d = facet_d(DISTRIBUTION_TROWBRIDGE_REITZ, alpha.x, alpha.y, 1.0, wm);
    let g = smith_g_separable(DISTRIBUTION_TROWBRIDGE_REITZ, alpha.x, alpha.y, wo, wi);
    if !reflects {
        let root = o_h + eta * i_h;
        let through = div(((1.0 - f) * d) * (g * (o_h * i_h).abs()), wo.z.abs() * max_(root * root, 1.0e-12));
        let tint = Vec3::new(sqrt_(closure.color.x), sqrt_(closure.color.y), sqrt_(closure.color.z));
        return spectrum_from_rgb(tint * (bsdf * through));
    }
    let facets = div(d * g, 4.0 * wo.z.abs());
    if !outside {
        return spectrum_from_rgb(Vec3::splat((bsdf * f) * facets));
    }
    let mut value = principled_fresnel(closure, f, o_h) * facets + principled_diffuse(closure, wo, wi, i_h);
    let clearcoat = closure.clearcoat;
    if clearcoat > 0.0 {
        let coat_f = mix_(0.04, 1.0, schlick_weight(o_h));
        let coat_d = clearcoat_d(clearcoat_alpha(closure), wm.z);
        let coat_g = smith_g_separable(DISTRIBUTION_TROWBRIDGE_REITZ, CLEARCOAT_MASKING, CLEARCOAT_MASKING, wo, wi);
        value += Vec3::splat(((0.25 * clearcoat) * (coat_f * coat_d)) * (coat_g * wi.z));
    }
    spectrum_from_rgb(value)
}

/// Probabilities of the diffuse part (x) and of the clear coat (y); the rest is the facets'.
#[inline]
pub fn principled_choice(closure: &Closure, wo: Vec3) -> Vec2 {
    if wo.z <= 0.0 {
        return Vec2::new(0.0, 0.0);
    }
    let diffuse = (1.0 - closure.metallic) * (1.0 - closure.spec_trans);
    let coat = 0.25 * closure.clearcoat;
    let inv = rcp((1.0 + diffuse) + coat);
    Vec2::new(diffuse * inv, coat * inv)
}

/// Probability that a facet reflects rather than refracts. `f`: its exact reflectance.
#[inline]
pub fn principled_reflection(closure: &Closure, f: f32, outside: bool) -> f32 {
    let bsdf = (1.0 - closure.metallic) * closure.spec_trans;
    if outside { 1.0 - bsdf * (1.0 - f) } else { f }
}

/// Density of `sample_principled` over the sphere.
#[inline]
pub fn pdf_principled(closure: &Closure, wo: Vec3, wi: Vec3) -> f32 {
    let eta = eta_across(closure, wo);
    let wm = half_vector(wo, wi, eta);
    if wm.z <= COS_MIN {
        return 0.0;
    }
    let outside = wo.z > 0.0;
    let o_h = dot3(wo, wm);
    // Seen from inside: the view through the surface's mirror, whose facets are the same.
    let view = Vec3::new(wo.x, wo.y, wo.z.abs());
    let facing = if outside { wm } else { Vec3::new(-wm.x, -wm.y, wm.z) };
    let alpha = principled_alpha(closure);
    let choice = principled_choice(closure, wo);
    let mut facets = pdf_facet(DISTRIBUTION_TROWBRIDGE_REITZ, alpha.x, alpha.y, view, facing);
    facets *= (1.0 - choice.x) - choice.y;
    let reflection = principled_reflection(closure, fresnel_dielectric(min_(o_h.abs(), 1.0), eta), outside);
    if wo.z * wi.z <= 0.0 {
        return ((1.0 - reflection) * facets) * refraction_jacobian(o_h, dot3(wi, wm), eta);
    }
    let coat = if choice.y > 0.0 { choice.y * (clearcoat_d(clearcoat_alpha(closure), wm.z) * wm.z) } else { 0.0 };
    div(reflection * facets + coat, 4.0 * o_h.abs()) + choice.x * (max_(wi.z, 0.0) * INV_PI)
}

/// Cosine-weighted, or about a facet of the clear coat or of the main lobe, there reflected or refracted.
/// `u`: 0..1 each, excluding 1. `u_lobe`: 0..1, chooses.
#[inline]
pub fn sample_principled(closure: &Closure, wo: Vec3, u: Vec2, u_lobe: f32) -> BsdfSample {
    if wo.z.abs() <= COS_MIN {
        return no_sample();
    }
    let outside = wo.z > 0.0;
    let side = if outside { 1.0 } else { -1.0 };
    let eta = eta_across(closure, wo);
    let view = Vec3::new(wo.x, wo.y, wo.z * side);
    let choice = principled_choice(closure, wo);
    let mut upper = square_to_cosine_hemisphere(u);
    let mut refracts = false;
    if u_lobe >= choice.x && u_lobe < choice.x + choice.y {
        let a2 = clearcoat_alpha(closure) * clearcoat_alpha(closure);
        // The inverse of the integral of D cos: 1 - cos^2 = (a2^(1 - u) - a2) / (1 - a2)
        let cos2 = clamp_(div(1.0 - pow_(a2, 1.0 - u.x), 1.0 - a2), 0.0, 1.0);
        let sin_h = sqrt_(1.0 - cos2);
        upper = reflect_about(view, Vec3::new(sin_h * cos_turns(u.y), sin_h * sin_turns(u.y), sqrt_(cos2)));
    }
    if u_lobe >= choice.x + choice.y {
        let alpha = principled_alpha(closure);
        let wm = sample_facet(DISTRIBUTION_TROWBRIDGE_REITZ, alpha.x, alpha.y, view, u);
        let o_h = min_(dot3(view, wm), 1.0);
        if o_h <= COS_MIN {
            return no_sample();
        }
        let reflection = principled_reflection(closure, fresnel_dielectric(o_h, eta), outside);
        // What is left of u_lobe once the lobe is chosen, 0..1
        let rest = div(u_lobe - (choice.x + choice.y), max_((1.0 - choice.x) - choice.y, 1.0e-6));
        refracts = rest >= reflection;
        upper = reflect_about(view, wm);
        if refracts {
            let root = refraction_root(o_h, eta);
            if root <= 0.0 {
                return no_sample();
            }
            let ratio = rcp(eta);
            upper = normalize3(wm * (ratio * o_h - sqrt_(root) * ratio) - view * ratio);
        }
    }
    let kept = if refracts { upper.z < -COS_MIN } else { upper.z > COS_MIN };
    if !kept {
        return no_sample();
    }
    let wi = Vec3::new(upper.x, upper.y, upper.z * side);
    let pdf = pdf_principled(closure, wo, wi);
    let flags = if refracts { SAMPLE_TRANSMIT } else { 0 };
    finish_sample(wi, pdf, eval_principled(closure, wo, wi), if refracts { eta } else { 1.0 }, flags)
}
