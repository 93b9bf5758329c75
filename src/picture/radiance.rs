//! Radiance pictures (.hdr, .pic): what their head says of order, exposure and colours. The scanlines are decoded by the
//! `image` crate, which knows the usual order of them alone and leaves the rest of the head to us.
//!
//! Source: Ward, "The Radiance picture file format" (ray/doc/filefmts of Radiance).

use super::chromaticity::{self, Chromaticities, REC709};
use super::{Picture, Purpose, SizeCheck};
use image::DynamicImage;
use image::codecs::hdr::HdrDecoder;
use std::io::{Cursor, Read};

/// How a file begins; "RADIANCE", "RGBE" and names of programs follow.
pub const MAGIC: &[u8] = b"#?";

/// Bytes of a head at most: no program writes more than a few lines.
const HEAD_MOST: usize = 1 << 20;

/// Radiance's own primaries, which files have that say nothing, with white of equal energy. Every program shows such files as
/// Rec. 709 without a change, and so does this one.
const OWN: Chromaticities =
    Chromaticities { red: [0.64, 0.33], green: [0.29, 0.6], blue: [0.15, 0.06], white: [1.0 / 3.0, 1.0 / 3.0] };

/// Lumens a watt that X, Y and Z count (Radiance's WHTEFFICACY).
const EFFICACY: f64 = 179.0;

/// What the head says.
#[derive(Clone, Debug, PartialEq)]
struct Head {
    /// The colours are X, Y and Z.
    xyz: bool,
    /// What the stored colours have been multiplied by.
    factors: [f64; 3],
    primaries: Option<Chromaticities>,
    order: Order,
    /// Where scanlines begin.
    end: usize,
}

/// How scanlines lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Order {
    width: u32,
    height: u32,
    /// Scanlines are columns.
    columns: bool,
    /// From the right to the left.
    leftwards: bool,
    /// From the bottom to the top.
    upwards: bool,
}

/// Reads the picture in `bytes`. `check` is asked before memory is taken for it.
pub fn read<E: From<String>>(bytes: &[u8], purpose: Purpose, check: SizeCheck<E>) -> Result<Picture, E> {
    let head = Head::parse(bytes)?;
    let order = head.order;
    check(order.width.into(), order.height.into())?;
    let stored = decode(order, &bytes[head.end..])?;
    let factor = head.factors(purpose)?;
    let mut pixels = vec![[0.0, 0.0, 0.0, 1.0]; stored.len()];
    let length = if order.columns { order.height } else { order.width } as usize;
    for (index, color) in stored.iter().enumerate() {
        let (line, along) = (index / length, index % length);
        let (x, y) = if order.columns { (line, along) } else { (along, line) };
        let x = if order.leftwards { order.width as usize - 1 - x } else { x };
        let y = if order.upwards { order.height as usize - 1 - y } else { y };
        let pixel = &mut pixels[y * order.width as usize + x];
        for lane in 0..3 {
            pixel[lane] = (f64::from(color[lane]) * factor[lane]) as f32;
        }
    }
    if let Some(matrix) = head.conversion(purpose) {
        chromaticity::convert(&mut pixels, matrix);
    }
    Ok(Picture { width: order.width, height: order.height, pixels })
}

/// The scanlines one after the other, as the crate reads them under a head that it understands.
fn decode(order: Order, scanlines: &[u8]) -> Result<Vec<[f32; 3]>, String> {
    let (length, count) = if order.columns { (order.height, order.width) } else { (order.width, order.height) };
    let head = format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {count} +X {length}\n");
    let readable = |e: image::ImageError| format!("cannot decode the picture: {e}");
    let decoder = HdrDecoder::new(Cursor::new(head).chain(scanlines)).map_err(readable)?;
    match DynamicImage::from_decoder(decoder).map_err(readable)? {
        DynamicImage::ImageRgb32F(picture) => Ok(picture.pixels().map(|pixel| pixel.0).collect()),
        other => Ok(other.into_rgb32f().pixels().map(|pixel| pixel.0).collect()),
    }
}

