//! Lines, areas and words on a picture of either kind, in pixels from its upper left corner.

use super::figure::Color;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color as _, FontTransform, register_font};
use std::fmt::Display;
use std::sync::OnceLock;

/// The pictures' font: its licence is beside it.
static FONT: &[u8] = include_bytes!("font/NotoSans-Plot.ttf");
/// A list, as SVG takes it: where a viewer has no Noto Sans, another font without serifs is as good.
const FAMILY: &str = "Noto Sans, sans-serif";

/// Why a picture could not be drawn.
#[derive(Debug, thiserror::Error)]
#[error("cannot draw the picture: {0}")]
pub struct PlotError(String);

impl PlotError {
    pub fn new(reason: impl Display) -> Self {
        Self(reason.to_string())
    }
}

pub type Result<T> = std::result::Result<T, PlotError>;

/// Where a word stands relative to its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    Left,
    Centre,
    Right,
}

/// A line's look.
#[derive(Clone, Copy, Debug)]
pub struct Pen {
    pub color: Color,
    /// Pixels.
    pub width: f64,
    pub dashed: bool,
}

impl Pen {
    pub fn new(color: Color, width: f64) -> Self {
        Self { color, width, dashed: false }
    }
}

/// Length of a dash and of the gap after it, pixels.
const DASH: [f64; 2] = [7.0, 5.0];

/// A picture being drawn; the backend's pixels are `scale` times finer, since it knows whole numbers only.
pub struct Canvas<DB: DrawingBackend> {
    area: DrawingArea<DB, plotters::coord::Shift>,
    scale: f64,
}

fn rgb(color: Color) -> RGBColor {
    RGBColor(color[0], color[1], color[2])
}

impl<DB: DrawingBackend> Canvas<DB> {
    /// White.
    pub fn new(backend: DB, scale: f64) -> Result<Self> {
        static REGISTERED: OnceLock<bool> = OnceLock::new();
        let registered = REGISTERED.get_or_init(|| register_font(FAMILY, FontStyle::Normal, FONT).is_ok());
        debug_assert!(registered, "the embedded font is a font");
        let area = backend.into_drawing_area();
        area.fill(&WHITE).map_err(PlotError::new)?;
        Ok(Self { area, scale })
    }

    fn fine(&self, [x, y]: [f64; 2]) -> (i32, i32) {
        ((x * self.scale).round() as i32, (y * self.scale).round() as i32)
    }

    /// A line through `points`.
    pub fn line(&self, points: &[[f64; 2]], pen: Pen) -> Result<()> {
        let style = ShapeStyle { color: rgb(pen.color).to_rgba(), filled: false, stroke_width: self.stroke(pen.width) };
        let pieces = if pen.dashed { dashes(points) } else { vec![points.to_vec()] };
        for piece in pieces.iter().filter(|piece| piece.len() > 1) {
            let path: Vec<(i32, i32)> = piece.iter().map(|p| self.fine(*p)).collect();
            self.area.draw(&PathElement::new(path, style)).map_err(PlotError::new)?;
        }
        Ok(())
    }

    fn stroke(&self, width: f64) -> u32 {
        (width * self.scale).round().max(1.0) as u32
    }

    pub fn polygon(&self, corners: &[[f64; 2]], color: Color) -> Result<()> {
        let path: Vec<(i32, i32)> = corners.iter().map(|p| self.fine(*p)).collect();
        self.area.draw(&Polygon::new(path, rgb(color).filled())).map_err(PlotError::new)
    }

    /// `text` with its middle at the height of `at`; `size` in pixels.
    pub fn text(&self, text: &str, at: [f64; 2], size: f64, anchor: Anchor, color: Color) -> Result<()> {
        self.word(text, at, size, anchor, color, FontTransform::None)
    }

    /// `text` from bottom to top, centred at `at`.
    pub fn upward(&self, text: &str, at: [f64; 2], size: f64, color: Color) -> Result<()> {
        self.word(text, at, size, Anchor::Centre, color, FontTransform::Rotate270)
    }

    fn word(
        &self,
        text: &str,
        at: [f64; 2],
        size: f64,
        anchor: Anchor,
        color: Color,
        turn: FontTransform,
    ) -> Result<()> {
        let horizontal = match anchor {
            Anchor::Left => HPos::Left,
            Anchor::Centre => HPos::Center,
            Anchor::Right => HPos::Right,
        };
        let ink = rgb(color);
        let font = (FAMILY, size * self.scale).into_font().transform(turn);
        let style = TextStyle::from(font).color(&ink).pos(Pos::new(horizontal, VPos::Center));
        self.area.draw(&Text::new(text.to_owned(), self.fine(at), style)).map_err(PlotError::new)
    }

    pub fn finish(self) -> Result<()> {
        self.area.present().map_err(PlotError::new)
    }
}

/// Width of `text` in pixels.
pub fn text_width(text: &str, size: f64) -> f64 {
    // Half of an em on average; what is estimated too wide only leaves space.
    text.chars().count() as f64 * size * 0.52
}

/// `points` cut into dashes.
fn dashes(points: &[[f64; 2]]) -> Vec<Vec<[f64; 2]>> {
    let mut pieces = vec![vec![]];
    let (mut on, mut left) = (true, DASH[0]);
    for ends in points.windows(2) {
        let [a, b] = [ends[0], ends[1]];
        let length = libm::hypot(b[0] - a[0], b[1] - a[1]);
        let along = |t: f64| [a[0] + (b[0] - a[0]) * t / length, a[1] + (b[1] - a[1]) * t / length];
        let mut done = 0.0;
        while length > 0.0 && done < length {
            if on && pieces.last().is_some_and(Vec::is_empty) {
                pieces.last_mut().into_iter().for_each(|piece| piece.push(along(done)));
            }
            let step = left.min(length - done);
            (done, left) = (done + step, left - step);
            if on {
                pieces.last_mut().into_iter().for_each(|piece| piece.push(along(done)));
            }
            if left <= 0.0 {
                on = !on;
                left = DASH[usize::from(!on)];
                pieces.push(vec![]);
            }
        }
    }
    pieces
}
