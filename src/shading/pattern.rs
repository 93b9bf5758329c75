//! Patterns: textures without an image, between two colours. Each gives the share of the second colour, 0 to 1.

use crate::layout::{
    PATTERN_CHECKER, PATTERN_GRADIENT, PATTERN_NOISE, SceneView, Texture, WRAP_MIRROR, WRAP_REPEAT, load_texel,
};
use crate::shading::coordinate::wrap_coordinate;
use crate::shading::math::{clamp_, cos_turns, div, dot2, mix_, mix3_, sin_turns};
use crate::shading::sampling::{hash_combine, unit_float};
use glam::{Vec2, Vec3, Vec4};

/// Octaves of noise at most.
const OCTAVES_MOST: u32 = 16;
/// Farther out than this (2^22) floats have no fraction left to make a pattern of.
const REACH: f32 = 4194304.0;
/// Noise along one lattice of unit gradients stays within sqrt(1/2) (Perlin noise in two dimensions).
const NOISE_NORM: f32 = 1.41421354;

/// `x`, or 0 where its fraction is lost.
fn within_pattern(x: f32) -> f32 {
    if x.abs() > REACH { 0.0 } else { x }
}

/// Mean over `width` around `x` of the square wave that is 1 in the first half of each unit and -1 in the second.
#[inline]
pub fn square_mean(x: f32, width: f32) -> f32 {
    let f = x - x.floor();
    // Distance to the nearest edge, on the side of 1; at most a quarter.
    let inside = if f < 0.5 { 0.25 - (f - 0.25).abs() } else { (f - 0.75).abs() - 0.25 };
    if width <= 0.5 {
        let sharp = if f < 0.5 { 1.0 } else { -1.0 };
        // A window narrower than half a unit sees one edge at most.
        let half_width = 0.5 * width;
        return if inside.abs() >= half_width { sharp } else { div(inside, half_width) };
    }
    // The integral of the wave is a triangle between 0 and a half.
    let a = wrap_coordinate(f - 0.5 * width, WRAP_REPEAT);
    let b = wrap_coordinate(f + 0.5 * width, WRAP_REPEAT);
    let below = if a < 0.5 { a } else { 1.0 - a };
    let above = if b < 0.5 { b } else { 1.0 - b };
    div(above - below, width)
}

/// Two by two fields a unit; the first colour at the lower left. The mean over a square of `width`.
#[inline]
pub fn checker(uv: Vec2, width: f32) -> f32 {
    0.5 - (0.5 * square_mean(uv.x, width)) * square_mean(uv.y, width)
}

/// Gradient noise of one lattice, -1..1: unit gradients at whole coordinates, quintic weights.
/// `uv`: within 2^22. Source: Perlin 2002, "Improving Noise", with directions from a hash.
#[inline]
pub fn gradient_noise(uv: Vec2, seed: u32) -> f32 {
    let left = uv.x.floor();
    let below = uv.y.floor();
    let x = uv.x - left;
    let y = uv.y - below;
    let weight_x = ((x * x) * x) * (x * (x * 6.0 - 15.0) + 10.0);
    let weight_y = ((y * y) * y) * (y * (y * 6.0 - 15.0) + 10.0);
    let mut row = 0.0;
    let mut noise = 0.0;
    for corner in 0..4 {
        let dx = corner & 1;
        let dy = corner >> 1;
        let column_hash = hash_combine(seed, (left as i32 + dx) as u32);
        let turn = unit_float(hash_combine(column_hash, (below as i32 + dy) as u32));
        let direction = Vec2::new(cos_turns(turn), sin_turns(turn));
        let value = dot2(direction, Vec2::new(x - dx as f32, y - dy as f32));
        row = if dx == 0 { value } else { mix_(row, value, weight_x) };
        noise = if dy == 0 { row } else { noise };
    }
    mix_(noise, row, weight_y) * NOISE_NORM
}

/// Sum of `octaves` of noise, each twice as fine and `gain` as strong as the last, over the sum of their strengths;
/// -1..1. Octaves too fine for `width` fade out.
#[inline]
pub fn fractal_noise(uv: Vec2, octaves: u32, gain: f32, seed: u32, width: f32) -> f32 {
    let mut place = uv;
    let mut strength = 1.0;
    let mut covered_width = width;
    let mut sum = 0.0;
    let mut total = 0.0;
    let count = octaves.clamp(1, OCTAVES_MOST);
    for octave in 0..count {
        // From a quarter of the wavelength on, nothing is left at a half (Nyquist's limit).
        let kept = clamp_(2.0 - 4.0 * covered_width, 0.0, 1.0);
        let inside = Vec2::new(within_pattern(place.x), within_pattern(place.y));
        if kept > 0.0 {
            sum += (strength * kept) * gradient_noise(inside, hash_combine(seed, octave));
        }
        total += strength;
        strength *= gain;
        place *= 2.0;
        covered_width *= 2.0;
    }
    div(sum, total)
}

/// Rings around the origin, whose frequency at the distance r is r cycles a unit: what a filter lets through is seen at
/// one look. Not smoothed: it is there to show aliasing.
#[inline]
pub fn zone_plate(uv: Vec2) -> f32 {
    0.5 + 0.5 * cos_turns(0.5 * dot2(uv, uv))
}

/// The share of the second colour at the texture's own coordinates `uv` (finite); `width` is covered, in their units.
/// `pattern`: `PATTERN_*`. `octaves`, `gain` and `seed` count for noise alone.
#[inline]
pub fn pattern_share(pattern: u32, uv: Vec2, octaves: u32, gain: f32, seed: u32, width: f32) -> f32 {
    let place = Vec2::new(within_pattern(uv.x), within_pattern(uv.y));
    match pattern {
        PATTERN_CHECKER => checker(place, width),
        PATTERN_NOISE => clamp_(0.5 + 0.5 * fractal_noise(place, octaves, gain, seed, width), 0.0, 1.0),
        PATTERN_GRADIENT => wrap_coordinate(place.x, WRAP_MIRROR),
        // PATTERN_ZONE_PLATE
        _ => zone_plate(place),
    }
}

/// The pattern at the texture's own coordinates `uv` (finite), opaque; `width` is covered, in their units.
#[inline]
pub fn sample_pattern(scene: &SceneView, texture: &Texture, uv: Vec2, width: f32) -> Vec4 {
    let at = texture.first_word;
    let octaves = load_texel(scene, at + 6);
    let gain = f32::from_bits(load_texel(scene, at + 7));
    let seed = load_texel(scene, at + 8);
    let share = pattern_share(texture.format, uv, octaves, gain, seed, width);
    let first = Vec3::new(
        f32::from_bits(load_texel(scene, at)),
        f32::from_bits(load_texel(scene, at + 1)),
        f32::from_bits(load_texel(scene, at + 2)),
    );
    let second = Vec3::new(
        f32::from_bits(load_texel(scene, at + 3)),
        f32::from_bits(load_texel(scene, at + 4)),
        f32::from_bits(load_texel(scene, at + 5)),
    );
    let color = mix3_(first, second, share);
    Vec4::new(color.x, color.y, color.z, 1.0)
}