impl Head {
    fn parse(bytes: &[u8]) -> Result<Self, String> {
        let mut lines = Lines { bytes: &bytes[..bytes.len().min(HEAD_MOST)], at: 0 };
        let mut head = Self {
            xyz: false,
            factors: [1.0; 3],
            primaries: None,
            order: Order { width: 0, height: 0, columns: false, leftwards: false, upwards: false },
            end: 0,
        };
        lines.next().filter(|line| line.starts_with("#?")).ok_or("not a Radiance picture")?;
        loop {
            let line = lines.next().ok_or("the head of the Radiance picture has no end")?;
            if line.is_empty() {
                break;
            }
            let Some((key, value)) = line.split_once('=') else { continue };
            let number = || format!("the Radiance picture says {line:?}");
            match key.trim() {
                "FORMAT" => {
                    head.xyz = match value.trim() {
                        "32-bit_rle_rgbe" => false,
                        "32-bit_rle_xyze" => true,
                        _ => return Err(format!("{}; known are 32-bit_rle_rgbe and 32-bit_rle_xyze", number())),
                    }
                }
                "EXPOSURE" => {
                    let [factor] = positive(value).ok_or_else(|| format!("{}; it is a number above 0", number()))?;
                    head.factors = head.factors.map(|before| before * factor);
                }
                "COLORCORR" => {
                    let factors: [f64; 3] =
                        positive(value).ok_or_else(|| format!("{}; it is three numbers above 0", number()))?;
                    for (before, factor) in head.factors.iter_mut().zip(factors) {
                        *before *= factor;
                    }
                }
                "PRIMARIES" => {
                    let numbers = numbers(value).ok_or_else(|| format!("{}; they are eight numbers", number()))?;
                    head.primaries = Some(Chromaticities::from_numbers(numbers));
                }
                // Views, programs, aspects: no part of the light.
                _ => {}
            }
        }
        let line = lines.next().ok_or("the Radiance picture ends before it says its size")?;
        head.order = Order::parse(&line)
            .ok_or_else(|| format!("the Radiance picture says its size as {line:?}, not as \"-Y 480 +X 640\""))?;
        head.end = lines.at;
        Ok(head)
    }

    /// What makes light of what is stored.
    fn factors(&self, purpose: Purpose) -> Result<[f64; 3], String> {
        if purpose == Purpose::Mitsuba {
            return Ok([1.0; 3]);
        }
        let unit = if self.xyz { 1.0 / EFFICACY } else { 1.0 };
        let factors = self.factors.map(|factor| unit / factor);
        match factors.iter().all(|factor| factor.is_finite() && *factor > 0.0) {
            true => Ok(factors),
            false => Err(format!("the exposures of the Radiance picture make {:?}", self.factors)),
        }
    }

    /// What turns the stored colours into Rec. 709; none where they are.
    fn conversion(&self, purpose: Purpose) -> Option<glam::DMat3> {
        let mitsuba = purpose == Purpose::Mitsuba;
        if self.xyz && mitsuba {
            return Some(chromaticity::xyz_to_rec709());
        }
        if self.xyz {
            // White of equal energy is white, as in pictures of Radiance's own primaries.
            return OWN.to_xyz().map(|matrix| matrix.inverse());
        }
        let other = self.primaries.filter(|own| !own.is_nearly(&OWN) && !own.is_nearly(&REC709));
        // Some programs write zeros where they know none.
        chromaticity::to_rec709(&other.filter(|_| !mitsuba && purpose != Purpose::Data)?, true)
    }
}

impl Order {
    /// Reads such as `-Y 480 +X 640`: the first axis is that of the scanlines, and + along Y is upwards.
    fn parse(line: &str) -> Option<Self> {
        let words: Vec<&str> = line.split_whitespace().collect();
        let [first, count, second, length] = words[..] else { return None };
        let [count, length] = [count, length].map(|word| word.parse::<u32>().ok());
        let ((first, first_axis), (second, second_axis)) = (axis(first)?, axis(second)?);
        let (columns, x, y, width, height) = match (first_axis, second_axis) {
            ("Y", "X") => (false, second, first, length?, count?),
            ("X", "Y") => (true, first, second, count?, length?),
            _ => return None,
        };
        Some(Self { width, height, columns, leftwards: x, upwards: !y })
    }
}

/// Whether it goes backwards, and the name of the axis.
fn axis(word: &str) -> Option<(bool, &str)> {
    match word.strip_prefix('-') {
        Some(name) => Some((true, name)),
        None => Some((false, word.strip_prefix('+')?)),
    }
}

/// N numbers, separated by spaces.
fn numbers<const N: usize>(text: &str) -> Option<[f64; N]> {
    let numbers: Option<Vec<f64>> = text.split_whitespace().map(|word| word.parse().ok()).collect();
    numbers?.try_into().ok()
}

fn positive<const N: usize>(text: &str) -> Option<[f64; N]> {
    numbers(text).filter(|numbers| numbers.iter().all(|number| number.is_finite() && *number > 0.0))
}

/// The lines of a head.
struct Lines<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl Iterator for Lines<'_> {
    type Item = String;

    /// The next line, without its end; none where there is no end.
    fn next(&mut self) -> Option<String> {
        let rest = &self.bytes[self.at..];
        let length = rest.iter().position(|byte| *byte == b'\n')?;
        self.at += length + 1;
        let line = String::from_utf8_lossy(&rest[..length]);
        Some(line.strip_suffix('\r').unwrap_or(&line).to_owned())
    }
}
