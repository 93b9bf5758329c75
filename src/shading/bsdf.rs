//! What every model returns for a direction it has chosen.

use crate::shading::math::rcp;
use crate::shading::spectrum::{Spectrum, spectrum_zero};
use glam::Vec3;

/// A direction of zero width: `pdf` is the probability of having chosen it, and no light can be sampled towards it.
pub const SAMPLE_DELTA: u32 = 1;
/// `wi` is on the other side of the surface.
pub const SAMPLE_TRANSMIT: u32 = 2;

/// A direction to the light, drawn with density `pdf`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BsdfSample {
    /// Unit, local frame, leaving the surface.
    pub wi: Vec3,
    /// Per solid angle, or a probability (`SAMPLE_DELTA`); 0 if the sample is to be dropped.
    pub pdf: f32,
    /// f |cos theta_i| / pdf.
    pub weight: Spectrum,
    /// Index on the side of `wi` over the index on the side of `wo`: 1 unless `SAMPLE_TRANSMIT`.
    pub eta: f32,
    /// `SAMPLE_*`.
    pub flags: u32,
}

/// A sample of all its parts.
#[inline]
pub fn make_sample(wi: Vec3, pdf: f32, weight: Spectrum, eta: f32, flags: u32) -> BsdfSample {
    BsdfSample { wi, pdf, weight, eta, flags }
}

/// The sample that is to be dropped.
#[inline]
pub fn no_sample() -> BsdfSample {
    make_sample(Vec3::new(0.0, 0.0, 1.0), 0.0, spectrum_zero(), 1.0, 0)
}

/// The sample of a direction with what eval and pdf say of it. `value`: f |cos theta_i|.
#[inline]
pub fn finish_sample(wi: Vec3, pdf: f32, value: Spectrum, eta: f32, flags: u32) -> BsdfSample {
    // Below this the weight would mean nothing.
    if pdf <= 1.0e-12 {
        return no_sample();
    }
    make_sample(wi, pdf, value * rcp(pdf), eta, flags)
}
