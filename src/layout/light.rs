//! Lights.

use bytemuck::{Pod, Zeroable};
use glam::Vec3;

use super::path::T_INFINITE;

pub const LIGHT_POINT: u32 = 0;
pub const LIGHT_DIRECTIONAL: u32 = 1;
pub const LIGHT_SPOT: u32 = 2;

/// Physical 1 / d^2.
pub const ATTENUATION_INVERSE_SQUARE: u32 = 0;
/// min(1, 1 / (c1 + c2 d + c3 d^2)).
pub const ATTENUATION_POLYNOMIAL: u32 = 1;
pub const ATTENUATION_NONE: u32 = 2;

/// Entries of the table array that describe a slide.
pub const SLIDE_ENTRIES: u32 = 10;

/// One light. 112 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct Light {
    pub position: Vec3,
    /// `LIGHT_*`.
    pub kind: u32,
    /// Unit, the way the light travels (directional and spot).
    pub direction: Vec3,
    /// `ATTENUATION_*`.
    pub attenuation: u32,
    /// Radiant intensity (W/sr), or irradiance for a directional light; radiometric (lecture units are converted by bake).
    pub intensity: Vec3,
    /// Cosine of the half angle where a spot ends.
    pub cos_outer: f32,
    /// c1, c2, c3 of the polynomial law.
    pub c: Vec3,
    /// Cosine of the half angle where a spot begins to fall off; equal to `cos_outer` for a hard edge.
    pub cos_inner: f32,
    /// Warn's flaps: the box of the world that the light reaches, from -`T_INFINITE`
    pub flaps_min: Vec3,
    /// Warn's exponent p: intensity times cos^p of the angle off the axis; 0 for none.
    pub exponent: f32,
    /// to `T_INFINITE` where there are none.
    pub flaps_max: Vec3,
    /// 1 if the light casts shadows.
    pub casts_shadow: u32,
    /// 1 if something stands in a spot's beam (`shading/slide`); `table` is then the first of its `SLIDE_ENTRIES`.
    pub slide: u32,
    pub table: u32,
    pub _pad0: u32,
    pub _pad1: u32,
}

impl Default for Light {
    /// Nothing but open flaps.
    fn default() -> Self {
        Self { flaps_min: Vec3::splat(-T_INFINITE), flaps_max: Vec3::splat(T_INFINITE), ..Self::zeroed() }
    }
}
