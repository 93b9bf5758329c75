//! What surrounds the scene: a vertical gradient or an equirectangular image, seen and sampled.
//!
//! The image's grid: vertices are the centres of its texels (columns wrap round), and both poles; between them the
//! density is bilinear, as the image itself is between texels, so it is zero only where the image is. Rows of cells next to
//! the poles are half as high as the others.

use crate::layout::{EnvironmentMap, SceneView, load_environment_map, load_table, load_texture};
use crate::shading::math::{
    INV_PI, INV_TWO_PI, acos_, atan2_, cos_turns, div, dot3, max_, min_, mix_, mix3_, sin_turns, sqrt_,
};
use crate::shading::spectrum::{Spectrum, spectrum_from_rgb, spectrum_luminance};
use crate::shading::texture::sample_texture;
use glam::{Vec2, Vec3, Vec4};

/// The largest float below 1.
const BELOW_ONE: f32 = 0.99999994;
/// 1 / (2 pi^2): area of the unit square of (u, v) over that of the sphere at the equator.
const INV_TWO_PI_SQUARED: f32 = 0.0506605916;
/// Sine of the angle from a pole below which no direction is drawn: the density has no limit there.
const SIN_POLE: f32 = 1.0e-6;

/// A direction to the environment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EnvironmentSample {
    /// Unit, world.
    pub wi: Vec3,
    pub radiance: Vec3,
    /// 0 if the sample is to be dropped.
    pub pdf_solid_angle: f32,
}

/// A point of the image's grid: the cell, and the place in it, 0..1 each way. Row 0 is at the upper pole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GridPlace {
    pub column: u32,
    pub row: u32,
    pub x: f32,
    pub y: f32,
}

/// x in [0, 1) with density proportional to a (1 - x) + b x, for a, b >= 0, not both 0. `u`: [0, 1).
#[inline]
pub fn sample_linear(u: f32, a: f32, b: f32) -> f32 {
    let low = div(a, a + b);
    let high = 1.0 - low;
    // The quadratic's root without cancellation.
    min_(div(u, low + sqrt_((low * low) * (1.0 - u) + (high * high) * u)), BELOW_ONE)
}

/// The bilinear function with values f00, f10 (x = 1), f01 (y = 1), f11 at the corners of the unit square.
#[inline]
pub fn bilinear(f00: f32, f10: f32, f01: f32, f11: f32, x: f32, y: f32) -> f32 {
    mix_(mix_(f00, f10, x), mix_(f01, f11, x), y)
}

/// `v` in the space of the rotation's rows.
#[inline]
pub fn rotate_to(rows: [Vec4; 3], v: Vec3) -> Vec3 {
    Vec3::new(dot3(rows[0].truncate(), v), dot3(rows[1].truncate(), v), dot3(rows[2].truncate(), v))
}

/// `v`, given in the space of the rotation's rows, where they are given.
#[inline]
pub fn rotate_from(rows: [Vec4; 3], v: Vec3) -> Vec3 {
    (rows[0].truncate() * v.x + rows[1].truncate() * v.y) + rows[2].truncate() * v.z
}

/// The unit direction at (u, v), both 0..1: u from -z over +x, +z and -x, v from +y down.
#[inline]
pub fn equirectangular_direction(uv: Vec2) -> Vec3 {
    let sin_theta = sin_turns(0.5 * uv.y);
    Vec3::new(sin_theta * sin_turns(uv.x), cos_turns(0.5 * uv.y), -sin_theta * cos_turns(uv.x))
}

/// The inverse of `equirectangular_direction`.
#[inline]
pub fn equirectangular_uv(w: Vec3) -> Vec2 {
    let turns = atan2_(w.x, -w.z) * INV_TWO_PI;
    Vec2::new(if turns < 0.0 { turns + 1.0 } else { turns }, acos_(w.y) * INV_PI)
}

/// Where (u, v) lies in the grid of an image of this size.
#[inline]
pub fn grid_place(width: u32, height: u32, uv: Vec2) -> GridPlace {
    let along = uv.x * width as f32 - 0.5;
    let shifted = if along < 0.0 { along + width as f32 } else { along };
    let left = min_(shifted.floor(), width as f32 - 1.0);
    let down = min_(max_(uv.y * height as f32 + 0.5, 0.5), height as f32 + 0.5);
    let above = min_(down.floor(), height as f32);
    let row = above as u32;
    let y = down - above;
    // Of the rows at the poles there are the lower half of the first and the upper half of the last.
    let stretched = if row == 0 { max_(2.0 * y - 1.0, 0.0) } else { min_(2.0 * y, 1.0) };
    let polar = row == 0 || row == height;
    GridPlace { column: left as u32, row, x: shifted - left, y: if polar { stretched } else { y } }
}

/// (u, v) of a point of the grid.
#[inline]
pub fn grid_uv(width: u32, height: u32, place: GridPlace) -> Vec2 {
    let along = (place.column as f32 + 0.5) + place.x;
    let wrapped = if along >= width as f32 { along - width as f32 } else { along };
    let first = place.row == 0;
    let from = if first { 0.0 } else { place.row as f32 - 0.5 };
    let step = if first || place.row == height { 0.5 * place.y } else { place.y };
    Vec2::new(div(wrapped, width as f32), div(from + step, height as f32))
}

/// Density of the gradient's samples at `height`, 0 (-y) to 1 (+y). `luminance`: at both ends.
#[inline]
pub fn gradient_pdf(luminance: Vec2, height: f32) -> f32 {
    div(mix_(luminance.x, luminance.y, height), luminance.x + luminance.y) * INV_TWO_PI
}

