//! Integer sums of samples, and what is made of them.
//!
//! [`Film`] adds, records and merges; [`Film::resolve`] makes an [`Image`] of it; `write` turns either into a file.

pub mod display;
mod error;
pub mod gfilm;
pub mod metrics;
pub mod output;
mod ranges;
pub mod read;
mod resolve;
mod sums;
pub mod tone;
pub mod write;

pub use error::{FilmError, MergeError};
pub use output::OutputFile;
pub use ranges::{MAX_SAMPLES, SampleRanges};
pub use resolve::{Aovs, Image};
pub use sums::{AovSums, Film, FilmSpec, SUM_BITS, sum_lanes, sum_record};

use serde::{Deserialize, Serialize};

/// Pixels of the full frame: corner and size.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rect {
    pub x: u32,
    pub y: u32,
    pub width: u32,
    pub height: u32,
}

impl Rect {
    /// The whole of a frame.
    pub fn whole(width: u32, height: u32) -> Self {
        Self { x: 0, y: 0, width, height }
    }

    /// Number of pixels.
    pub fn area(&self) -> usize {
        self.width as usize * self.height as usize
    }

    /// Whether every pixel of `other` is one of this rectangle's.
    pub fn contains(&self, other: &Rect) -> bool {
        let end = |corner: u32, size: u32| u64::from(corner) + u64::from(size);
        other.x >= self.x
            && other.y >= self.y
            && end(other.x, other.width) <= end(self.x, self.width)
            && end(other.y, other.height) <= end(self.y, self.height)
    }
}

impl std::fmt::Display for Rect {
    /// `WxH+X+Y`
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}x{}+{}+{}", self.width, self.height, self.x, self.y)
    }
}
