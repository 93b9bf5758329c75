//! Pictures side by side as one, with their names in the plots' font.

use super::canvas::{Anchor, Canvas, PlotError, Result, text_width};
use plotters::prelude::BitMapBackend;

/// An 8-bit sRGB picture: r, g, b of each pixel, rows from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    pub width: u32,
    pub height: u32,
    pub pixels: Vec<u8>,
}

/// Height of the line of names, and the gap between pictures, pixels.
const LINE: u32 = 30;
const GAP: u32 = 6;
const INK: [u8; 3] = [30, 30, 30];

impl Picture {
    fn white(width: u32, height: u32) -> Self {
        Self { width, height, pixels: vec![255; (width * height * 3) as usize] }
    }

    /// Lays `other` over the picture, its upper left corner at `at`, both inside.
    fn put(&mut self, other: &Picture, at: [u32; 2]) {
        debug_assert!(at[0] + other.width <= self.width && at[1] + other.height <= self.height, "{at:?}");
        for row in 0..other.height {
            let from = (row * other.width * 3) as usize;
            let to = (((at[1] + row) * self.width + at[0]) * 3) as usize;
            let length = other.width as usize * 3;
            self.pixels[to..to + length].copy_from_slice(&other.pixels[from..from + length]);
        }
    }

    /// The picture as a PNG file.
    pub fn png(&self) -> Result<Vec<u8>> {
        let mut file = Vec::new();
        crate::film::write::write_rgb8(self.width, self.height, &self.pixels, &mut file).map_err(PlotError::new)?;
        Ok(file)
    }
}

/// A line of names, each in the middle of its part of `width`.
fn line(names: &[&str], width: u32) -> Result<Picture> {
    const FINE: u32 = super::PNG_SCALE;
    let part = f64::from(width) / names.len().max(1) as f64;
    let widest = names.iter().map(|name| text_width(name, 1.0)).fold(1.0, f64::max);
    let size = (part * 0.94 / widest).clamp(9.0, 19.0);
    let mut fine = vec![0u8; (width * FINE * LINE * FINE * 3) as usize];
    let canvas = Canvas::new(BitMapBackend::with_buffer(&mut fine, (width * FINE, LINE * FINE)), f64::from(FINE))?;
    for (i, name) in names.iter().enumerate() {
        canvas.text(name, [part * (i as f64 + 0.5), f64::from(LINE) * 0.5], size, Anchor::Centre, INK)?;
    }
    canvas.finish()?;
    Ok(Picture { width, height: LINE, pixels: super::averaged(&fine, (width * FINE) as usize, FINE as usize) })
}

/// One picture with a line of names under it, each under an equal part.
pub fn labelled(picture: &Picture, names: &[&str]) -> Result<Picture> {
    if names.is_empty() {
        return Ok(picture.clone());
    }
    let mut whole = Picture::white(picture.width, picture.height + LINE);
    whole.put(picture, [0, 0]);
    whole.put(&line(names, picture.width)?, [0, picture.height]);
    Ok(whole)
}

/// Pictures of one size side by side, each with its name below.
pub fn side_by_side(pictures: &[(&str, Picture)]) -> Result<Picture> {
    let count = pictures.len() as u32;
    let width = pictures.iter().map(|(_, picture)| picture.width).sum::<u32>() + GAP * count.saturating_sub(1);
    let height = pictures.iter().map(|(_, picture)| picture.height).max().unwrap_or(0) + LINE;
    let mut whole = Picture::white(width, height);
    let mut left = 0;
    for (name, picture) in pictures {
        whole.put(&labelled(picture, &[name])?, [left, 0]);
        left += picture.width + GAP;
    }
    Ok(whole)
}
