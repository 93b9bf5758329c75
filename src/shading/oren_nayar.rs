//! Rough diffuse reflection: V-cavities whose slope angle has the standard deviation `sigma` (radians), the
//! qualitative form: f = k_d O_d / pi (A + B max(0, cos(phi_i - phi_o)) sin alpha tan beta), without interreflection.
//! Source: Oren and Nayar 1994, "Generalization of Lambert's Reflectance Model", equation 30.

use crate::shading::closure::Closure;
use crate::shading::lobe::{DirectionSample, make_direction, no_direction, on_upper_side};
use crate::shading::math::{INV_PI, div, max_};
use crate::shading::spectrum::{Spectrum, spectrum_from_rgb, spectrum_zero};
use crate::shading::warp::square_to_cosine_hemisphere;
use glam::{Vec2, Vec3};

/// Reflection times cosine, per steradian. Local frame; zero unless both directions are on the upper side.
#[inline]
pub fn eval_oren_nayar(closure: &Closure, wo: Vec3, wi: Vec3) -> Spectrum {
    if !on_upper_side(wo, wi) {
        return spectrum_zero();
    }
    let s2 = closure.sigma * closure.sigma;
    let a = 1.0 - 0.5 * div(s2, s2 + 0.33);
    let b = 0.45 * div(s2, s2 + 0.09);
    // cos(phi_i - phi_o) sin_i sin_o; sin alpha tan beta = sin_i sin_o / the larger cosine
    let along = max_(wo.x * wi.x + wo.y * wi.y, 0.0);
    let rough = a + b * div(along, max_(wo.z, wi.z));
    spectrum_from_rgb(closure.color * ((closure.k_d * INV_PI) * (rough * wi.z)))
}

/// Density of `sample_oren_nayar`: cos theta_i / pi.
#[inline]
pub fn pdf_oren_nayar(_closure: &Closure, wo: Vec3, wi: Vec3) -> f32 {
    if !on_upper_side(wo, wi) {
        return 0.0;
    }
    wi.z * INV_PI
}

/// Cosine-weighted over the hemisphere. `u`: 0..1 each, excluding 1; `u_lobe` is not used (one lobe).
#[inline]
pub fn sample_oren_nayar(_closure: &Closure, wo: Vec3, u: Vec2, _u_lobe: f32) -> DirectionSample {
    let wi = square_to_cosine_hemisphere(u);
    if !on_upper_side(wo, wi) {
        return no_direction();
    }
    make_direction(wi, wi.z * INV_PI)
}
