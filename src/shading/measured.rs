//! Measured isotropic reflection (row 9) over Rusinkiewicz's angles theta_h, theta_d, phi_d of the half and difference vectors.
//!
//! The table from `table` on: MEASURED_H + 1 steps of the integral over theta_h that samples are drawn from, then planes R, G, B of
//! 90 x 90 x 180 values as MERL stores them; the value of a cell holds in all of it. O_s is a factor.
//! Sources: Matusik et al. 2003, "A Data-Driven Reflectance Model"; Rusinkiewicz 1998, "A New Change of Variables for
//! Efficient BRDF Representation".

use crate::layout::{SceneView, load_table};
use crate::shading::closure::Closure;
use crate::shading::lobe::{DirectionSample, make_direction, no_direction, on_upper_side, reflect_about};
use crate::shading::math::{
    HALF_PI, INV_PI, PI, atan2_, clamp_, cos_turns, div, dot3, max_, mix_, normalize3, sin_, sin_turns, sqrt_,
};
use crate::shading::spectrum::{Spectrum, spectrum_from_rgb, spectrum_zero};
use crate::shading::warp::square_to_cosine_hemisphere;
use glam::{Vec2, Vec3};

/// Cells in theta_h, of sizes that grow with the angle, in theta_d and in phi_d.
pub const MEASURED_H: u32 = 90;
pub const MEASURED_D: u32 = 90;
pub const MEASURED_P: u32 = 180;
/// 2 / pi.
pub const INV_HALF_PI: f32 = 0.636619747;
/// Share of samples that are cosine-weighted; as many follow the table.
pub const MEASURED_COSINE: f32 = 0.5;

/// A cell's number. `x`: 0..1 from the first to the last of `count` cells.
#[inline]
pub fn measured_cell(x: f32, count: u32) -> u32 {
    let last = count as f32 - 1.0;
    clamp_((x * count as f32).floor(), 0.0, last) as u32
}

/// The cell of theta_h: its number grows as the root of the angle. `wm`: unit, z > 0.
#[inline]
pub fn measured_cell_h(wm: Vec3) -> u32 {
    let theta = atan2_(sqrt_(wm.x * wm.x + wm.y * wm.y), wm.z);
    measured_cell(sqrt_(max_(theta * INV_HALF_PI, 0.0)), MEASURED_H)
}

/// sin^2 of the angle at which a cell of theta_h begins.
#[inline]
pub fn measured_edge(cell: u32) -> f32 {
    let x = cell as f32 * 0.0111111114;
    let sine = sin_((x * x) * HALF_PI);
    sine * sine
}

/// Reflection times cosine, per steradian. Local frame; zero unless both directions are on the upper side.
#[inline]
pub fn eval_measured(scene: &SceneView, closure: &Closure, wo: Vec3, wi: Vec3) -> Spectrum {
    if !on_upper_side(wo, wi) {
        return spectrum_zero();
    }
    let wm = normalize3(wo + wi);
    let across = sqrt_(wm.x * wm.x + wm.y * wm.y);
    // The frame of the half vector: x towards growing theta_h, y along phi_h.
    let cos_h = if across > 1.0e-7 { div(wm.x, across) } else { 1.0 };
    let sin_h = if across > 1.0e-7 { div(wm.y, across) } else { 0.0 };
    let along = wi.x * cos_h + wi.y * sin_h;
    let x = along * wm.z - wi.z * across;
    let y = wi.y * cos_h - wi.x * sin_h;
    let z = along * across + wi.z * wm.z;
    let theta_d = atan2_(sqrt_(x * x + y * y), z);
    let phi_d = atan2_(y, x);
    // Light and viewer may change places: phi_d and phi_d + pi are the same cell.
    let mut turn = phi_d * INV_PI;
    turn = if turn < 0.0 { turn + 1.0 } else { turn };
    let mut cell = measured_cell_h(wm) * MEASURED_D + measured_cell(theta_d * INV_HALF_PI, MEASURED_D);
    cell = cell * MEASURED_P + measured_cell(turn, MEASURED_P);
    let first = closure.table + (MEASURED_H + 1);
    let plane = MEASURED_H * (MEASURED_D * MEASURED_P);
    let value = Vec3::new(
        load_table(scene, first + cell),
        load_table(scene, (first + plane) + cell),
        load_table(scene, (first + 2 * plane) + cell),
    );
    spectrum_from_rgb((closure.specular_color * value) * wi.z)
}

/// Density of `sample_measured`; its integral over the upper side is below 1 by what falls under the horizon.
#[inline]
pub fn pdf_measured(scene: &SceneView, closure: &Closure, wo: Vec3, wi: Vec3) -> f32 {
    if !on_upper_side(wo, wi) {
        return 0.0;
    }
    let wm = normalize3(wo + wi);
    let cell = measured_cell_h(wm);
    let share = load_table(scene, closure.table + cell + 1) - load_table(scene, closure.table + cell);
    let size = measured_edge(cell + 1) - measured_edge(cell);
    let facets = div(share * wm.z, PI * max_(size, 1.0e-12));
    let specular = div(max_(facets, 0.0), 4.0 * max_(dot3(wo, wm), 1.0e-7));
    MEASURED_COSINE * (wi.z * INV_PI + specular)
}

/// Cosine-weighted, or `wo` mirrored about a half vector of a cell drawn by what the table reflects there; what falls below
/// the horizon is dropped. `u`: 0..1 each, excluding 1. `u_lobe`: 0..1, chooses.
#[inline]
pub fn sample_measured(scene: &SceneView, closure: &Closure, wo: Vec3, u: Vec2, u_lobe: f32) -> DirectionSample {
    let mut wi = square_to_cosine_hemisphere(u);
    if u_lobe >= MEASURED_COSINE {
        let mut low = 0;
        let mut high = MEASURED_H;
        // Seven halvings reach one of 90 cells.
        for _ in 0..7 {
            let middle = (low + high) >> 1;
            if middle > low {
                let below = load_table(scene, closure.table + middle) <= u.x;
                low = if below { middle } else { low };
                high = if below { high } else { middle };
            }
        }
        let begin = load_table(scene, closure.table + low);
        let share = load_table(scene, closure.table + low + 1) - begin;
        let within = clamp_(div(u.x - begin, share), 0.0, 1.0);
        let sin2 = mix_(measured_edge(low), measured_edge(low + 1), within);
        let sin_h = sqrt_(sin2);
        let wm = Vec3::new(sin_h * cos_turns(u.y), sin_h * sin_turns(u.y), sqrt_(max_(1.0 - sin2, 0.0)));
        wi = reflect_about(wo, wm);
    }
    if !on_upper_side(wo, wi) {
        return no_direction();
    }
    make_direction(wi, pdf_measured(scene, closure, wo, wi))
}
