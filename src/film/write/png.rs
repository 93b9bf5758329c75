//! PNG: what a display shows.

use super::Plate;
use png::{BitDepth, ColorType, Encoder, ScaledFloat, SrgbRenderingIntent};
use std::io::{self, Write};

/// Writes `plate` with `facts`, keywords and texts; tagged sRGB or with its gamma.
pub fn write(plate: &Plate, facts: &[(&'static str, String)], out: &mut dyn Write) -> io::Result<()> {
    let (color, channels) = if plate.transparent { (ColorType::Rgba, 4) } else { (ColorType::Rgb, 3) };
    let values = plate.pixels.iter().flat_map(|pixel| pixel[..channels].iter().copied());
    let bytes: Vec<u8> = match plate.sixteen_bit {
        false => values.map(|v| v as u8).collect(),
        true => values.flat_map(u16::to_be_bytes).collect(),
    };
    let mut encoder = Encoder::new(out, plate.width, plate.height);
    encoder.set_color(color);
    encoder.set_depth(if plate.sixteen_bit { BitDepth::Sixteen } else { BitDepth::Eight });
    match plate.gamma {
        None => encoder.set_source_srgb(SrgbRenderingIntent::Perceptual),
        // Said, so that a viewer that knows can show the light that was meant.
        Some(gamma) => encoder.set_source_gamma(ScaledFloat::new(1.0 / gamma)),
    }
    for (keyword, text) in facts {
        // tEXt is Latin-1; iTXt is UTF-8, and known to fewer programs.
        match text.is_ascii() {
            true => encoder.add_text_chunk((*keyword).into(), text.clone()),
            false => encoder.add_itxt_chunk((*keyword).into(), text.clone()),
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
