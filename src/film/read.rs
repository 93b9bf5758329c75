//! Pictures of any format, told apart by their first bytes, as linear light.

use super::display::srgb_decode;
use super::{Film, FilmError, Image, gfilm};
use crate::memory::{self, Refused};
use crate::picture::{self, Purpose};
use image::{DynamicImage, ImageError, ImageFormat, ImageReader, Limits};
use std::fs::File;
use std::io::{self, Cursor, Read};
use std::path::Path;

/// Pixels a picture may have: 2^28, 4 GiB as linear light.
pub const MAX_PIXELS: u64 = 1 << 28;

/// A picture that was read.
#[derive(Clone, Debug)]
pub struct Picture {
    /// Linear, premultiplied; alpha is 1 where the file has none.
    pub image: Image,
    /// The integers as they were stored, for the formats that store them.
    pub codes: Option<Codes>,
    /// For a film: its hash.
    pub film_hash: Option<blake3::Hash>,
}

/// Stored integers: r, g, b, alpha, not premultiplied; grey is repeated, an absent alpha is the largest code.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Codes {
    /// 8 or 16.
    pub bits: u32,
    pub pixels: Vec<[u16; 4]>,
}

/// The file, or standard input for `-`.
fn open(path: &Path) -> io::Result<Box<dyn Read>> {
    if path == Path::new("-") {
        return Ok(Box::new(io::stdin().lock()));
    }
    let file = File::open(path)?;
    if file.metadata()?.is_dir() {
        return Err(io::Error::other("it is a folder"));
    }
    Ok(Box::new(io::BufReader::new(file)))
}

/// Reads a `.gfilm` file; `-` is standard input.
pub fn read_film(path: &Path) -> Result<Film, FilmError> {
    let mut source = open(path).map_err(|e| FilmError::read(path, e))?;
    gfilm::read(path, &mut source)
}

/// Reads a picture: PNG, JPEG, WebP, Radiance HDR, OpenEXR or gfilm; `-` is standard input.
/// Integers are taken as sRGB; of EXR and HDR files what `picture` says for `Purpose::Compared`.
pub fn read_picture(path: &Path) -> Result<Picture, FilmError> {
    let source = open(path).map_err(|e| FilmError::read(path, e))?;
    read_picture_from(path, source)
}

/// As `read_picture`, from a stream; `path` is its name in messages.
pub fn read_picture_from(path: &Path, mut source: impl Read) -> Result<Picture, FilmError> {
    let io = |e| FilmError::read(path, e);
    // The first bytes before the rest: an endless stream of something else ends here.
    let mut bytes = Vec::new();
    source.by_ref().take(16).read_to_end(&mut bytes).map_err(io)?;
    if bytes.starts_with(&gfilm::MAGIC) {
        return gfilm::read(path, &mut Cursor::new(bytes).chain(source)).map(|film| film_picture(&film));
    }
    let format = match bytes.as_slice() {
        linear if linear.starts_with(&picture::exr::MAGIC) || linear.starts_with(picture::radiance::MAGIC) => None,
        [0x89, b'P', b'N', b'G', ..] => Some(ImageFormat::Png),
        [0xff, 0xd8, 0xff, ..] => Some(ImageFormat::Jpeg),
        [b'R', b'I', b'F', b'F', _, _, _, _, b'W', b'E', b'B', b'P', ..] => Some(ImageFormat::WebP),
        _ => {
            return Err(FilmError::bad(path, "not a PNG, JPEG, WebP, Radiance HDR, OpenEXR or gfilm file"));
        }
    };
    source.read_to_end(&mut bytes).map_err(io)?;
    match format {
        Some(format) => read_with_image(path, &bytes, format),
        None if bytes.starts_with(&picture::exr::MAGIC) => {
            linear_picture(path, picture::exr::read(&bytes, Purpose::Compared, &check_size))
        }
        None => linear_picture(path, picture::radiance::read(&bytes, Purpose::Compared, &check_size)),
    }
}

/// The film as its files show it: opaque unless it was made transparent.
pub fn film_picture(film: &Film) -> Picture {
    let mut image = film.resolve();
    if !film.spec().transparent {
        image.pixels.iter_mut().for_each(|pixel| pixel[3] = 1.0);
    }
    Picture { image, codes: None, film_hash: Some(film.hash()) }
}

/// The error of a picture that is refused; `path` is its name.
fn refusal(path: &Path, refused: Refused) -> FilmError {
    match refused {
        Refused::Bad(message) => FilmError::bad(path, message),
        Refused::Memory(short) => FilmError::short(path, short),
    }
}

fn check_size(width: u64, height: u64) -> Result<(), Refused> {
    let pixels = width.saturating_mul(height);
    if width == 0 || height == 0 || pixels > MAX_PIXELS {
        return Err(format!("the picture is {width}x{height}; 1 to {MAX_PIXELS} pixels are allowed").into());
    }
    memory::check("the picture", pixels * 16).map_err(Refused::Memory)
}

fn read_with_image(path: &Path, bytes: &[u8], format: ImageFormat) -> Result<Picture, FilmError> {
    let bad = |e: ImageError| FilmError::bad(path, e.to_string());
    let (width, height) = ImageReader::with_format(Cursor::new(bytes), format).into_dimensions().map_err(bad)?;
    check_size(width.into(), height.into()).map_err(|refused| refusal(path, refused))?;
    let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
    let mut limits = Limits::default();
    limits.max_alloc = Some(16 * MAX_PIXELS);
    reader.limits(limits);
    let decoded = reader.decode().map_err(bad)?;
    Ok(match decoded {
        DynamicImage::ImageLuma16(_)
        | DynamicImage::ImageLumaA16(_)
        | DynamicImage::ImageRgb16(_)
        | DynamicImage::ImageRgba16(_) => {
            let pixels = decoded.into_rgba16().pixels().map(|pixel| pixel.0).collect();
            coded_picture(width, height, Codes { bits: 16, pixels })
        }
        _ => {
            let pixels = decoded.into_rgba8().pixels().map(|pixel| pixel.0.map(u16::from)).collect();
            coded_picture(width, height, Codes { bits: 8, pixels })
        }
    })
}

fn coded_picture(width: u32, height: u32, codes: Codes) -> Picture {
    let max = (1u32 << codes.bits) - 1;
    let linear: Vec<f64> = (0..=max).map(|code| srgb_decode(f64::from(code) / f64::from(max))).collect();
    let pixel = |[r, g, b, a]: &[u16; 4]| {
        let alpha = f64::from(*a) / f64::from(max);
        let colour = |code: u16| (linear[usize::from(code)] * alpha) as f32;
        [colour(*r), colour(*g), colour(*b), alpha as f32]
    };
    let pixels = codes.pixels.iter().map(pixel).collect();
    Picture { image: Image { width, height, pixels }, codes: Some(codes), film_hash: None }
}

/// The picture in a file of linear numbers.
fn linear_picture(path: &Path, picture: Result<picture::Picture, Refused>) -> Result<Picture, FilmError> {
    let picture::Picture { width, height, pixels } = picture.map_err(|refused| refusal(path, refused))?;
    Ok(Picture { image: Image { width, height, pixels }, codes: None, film_hash: None })
}
