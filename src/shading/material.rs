//! Every model behind one set of functions. `match` here and `switch` in GLSL keep the order of `layout/material`.
//!
//! Directions are unit, in the local frame, leaving the surface. z leaves the outside of models that transmit
//! (`MATERIAL_TRANSMISSIVE`), where wo.z < 0 is a viewer inside; of the others the caller turns it to the viewer's side, so that
//! wo.z > 0. `eval` includes the cosine. Lobes of zero width (mirror, smooth glass and metal, a plastic's coat) exist for
//! `sample_closure` only: their eval and pdf are zero, and `local` and `whitted` draw them as branches.

use crate::layout::{
    MATERIAL_FILTERED, MODEL_ASHIKHMIN_SHIRLEY, MODEL_BLEND, MODEL_BLINN_PHONG, MODEL_CONDUCTOR, MODEL_COOK_TORRANCE,
    MODEL_DIELECTRIC, MODEL_EMISSIVE, MODEL_EON, MODEL_KELEMEN, MODEL_LAMBERT, MODEL_MEASURED, MODEL_MIRROR,
    MODEL_NULL, MODEL_OREN_NAYAR, MODEL_PHONG, MODEL_PLASTIC, MODEL_PRINCIPLED, MODEL_ROUGH_CONDUCTOR,
    MODEL_ROUGH_DIELECTRIC, MODEL_ROUGH_PLASTIC, MODEL_TABULATED, MODEL_THIN_DIELECTRIC, MODEL_WARD, SceneView,
};
use crate::shading::ashikhmin::{eval_ashikhmin, pdf_ashikhmin, sample_ashikhmin};
use crate::shading::blinn_phong::{eval_blinn_phong, pdf_blinn_phong, sample_blinn_phong};
use crate::shading::bsdf::{BsdfSample, finish_sample, no_sample};
use crate::shading::closure::Closure;
use crate::shading::cook_torrance::{eval_cook_torrance, pdf_cook_torrance, sample_cook_torrance};
use crate::shading::delta::{sample_conductor, sample_dielectric, sample_mirror, sample_null, sample_thin_dielectric};
use crate::shading::eon::{eval_eon, pdf_eon, sample_eon};
use crate::shading::fresnel::fresnel_closure;
use crate::shading::kelemen::{eval_kelemen, pdf_kelemen, sample_kelemen};
use crate::shading::lambert::{eval_lambert, pdf_lambert, sample_lambert};
use crate::shading::lobe::{COS_MIN, DirectionSample, no_direction};
use crate::shading::math::clamp_;
use crate::shading::measured::{eval_measured, pdf_measured, sample_measured};
use crate::shading::oren_nayar::{eval_oren_nayar, pdf_oren_nayar, sample_oren_nayar};
use crate::shading::phong::{eval_phong, pdf_phong, sample_phong};
use crate::shading::plastic::{
    eval_plastic, eval_rough_plastic, pdf_plastic, pdf_rough_plastic, sample_plastic, sample_rough_plastic,
};
use crate::shading::principled::{eval_principled, pdf_principled, sample_principled};
use crate::shading::rough_conductor::{eval_rough_conductor, pdf_rough_conductor, sample_rough_conductor};
use crate::shading::rough_dielectric::{eval_rough_dielectric, pdf_rough_dielectric, sample_rough_dielectric};
use crate::shading::spectrum::{Spectrum, spectrum_from_rgb, spectrum_zero};
use crate::shading::tabulated::{eval_tabulated, pdf_tabulated, sample_tabulated};
use crate::shading::ward::{eval_ward, pdf_ward, sample_ward};
use glam::{Vec2, Vec3, Vec4};

/// f |cos theta_i| (for the lecture's printed terms: the term over pi), per steradian, over the whole sphere.
/// Lobes of zero width add nothing.
#[inline]
pub fn eval_closure(scene: &SceneView, closure: &Closure, wo: Vec3, wi: Vec3) -> Spectrum {
    match closure.model {
        MODEL_LAMBERT => eval_lambert(closure, wo, wi),
        MODEL_PHONG => eval_phong(closure, wo, wi),
        MODEL_BLINN_PHONG => eval_blinn_phong(closure, wo, wi),
        MODEL_COOK_TORRANCE => eval_cook_torrance(scene, closure, wo, wi),
        MODEL_OREN_NAYAR => eval_oren_nayar(closure, wo, wi),
        MODEL_WARD => eval_ward(closure, wo, wi),
        MODEL_ASHIKHMIN_SHIRLEY => eval_ashikhmin(closure, wo, wi),
        MODEL_KELEMEN => eval_kelemen(scene, closure, wo, wi),
        MODEL_ROUGH_CONDUCTOR => eval_rough_conductor(scene, closure, wo, wi),
        MODEL_ROUGH_DIELECTRIC => eval_rough_dielectric(closure, wo, wi),
        MODEL_PLASTIC => eval_plastic(closure, wo, wi),
        MODEL_ROUGH_PLASTIC => eval_rough_plastic(scene, closure, wo, wi),
        MODEL_PRINCIPLED => eval_principled(closure, wo, wi),
        MODEL_MEASURED => eval_measured(scene, closure, wo, wi),
        MODEL_TABULATED => eval_tabulated(scene, closure, wo, wi),
        MODEL_EON => eval_eon(closure, wo, wi),
        _ => spectrum_zero(),
    }
}

