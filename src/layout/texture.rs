//! Textures.

use bytemuck::{Pod, Zeroable};

/// One u32 a texel, 8 bits a channel (R lowest), colour channels sRGB-encoded.
pub const TEXEL_SRGB8: u32 = 0;
/// One u32 a texel, 8 bits a channel, linear.
pub const TEXEL_LINEAR8: u32 = 1;
/// Four f32 a texel, linear.
pub const TEXEL_FLOAT: u32 = 2;
/// No image: `PATTERN_WORDS` f32 in the texel array say which colours, octaves and so on (`shading/pattern`).
pub const PATTERN_CHECKER: u32 = 3;
pub const PATTERN_NOISE: u32 = 4;
pub const PATTERN_GRADIENT: u32 = 5;
pub const PATTERN_ZONE_PLATE: u32 = 6;

pub const WRAP_REPEAT: u32 = 0;
pub const WRAP_CLAMP: u32 = 1;
pub const WRAP_MIRROR: u32 = 2;

pub const MAGNIFY_NEAREST: u32 = 0;
pub const MAGNIFY_BILINEAR: u32 = 1;

/// What of a material a texture varies. It multiplies the constant; a normal or bump map turns the normal instead.
pub const PARAMETER_COLOR: u32 = 0;
pub const PARAMETER_SPECULAR_COLOR: u32 = 1;
pub const PARAMETER_EMISSION: u32 = 2;
pub const PARAMETER_ROUGHNESS: u32 = 3;
pub const PARAMETER_ROUGHNESS_U: u32 = 4;
pub const PARAMETER_ROUGHNESS_V: u32 = 5;
pub const PARAMETER_METALLIC: u32 = 6;
pub const PARAMETER_OPACITY: u32 = 7;
/// Opacity 0 below `scale` and 1 from there on, instead of a factor.
pub const PARAMETER_MASK: u32 = 8;
pub const PARAMETER_WEIGHT: u32 = 9;
pub const PARAMETER_NORMAL: u32 = 10;
pub const PARAMETER_BUMP: u32 = 11;
// Of a principled material.
pub const PARAMETER_ANISOTROPIC: u32 = 12;
pub const PARAMETER_SPEC_TRANS: u32 = 13;
pub const PARAMETER_SPEC_TINT: u32 = 14;
pub const PARAMETER_SHEEN: u32 = 15;
pub const PARAMETER_SHEEN_TINT: u32 = 16;
pub const PARAMETER_FLATNESS: u32 = 17;
pub const PARAMETER_CLEARCOAT: u32 = 18;
pub const PARAMETER_CLEARCOAT_GLOSS: u32 = 19;

/// Which channel of the texel counts; a single one stands for all three.
pub const CHANNEL_R: u32 = 0;
pub const CHANNEL_G: u32 = 1;
pub const CHANNEL_B: u32 = 2;
pub const CHANNEL_A: u32 = 3;
pub const CHANNEL_RGB: u32 = 4;

/// Texture records of a material at most; bake refuses more.
pub const TEXTURES_MOST: u32 = 16;

/// One texture, or one level of its mip chain: where its texels lie, how they are read, and what a material does with
/// them. 80 bytes. v = 0 is the bottom row; texels are stored from the top row down.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Texture {
    /// In texels, 1 to 65,535. Of a pattern: its finest step is taken for 1 / width and 1 / height.
    pub width: u32,
    pub height: u32,
    /// First 32-bit word of the image in the texel array.
    pub first_word: u32,
    /// `TEXEL_*` or `PATTERN_*`.
    pub format: u32,
    /// `WRAP_*`.
    pub wrap_u: u32,
    pub wrap_v: u32,
    /// `MAGNIFY_*`.
    pub magnify: u32,
    /// Levels of the mip chain, this one included; 0: read at the point alone, whatever the pixel covers.
    pub level_count: u32,
    /// uv' = (u scale_u + v shear_u + offset_u, v scale_v + u shear_v + offset_v).
    pub scale_u: f32,
    pub scale_v: f32,
    pub offset_u: f32,
    pub offset_v: f32,
    pub shear_u: f32,
    pub shear_v: f32,
    /// Index of the record of level 1; the others follow it.
    pub first_level: u32,
    /// `PARAMETER_*` of the material that has this record.
    pub parameter: u32,
    /// `CHANNEL_*`.
    pub channel: u32,
    /// Factor on what is read; of a normal map its strength, of a bump map the height of 1 in scene units.
    pub scale: f32,
    pub _pad0: u32,
    pub _pad1: u32,
}
