//! Kelemen and Szirmay-Kalos's coupled matte and specular reflection (row 19): what the specular part does not reflect
//! reaches the base, so that the two share the light at every angle.
//!
//! Specular: D F / (4 (V.H)^2), D Beckmann's; matte: O_d (1 - E(o)) (1 - E(i)) / (pi (1 - E_mean)), E the specular part's albedo
//! (a table at `table`). `specular_color` is a factor on the specular part.
//! Source: Kelemen and Szirmay-Kalos 2001, "A Microfacet Based Coupled Specular-Matte BRDF Model".

use crate::layout::{SceneView, load_table};
use crate::shading::albedo::albedo_at;
use crate::shading::closure::Closure;
use crate::shading::fresnel::fresnel_closure;
use crate::shading::lobe::{COS_MIN, DirectionSample, make_direction, no_direction, on_upper_side, reflect_about};
use crate::shading::math::{INV_PI, PI, clamp_, div, dot3, max_, max3_, min_, normalize3, sqrt_};
use crate::shading::microfacet::{beckmann_d_slope, pdf_beckmann, sample_beckmann, tan2_theta};
use crate::shading::spectrum::{Spectrum, spectrum_from_rgb, spectrum_zero};
use crate::shading::warp::square_to_cosine_hemisphere;
use glam::{Vec2, Vec3};

/// Both parts times cosine, per steradian. Local frame; zero unless both directions are on the upper side.
#[inline]
pub fn eval_kelemen(scene: &SceneView, closure: &Closure, wo: Vec3, wi: Vec3) -> Spectrum {
    if !on_upper_side(wo, wi) {
        return spectrum_zero();
    }
    let h = wo + wi;
    // |h|^2 = 2 (1 + L.V) = 4 (V.H)^2
    let h2 = dot3(h, h);
    let v_h = min_(0.5 * sqrt_(h2), 1.0);
    let d = beckmann_d_slope(tan2_theta(h), closure.alpha_u);
    let specular = (closure.specular_color * fresnel_closure(closure, v_h)) * (div(d, h2) * wi.z);
    let entered = (1.0 - albedo_at(scene, closure.table, wo.z)) * (1.0 - albedo_at(scene, closure.table, wi.z));
    let mean = load_table(scene, closure.table + 2);
    let matte = closure.color * div(entered * wi.z, PI * max_(1.0 - mean, 1.0e-6));
    spectrum_from_rgb(specular + matte)
}

/// Probability of sampling the specular part: its share of the light.
#[inline]
pub fn kelemen_probability(scene: &SceneView, closure: &Closure, cos_o: f32) -> f32 {
    let e = clamp_(albedo_at(scene, closure.table, cos_o), 0.0, 1.0);
    let specular = e * max3_(closure.specular_color);
    let sum = specular + (1.0 - e) * max3_(closure.color);
    if sum > 1.0e-20 { div(specular, sum) } else { 0.0 }
}

/// Density of `sample_kelemen`; its integral over the upper side is below 1 by what falls under the horizon.
#[inline]
pub fn pdf_kelemen(scene: &SceneView, closure: &Closure, wo: Vec3, wi: Vec3) -> f32 {
    if !on_upper_side(wo, wi) {
        return 0.0;
    }
    let p = kelemen_probability(scene, closure, wo.z);
    let wm = normalize3(wo + wi);
    let specular = div(pdf_beckmann(wm, closure.alpha_u), 4.0 * max_(dot3(wo, wm), 1.0e-7));
    (1.0 - p) * (wi.z * INV_PI) + p * specular
}

/// Cosine-weighted, or `wo` mirrored about a Beckmann facet; what falls below the horizon is dropped.
/// `u`: 0..1 each, excluding 1. `u_lobe`: 0..1, chooses.
#[inline]
pub fn sample_kelemen(scene: &SceneView, closure: &Closure, wo: Vec3, u: Vec2, u_lobe: f32) -> DirectionSample {
    if wo.z <= COS_MIN {
        return no_direction();
    }
    let mut wi = square_to_cosine_hemisphere(u);
    if u_lobe < kelemen_probability(scene, closure, wo.z) {
        wi = reflect_about(wo, sample_beckmann(u, closure.alpha_u));
    }
    if !on_upper_side(wo, wi) {
        return no_direction();
    }
    make_direction(wi, pdf_kelemen(scene, closure, wo, wi))
}