/// Density of `sample_closure` without its lobes of zero width, per solid angle; its integral is at most 1.
#[inline]
pub fn pdf_closure(scene: &SceneView, closure: &Closure, wo: Vec3, wi: Vec3) -> f32 {
    match closure.model {
        MODEL_LAMBERT => pdf_lambert(closure, wo, wi),
        MODEL_PHONG => pdf_phong(closure, wo, wi),
        MODEL_BLINN_PHONG => pdf_blinn_phong(closure, wo, wi),
        MODEL_COOK_TORRANCE => pdf_cook_torrance(scene, closure, wo, wi),
        MODEL_OREN_NAYAR => pdf_oren_nayar(closure, wo, wi),
        MODEL_WARD => pdf_ward(closure, wo, wi),
        MODEL_ASHIKHMIN_SHIRLEY => pdf_ashikhmin(closure, wo, wi),
        MODEL_KELEMEN => pdf_kelemen(scene, closure, wo, wi),
        MODEL_ROUGH_CONDUCTOR => pdf_rough_conductor(scene, closure, wo, wi),
        MODEL_ROUGH_DIELECTRIC => pdf_rough_dielectric(closure, wo, wi),
        MODEL_PLASTIC => pdf_plastic(closure, wo, wi),
        MODEL_ROUGH_PLASTIC => pdf_rough_plastic(scene, closure, wo, wi),
        MODEL_PRINCIPLED => pdf_principled(closure, wo, wi),
        MODEL_MEASURED => pdf_measured(scene, closure, wo, wi),
        MODEL_TABULATED => pdf_tabulated(scene, closure, wo, wi),
        MODEL_EON => pdf_eon(closure, wo, wi),
        _ => 0.0,
    }
}

/// The direction that models of one side choose, with density `pdf_closure`; pdf 0 if it is to be dropped.
#[inline]
pub fn sample_direction(scene: &SceneView, closure: &Closure, wo: Vec3, u: Vec2, u_lobe: f32) -> DirectionSample {
    match closure.model {
        MODEL_LAMBERT => sample_lambert(closure, wo, u, u_lobe),
        MODEL_PHONG => sample_phong(closure, wo, u, u_lobe),
        MODEL_BLINN_PHONG => sample_blinn_phong(closure, wo, u, u_lobe),
        MODEL_COOK_TORRANCE => sample_cook_torrance(scene, closure, wo, u, u_lobe),
        MODEL_OREN_NAYAR => sample_oren_nayar(closure, wo, u, u_lobe),
        MODEL_WARD => sample_ward(closure, wo, u, u_lobe),
        MODEL_ASHIKHMIN_SHIRLEY => sample_ashikhmin(closure, wo, u, u_lobe),
        MODEL_KELEMEN => sample_kelemen(scene, closure, wo, u, u_lobe),
        MODEL_ROUGH_CONDUCTOR => sample_rough_conductor(scene, closure, wo, u, u_lobe),
        MODEL_ROUGH_PLASTIC => sample_rough_plastic(scene, closure, wo, u, u_lobe),
        MODEL_MEASURED => sample_measured(scene, closure, wo, u, u_lobe),
        MODEL_TABULATED => sample_tabulated(scene, closure, wo, u, u_lobe),
        MODEL_EON => sample_eon(closure, wo, u, u_lobe),
        _ => no_direction(),
    }
}

/// A direction to the light, lobes of zero width included; pdf 0 if it is to be dropped.
/// `u`: 0..1 each, excluding 1. `u_lobe`: 0..1, excluding 1, chooses among the model's lobes.
#[inline]
pub fn sample_closure(scene: &SceneView, closure: &Closure, wo: Vec3, u: Vec2, u_lobe: f32) -> BsdfSample {
    match closure.model {
        MODEL_MIRROR => sample_mirror(closure, wo),
        MODEL_DIELECTRIC => sample_dielectric(closure, wo, u_lobe),
        MODEL_CONDUCTOR => sample_conductor(closure, wo),
        MODEL_ROUGH_DIELECTRIC => sample_rough_dielectric(closure, wo, u, u_lobe),
        MODEL_THIN_DIELECTRIC => sample_thin_dielectric(closure, wo, u_lobe),
        MODEL_PLASTIC => sample_plastic(closure, wo, u, u_lobe),
        MODEL_PRINCIPLED => sample_principled(closure, wo, u, u_lobe),
        MODEL_NULL => sample_null(wo),
        _ => {
            let direction = sample_direction(scene, closure, wo, u, u_lobe);
            if direction.pdf <= 0.0 {
                return no_sample();
            }
            finish_sample(direction.wi, direction.pdf, eval_closure(scene, closure, wo, direction.wi), 1.0, 0)
        }
    }
}

