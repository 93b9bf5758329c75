//! The image around the scene and the tables that directions are drawn from (`shading::environment`).

use super::srgb::srgb_table;
use crate::layout::EnvironmentMap;
use crate::scene::{Environment, Rgb, Texture, TextureData};
use glam::{DVec3, Vec4};
use std::f64::consts::PI;

/// An image that shines, ready to be sampled.
#[derive(Clone, Debug)]
pub struct BakedEnvironment {
    pub map: EnvironmentMap,
    /// What `EnvironmentMap::first_table` describes.
    pub table: Vec<f32>,
    /// Integral of the luminance over all directions.
    pub luminance: f64,
}

/// Relative luminance Y (ITU-R BT.709-6, item 3.2); negative texels count as none.
pub fn luminance(rgb: DVec3) -> f64 {
    (0.2126 * rgb.x + 0.7152 * rgb.y + 0.0722 * rgb.z).max(0.0)
}

/// The tables of `texture`; none if the environment is black.
pub fn bake_environment(environment: &Environment, texture: &Texture) -> Option<BakedEnvironment> {
    let (width, height) = (texture.width as usize, texture.height as usize);
    let brightness = brightness(texture, environment.scale);
    // Vertices: texel centres between two rows at the poles.
    let mut density = vec![0.0f64; (height + 2) * width];
    for row in 0..height {
        let sine = libm::sin(PI * (row as f64 + 0.5) / height as f64);
        for column in 0..width {
            density[(row + 1) * width + column] = brightness[row * width + column] * sine;
        }
    }
    let share = |row: usize, column: usize| {
        let right = (column + 1) % width;
        let (upper, lower) = (row * width, (row + 1) * width);
        let mean = 0.25
            * (density[upper + column] + density[upper + right] + density[lower + column] + density[lower + right]);
        let cell_height = if row == 0 || row == height { 0.5 } else { 1.0 };
        mean * cell_height / (width * height) as f64
    };
    let rows: Vec<f64> = (0..=height).map(|row| (0..width).map(|column| share(row, column)).sum()).collect();
    let total: f64 = rows.iter().sum();
    if !(total > 0.0 && total.is_finite()) {
        return None;
    }
    let mut table: Vec<f32> = density.iter().map(|d| (d / total) as f32).collect();
    for row in 0..=height {
        push_cdf(&mut table, (0..width).map(|column| share(row, column)));
    }
    push_cdf(&mut table, rows.iter().copied());
    let map = EnvironmentMap {
        to_local: rotation(environment),
        scale: environment.scale,
        texture: environment.texture.0,
        width: texture.width,
        height: texture.height,
        ..EnvironmentMap::default()
    };
    // The unit square of (u, v) is 2 pi^2 sin(theta) steradians, and the sine is in the density.
    Some(BakedEnvironment { map, table, luminance: total * 2.0 * PI * PI })
}

/// Appends the cumulative sums of `shares`, from 0 to 1; equal steps if there is nothing to share.
fn push_cdf(table: &mut Vec<f32>, shares: impl Iterator<Item = f64> + Clone) {
    let total: f64 = shares.clone().sum();
    let count = shares.clone().count();
    let mut sum = 0.0;
    table.push(0.0);
    for (index, share) in shares.enumerate() {
        sum += share;
        let value = if total > 0.0 { sum / total } else { (index + 1) as f64 / count as f64 };
        table.push(if index + 1 == count { 1.0 } else { value.min(1.0) as f32 });
    }
}

/// Rows that take a direction from world space to the image's.
fn rotation(environment: &Environment) -> [Vec4; 3] {
    let matrix = environment.to_world.0.matrix3;
    // A rotation's inverse is its transpose: the columns, made unit.
    [matrix.x_axis, matrix.y_axis, matrix.z_axis].map(|axis| super::light::unit(axis).extend(0.0))
}

/// Luminance of each texel times `scale`, from the top row down.
fn brightness(texture: &Texture, scale: Rgb) -> Vec<f64> {
    let scale = scale.as_dvec3();
    let of = |rgb: [f64; 3]| luminance(DVec3::from_array(rgb) * scale);
    match &texture.data {
        TextureData::Srgb8(texels) => {
            let table = srgb_table();
            let decode = |code: u8| f64::from(table[usize::from(code)]);
            texels.iter().map(|t| of([decode(t[0]), decode(t[1]), decode(t[2])])).collect()
        }
        TextureData::Linear8(texels) => {
            let decode = |code: u8| f64::from(code) / 255.0;
            texels.iter().map(|t| of([decode(t[0]), decode(t[1]), decode(t[2])])).collect()
        }
        TextureData::Float(texels) => {
            texels.iter().map(|t| of([f64::from(t[0]), f64::from(t[1]), f64::from(t[2])])).collect()
        }
        // No image to sample from; it counts as black.
        TextureData::Pattern(_) => vec![0.0; texture.width as usize * texture.height as usize],
    }
}
