//! Integer sums of samples, and what is made of them.

/// Pixels of the full frame: corner and size.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rect {
    pub x: u32,
    pub y: u32,
    pub width: u32,
    pub height: u32,
}

/// Signed fixed-point sums per pixel of a crop (placeholder body: the film helper fills it in).
#[derive(Clone, Debug)]
pub struct Film {
    pub crop: Rect,
}
