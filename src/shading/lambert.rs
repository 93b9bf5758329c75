//! Ideal diffuse reflection (row 1): radiance independent of the viewer.
//! Source: Lambert 1760, "Photometria".

use crate::shading::closure::Closure;
use crate::shading::lobe::{DirectionSample, no_direction, on_upper_side};
use crate::shading::math::INV_PI;
use crate::shading::spectrum::{Spectrum, spectrum_from_rgb, spectrum_zero};
use crate::shading::warp::square_to_cosine_hemisphere;
use glam::{Vec2, Vec3};

/// k_d O_d / pi times cos theta_i, per steradian. Local frame.
#[inline]
pub fn eval_lambert(closure: &Closure, wo: Vec3, wi: Vec3) -> Spectrum {
    if !on_upper_side(wo, wi) {
        return spectrum_zero();
    }
    spectrum_from_rgb(closure.color * ((closure.k_d * INV_PI) * wi.z))
}

/// Density of `sample_lambert`: cos theta_i / pi.
#[inline]
pub fn pdf_lambert(_closure: &Closure, wo: Vec3, wi: Vec3) -> f32 {
    if !on_upper_side(wo, wi) {
        return 0.0;
    }
    wi.z * INV_PI
}

/// Cosine-weighted over the hemisphere. `u`: 0..1 each, excluding 1; `u_lobe` is not used (one lobe).
#[inline]
pub fn sample_lambert(_closure: &Closure, wo: Vec3, u: Vec2, _u_lobe: f32) -> DirectionSample {
    let wi = square_to_cosine_hemisphere(u);
    if !on_upper_side(wo, wi) {
        return no_direction();
    }
    DirectionSample { wi, pdf: wi.z * INV_PI }
}
