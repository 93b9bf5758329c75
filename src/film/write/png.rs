//! PNG: what a display shows.

use super::{Film, facts};
use crate::film::display::encode;
use png::{BitDepth, ColorType, Encoder, ScaledFloat, SrgbRenderingIntent};
use std::io::{self, Write};

/// The displayed film, 8 or 16 bits, tagged sRGB or with its gamma, with the facts as text.
pub fn write(film: &Film, sixteen_bit: bool, out: &mut dyn Write) -> io::Result<()> {
    let image = film.resolve();
    let display = film.spec().display();
    let pixels = encode(&image, &display, if sixteen_bit { 65_535 } else { 255 });
    let plate = Plate {
        width: image.width,
        height: image.height,
        pixels: &pixels,
        sixteen_bit,
        transparent: display.transparent,
        gamma: display.gamma,
    };
    plate.write(&facts(film), out)
}

/// A displayed picture: what `encode` gives, and what else a PNG says of it.
#[derive(Clone, Copy, Debug)]
pub struct Plate<'a> {
    pub width: u32,
    pub height: u32,
    /// Integers of 0..=255, or 0..=65,535.
    pub pixels: &'a [[u16; 4]],
    pub sixteen_bit: bool,
    /// With alpha.
    pub transparent: bool,
    /// None: sRGB.
    pub gamma: Option<f32>,
}

impl Plate<'_> {
    /// As a PNG with `facts`, keywords and texts.
    pub fn write(&self, facts: &[(&'static str, String)], out: &mut dyn Write) -> io::Result<()> {
        let (color, channels) = if self.transparent { (ColorType::Rgba, 4) } else { (ColorType::Rgb, 3) };
        let values = self.pixels.iter().flat_map(|pixel| pixel[..channels].iter().copied());
        let bytes: Vec<u8> = match self.sixteen_bit {
            false => values.map(|v| v as u8).collect(),
            true => values.flat_map(u16::to_be_bytes).collect(),
        };
        let mut encoder = Encoder::new(out, self.width, self.height);
        encoder.set_color(color);
        encoder.set_depth(if self.sixteen_bit { BitDepth::Sixteen } else { BitDepth::Eight });
        match self.gamma {
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
