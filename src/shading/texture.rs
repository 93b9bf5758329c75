//! Textures: nearest and bilinear reading with exact weights, and the means over what a pixel covers (row 27).
//!
//! Texel centres are at half-integers; v = 0 is the bottom edge.

use crate::layout::{
    MAGNIFY_BILINEAR, PATTERN_CHECKER, SceneView, TEXEL_LINEAR8, TEXEL_SRGB8, Texture, WRAP_CLAMP, load_table,
    load_texel, load_texture,
};
use crate::shading::coordinate::{texture_uv, texture_vector, wrap_coordinate, wrap_texel};
use crate::shading::footprint::Footprint;
use crate::shading::math::{clamp_, div, dot2, log2_, max_, min_, rcp, sqrt_};
use crate::shading::pattern::sample_pattern;
use glam::{Vec2, Vec4};

/// The f32 nearest to 1 / 255; 255 times it is exactly 1.
const INV_255: f32 = 0.003_921_569;
/// Probes along the longer side of what a pixel covers, at most; beyond, both sides blur.
const PROBES_MOST: f32 = 8.0;
/// 1 / `PROBES_MOST`.
const PROBE_LEAST: f32 = 0.125;

/// How finely a texture is read: `probes` (1 to 8) in a row, `spacing` apart in its own coordinates, each as wide as
/// `width` texels of level 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Detail {
    pub spacing: Vec2,
    pub width: f32,
    pub probes: u32,
}

/// The detail that `footprint` leaves: probes along its longer side, each as wide as the shorter one. A texture without
/// mip levels is read at the point alone.
/// Source: after McCormack et al. 1999, "Feline: Fast Elliptical Lines for Anisotropic Texture Mapping", with equal weights.
#[inline]
pub fn texture_detail(texture: &Texture, footprint: Footprint) -> Detail {
    if texture.level_count == 0 {
        return Detail { spacing: Vec2::ZERO, width: 0.0, probes: 1 };
    }
    let size = Vec2::new(texture.width as f32, texture.height as f32);
    let along = texture_vector(texture, footprint.along);
    let across = texture_vector(texture, footprint.across);
    let along_texels = along * size;
    let across_texels = across * size;
    let along_length = sqrt_(dot2(along_texels, along_texels));
    let across_length = sqrt_(dot2(across_texels, across_texels));
    let longer = if along_length >= across_length { along } else { across };
    let major = max_(along_length, across_length);
    let minor = min_(along_length, across_length);
    // Bilinear reading is one texel wide in any case; a pattern can be as sharp as the pixel.
    let finest = if texture.format >= PATTERN_CHECKER { 0.0 } else { 1.0 };
    let width = max_(max_(minor, major * PROBE_LEAST), finest);
    let probes = clamp_((div(major, width) + 0.5).floor(), 1.0, PROBES_MOST);
    Detail { spacing: longer * rcp(probes), width, probes: probes as u32 }
}

/// Channel `shift` / 8 of a packed texel, 0..255.
#[inline]
fn texel_byte(word: u32, shift: u32) -> u32 {
    (word >> shift) & 255
}

/// One texel, linear. `column` from the left, `row` from the bottom, both inside the image.
#[inline]
pub fn read_texel(scene: &SceneView, texture: &Texture, column: i32, row: i32) -> Vec4 {
    // Stored from the top row down.
    let index = (texture.height - 1 - row as u32) * texture.width + column as u32;
    match texture.format {
        TEXEL_SRGB8 => {
            let word = load_texel(scene, texture.first_word + index);
            // The decoding table is the first of the table array.
            Vec4::new(
                load_table(scene, texel_byte(word, 0)),
                load_table(scene, texel_byte(word, 8)),
                load_table(scene, texel_byte(word, 16)),
                texel_byte(word, 24) as f32 * INV_255,
            )
        }
        TEXEL_LINEAR8 => {
            let word = load_texel(scene, texture.first_word + index);
            Vec4::new(
                texel_byte(word, 0) as f32 * INV_255,
                texel_byte(word, 8) as f32 * INV_255,
                texel_byte(word, 16) as f32 * INV_255,
                texel_byte(word, 24) as f32 * INV_255,
            )
        }
        // TEXEL_FLOAT
        _ => {
            let word = texture.first_word + 4 * index;
            Vec4::new(
                f32::from_bits(load_texel(scene, word)),
                f32::from_bits(load_texel(scene, word + 1)),
                f32::from_bits(load_texel(scene, word + 2)),
                f32::from_bits(load_texel(scene, word + 3)),
            )
        }
    }
}

