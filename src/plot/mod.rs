//! Pictures of models: curves, lobes and colours, computed by the functions that render, as SVG, PNG or numbers.
//!
//! A plot is two steps: a function of `curves`, `lobes`, `albedo`, `edge` or `fit` makes a [`Figure`], and [`render`] draws it.

pub mod canvas;
pub mod curves;
mod draw;
pub mod edge;
pub mod figure;
pub mod fit;
pub mod lecture;
pub mod lobes;
pub mod page;
pub mod panels;
pub mod shelf;
mod simplex;

pub use canvas::PlotError;
pub use figure::Figure;

use crate::film::write::write_rgb8;
use canvas::{Canvas, Result};
use plotters::prelude::{BitMapBackend, SVGBackend};

/// File formats of plots.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    Svg,
    Png,
    /// The curves' numbers.
    Csv,
}

impl Format {
    /// By its name or a file's extension, in any case.
    pub fn from_name(name: &str) -> Option<Self> {
        match name.to_ascii_lowercase().as_str() {
            "svg" => Some(Self::Svg),
            "png" => Some(Self::Png),
            "csv" => Some(Self::Csv),
            _ => None,
        }
    }
}

/// Backends count in whole numbers: an SVG has quarters of pixels, a PNG averages 3 x 3 to one.
const SVG_SCALE: u32 = 4;
const PNG_SCALE: u32 = 3;

/// The file of a figure, `size` in pixels; the same figure gives the same bytes.
pub fn render(figure: &Figure, format: Format, size: [u32; 2]) -> Result<Vec<u8>> {
    match format {
        Format::Svg => svg(figure, size).map(String::into_bytes),
        Format::Png => png(figure, size),
        Format::Csv => Ok(figure.csv().into_bytes()),
    }
}

fn svg(figure: &Figure, size: [u32; 2]) -> Result<String> {
    let [width, height] = size.map(|pixels| pixels * SVG_SCALE);
    let mut text = String::new();
    let canvas = Canvas::new(SVGBackend::with_string(&mut text, (width, height)), f64::from(SVG_SCALE))?;
    draw::draw(&canvas, figure, size)?;
    canvas.finish()?;
    // The view box keeps the fine units; the picture has the size that was asked for.
    let fine = format!("width=\"{width}\" height=\"{height}\"");
    debug_assert!(text.contains(&fine), "{}", &text[..text.len().min(200)]);
    let text = text.replacen(&fine, &format!("width=\"{}\" height=\"{}\"", size[0], size[1]), 1);
    // Smoothed one by one, polygons beside each other would show seams.
    Ok(text.replacen('>', "><style>polygon{shape-rendering:crispEdges}</style>", 1))
}

fn png(figure: &Figure, size: [u32; 2]) -> Result<Vec<u8>> {
    let pixels = bitmap(figure, size)?;
    let mut file = Vec::new();
    write_rgb8(size[0], size[1], &pixels, &mut file).map_err(PlotError::new)?;
    Ok(file)
}

/// r, g, b of each pixel, rows from the top.
pub fn bitmap(figure: &Figure, size: [u32; 2]) -> Result<Vec<u8>> {
    let [width, height] = size.map(|pixels| (pixels * PNG_SCALE) as usize);
    let mut fine = vec![0u8; width * height * 3];
    let backend = BitMapBackend::with_buffer(&mut fine, (width as u32, height as u32));
    let canvas = Canvas::new(backend, f64::from(PNG_SCALE))?;
    draw::draw(&canvas, figure, size)?;
    canvas.finish()?;
    Ok(averaged(&fine, width, PNG_SCALE as usize))
}

/// Blocks of `scale` x `scale` pixels, each its mean.
fn averaged(fine: &[u8], width: usize, scale: usize) -> Vec<u8> {
    let height = fine.len() / (3 * width);
    let block = |x: usize, y: usize, channel: usize| {
        let rows = (0..scale).map(|j| &fine[3 * ((y * scale + j) * width + x * scale)..]);
        let sum: u32 = rows.map(|row| (0..scale).map(|i| u32::from(row[3 * i + channel])).sum::<u32>()).sum();
        let count = (scale * scale) as u32;
        ((sum + count / 2) / count) as u8
    };
    (0..height / scale)
        .flat_map(|y| (0..width / scale).flat_map(move |x| (0..3).map(move |channel| block(x, y, channel))))
        .collect()
}
