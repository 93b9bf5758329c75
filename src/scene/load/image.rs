//! Pictures as textures: PNG, JPEG, Radiance HDR, WebP, BMP, PNM and (by the file's name) TGA through `image`, OpenEXR through
//! `exr`.

use crate::scene::{Location, SceneError, Texture, TextureData};
use image::{DynamicImage, ImageDecoder, ImageReader};
use std::io::Cursor;
use std::path::Path;
use std::sync::{Arc, OnceLock};

/// What the numbers in an 8 or 16-bit picture stand for. HDR and EXR files are always linear.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ColorSpace {
    /// Colour channels encoded as IEC 61966-2-1.
    #[default]
    Srgb,
    /// Data: roughness, heights, normals.
    Linear,
}

/// Texels along a side: what a 16-bit coordinate holds.
const SIDE_MAX: u32 = 65_535;
/// Texels of a picture (16,384 x 8,192); a file that claims more is refused before memory is taken.
const TEXELS_MAX: u64 = 1 << 27;
/// What a decoder may take.
const DECODED_BYTES_MAX: u64 = TEXELS_MAX * 16;

/// Reads the texture in the file `path`. The texture repeats, is filtered, and is not scaled.
pub fn load_texture(path: &Path, space: ColorSpace) -> Result<Texture, SceneError> {
    let bytes = std::fs::read(path).map_err(|source| SceneError::Io { location: Location::file(path), source })?;
    texture_from_bytes(&bytes, path, space)
}

/// Reads a texture from the bytes of a picture; `name` is its file, or what stands for one in messages.
pub fn texture_from_bytes(bytes: &[u8], name: &Path, space: ColorSpace) -> Result<Texture, SceneError> {
    let bad = |message: String| SceneError::bad(Location::file(name), message);
    let (width, height, data) = match bytes.starts_with(&[0x76, 0x2f, 0x31, 0x01]) {
        true => decode_exr(bytes).map_err(bad)?,
        false => decode(bytes, name, space).map_err(bad)?,
    };
    Ok(Texture::new(name.display().to_string(), width, height, data))
}

fn decode(bytes: &[u8], name: &Path, space: ColorSpace) -> Result<(u32, u32, TextureData), String> {
    let mut reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format().map_err(|e| e.to_string())?;
    // Nothing in a TGA file says that it is one.
    if reader.format().is_none() && name.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("tga")) {
        reader.set_format(image::ImageFormat::Tga);
    }
    if reader.format().is_none() {
        return Err("not a picture in PNG, JPEG, HDR, WebP, BMP, PNM, TGA or EXR format".to_owned());
    }
    let readable = |e: image::ImageError| format!("cannot decode the picture: {e}");
    let mut decoder = reader.into_decoder().map_err(readable)?;
    let (width, height) = decoder.dimensions();
    check_size(u64::from(width), u64::from(height))?;
    let mut limits = image::Limits::default();
    limits.max_alloc = Some(DECODED_BYTES_MAX);
    decoder.set_limits(limits).map_err(readable)?;
    let picture = DynamicImage::from_decoder(decoder).map_err(readable)?;
    Ok((width, height, texels(picture, space)))
}

fn check_size(width: u64, height: u64) -> Result<(), String> {
    let side = 1..=u64::from(SIDE_MAX);
    if !side.contains(&width) || !side.contains(&height) {
        return Err(format!("a picture of {width} x {height}; allowed are 1 to {SIDE_MAX} each way"));
    }
    if width * height > TEXELS_MAX {
        return Err(format!("a picture of {width} x {height}; allowed are {TEXELS_MAX} texels"));
    }
    Ok(())
}

fn texels(picture: DynamicImage, space: ColorSpace) -> TextureData {
    match picture {
        DynamicImage::ImageRgb32F(_) | DynamicImage::ImageRgba32F(_) => {
            let texels = picture.into_rgba32f();
            TextureData::Float(Arc::new(texels.pixels().map(|p| p.0.map(finite)).collect()))
        }
        DynamicImage::ImageLuma16(_)
        | DynamicImage::ImageLumaA16(_)
        | DynamicImage::ImageRgb16(_)
        | DynamicImage::ImageRgba16(_) => {
            let decode = |code: u16| match space {
                ColorSpace::Srgb => srgb16_to_linear()[usize::from(code)],
                ColorSpace::Linear => f32::from(code) / 65_535.0,
            };
            let texel = |p: [u16; 4]| [decode(p[0]), decode(p[1]), decode(p[2]), f32::from(p[3]) / 65_535.0];
            TextureData::Float(Arc::new(picture.into_rgba16().pixels().map(|p| texel(p.0)).collect()))
        }
        _ => {
            let texels = Arc::new(picture.into_rgba8().pixels().map(|p| p.0).collect());
            match space {
                ColorSpace::Srgb => TextureData::Srgb8(texels),
                ColorSpace::Linear => TextureData::Linear8(texels),
            }
        }
    }
}

fn srgb16_to_linear() -> &'static [f32] {
    static TABLE: OnceLock<Vec<f32>> = OnceLock::new();
    TABLE.get_or_init(|| (0..=u16::MAX).map(|code| srgb_to_linear(f64::from(code) / 65_535.0) as f32).collect())
}

/// IEC 61966-2-1, 0 to 1.
pub(super) fn srgb_to_linear(v: f64) -> f64 {
    if v <= 0.04045 { v / 12.92 } else { libm::pow((v + 0.055) / 1.055, 2.4) }
}

/// A texture must not bring NaN or infinity into a picture: those texels are black or the largest half.
fn finite(v: f32) -> f32 {
    const HALF_MAX: f32 = 65_504.0;
    if v.is_nan() {
        return 0.0;
    }
    if v.is_infinite() { HALF_MAX.copysign(v) } else { v }
}

fn decode_exr(bytes: &[u8]) -> Result<(u32, u32, TextureData), String> {
    use exr::prelude::{ReadChannels, ReadLayers, read};
    let readable = |e: exr::error::Error| format!("cannot decode the picture: {e}");
    // The sizes in the header come before any allocation for texels.
    let meta = exr::meta::MetaData::read_from_buffered(Cursor::new(bytes), false).map_err(readable)?;
    for header in &meta.headers {
        check_size(header.layer_size.0 as u64, header.layer_size.1 as u64)?;
    }
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .rgba_channels(
            |size, _| (size.0, vec![[0.0f32; 4]; size.0 * size.1]),
            |(width, texels), at, (r, g, b, a): (f32, f32, f32, f32)| {
                texels[at.1 * *width + at.0] = [r, g, b, a].map(finite);
            },
        )
        .first_valid_layer()
        .all_attributes()
        .from_buffered(Cursor::new(bytes))
        .map_err(readable)?;
    let size = image.layer_data.size;
    let texels = image.layer_data.channel_data.pixels.1;
    Ok((size.0 as u32, size.1 as u32, TextureData::Float(Arc::new(texels))))
}
