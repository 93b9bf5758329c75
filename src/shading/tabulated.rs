//! Reflection tabulated for each direction of light (row 9), anisotropic if the table has several azimuths of light: multilinear
//! between the directions of light, by angle, and within each between the directions of view. O_s is a factor.
//!
//! A view's azimuth counts from the light's, so that highlights lie on each other where light directions are mixed.
//! The table from `table` on: five counts (`Tabulated`); light angles and view angles from the normal in radians, ascending, those
//! of views from 0 to pi / 2; the cosines of the latter. Then for each light angle, for each light azimuth: values R, G, B
//! for each view angle, for each view azimuth; steps of the integral of value times cosine over view angles; for each of their
//! intervals its steps over azimuths. Samples take `wo` for the light: exact as far as the table is reciprocal.

use crate::layout::{SceneView, load_table};
use crate::shading::closure::Closure;
use crate::shading::lobe::{DirectionSample, make_direction, no_direction, on_upper_side};
use crate::shading::math::{
    INV_PI, INV_TWO_PI, TWO_PI, atan2_, clamp_, cos_turns, div, max_, mix_, rcp, sin_turns, sqrt_,
};
use crate::shading::spectrum::{Spectrum, spectrum_from_rgb, spectrum_zero};
use crate::shading::warp::square_to_cosine_hemisphere;
use glam::{Vec2, Vec3};

/// Share of samples that are cosine-weighted; the others follow the table.
pub const TABULATED_COSINE: f32 = 0.25;
/// 1 - TABULATED_COSINE.
const TABULATED_SPECULAR: f32 = 0.75;
/// 1 / (1 - TABULATED_COSINE).
pub const TABULATED_REST: f32 = 1.33333337;
/// Most angles or azimuths.
pub const TABULATED_MOST: f32 = 4096.0;

/// What a table holds, and where.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tabulated {
    pub light_angles: u32,
    /// In one of `fold` equal parts of a turn.
    pub light_azimuths: u32,
    pub view_angles: u32,
    /// In a turn.
    pub view_azimuths: u32,
    pub fold: u32,
    /// First of the light angles, of the view angles, of the cosines, of the first direction of light.
    pub lights: u32,
    pub views: u32,
    pub cosines: u32,
    pub slices: u32,
    /// From one direction of light to the next.
    pub stride: u32,
}

/// A place in a grid of angles and azimuths: the row and column before it, and 0..1 how far it is to the next ones.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TabulatedPlace {
    pub row: u32,
    pub column: u32,
    pub along: f32,
    pub around: f32,
}

/// A count in the table, at least 1.
#[inline]
pub fn tabulated_count(scene: &SceneView, index: u32) -> u32 {
    clamp_(load_table(scene, index), 1.0, TABULATED_MOST) as u32
}

/// The head of the material's table.
#[inline]
pub fn tabulated(scene: &SceneView, closure: &Closure) -> Tabulated {
    let light_angles = tabulated_count(scene, closure.table);
    let light_azimuths = tabulated_count(scene, closure.table + 1);
    let view_angles = tabulated_count(scene, closure.table + 2);
    let view_azimuths = tabulated_count(scene, closure.table + 3);
    let fold = tabulated_count(scene, closure.table + 4);
    let lights = closure.table + 5;
    let views = lights + light_angles;
    let cosines = views + view_angles;
    let slices = cosines + view_angles;
    let stride = 3 * (view_angles * view_azimuths) + view_angles + (view_angles - 1) * (view_azimuths + 1);
    Tabulated { light_angles, light_azimuths, view_angles, view_azimuths, fold, lights, views, cosines, slices, stride }
}

