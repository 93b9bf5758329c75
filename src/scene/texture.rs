//! Textures as loaded or described.

use super::Rgb;
use std::sync::Arc;

/// What lies beyond the image's edge.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Wrap {
    #[default]
    Repeat,
    Clamp,
    Mirror,
}

/// A texture that is computed: where it lies between `colors`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pattern {
    pub kind: PatternKind,
    pub colors: [Rgb; 2],
}

/// The patterns, in texture coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PatternKind {
    /// Two by two fields a unit, the first colour at the lower left.
    Checker,
    /// Gradient noise of one feature a unit: `octaves` of it (1 to 16), each twice as fine and `gain` as strong as the last.
    Noise { octaves: u32, gain: f32, seed: u32 },
    /// From the first colour at u = 0 to the second at u = 1, and back again.
    Gradient,
    /// Rings, at the distance r from the origin r of them a unit (row 26).
    ZonePlate,
}

/// Texels from the top row down, or none at all.
#[derive(Clone, Debug)]
pub enum TextureData {
    /// RGBA, colour channels sRGB-encoded.
    Srgb8(Arc<Vec<[u8; 4]>>),
    /// RGBA, linear.
    Linear8(Arc<Vec<[u8; 4]>>),
    /// RGBA, linear.
    Float(Arc<Vec<[f32; 4]>>),
    Pattern(Pattern),
}

impl PartialEq for TextureData {
    /// Shared texels are equal without a look, and even where one of them is no number.
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Srgb8(a), Self::Srgb8(b)) | (Self::Linear8(a), Self::Linear8(b)) => Arc::ptr_eq(a, b) || a == b,
            (Self::Float(a), Self::Float(b)) => Arc::ptr_eq(a, b) || a == b,
            (Self::Pattern(a), Self::Pattern(b)) => a == b,
            _ => false,
        }
    }
}

/// One texture. uv' = (u scale.0 + v shear.0 + offset.0, v scale.1 + u shear.1 + offset.1).
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    pub name: String,
    /// In texels. Of a pattern: heights are compared 1 / width and 1 / height apart.
    pub width: u32,
    pub height: u32,
    pub data: TextureData,
    pub wrap_u: Wrap,
    pub wrap_v: Wrap,
    /// False: the nearest texel.
    pub bilinear: bool,
    /// Read as the mean over what a pixel's cone covers, from smaller copies; else at the point alone, which many samples
    /// turn into the same picture without the cone's approximations.
    pub mipmap: bool,
    /// Some texels are not read but between others, as the ends of planes: they may be out of range where what is read is not.
    pub extrapolated: bool,
    pub scale: [f32; 2],
    pub shear: [f32; 2],
    pub offset: [f32; 2],
}

impl Texture {
    /// What stands for a pattern's texels: the finest detail that bump maps see.
    pub const PATTERN_SIDE: u32 = 1024;

    /// A texture that repeats, is bilinear, has no mip levels and lies as the surface's coordinates say.
    pub fn new(name: impl Into<String>, width: u32, height: u32, data: TextureData) -> Self {
        Self {
            name: name.into(),
            width,
            height,
            data,
            wrap_u: Wrap::Repeat,
            wrap_v: Wrap::Repeat,
            bilinear: true,
            mipmap: false,
            extrapolated: false,
            scale: [1.0; 2],
            shear: [0.0; 2],
            offset: [0.0; 2],
        }
    }

    /// One texel of a colour.
    pub fn uniform(color: Rgb) -> Self {
        Self::new("uniform", 1, 1, TextureData::Float(Arc::new(vec![[color.x, color.y, color.z, 1.0]])))
    }

    /// The texture of a pattern.
    pub fn pattern(name: impl Into<String>, pattern: Pattern) -> Self {
        Self::new(name, Self::PATTERN_SIDE, Self::PATTERN_SIDE, TextureData::Pattern(pattern))
    }
}
