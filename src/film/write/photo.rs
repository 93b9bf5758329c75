//! JPEG and WebP: what a display shows, for the web.

use super::{Format, Plate};
use image::codecs::jpeg::JpegEncoder;
use image::codecs::webp::WebPEncoder;
use image::{ExtendedColorType, ImageEncoder, ImageError};
use std::io::{self, Write};

/// Of JPEG, 1 to 100: no blocks are seen, at a fifth of a PNG's size.
const QUALITY: u8 = 92;

/// Writes `plate`, 8 bits a channel, with `facts` as the description in EXIF. JPEG is lossy and has no alpha, which is left out;
/// WebP is lossless.
pub fn write(plate: &Plate, format: Format, facts: &[(&'static str, String)], out: &mut dyn Write) -> io::Result<()> {
    let alpha = plate.transparent && format == Format::Webp;
    let (color, channels) = if alpha { (ExtendedColorType::Rgba8, 4) } else { (ExtendedColorType::Rgb8, 3) };
    let bytes: Vec<u8> = plate.pixels.iter().flat_map(|pixel| pixel[..channels].iter().map(|v| *v as u8)).collect();
    let (width, height) = (plate.width, plate.height);
    let written = match format {
        Format::Jpeg => encode(JpegEncoder::new_with_quality(out, QUALITY), &bytes, width, height, color, facts),
        _ => encode(WebPEncoder::new_lossless(out), &bytes, width, height, color, facts),
    };
    written.map_err(|error| match error {
        ImageError::IoError(error) => error,
        other => io::Error::other(other),
    })
}

fn encode(
    mut encoder: impl ImageEncoder,
    bytes: &[u8],
    width: u32,
    height: u32,
    color: ExtendedColorType,
    facts: &[(&'static str, String)],
) -> Result<(), ImageError> {
    if !facts.is_empty() {
        // A picture without its description is still a picture.
        let _ = encoder.set_exif_metadata(description(facts));
    }
    encoder.write_image(bytes, width, height, color)
}

/// EXIF with one entry, ImageDescription (270): the facts, one a line; what is not ASCII becomes `?`.
/// Source: TIFF 6.0, sections 2 and 8.
fn description(facts: &[(&'static str, String)]) -> Vec<u8> {
    let lines: Vec<String> = facts.iter().map(|(key, value)| format!("{key}: {value}")).collect();
    let mut text: Vec<u8> = lines.join("\n").chars().map(|c| if c.is_ascii() { c as u8 } else { b'?' }).collect();
    // At least five bytes with its end, so that the text never fits into the entry itself.
    text.resize(text.len().max(4), b' ');
    text.push(0);
    let mut exif = b"II*\0\x08\0\0\0".to_vec();
    exif.extend(1u16.to_le_bytes());
    for word in [270u16, 2] {
        exif.extend(word.to_le_bytes());
    }
    // The text follows the header (8), the count (2), the entry (12) and the end of the list (4).
    for word in [text.len() as u32, 26, 0] {
        exif.extend(word.to_le_bytes());
    }
    exif.extend(text);
    exif
}