/// What the ambient radiance I_a is multiplied by: k_a O_d (row 4); zero for what only mirrors or transmits.
#[inline]
pub fn ambient_closure(closure: &Closure) -> Spectrum {
    match closure.model {
        MODEL_MIRROR
        | MODEL_DIELECTRIC
        | MODEL_EMISSIVE
        | MODEL_CONDUCTOR
        | MODEL_ROUGH_DIELECTRIC
        | MODEL_THIN_DIELECTRIC
        | MODEL_NULL
        | MODEL_BLEND => spectrum_zero(),
        _ => spectrum_from_rgb(closure.color * closure.k_a),
    }
}

/// Weight of the branch that follows the mirror direction (row 24): what a mirror, a smooth metal or a plastic's coat
/// reflects, else k_r O_s. Zero below the horizon, for glass (its branches are weighted by Fresnel), for what is not there
/// and for an emissive surface. `cos_o`: cosine between normal and `wo`.
#[inline]
pub fn mirror_weight(closure: &Closure, cos_o: f32) -> Spectrum {
    if cos_o <= COS_MIN {
        return spectrum_zero();
    }
    match closure.model {
        MODEL_MIRROR => spectrum_from_rgb(closure.color),
        MODEL_CONDUCTOR | MODEL_PLASTIC => spectrum_from_rgb(closure.specular_color * fresnel_closure(closure, cos_o)),
        MODEL_DIELECTRIC
        | MODEL_EMISSIVE
        | MODEL_ROUGH_DIELECTRIC
        | MODEL_THIN_DIELECTRIC
        | MODEL_NULL
        | MODEL_BLEND => spectrum_zero(),
        _ => spectrum_from_rgb(closure.specular_color * closure.k_r),
    }
}

/// How much of the surface's own light a pane keeps: 1 - k_t if interpolated, all of it if filtered (row 22).
#[inline]
pub fn own_weight(flags: u32, k_t: f32) -> f32 {
    if (flags & MATERIAL_FILTERED) != 0 { 1.0 } else { 1.0 - k_t }
}

/// What a pane multiplies the light by that passes it straight on: k_t, of a filter k_t O_t (row 22).
#[inline]
pub fn pane_tint(closure: &Closure) -> Spectrum {
    let tint = Vec4::splat(closure.k_t);
    if (closure.flags & MATERIAL_FILTERED) != 0 {
        return tint * spectrum_from_rgb(closure.transmit_color);
    }
    tint
}

/// Reflectance for the auxiliary image, 0..1 per channel: k_d O_d + k_s O_s, O_s times F(0) where there is an interface.
#[inline]
pub fn albedo_closure(closure: &Closure) -> Spectrum {
    let diffuse = closure.color * closure.k_d;
    let specular = closure.specular_color * closure.k_s;
    let rgb = match closure.model {
        MODEL_LAMBERT | MODEL_OREN_NAYAR | MODEL_EON => diffuse,
        MODEL_PHONG | MODEL_BLINN_PHONG | MODEL_WARD | MODEL_ASHIKHMIN_SHIRLEY => diffuse + specular,
        MODEL_COOK_TORRANCE => diffuse + specular * fresnel_closure(closure, 1.0),
        MODEL_CONDUCTOR | MODEL_ROUGH_CONDUCTOR => closure.specular_color * fresnel_closure(closure, 1.0),
        MODEL_DIELECTRIC | MODEL_ROUGH_DIELECTRIC | MODEL_THIN_DIELECTRIC => closure.specular_color,
        MODEL_EMISSIVE => closure.emission,
        MODEL_NULL | MODEL_BLEND => Vec3::ZERO,
        _ => closure.color,
    };
    spectrum_from_rgb(Vec3::new(clamp_(rgb.x, 0.0, 1.0), clamp_(rgb.y, 0.0, 1.0), clamp_(rgb.z, 0.0, 1.0)))
}

/// True if whitted follows what the material transmits: glass, drawn smooth even if it is rough, and thin panes.
pub fn is_refracting(model: u32) -> bool {
    model == MODEL_DIELECTRIC || model == MODEL_ROUGH_DIELECTRIC || model == MODEL_THIN_DIELECTRIC
}

/// True if the model has lobes of zero width only: no light needs to be sampled for it.
#[inline]
pub fn is_delta(closure: &Closure) -> bool {
    matches!(closure.model, MODEL_MIRROR | MODEL_DIELECTRIC | MODEL_CONDUCTOR | MODEL_THIN_DIELECTRIC | MODEL_NULL)
}
