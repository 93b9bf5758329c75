//! Every model behind one set of functions. `match` here and `switch` in GLSL keep the order of `layout/material`.
//!
//! Directions are unit, in the local frame, leaving the surface. `eval` includes the cosine. Mirror and dielectric are
//! directions of zero width, drawn as branches by the integrator: their eval and pdf are zero.

use crate::layout::{
    MODEL_BLINN_PHONG, MODEL_COOK_TORRANCE, MODEL_DIELECTRIC, MODEL_EMISSIVE, MODEL_LAMBERT, MODEL_MIRROR, MODEL_PHONG,
    Material,
};
use crate::shading::blinn_phong::{eval_blinn_phong, pdf_blinn_phong, sample_blinn_phong};
use crate::shading::cook_torrance::{
    eval_cook_torrance, fresnel_cook_torrance, pdf_cook_torrance, sample_cook_torrance,
};
use crate::shading::lambert::{eval_lambert, pdf_lambert, sample_lambert};
use crate::shading::lobe::{COS_MIN, DirectionSample, no_direction};
use crate::shading::math::clamp_;
use crate::shading::phong::{eval_phong, pdf_phong, sample_phong};
use crate::shading::spectrum::{Spectrum, spectrum_from_rgb, spectrum_zero};
use glam::{Vec2, Vec3};

/// BRDF times cosine (for the lecture's printed terms: the term over pi), per steradian.
/// Zero unless both directions are on the upper side.
#[inline]
pub fn eval_material(material: &Material, wo: Vec3, wi: Vec3) -> Spectrum {
    match material.model {
        MODEL_LAMBERT => eval_lambert(material, wo, wi),
        MODEL_PHONG => eval_phong(material, wo, wi),
        MODEL_BLINN_PHONG => eval_blinn_phong(material, wo, wi),
        MODEL_COOK_TORRANCE => eval_cook_torrance(material, wo, wi),
        // MODEL_MIRROR, MODEL_DIELECTRIC, MODEL_EMISSIVE
        _ => spectrum_zero(),
    }
}

/// A direction to the light with density `pdf_material`; pdf 0 if it is to be dropped.
/// `u`: 0..1 each, excluding 1. `u_lobe`: 0..1, chooses among the model's lobes.
#[inline]
pub fn sample_material(material: &Material, wo: Vec3, u: Vec2, u_lobe: f32) -> DirectionSample {
    match material.model {
        MODEL_LAMBERT => sample_lambert(material, wo, u, u_lobe),
        MODEL_PHONG => sample_phong(material, wo, u, u_lobe),
        MODEL_BLINN_PHONG => sample_blinn_phong(material, wo, u, u_lobe),
        MODEL_COOK_TORRANCE => sample_cook_torrance(material, wo, u, u_lobe),
        // MODEL_MIRROR, MODEL_DIELECTRIC, MODEL_EMISSIVE
        _ => no_direction(),
    }
}

/// Density of `sample_material`, per solid angle; its integral over the upper side is at most 1.
#[inline]
pub fn pdf_material(material: &Material, wo: Vec3, wi: Vec3) -> f32 {
    match material.model {
        MODEL_LAMBERT => pdf_lambert(material, wo, wi),
        MODEL_PHONG => pdf_phong(material, wo, wi),
        MODEL_BLINN_PHONG => pdf_blinn_phong(material, wo, wi),
        MODEL_COOK_TORRANCE => pdf_cook_torrance(material, wo, wi),
        // MODEL_MIRROR, MODEL_DIELECTRIC, MODEL_EMISSIVE
        _ => 0.0,
    }
}

/// What the ambient radiance I_a is multiplied by: k_a O_d (row 4); zero for mirror, dielectric and emissive.
#[inline]
pub fn ambient_material(material: &Material) -> Spectrum {
    match material.model {
        MODEL_LAMBERT | MODEL_PHONG | MODEL_BLINN_PHONG | MODEL_COOK_TORRANCE => {
            spectrum_from_rgb(material.color * material.k_a)
        }
        // MODEL_MIRROR, MODEL_DIELECTRIC, MODEL_EMISSIVE
        _ => spectrum_zero(),
    }
}

/// Weight of the branch that follows the mirror direction (row 24): a mirror's reflectance, else k_r O_s.
/// Zero below the horizon, for a dielectric (its branches are weighted by Fresnel) and for an emissive surface.
/// `cos_o`: cosine between normal and `wo`.
#[inline]
pub fn mirror_weight(material: &Material, cos_o: f32) -> Spectrum {
    if cos_o <= COS_MIN {
        return spectrum_zero();
    }
    match material.model {
        MODEL_LAMBERT | MODEL_PHONG | MODEL_BLINN_PHONG | MODEL_COOK_TORRANCE => {
            spectrum_from_rgb(material.specular_color * material.k_r)
        }
        MODEL_MIRROR => spectrum_from_rgb(material.color),
        // MODEL_DIELECTRIC, MODEL_EMISSIVE
        _ => spectrum_zero(),
    }
}

/// Radiance the surface sends out by itself, the same in every direction: its emission, and the colour of an emissive one.
#[inline]
pub fn emission_material(material: &Material) -> Spectrum {
    let shown = if material.model == MODEL_EMISSIVE { material.color } else { Vec3::ZERO };
    spectrum_from_rgb(material.emission + shown)
}

/// Reflectance for the auxiliary image, 0..1 per channel: k_d O_d + k_s O_s, O_s times F(0) for Cook-Torrance.
#[inline]
pub fn albedo_material(material: &Material) -> Spectrum {
    let diffuse = material.color * material.k_d;
    let specular = material.specular_color * material.k_s;
    let rgb = match material.model {
        MODEL_LAMBERT => diffuse,
        MODEL_PHONG | MODEL_BLINN_PHONG => diffuse + specular,
        MODEL_COOK_TORRANCE => diffuse + specular * fresnel_cook_torrance(material, 1.0),
        MODEL_MIRROR => material.color,
        MODEL_DIELECTRIC => material.specular_color,
        MODEL_EMISSIVE => material.color,
        _ => Vec3::ZERO,
    };
    spectrum_from_rgb(Vec3::new(clamp_(rgb.x, 0.0, 1.0), clamp_(rgb.y, 0.0, 1.0), clamp_(rgb.z, 0.0, 1.0)))
}

/// True if the model reflects and refracts into single directions only.
#[inline]
pub fn is_delta(material: &Material) -> bool {
    material.model == MODEL_MIRROR || material.model == MODEL_DIELECTRIC
}
