//! Radiance HDR: linear light in 8-bit mantissas with a shared exponent. Alpha is not stored.
//!
//! Written here because the `image` crate finds exponents with the platform's log2, truncates mantissas (its own
//! reader adds no half back) and has no place for comments.
//!
//! Source: Ward 1991, Real Pixels, Graphics Gems II; the Radiance reference manual, "Picture file format".

use super::{Film, facts};
use std::io::{self, Write};

/// The film, rows from the top, run-length encoded where the format allows it.
pub fn write(film: &Film, out: &mut dyn Write) -> io::Result<()> {
    let image = film.resolve();
    writeln!(out, "#?RADIANCE")?;
    for (key, value) in facts(film) {
        // A line break in a name would end the comment.
        writeln!(out, "# {key}: {}", value.replace(['\n', '\r'], " "))?;
    }
    write!(out, "FORMAT=32-bit_rle_rgbe\n\n-Y {} +X {}\n", image.height, image.width)?;
    let width = image.width as usize;
    let mut bytes = Vec::new();
    for row in image.pixels.chunks_exact(width) {
        let row: Vec<[u8; 4]> = row.iter().map(|&[r, g, b, _]| rgbe([r, g, b])).collect();
        bytes.clear();
        if (8..=32_767).contains(&width) {
            bytes.extend([2, 2, (width >> 8) as u8, width as u8]);
            for channel in 0..4 {
                let values: Vec<u8> = row.iter().map(|pixel| pixel[channel]).collect();
                run_lengths(&values, &mut bytes);
            }
        } else {
            // Flat pixels are never mistaken for runs: those start with mantissas 1, 1, 1, and here one is above 127.
            bytes.extend(row.iter().flatten());
        }
        out.write_all(&bytes)?;
    }
    Ok(())
}

/// Three 8-bit mantissas and their exponent: v = mantissa 2^(e - 136), nearest. Negative values and NaN become 0, as
/// does light below 2^-128; above 2^127 the largest value is kept.
pub fn rgbe(rgb: [f32; 3]) -> [u8; 4] {
    let largest_finite = f64::from(255u8) * f64::from_bits((1023 + 119) << 52);
    let rgb = rgb.map(|v| f64::from(v).max(0.0).min(largest_finite));
    let largest = rgb[0].max(rgb[1]).max(rgb[2]);
    // The exponent of f64: 2^(exponent - 1) <= largest < 2^exponent.
    let exponent = |v: f64| (v.to_bits() >> 52) as i64 - 1022;
    let scale = |exponent: i64| f64::from_bits(((1023 + 8 - exponent) as u64) << 52);
    if largest == 0.0 || exponent(largest) < -127 {
        return [0; 4];
    }
    let mut exponent = exponent(largest);
    if largest * scale(exponent) >= 255.5 {
        exponent += 1; // rounds up to 256
    }
    let [r, g, b] = rgb.map(|v| (v * scale(exponent) + 0.5) as u8);
    [r, g, b, (exponent + 128) as u8]
}

/// One channel of a line: a count above 128 is a run of count - 128 equal bytes, else count bytes follow.
fn run_lengths(values: &[u8], out: &mut Vec<u8>) {
    /// Shorter runs cost more than they save.
    const MIN_RUN: usize = 4;
    let run_at = |i: usize| values[i..].iter().take(127).take_while(|v| **v == values[i]).count();
    let mut i = 0;
    while i < values.len() {
        let run = run_at(i);
        if run >= MIN_RUN {
            out.extend([128 + run as u8, values[i]]);
            i += run;
            continue;
        }
        let start = i;
        while i < values.len() && i - start < 128 && run_at(i) < MIN_RUN {
            i += 1;
        }
        out.push((i - start) as u8);
        out.extend(&values[start..i]);
    }
}
