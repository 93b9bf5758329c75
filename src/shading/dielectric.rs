//! Refraction and absorption of clear bodies (row 23).

use crate::shading::fresnel::refraction_root;
use crate::shading::lobe::reflect_local;
use crate::shading::math::{exp_, normalize3, rcp, sqrt_};
use crate::shading::spectrum::{Spectrum, spectrum_from_rgb};
use glam::Vec3;

/// What `refract_local` returns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Refraction {
    /// Unit, local frame, leaving the surface on the other side (z < 0); the mirror direction on total reflection.
    pub wt: Vec3,
    /// Cosine between wt and -N, 0..1; 0 on total reflection.
    pub cos_t: f32,
    /// Total internal reflection: nothing is transmitted.
    pub total: bool,
}

/// The refracted direction: T = (eta_i/eta_t cos theta_i - cos theta_t) N - eta_i/eta_t L.
/// `wo`: unit, local frame, z > 0: where the light comes from (or the viewer, for a ray traced backwards).
/// `eta`: index on the transmitted side over index on the incident side, > 0.
/// Source: Snell's law; Whitted 1980, "An Improved Illumination Model for Shaded Display".
#[inline]
pub fn refract_local(wo: Vec3, eta: f32) -> Refraction {
    let root = refraction_root(wo.z, eta);
    if root <= 0.0 {
        return Refraction { wt: reflect_local(wo), cos_t: 0.0, total: true };
    }
    let ratio = rcp(eta);
    // cos^2 theta_t = 1 - ratio^2 (1 - cos^2 theta_i) = root / eta^2
    let cos_t = sqrt_(root) * ratio;
    // N is z, so T's normal part, ratio cos_i - cos_t - ratio wo.z, is -cos_t.
    // Normalised, so that errors do not add up over many surfaces.
    let wt = normalize3(Vec3::new(-(ratio * wo.x), -(ratio * wo.y), -cos_t));
    Refraction { wt, cos_t: -wt.z, total: false }
}

/// One channel of `transmittance`.
#[inline]
fn transmittance1(absorption: f32, distance: f32) -> f32 {
    let depth = absorption * distance;
    if depth > 60.0 { 0.0 } else { exp_(-depth) }
}

/// Beer's law: e^(-absorption distance) per channel, 0..1; below e^-60 it is 0.
/// `absorption`: per scene unit, >= 0. `distance`: scene units, >= 0, up to `T_INFINITE`.
#[inline]
pub fn transmittance(absorption: Vec3, distance: f32) -> Spectrum {
    spectrum_from_rgb(Vec3::new(
        transmittance1(absorption.x, distance),
        transmittance1(absorption.y, distance),
        transmittance1(absorption.z, distance),
    ))
}
