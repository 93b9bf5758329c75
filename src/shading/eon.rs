//! Rough diffuse reflection that loses no energy: Fujii's form of Oren and Nayar's model, and what its cavities reflect among
//! each other. `roughness` 0 is Lambert's model, 1 the roughest.
//! Source: Portsmouth, Kutz and Hill 2025, "EON: A Practical Energy-Preserving Rough Diffuse BRDF", JCGT 14(1), listings 1 to 3;
//! <https://jcgt.org/published/0014/01/06/>.

use crate::shading::closure::Closure;
use crate::shading::lobe::{COS_MIN, DirectionSample, make_direction, no_direction, on_upper_side};
use crate::shading::math::{
    INV_PI, INV_TWO_PI, PI, cos_turns, div, max_, mix_, normalize3, pow_, rcp, rsqrt, sin_turns, sqrt_,
};
use crate::shading::spectrum::{Spectrum, spectrum_from_rgb, spectrum_zero};
use crate::shading::warp::square_to_uniform_hemisphere;
use glam::{Vec2, Vec3, Vec4};

/// 1/2 - 2 / (3 pi), and 2/3 - 28 / (15 pi).
pub const FON_A: f32 = 0.287793398;
pub const FON_B: f32 = 0.0724882111;

/// Part of white light from one direction that cavities of a white surface reflect without interreflection, within .1 %.
#[inline]
pub fn eon_albedo(cos_theta: f32, roughness: f32) -> f32 {
    let x = 1.0 - cos_theta;
    let g = x * (0.0571085289 + x * (0.491881867 + x * (-0.332181442 + x * 0.0714429953)));
    div(1.0 + roughness * g, 1.0 + FON_A * roughness)
}

/// Reflectance of one channel: `single` times its colour, and `multiple` times what is left of it after reflection among cavities
/// whose mean albedo is `mean`.
#[inline]
pub fn eon_channel(color: f32, single: f32, multiple: f32, mean: f32) -> f32 {
    let coupled = div((color * color) * mean, max_(1.0 - color * (1.0 - mean), 1.0e-6));
    color * single + coupled * multiple
}

/// Reflection times cosine, per steradian. Local frame; zero unless both directions are on the upper side.
#[inline]
pub fn eval_eon(closure: &Closure, wo: Vec3, wi: Vec3) -> Spectrum {
    if !on_upper_side(wo, wi) {
        return spectrum_zero();
    }
    let r = closure.roughness;
    let s = wo.x * wi.x + wo.y * wi.y;
    let along = if s > 0.0 { div(s, max_(wo.z, wi.z)) } else { s };
    let a = rcp(1.0 + FON_A * r);
    let mean = a * (1.0 + FON_B * r);
    let scale = (closure.k_d * INV_PI) * wi.z;
    let single = (scale * a) * (1.0 + r * along);
    let lost = max_(1.0 - eon_albedo(wo.z, r), 1.0e-7) * max_(1.0 - eon_albedo(wi.z, r), 1.0e-7);
    let multiple = scale * div(lost, max_(1.0 - mean, 1.0e-7));
    spectrum_from_rgb(Vec3::new(
        eon_channel(closure.color.x, single, multiple, mean),
        eon_channel(closure.color.y, single, multiple, mean),
        eon_channel(closure.color.z, single, multiple, mean),
    ))
}

/// The linear transform of cosines that the lobe seen from a cosine `mu` is like: a, b, c, d of ((a, 0, b), (0, c, 0), (d, 0, 1)).
#[inline]
pub fn eon_transform(mu: f32, r: f32) -> Vec4 {
    let a = r * (0.303392 + (0.111709 * mu - 0.518982) * mu + (0.335918 * mu - 0.276266) * r) + 1.0;
    let b = div(r * ((1.15859 * mu - 1.16407) + (0.150815 - 0.150105 * mu) * r), (mu * mu) * mu - 1.43545);
    let c = (0.20013 + (0.261777 * mu - 0.506373) * mu) * r + 1.0;
    let d = div((0.540852 + (0.475392 * mu - 1.01625) * mu) * r, mu * (0.0725628 + mu) - 1.0743);
    Vec4::new(a, b, c, d)
}

/// Area of the unit disk, over pi, that the transform leaves above the horizon. `d`: of `eon_transform`.
#[inline]
pub fn eon_clip(d: f32) -> f32 {
    (rsqrt(d * d + 1.0) + 1.0) * 0.5
}

/// Unit vector across the normal towards `w`; x where that is the normal itself.
#[inline]
pub fn eon_azimuth(w: Vec3) -> Vec2 {
    let across2 = w.x * w.x + w.y * w.y;
    if across2 <= 1.0e-14 {
        return Vec2::new(1.0, 0.0);
    }
    Vec2::new(w.x, w.y) * rsqrt(across2)
}

/// Probability of a direction that is uniform over the hemisphere.
#[inline]
pub fn eon_uniform(mu: f32, r: f32) -> f32 {
    if r <= 0.0 {
        return 0.0;
    }
    pow_(r, 0.1) * (0.162925 + mu * ((0.538233 - 0.290822 * mu) * mu - 0.372058))
}

/// Density of `sample_eon`.
#[inline]
pub fn pdf_eon(closure: &Closure, wo: Vec3, wi: Vec3) -> f32 {
    if !on_upper_side(wo, wi) {
        return 0.0;
    }
    let m = eon_transform(wo.z, closure.roughness);
    let t = eon_azimuth(wo);
    let x = wi.x * t.x + wi.y * t.y;
    let y = wi.y * t.x - wi.x * t.y;
    let minor = m.x - m.y * m.w;
    let h = Vec3::new(m.z * (x - m.y * wi.z), minor * y, m.z * (m.x * wi.z - m.w * x));
    let determinant = m.z * minor;
    let length2 = (h.x * h.x + h.y * h.y) + h.z * h.z;
    let clipped = div((determinant * determinant) * max_(h.z, 0.0), ((length2 * length2) * PI) * eon_clip(m.w));
    let even = eon_uniform(wo.z, closure.roughness);
    even * INV_TWO_PI + (1.0 - even) * clipped
}

/// Uniform over the hemisphere, or by a linearly transformed cosine of which what falls below the horizon is clipped away.
/// `u`: 0..1 each, excluding 1. `u_lobe`: 0..1, chooses.
#[inline]
pub fn sample_eon(closure: &Closure, wo: Vec3, u: Vec2, u_lobe: f32) -> DirectionSample {
    if wo.z <= COS_MIN {
        return no_direction();
    }
    let mut wi = square_to_uniform_hemisphere(u);
    if u_lobe >= eon_uniform(wo.z, closure.roughness) {
        let m = eon_transform(wo.z, closure.roughness);
        let radius = sqrt_(u.x);
        let y = radius * sin_turns(u.y);
        // Half a disk, and the part of the other half that stays above the horizon.
        let edge = sqrt_(max_(1.0 - y * y, 0.0));
        let x = -mix_(edge, radius * cos_turns(u.y), eon_clip(m.w));
        let z = sqrt_(max_(1.0 - (x * x + y * y), 0.0));
        let bent = normalize3(Vec3::new(m.x * x + m.y * z, m.z * y, m.w * x + z));
        let t = eon_azimuth(wo);
        wi = Vec3::new(bent.x * t.x - bent.y * t.y, bent.x * t.y + bent.y * t.x, bent.z);
    }
    if !on_upper_side(wo, wi) {
        return no_direction();
    }
    make_direction(wi, pdf_eon(closure, wo, wi))
}
