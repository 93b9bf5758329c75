//! Pictures as textures: PNG, JPEG, WebP, BMP, PNM and (by the file's name) TGA through `image`, OpenEXR and Radiance HDR
//! through `picture`.

use super::text::read_bytes;
use crate::memory::{self, Refused};
use crate::picture::{self, Purpose};
use crate::scene::{Location, SceneError, Texture, TextureData};
use image::{DynamicImage, ImageDecoder, ImageReader};
use std::io::Cursor;
use std::path::Path;
use std::sync::{Arc, OnceLock};

/// What the numbers in a picture stand for. HDR and EXR files are always linear; as data they are not even taken from other
/// chromaticities to Rec. 709.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ColorSpace {
    /// Colour channels encoded as IEC 61966-2-1.
    #[default]
    Srgb,
    /// Data: roughness, heights, normals.
    Linear,
}

impl ColorSpace {
    fn purpose(self) -> Purpose {
        match self {
            Self::Srgb => Purpose::Colors,
            Self::Linear => Purpose::Data,
        }
    }
}

/// Texels along a side: what a 16-bit coordinate holds.
const SIDE_MAX: u32 = 65_535;
/// Texels of a picture (16,384 x 8,192); a file that claims more is refused before memory is taken.
const TEXELS_MAX: u64 = 1 << 27;
/// Bytes of a texel of floats.
const TEXEL_BYTES: u64 = 16;
/// What a decoder may take.
const DECODED_BYTES_MAX: u64 = TEXELS_MAX * TEXEL_BYTES;

/// Reads the texture in the file `path`. The texture repeats, is filtered, and is not scaled.
pub fn load_texture(path: &Path, space: ColorSpace) -> Result<Texture, SceneError> {
    load_texture_for(path, space, space.purpose())
}

/// The same, of EXR and HDR files with another purpose.
pub fn load_texture_for(path: &Path, space: ColorSpace, purpose: Purpose) -> Result<Texture, SceneError> {
    read_texture(&read_bytes(path)?, path, space, purpose)
}

/// Reads a texture from the bytes of a picture; `name` is its file, or what stands for one in messages.
pub fn texture_from_bytes(bytes: &[u8], name: &Path, space: ColorSpace) -> Result<Texture, SceneError> {
    read_texture(bytes, name, space, space.purpose())
}

fn read_texture(bytes: &[u8], name: &Path, space: ColorSpace, purpose: Purpose) -> Result<Texture, SceneError> {
    let linear =
        |picture: picture::Picture| (picture.width, picture.height, TextureData::Float(Arc::new(picture.pixels)));
    let read = if bytes.starts_with(&picture::exr::MAGIC) {
        picture::exr::read(bytes, purpose, &check_size).map(linear)
    } else if bytes.starts_with(picture::radiance::MAGIC) {
        picture::radiance::read(bytes, purpose, &check_size).map(linear)
    } else {
        decode(bytes, name, space)
    };
    let (width, height, data) = read.map_err(|refused| match refused {
        Refused::Bad(message) => SceneError::bad(Location::file(name), message),
        Refused::Memory(short) => SceneError::Memory { location: Location::file(name), short },
    })?;
    Ok(Texture::new(name.display().to_string(), width, height, data))
}

fn decode(bytes: &[u8], name: &Path, space: ColorSpace) -> Result<(u32, u32, TextureData), Refused> {
    let mut reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format().map_err(|e| e.to_string())?;
    // Nothing in a TGA file says that it is one.
    if reader.format().is_none() && name.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("tga")) {
        reader.set_format(image::ImageFormat::Tga);
    }
    if reader.format().is_none() {
        return Err("not a picture in PNG, JPEG, HDR, WebP, BMP, PNM, TGA or EXR format".to_owned().into());
    }
    let readable = |e: image::ImageError| Refused::Bad(format!("cannot decode the picture: {e}"));
    let mut decoder = reader.into_decoder().map_err(readable)?;
    let (width, height) = decoder.dimensions();
    check_size(u64::from(width), u64::from(height))?;
    let mut limits = image::Limits::default();
    limits.max_alloc = Some(DECODED_BYTES_MAX);
    decoder.set_limits(limits).map_err(readable)?;
    let picture = DynamicImage::from_decoder(decoder).map_err(readable)?;
    Ok((width, height, texels(picture, space)))
}

/// Refuses what is too large, and claims memory for the rest: decoded, as a decoder has it beside.
fn check_size(width: u64, height: u64) -> Result<(), Refused> {
    let side = 1..=u64::from(SIDE_MAX);
    if !side.contains(&width) || !side.contains(&height) {
        return Err(format!("a picture of {width} x {height}; allowed are 1 to {SIDE_MAX} each way").into());
    }
    if width * height > TEXELS_MAX {
        return Err(format!("a picture of {width} x {height}; allowed are {TEXELS_MAX} texels").into());
    }
    memory::check("the picture", width * height * 2 * TEXEL_BYTES).map_err(Refused::Memory)
}

fn texels(picture: DynamicImage, space: ColorSpace) -> TextureData {
    match picture {
        DynamicImage::ImageRgb32F(_) | DynamicImage::ImageRgba32F(_) => {
            let texels = picture.into_rgba32f();
            TextureData::Float(Arc::new(texels.pixels().map(|p| p.0).collect()))
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
