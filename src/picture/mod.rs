//! Files of light, OpenEXR and Radiance, as linear numbers.

mod channels;
pub mod chromaticity;
pub mod exr;
pub mod radiance;

/// What the numbers of a picture are for: where the formats leave a choice, this decides.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// Colours, in linear Rec. 709: what lies in the display window, 0 where there is no data.
    Colors,
    /// Numbers as they were stored; the window as for colours.
    Data,
    /// One picture beside another. Colours, but of the display window only what there is data for: a crop is a picture.
    Compared,
    /// As Mitsuba 3.9.1 reads its textures, colours and numbers alike: the data window alone, other chromaticities converted
    /// without adaptation of white, EXPOSURE and COLORCORR ignored, XYZ under D65.
    Mitsuba,
}

/// Linear numbers, from the top row down.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    pub width: u32,
    pub height: u32,
    /// r, g, b, alpha, as they were stored: any of them may be negative, infinite or no number.
    pub pixels: Vec<[f32; 4]>,
}

/// Refuses a width and height before memory is taken for them.
pub type SizeCheck<'a, E> = &'a dyn Fn(u64, u64) -> Result<(), E>;
