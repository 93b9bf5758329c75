//! Pictures side by side as one, with their names in the plots' font.

use super::canvas::{Anchor, Canvas, Result, text_width};
use plotters::prelude::BitMapBackend;

/// A displayed picture: r, g, b and alpha of each pixel from 0 to `max`, rows from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    pub width: u32,
    pub height: u32,
    /// 255 or 65,535.
    pub max: u16,
    pub pixels: Vec<[u16; 4]>,
}

/// Gap between pictures, pixels.
const GAP: u32 = 6;
const INK: [u8; 3] = [30, 30, 30];

impl Picture {
    fn white(width: u32, height: u32, max: u16) -> Self {
        Self { width, height, max, pixels: vec![[max; 4]; (width * height) as usize] }
    }

    /// Lays `other` over the picture, its upper left corner at `at`, both inside.
    fn put(&mut self, other: &Picture, at: [u32; 2]) {
        debug_assert!(at[0] + other.width <= self.width && at[1] + other.height <= self.height, "{at:?}");
        for (row, pixels) in other.pixels.chunks_exact(other.width as usize).enumerate() {
            let start = ((at[1] + row as u32) * self.width + at[0]) as usize;
            self.pixels[start..start + pixels.len()].copy_from_slice(pixels);
        }
    }
}

/// Height of a line of text under pictures this wide, pixels.
fn line_height(width: u32) -> u32 {
    (width / 11).clamp(24, 120)
}

/// A name in the middle of a line.
fn line(name: &str, width: u32, height: u32, max: u16) -> Result<Picture> {
    const FINE: u32 = super::PNG_SCALE;
    let size = (f64::from(width) * 0.96 / text_width(name, 1.0).max(1.0)).min(f64::from(height) * 0.64);
    let mut fine = vec![0u8; (width * FINE * height * FINE * 3) as usize];
    let canvas = Canvas::new(BitMapBackend::with_buffer(&mut fine, (width * FINE, height * FINE)), f64::from(FINE))?;
    canvas.text(name, [f64::from(width) * 0.5, f64::from(height) * 0.5], size, Anchor::Centre, INK)?;
    canvas.finish()?;
    let code = |v: u8| u16::from(v) * (max / 255);
    let averaged = super::averaged(&fine, (width * FINE) as usize, FINE as usize);
    let pixels = averaged.chunks_exact(3).map(|p| [code(p[0]), code(p[1]), code(p[2]), max]).collect();
    Ok(Picture { width, height, max, pixels })
}

/// Pictures in rows of `columns`, each with its name below; those of a column are as wide as its widest.
pub fn sheet(pictures: &[(&str, Picture)], columns: usize) -> Result<Picture> {
    let columns = columns.clamp(1, pictures.len().max(1));
    let rows: Vec<_> = pictures.chunks(columns).collect();
    let column_width = |column: usize| rows.iter().filter_map(|row| row.get(column)).map(|(_, p)| p.width).max();
    let widths: Vec<u32> = (0..columns).filter_map(column_width).collect();
    let heights: Vec<u32> = rows.iter().map(|row| row.iter().map(|(_, p)| p.height).max().unwrap_or(0)).collect();
    let label = line_height(widths.iter().copied().min().unwrap_or(0));
    let gaps = |count: usize| GAP * (count.saturating_sub(1)) as u32;
    let max = pictures.first().map_or(255, |(_, picture)| picture.max);
    let width = widths.iter().sum::<u32>() + gaps(columns);
    let height = heights.iter().map(|height| height + label).sum::<u32>() + gaps(rows.len());
    let mut whole = Picture::white(width, height, max);
    let mut top = 0;
    for (row, height) in rows.iter().zip(&heights) {
        let mut left = 0;
        for ((name, picture), width) in row.iter().zip(&widths) {
            whole.put(picture, [left + (width - picture.width) / 2, top]);
            whole.put(&line(name, *width, label, max)?, [left, top + height]);
            left += width + GAP;
        }
        top += height + label + GAP;
    }
    Ok(whole)
}
