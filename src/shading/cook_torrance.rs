//! Cook and Torrance's model (rows 14 to 18): f = k_d O_d / pi + k_s O_s D G F / (4 (N.L)(N.V)), k_d + k_s = 1.
//!
//! D is Beckmann's, normalised, one lobe or two; G the V-cavity's; F exact. The 1982 paper writes
//! D G F / (pi (N.L)(N.V)) with D = e^-(tan a / m)^2 / (m^2 cos^4 a): with the normalised D that is
//! D G F / ((N.L)(N.V)), four times the above; `MATERIAL_D_1982` draws it so.
//! Source: Cook and Torrance 1982, "A Reflectance Model for Computer Graphics".

use crate::layout::{MATERIAL_D_1982, Material};
use crate::shading::fresnel::fresnel_material;
use crate::shading::lobe::{DirectionSample, no_direction, on_upper_side, reflect_about, specular_probability};
use crate::shading::math::{INV_PI, div, dot3, min_, rsqrt};
use crate::shading::microfacet::{beckmann_lobes_d_slope, sample_beckmann, tan2_theta, v_cavity_g};
use crate::shading::spectrum::{Spectrum, spectrum_from_rgb, spectrum_zero};
use crate::shading::warp::square_to_cosine_hemisphere;
use glam::{Vec2, Vec3};

/// Diffuse and specular reflection times cosine, per steradian. Local frame; zero unless both are on the upper side.
/// Finite everywhere; the V-cavity's G lets the grazing mirror direction grow as 1 / (N.V).
#[inline]
pub fn eval_cook_torrance(material: &Material, wo: Vec3, wi: Vec3) -> Spectrum {
    if !on_upper_side(wo, wi) {
        return spectrum_zero();
    }
    let h = wo + wi;
    let h2 = dot3(h, h);
    let inv_h = rsqrt(h2);
    let n_h = min_(h.z * inv_h, 1.0);
    // V.H = L.H = |V + L| / 2
    let v_h = min_((0.5 * h2) * inv_h, 1.0);
    let d = beckmann_lobes_d_slope(tan2_theta(h), material.m0, material.m1, material.w0, material.w1);
    let g = v_cavity_g(n_h, wo.z, v_h, wi.z);
    let f = fresnel_material(material, v_h);
    // N.L of the cosine cancels the one below.
    let quarter = if (material.flags & MATERIAL_D_1982) != 0 { 1.0 } else { 0.25 };
    let facets = (material.k_s * quarter) * div(d * g, wo.z);
    let diffuse = material.color * ((material.k_d * INV_PI) * wi.z);
    let specular = (material.specular_color * f) * facets;
    spectrum_from_rgb(diffuse + specular)
}

/// Share of lobe 0 in w0 + w1; 1 if there is none.
#[inline]
fn first_lobe_share(material: &Material) -> f32 {
    let sum = material.w0 + material.w1;
    if sum > 1.0e-20 { div(material.w0, sum) } else { 1.0 }
}

/// Density of `sample_cook_torrance`; its integral over the upper side is below 1 by what falls under the horizon.
#[inline]
pub fn pdf_cook_torrance(material: &Material, wo: Vec3, wi: Vec3) -> f32 {
    if !on_upper_side(wo, wi) {
        return 0.0;
    }
    let p = specular_probability(material);
    let share = first_lobe_share(material);
    let h = wo + wi;
    let h2 = dot3(h, h);
    let inv_h = rsqrt(h2);
    let v_h = (0.5 * h2) * inv_h;
    // Density of H is D (N.H); d omega_i = 4 (V.H) d omega_h.
    let d = beckmann_lobes_d_slope(tan2_theta(h), material.m0, material.m1, share, 1.0 - share);
    let specular = div(d * (h.z * inv_h), 4.0 * v_h);
    (1.0 - p) * (wi.z * INV_PI) + p * specular
}

/// Cosine-weighted, or `wo` mirrored about a Beckmann facet of either lobe; what falls below the horizon is dropped.
/// `u`: 0..1 each, excluding 1. `u_lobe`: 0..1, chooses diffuse, lobe 0 or lobe 1.
#[inline]
pub fn sample_cook_torrance(material: &Material, wo: Vec3, u: Vec2, u_lobe: f32) -> DirectionSample {
    let p = specular_probability(material);
    let wi = if u_lobe < p * first_lobe_share(material) {
        reflect_about(wo, sample_beckmann(u, material.m0))
    } else if u_lobe < p {
        reflect_about(wo, sample_beckmann(u, material.m1))
    } else {
        square_to_cosine_hemisphere(u)
    };
    if !on_upper_side(wo, wi) {
        return no_direction();
    }
    DirectionSample { wi, pdf: pdf_cook_torrance(material, wo, wi) }
}
