//! PNG: what a display shows.

use super::{Film, facts};
use crate::film::display::encode;
use png::{BitDepth, ColorType, Encoder, ScaledFloat, SrgbRenderingIntent};
use std::io::{self, Write};

/// The displayed film, 8 or 16 bits, tagged sRGB or with its gamma, with the facts as text.
pub fn write(film: &Film, sixteen_bit: bool, out: &mut dyn Write) -> io::Result<()> {
    let image = film.resolve();
    let (bits, max) = if sixteen_bit { (BitDepth::Sixteen, 65_535) } else { (BitDepth::Eight, 255) };
    let display = film.spec().display();
    let (color, channels) = if display.transparent { (ColorType::Rgba, 4) } else { (ColorType::Rgb, 3) };
    let integers = encode(&image, &display, max);
    let values = integers.iter().flat_map(|pixel| pixel[..channels].iter().copied());
    let bytes: Vec<u8> = match sixteen_bit {
        false => values.map(|v| v as u8).collect(),
        true => values.flat_map(u16::to_be_bytes).collect(),
    };

    let mut encoder = Encoder::new(out, image.width, image.height);
    encoder.set_color(color);
    encoder.set_depth(bits);
    match display.gamma {
        None => encoder.set_source_srgb(SrgbRenderingIntent::Perceptual),
        // Said, so that a viewer that knows can show the light that was meant.
        Some(gamma) => encoder.set_source_gamma(ScaledFloat::new(1.0 / gamma)),
    }
    for (keyword, text) in facts(film) {
        // tEXt is Latin-1; iTXt is UTF-8, and known to fewer programs.
        match text.is_ascii() {
            true => encoder.add_text_chunk(keyword.into(), text),
            false => encoder.add_itxt_chunk(keyword.into(), text),
        }
        .map_err(into_io)?;
    }
    finish(encoder, &bytes)
}

/// A plain 8-bit sRGB picture: `bytes` are r, g, b of each pixel, rows from the top.
pub fn write_rgb8(width: u32, height: u32, bytes: &[u8], out: &mut dyn Write) -> io::Result<()> {
    let mut encoder = Encoder::new(out, width, height);
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_source_srgb(SrgbRenderingIntent::Perceptual);
    finish(encoder, bytes)
}

fn finish(encoder: Encoder<&mut dyn Write>, bytes: &[u8]) -> io::Result<()> {
    let mut writer = encoder.write_header().map_err(into_io)?;
    writer.write_image_data(bytes).map_err(into_io)?;
    writer.finish().map_err(into_io)
}

fn into_io(error: png::EncodingError) -> io::Error {
    match error {
        png::EncodingError::IoError(error) => error,
        other => io::Error::other(other),
    }
}
