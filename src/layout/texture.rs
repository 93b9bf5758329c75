//! Image textures.

use bytemuck::{Pod, Zeroable};

/// One u32 a texel, 8 bits a channel (R lowest), colour channels sRGB-encoded.
pub const TEXEL_SRGB8: u32 = 0;
/// One u32 a texel, 8 bits a channel, linear.
pub const TEXEL_LINEAR8: u32 = 1;
/// Four f32 a texel, linear.
pub const TEXEL_FLOAT: u32 = 2;

pub const WRAP_REPEAT: u32 = 0;
pub const WRAP_CLAMP: u32 = 1;
pub const WRAP_MIRROR: u32 = 2;

pub const MAGNIFY_NEAREST: u32 = 0;
pub const MAGNIFY_BILINEAR: u32 = 1;

/// One texture: where its texels lie and how they are read. 48 bytes.
/// v = 0 is the bottom row; texels are stored from the top row down.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Texture {
    /// In texels, 1 to 65,535.
    pub width: u32,
    pub height: u32,
    /// First 32-bit word of the image in the texel array.
    pub first_word: u32,
    /// `TEXEL_*`.
    pub format: u32,
    /// `WRAP_*`.
    pub wrap_u: u32,
    pub wrap_v: u32,
    /// `MAGNIFY_*`.
    pub magnify: u32,
    pub _pad0: u32,
    /// uv' = uv * scale + offset.
    pub scale_u: f32,
    pub scale_v: f32,
    pub offset_u: f32,
    pub offset_v: f32,
}