/// Which interval of `count` ascending knots from `first` on has `x`: 0 to count - 2, also for what lies outside.
#[inline]
pub fn tabulated_interval(scene: &SceneView, first: u32, count: u32, x: f32) -> u32 {
    let mut low = 0;
    let mut high = count - 1;
    // Twelve halvings reach one of TABULATED_MOST knots.
    for _ in 0..12 {
        let middle = (low + high) >> 1;
        if middle > low {
            let below = load_table(scene, first + middle) <= x;
            low = if below { middle } else { low };
            high = if below { high } else { middle };
        }
    }
    low
}

/// 0..1 from the knot at `index` to the next.
#[inline]
pub fn tabulated_share(scene: &SceneView, index: u32, x: f32) -> f32 {
    let begin = load_table(scene, index);
    let size = load_table(scene, index + 1) - begin;
    if size > 0.0 { clamp_(div(x - begin, size), 0.0, 1.0) } else { 0.0 }
}

/// The azimuth of `w` in turns, above -1 and up to 1; 0 along the normal.
#[inline]
pub fn tabulated_turns(w: Vec3) -> f32 {
    if w.x * w.x + w.y * w.y > 1.0e-14 { atan2_(w.y, w.x) * INV_TWO_PI } else { 0.0 }
}

/// Where the unit vector `w` lies among `angles` angles from `first` on and `azimuths` equal parts of a period.
/// `periods`: its azimuth in periods.
#[inline]
pub fn tabulated_place(
    scene: &SceneView,
    first: u32,
    angles: u32,
    azimuths: u32,
    w: Vec3,
    periods: f32,
) -> TabulatedPlace {
    let angle = atan2_(sqrt_(w.x * w.x + w.y * w.y), w.z);
    let row = tabulated_interval(scene, first, angles, angle);
    let along = if angles > 1 { tabulated_share(scene, first + row, angle) } else { 0.0 };
    let x = (periods - periods.floor()) * azimuths as f32;
    let column = clamp_(x.floor(), 0.0, azimuths as f32 - 1.0);
    TabulatedPlace { row, column: column as u32, along, around: clamp_(x - column, 0.0, 1.0) }
}

/// Number of a corner of the cell at a place. `corner`: bit 0 the next azimuth, bit 1 the next angle.
#[inline]
pub fn tabulated_corner(place: TabulatedPlace, angles: u32, azimuths: u32, corner: u32) -> u32 {
    let row = place.row + (corner >> 1);
    let column = place.column + (corner & 1);
    let last = angles - 1;
    (if row > last { last } else { row }) * azimuths + (if column < azimuths { column } else { 0 })
}

/// Bilinear weight of a corner, 0..1.
#[inline]
pub fn tabulated_weight(place: TabulatedPlace, corner: u32) -> f32 {
    let along = if corner >= 2 { place.along } else { 1.0 - place.along };
    let around = if (corner & 1) != 0 { place.around } else { 1.0 - place.around };
    along * around
}

/// Reflection times cosine, per steradian. Local frame; zero unless both directions are on the upper side.
#[inline]
pub fn eval_tabulated(scene: &SceneView, closure: &Closure, wo: Vec3, wi: Vec3) -> Spectrum {
    if !on_upper_side(wo, wi) {
        return spectrum_zero();
    }
    let t = tabulated(scene, closure);
    let turns = tabulated_turns(wi);
    let light = tabulated_place(scene, t.lights, t.light_angles, t.light_azimuths, wi, turns * t.fold as f32);
    let view = tabulated_place(scene, t.views, t.view_angles, t.view_azimuths, wo, tabulated_turns(wo) - turns);
    let mut sum = Vec3::new(0.0, 0.0, 0.0);
    for i in 0..4 {
        let slice = t.slices + tabulated_corner(light, t.light_angles, t.light_azimuths, i) * t.stride;
        let share = tabulated_weight(light, i);
        for j in 0..4 {
            let at = slice + 3 * tabulated_corner(view, t.view_angles, t.view_azimuths, j);
            let value = Vec3::new(load_table(scene, at), load_table(scene, at + 1), load_table(scene, at + 2));
            sum += value * (share * tabulated_weight(view, j));
        }
    }
    spectrum_from_rgb((closure.specular_color * sum) * wi.z)
}

