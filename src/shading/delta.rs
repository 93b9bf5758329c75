//! Surfaces that send light into single directions: mirror, smooth metal, smooth glass, a thin pane, nothing at all.
//!
//! All return samples with `SAMPLE_DELTA`; eval and pdf of these models are zero. Local frame; z leaves the outside of a
//! glass. Radiance is carried, so that what enters a denser medium is scaled by 1 / eta^2 (Veach 1997, section 5.2).

use crate::shading::bsdf::{BsdfSample, SAMPLE_DELTA, SAMPLE_TRANSMIT, make_sample, no_sample};
use crate::shading::closure::Closure;
use crate::shading::dielectric::refract_local;
use crate::shading::fresnel::{fresnel_closure, fresnel_dielectric};
use crate::shading::lobe::{COS_MIN, reflect_local};
use crate::shading::math::{div, rcp};
use crate::shading::spectrum::spectrum_from_rgb;
use glam::Vec3;

/// Whole reflection of the material's colour.
#[inline]
pub fn sample_mirror(closure: &Closure, wo: Vec3) -> BsdfSample {
    if wo.z <= COS_MIN {
        return no_sample();
    }
    make_sample(reflect_local(wo), 1.0, spectrum_from_rgb(closure.color), 1.0, SAMPLE_DELTA)
}

/// A smooth metal: Fresnel's reflectance times O_s.
#[inline]
pub fn sample_conductor(closure: &Closure, wo: Vec3) -> BsdfSample {
    if wo.z <= COS_MIN {
        return no_sample();
    }
    let weight = closure.specular_color * fresnel_closure(closure, wo.z);
    make_sample(reflect_local(wo), 1.0, spectrum_from_rgb(weight), 1.0, SAMPLE_DELTA)
}

/// A smooth dielectric: reflected with Fresnel's probability, else refracted. `color` and `specular_color` are factors on
/// the two; `u_lobe`: 0..1, chooses.
#[inline]
pub fn sample_dielectric(closure: &Closure, wo: Vec3, u_lobe: f32) -> BsdfSample {
    let inside = wo.z < 0.0;
    let eta = if inside { rcp(closure.eta) } else { closure.eta };
    let upper = Vec3::new(wo.x, wo.y, wo.z.abs());
    if upper.z <= COS_MIN {
        return no_sample();
    }
    let reflectance = fresnel_dielectric(upper.z, eta);
    if u_lobe < reflectance {
        let tint = spectrum_from_rgb(closure.color);
        return make_sample(reflect_local(wo), reflectance, tint, 1.0, SAMPLE_DELTA);
    }
    let refraction = refract_local(upper, eta);
    if refraction.total {
        return no_sample();
    }
    let below = refraction.wt;
    let wi = Vec3::new(below.x, below.y, if inside { -below.z } else { below.z });
    let inv_eta = rcp(eta);
    let weight = spectrum_from_rgb(closure.specular_color * (inv_eta * inv_eta));
    make_sample(wi, 1.0 - reflectance, weight, eta, SAMPLE_DELTA | SAMPLE_TRANSMIT)
}

/// Reflectance of a pane of both its faces and all reflections between them: R + T^2 R / (1 - R^2) = 2 R / (1 + R).
/// `cos_o`: cosine of the viewer's angle, either sign. `eta`: relative index.
#[inline]
pub fn thin_reflectance(cos_o: f32, eta: f32) -> f32 {
    let r = fresnel_dielectric(cos_o.abs(), eta);
    div(2.0 * r, 1.0 + r)
}

/// A pane without thickness: reflected, or straight on. Factors as of `sample_dielectric`.
#[inline]
pub fn sample_thin_dielectric(closure: &Closure, wo: Vec3, u_lobe: f32) -> BsdfSample {
    if wo.z.abs() <= COS_MIN {
        return no_sample();
    }
    let reflectance = thin_reflectance(wo.z, closure.eta);
    if u_lobe < reflectance {
        let tint = spectrum_from_rgb(closure.color);
        return make_sample(reflect_local(wo), reflectance, tint, 1.0, SAMPLE_DELTA);
    }
    let tint = spectrum_from_rgb(closure.specular_color);
    make_sample(-wo, 1.0 - reflectance, tint, 1.0, SAMPLE_DELTA | SAMPLE_TRANSMIT)
}

/// Straight through a surface that is not there.
#[inline]
pub fn sample_null(wo: Vec3) -> BsdfSample {
    make_sample(-wo, 1.0, spectrum_from_rgb(Vec3::splat(1.0)), 1.0, SAMPLE_DELTA | SAMPLE_TRANSMIT)
}
