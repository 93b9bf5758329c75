//! Image textures: wrapping, nearest and bilinear reading with exact weights (row 27).
//!
//! Texel centres are at half-integers; v = 0 is the bottom edge. No mip levels in this version.

use crate::layout::{
    MAGNIFY_BILINEAR, SceneView, TEXEL_LINEAR8, TEXEL_SRGB8, Texture, WRAP_CLAMP, WRAP_REPEAT, load_table, load_texel,
};
use crate::shading::math::clamp_;
use glam::{Vec2, Vec4};

/// The f32 nearest to 1 / 255; 255 times it is exactly 1.
const INV_255: f32 = 0.003_921_569;

/// `x`, or 0 if it is infinite or not a number. By its bits: no result may depend on comparing a NaN.
#[inline]
pub fn finite_or_zero(x: f32) -> f32 {
    if (x.to_bits() & 0x7f80_0000) == 0x7f80_0000 { 0.0 } else { x }
}

/// A texture coordinate brought into 0..1, both ends included. `x`: finite. `wrap`: `WRAP_*`.
#[inline]
pub fn wrap_coordinate(x: f32, wrap: u32) -> f32 {
    match wrap {
        // Subtracting the floor first is exact but for tiny negative x, which become 1.
        WRAP_REPEAT => x - x.floor(),
        WRAP_CLAMP => clamp_(x, 0.0, 1.0),
        // WRAP_MIRROR: period 2, there and back.
        _ => {
            let half_x = 0.5 * x;
            let period = 2.0 * (half_x - half_x.floor());
            if period <= 1.0 { period } else { 2.0 - period }
        }
    }
}

/// Texel index -1..size brought into 0..size-1: round the corner for repeat; at the edge itself for clamp and mirror.
#[inline]
pub fn wrap_texel(i: i32, size: i32, wrap: u32) -> i32 {
    if i < 0 {
        return if wrap == WRAP_REPEAT { size - 1 } else { 0 };
    }
    if i >= size {
        return if wrap == WRAP_REPEAT { 0 } else { size - 1 };
    }
    i
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

/// The texture at `uv` (before its own scale and offset), linear; alpha in lane 3. Any uv is safe: a coordinate that is
/// infinite or not a number reads as 0.
#[inline]
pub fn sample_texture(scene: &SceneView, texture: &Texture, uv: Vec2) -> Vec4 {
    let u = wrap_coordinate(finite_or_zero(uv.x * texture.scale_u + texture.offset_u), texture.wrap_u);
    let v = wrap_coordinate(finite_or_zero(uv.y * texture.scale_v + texture.offset_v), texture.wrap_v);
    let width = texture.width as i32;
    let height = texture.height as i32;
    // 0..size: at most 65,535, so the conversions below are in range.
    let x = u * texture.width as f32;
    let y = v * texture.height as f32;
    if texture.magnify == MAGNIFY_BILINEAR {
        let left = (x - 0.5).floor();
        let below = (y - 0.5).floor();
        let weight_x = (x - 0.5) - left;
        let weight_y = (y - 0.5) - below;
        let x0 = wrap_texel(left as i32, width, texture.wrap_u);
        let x1 = wrap_texel(left as i32 + 1, width, texture.wrap_u);
        let y0 = wrap_texel(below as i32, height, texture.wrap_v);
        let y1 = wrap_texel(below as i32 + 1, height, texture.wrap_v);
        let t00 = read_texel(scene, texture, x0, y0);
        let t10 = read_texel(scene, texture, x1, y0);
        let t01 = read_texel(scene, texture, x0, y1);
        let t11 = read_texel(scene, texture, x1, y1);
        // a + (b - a) t leaves equal neighbours exactly as they are.
        let bottom = t00 + (t10 - t00) * weight_x;
        let top = t01 + (t11 - t01) * weight_x;
        return bottom + (top - bottom) * weight_y;
    }
    // MAGNIFY_NEAREST; the far edge itself belongs to the last texel.
    let column = x.floor() as i32;
    let row = y.floor() as i32;
    let last_column = if column >= width { width - 1 } else { column };
    let last_row = if row >= height { height - 1 } else { row };
    read_texel(scene, texture, last_column, last_row)
}
