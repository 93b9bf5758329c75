//! Texture coordinates: from the surface's to the texture's own (scaled, turned and moved), and round its edges.

use crate::layout::{Texture, WRAP_CLAMP, WRAP_REPEAT};
use crate::shading::math::clamp_;
use glam::Vec2;

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

/// The texture's own coordinates at the surface's `uv`, finite whatever `uv` is: 0 for what is not.
#[inline]
pub fn texture_uv(texture: &Texture, uv: Vec2) -> Vec2 {
    Vec2::new(
        finite_or_zero((uv.x * texture.scale_u + uv.y * texture.shear_u) + texture.offset_u),
        finite_or_zero((uv.y * texture.scale_v + uv.x * texture.shear_v) + texture.offset_v),
    )
}

/// A difference of the surface's uvs as one of the texture's own coordinates.
#[inline]
pub fn texture_vector(texture: &Texture, uv: Vec2) -> Vec2 {
    Vec2::new(uv.x * texture.scale_u + uv.y * texture.shear_u, uv.y * texture.scale_v + uv.x * texture.shear_v)
}