/// The image at its own coordinates `uv` (finite), linear; alpha in lane 3.
#[inline]
pub fn read_image(scene: &SceneView, texture: &Texture, uv: Vec2) -> Vec4 {
    let bilinear = texture.magnify == MAGNIFY_BILINEAR;
    // 0..size: at most 65,535, so the conversions below are in range.
    let x = wrap_coordinate(uv.x, texture.wrap_u) * texture.width as f32;
    let y = wrap_coordinate(uv.y, texture.wrap_v) * texture.height as f32;
    let shift = if bilinear { 0.5 } else { 0.0 };
    let left = (x - shift).floor();
    let below = (y - shift).floor();
    let weight_x = (x - shift) - left;
    let weight_y = (y - shift) - below;
    // Nearest: the far edge itself belongs to the last texel.
    let wrap_u = if bilinear { texture.wrap_u } else { WRAP_CLAMP };
    let wrap_v = if bilinear { texture.wrap_v } else { WRAP_CLAMP };
    let mut row = Vec4::ZERO;
    let mut image = Vec4::ZERO;
    // Left and right below, left and right above; nearest takes the first. One place that reads: it is inlined once.
    let corners = if bilinear { 4 } else { 1 };
    for corner in 0..corners {
        let column_index = wrap_texel(left as i32 + (corner & 1), texture.width as i32, wrap_u);
        let row_index = wrap_texel(below as i32 + (corner >> 1), texture.height as i32, wrap_v);
        let texel = read_texel(scene, texture, column_index, row_index);
        // a + (b - a) t leaves equal neighbours exactly as they are.
        row = if (corner & 1) == 0 { texel } else { row + (texel - row) * weight_x };
        image = if corner <= 1 { row } else { image };
    }
    if bilinear { image + (row - image) * weight_y } else { image }
}

/// The texture at its own coordinates `uv` (finite), linear; alpha in lane 3. Trilinear between the two levels nearest to
/// the detail's width, and the mean of its probes.
#[inline]
pub fn filter_texture(scene: &SceneView, texture: &Texture, uv: Vec2, detail: Detail) -> Vec4 {
    let is_pattern = texture.format >= PATTERN_CHECKER;
    // The finer of the two levels, and the share of the coarser.
    let last = max_(texture.level_count as f32 - 1.0, 0.0);
    let lambda = if detail.width > 1.0 { min_(log2_(detail.width), last) } else { 0.0 };
    let finer = lambda.floor();
    let blend = lambda - finer;
    let levels = if blend > 0.0 { 2 } else { 1 };
    let mut result = Vec4::ZERO;
    for offset in 0..levels {
        let index = finer as u32 + offset;
        let level = if index == 0 { *texture } else { load_texture(scene, texture.first_level + (index - 1)) };
        let mut sum = Vec4::ZERO;
        for probe in 0..detail.probes {
            let place = uv + detail.spacing * ((probe as f32 + 0.5) - 0.5 * detail.probes as f32);
            let texel = if is_pattern {
                sample_pattern(scene, &level, place, detail.width * rcp(texture.width as f32))
            } else {
                read_image(scene, &level, place)
            };
            sum += texel;
        }
        let mean = if detail.probes == 1 { sum } else { sum * rcp(detail.probes as f32) };
        result = if offset == 0 { mean } else { result + (mean - result) * blend };
    }
    result
}

/// The image at the surface's `uv`, read at the point alone; any uv is safe. Not for patterns.
#[inline]
pub fn sample_texture(scene: &SceneView, texture: &Texture, uv: Vec2) -> Vec4 {
    read_image(scene, texture, texture_uv(texture, uv))
}