/// Density of `sample_tabulated`.
#[inline]
pub fn pdf_tabulated(scene: &SceneView, closure: &Closure, wo: Vec3, wi: Vec3) -> f32 {
    if !on_upper_side(wo, wi) {
        return 0.0;
    }
    let t = tabulated(scene, closure);
    let turns = tabulated_turns(wo);
    let light = tabulated_place(scene, t.lights, t.light_angles, t.light_azimuths, wo, turns * t.fold as f32);
    let cell = tabulated_place(scene, t.views, t.view_angles, t.view_azimuths, wi, tabulated_turns(wi) - turns);
    let steps = 3 * (t.view_angles * t.view_azimuths);
    let mut chance = 0.0;
    for i in 0..4 {
        let slice = t.slices + tabulated_corner(light, t.light_angles, t.light_azimuths, i) * t.stride;
        let row = slice + steps + cell.row;
        let column = slice + steps + t.view_angles + cell.row * (t.view_azimuths + 1) + cell.column;
        let rows = load_table(scene, row + 1) - load_table(scene, row);
        let columns = load_table(scene, column + 1) - load_table(scene, column);
        chance += tabulated_weight(light, i) * (rows * columns);
    }
    let high = load_table(scene, t.cosines + cell.row) - load_table(scene, t.cosines + cell.row + 1);
    let specular = div(max_(chance, 0.0) * t.view_azimuths as f32, max_(high, 1.0e-12) * TWO_PI);
    TABULATED_COSINE * (wi.z * INV_PI) + TABULATED_SPECULAR * specular
}

/// Cosine-weighted, or drawn from the values for light from about `wo`. `u`: 0..1 each, excluding 1. `u_lobe`: 0..1, excluding 1,
/// chooses, also among the directions of light next to `wo`.
#[inline]
pub fn sample_tabulated(scene: &SceneView, closure: &Closure, wo: Vec3, u: Vec2, u_lobe: f32) -> DirectionSample {
    let mut wi = square_to_cosine_hemisphere(u);
    if u_lobe >= TABULATED_COSINE && wo.z > 0.0 {
        let t = tabulated(scene, closure);
        let turns = tabulated_turns(wo);
        let light = tabulated_place(scene, t.lights, t.light_angles, t.light_azimuths, wo, turns * t.fold as f32);
        let choice = (u_lobe - TABULATED_COSINE) * TABULATED_REST;
        let first = tabulated_weight(light, 0);
        let second = first + tabulated_weight(light, 1);
        let third = second + tabulated_weight(light, 2);
        let upper: u32 = if choice < third { 2 } else { 3 };
        let lower: u32 = if choice < first { 0 } else { 1 };
        let corner = if choice < second { lower } else { upper };
        let slice = t.slices + tabulated_corner(light, t.light_angles, t.light_azimuths, corner) * t.stride;
        let rows = slice + 3 * (t.view_angles * t.view_azimuths);
        let row = tabulated_interval(scene, rows, t.view_angles, u.x);
        let columns = rows + t.view_angles + row * (t.view_azimuths + 1);
        let column = tabulated_interval(scene, columns, t.view_azimuths + 1, u.y);
        let down = tabulated_share(scene, rows + row, u.x);
        let around = tabulated_share(scene, columns + column, u.y);
        let z = mix_(load_table(scene, t.cosines + row), load_table(scene, t.cosines + row + 1), down);
        let azimuth = turns + (column as f32 + around) * rcp(t.view_azimuths as f32);
        let sine = sqrt_(max_((1.0 - z) * (1.0 + z), 0.0));
        wi = Vec3::new(sine * cos_turns(azimuth), sine * sin_turns(azimuth), z);
    }
    if !on_upper_side(wo, wi) {
        return no_direction();
    }
    make_direction(wi, pdf_tabulated(scene, closure, wo, wi))
}