/// An interval of a CDF, and how far into it a number is, 0..1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    pub index: u32,
    pub rest: f32,
}

/// The interval 0..count of a CDF, whose count + 1 values begin at table entry `first`, that holds `u` (below 1). No
/// interval of probability 0 is found.
#[inline]
pub fn find_interval(scene: &SceneView, first: u32, count: u32, u: f32) -> Interval {
    let mut low = 0;
    let mut high = count;
    // 2^17 entries: more than an image has rows or columns.
    for _ in 0..17 {
        if high - low <= 1 {
            break;
        }
        let middle = (low + high) >> 1;
        if load_table(scene, first + middle) <= u {
            low = middle;
        } else {
            high = middle;
        }
    }
    let below = load_table(scene, first + low);
    let above = load_table(scene, first + low + 1);
    Interval { index: low, rest: min_(div(u - below, above - below), BELOW_ONE) }
}

/// Density of (u, v) at the four corners of a cell: upper left, upper right, lower left, lower right.
#[inline]
pub fn cell_corners(scene: &SceneView, map: &EnvironmentMap, column: u32, row: u32) -> Vec4 {
    let right = if column + 1 == map.width { 0 } else { column + 1 };
    let upper = map.first_table + row * map.width;
    let lower = upper + map.width;
    Vec4::new(
        load_table(scene, upper + column),
        load_table(scene, upper + right),
        load_table(scene, lower + column),
        load_table(scene, lower + right),
    )
}

/// The image's radiance at (u, v).
#[inline]
fn map_radiance(scene: &SceneView, map: &EnvironmentMap, uv: Vec2) -> Vec3 {
    // Textures count v from the bottom.
    let texel = sample_texture(scene, &load_texture(scene, map.texture), Vec2::new(uv.x, 1.0 - uv.y));
    texel.truncate() * map.scale
}

/// Radiance where a ray leaves the scene along `direction` (unit).
pub fn background(scene: &SceneView, direction: Vec3) -> Spectrum {
    if scene.features.has_environment_map {
        let map = load_environment_map(scene, 0);
        let uv = equirectangular_uv(rotate_to(map.to_local, direction));
        return spectrum_from_rgb(map_radiance(scene, &map, uv));
    }
    let height = direction.y * 0.5 + 0.5;
    spectrum_from_rgb(mix3_(scene.header.background_bottom, scene.header.background_top, height))
}

/// Luminance of the gradient towards -y and +y.
#[inline]
fn gradient_luminance(scene: &SceneView) -> Vec2 {
    let bottom = spectrum_luminance(spectrum_from_rgb(scene.header.background_bottom));
    let top = spectrum_luminance(spectrum_from_rgb(scene.header.background_top));
    Vec2::new(bottom, top)
}

/// A direction drawn in proportion to the environment's luminance. `u`: 0..1 each, excluding 1.
pub fn sample_environment(scene: &SceneView, u: Vec2) -> EnvironmentSample {
    if scene.features.has_environment_map {
        let map = load_environment_map(scene, 0);
        let cdfs = map.first_table + (map.height + 2) * map.width;
        let row = find_interval(scene, cdfs + (map.height + 1) * (map.width + 1), map.height + 1, u.y);
        let column = find_interval(scene, cdfs + row.index * (map.width + 1), map.width, u.x);
        let corners = cell_corners(scene, &map, column.index, row.index);
        let y = sample_linear(row.rest, corners.x + corners.y, corners.z + corners.w);
        let x = sample_linear(column.rest, mix_(corners.x, corners.z, y), mix_(corners.y, corners.w, y));
        let uv = grid_uv(map.width, map.height, GridPlace { column: column.index, row: row.index, x, y });
        let density = bilinear(corners.x, corners.y, corners.z, corners.w, x, y);
        let sin_theta = sin_turns(0.5 * uv.y);
        return EnvironmentSample {
            wi: rotate_from(map.to_local, equirectangular_direction(uv)),
            radiance: map_radiance(scene, &map, uv),
            pdf_solid_angle: if sin_theta > SIN_POLE { div(density * INV_TWO_PI_SQUARED, sin_theta) } else { 0.0 },
        };
    }
    let luminance = gradient_luminance(scene);
    let height = sample_linear(u.x, luminance.x, luminance.y);
    // 1 - y^2 for y = 2 height - 1, without cancellation.
    let radius = 2.0 * sqrt_(height * (1.0 - height));
    EnvironmentSample {
        wi: Vec3::new(radius * cos_turns(u.y), 2.0 * height - 1.0, radius * sin_turns(u.y)),
        radiance: mix3_(scene.header.background_bottom, scene.header.background_top, height),
        pdf_solid_angle: gradient_pdf(luminance, height),
    }
}

/// Density of `sample_environment` at `direction` (unit, world), per solid angle; its integral is 1.
pub fn pdf_environment(scene: &SceneView, direction: Vec3) -> f32 {
    if scene.features.has_environment_map {
        let map = load_environment_map(scene, 0);
        let local = rotate_to(map.to_local, direction);
        let place = grid_place(map.width, map.height, equirectangular_uv(local));
        let corners = cell_corners(scene, &map, place.column, place.row);
        let density = bilinear(corners.x, corners.y, corners.z, corners.w, place.x, place.y);
        let sin_theta = sqrt_(local.x * local.x + local.z * local.z);
        return if sin_theta > SIN_POLE { div(density * INV_TWO_PI_SQUARED, sin_theta) } else { 0.0 };
    }
    gradient_pdf(gradient_luminance(scene), direction.y * 0.5 + 0.5)
}
