//! Image textures as loaded.

use std::sync::Arc;

/// What lies beyond the image's edge.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Wrap {
    #[default]
    Repeat,
    Clamp,
    Mirror,
}

/// Texels from the top row down.
#[derive(Clone, Debug, PartialEq)]
pub enum TextureData {
    /// RGBA, colour channels sRGB-encoded.
    Srgb8(Arc<Vec<[u8; 4]>>),
    /// RGBA, linear.
    Linear8(Arc<Vec<[u8; 4]>>),
    /// RGBA, linear.
    Float(Arc<Vec<[f32; 4]>>),
}

/// One texture. uv' = uv * scale + offset.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    pub name: String,
    pub width: u32,
    pub height: u32,
    pub data: TextureData,
    pub wrap_u: Wrap,
    pub wrap_v: Wrap,
    /// False: the nearest texel.
    pub bilinear: bool,
    pub scale: [f32; 2],
    pub offset: [f32; 2],
}
