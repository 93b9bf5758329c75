//! Tables for `shading/filter`: the inverse CDF of |filter|, one axis.
//!
//! A table has `FILTER_KNOTS` intervals of equal probability and constant density: what is drawn is a staircase of
//! equal areas instead of the smooth curve. Measured with weights against the filter (`tests/warp.rs`), the area
//! between the two is at most 1.5 % of the filter's for Gaussians and Blackman-Harris, 2.5 % for the Mitchell family and
//! 4.5 % for Lanczos. They differ most in the wide outermost intervals and around changes of sign: by up to 3 % of the
//! peak for Blackman-Harris and Gaussians of at least two sigma, 7.5 % for wider ones, 6 % for Mitchell and Lanczos.
//! Symmetry is exact, and weights average to 1 within rounding.

use crate::layout::{FILTER_BOX, FILTER_KNOTS, FILTER_TABLE, FILTER_TENT};
use crate::scene::settings::Filter;

/// What `SceneHeader` and the table array hold of a filter.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FilterTable {
    /// `FILTER_*`.
    pub kind: u32,
    /// Half width in pixels.
    pub radius: f32,
    /// (integral of |filter| / integral of filter)^2, for both axes.
    pub norm: f32,
    /// `FILTER_KNOTS` + 1 ascending positions in pixels, then `FILTER_KNOTS` signs; empty unless kind is `FILTER_TABLE`.
    pub table: Vec<f32>,
}

/// One axis of a filter, not normalised; 0 from `radius` on. x in pixels.
pub fn filter_value(filter: &Filter, x: f64) -> f64 {
    let x = x.abs();
    match *filter {
        Filter::Box { radius } => (x < radius as f64) as u32 as f64,
        Filter::Tent { radius } => (1.0 - x / radius as f64).max(0.0),
        Filter::Gaussian { radius, sigma } => {
            let gaussian = |x: f64| libm::exp(-x * x / (2.0 * sigma as f64 * sigma as f64));
            (gaussian(x) - gaussian(radius as f64)).max(0.0)
        }
        Filter::Mitchell { radius, b, c } => mitchell(2.0 * x / radius as f64, b as f64, c as f64),
        Filter::BlackmanHarris { radius } => blackman_harris(x / radius as f64),
        Filter::Lanczos { radius } if x < radius as f64 => sinc(x) * sinc(x / radius as f64),
        Filter::Lanczos { .. } => 0.0,
    }
}

/// The piecewise cubic of Mitchell and Netravali 1988, "Reconstruction filters in computer graphics", equation 8, for
/// x >= 0; 0 from 2 on.
fn mitchell(x: f64, b: f64, c: f64) -> f64 {
    let cubic = |k3: f64, k2: f64, k1: f64, k0: f64| (((k3 * x + k2) * x + k1) * x + k0) / 6.0;
    if x < 1.0 {
        cubic(12.0 - 9.0 * b - 6.0 * c, -18.0 + 12.0 * b + 6.0 * c, 0.0, 6.0 - 2.0 * b)
    } else if x < 2.0 {
        cubic(-b - 6.0 * c, 6.0 * b + 30.0 * c, -12.0 * b - 48.0 * c, 8.0 * b + 24.0 * c)
    } else {
        0.0
    }
}

/// The minimum four-term window of Harris 1978, "On the use of windows for harmonic analysis with the discrete Fourier
/// transform", equation 33 and table I, for x >= 0 in half widths; 0 from 1 on.
fn blackman_harris(x: f64) -> f64 {
    let cosine = |n: f64| libm::cos(n * std::f64::consts::PI * x);
    if x < 1.0 { 0.358_75 + 0.488_29 * cosine(1.0) + 0.141_28 * cosine(2.0) + 0.011_68 * cosine(3.0) } else { 0.0 }
}

/// sin(pi x) / (pi x).
fn sinc(x: f64) -> f64 {
    let angle = std::f64::consts::PI * x;
    // Below this the quotient is 1 to the last bit.
    if angle < 1.0e-9 { 1.0 } else { libm::sin(angle) / angle }
}

/// Prepares a filter for sampling. Box and tent need no table. Radius and sigma must be positive.
pub fn filter_table(filter: &Filter) -> FilterTable {
    match *filter {
        Filter::Box { radius } => FilterTable { kind: FILTER_BOX, radius, norm: 1.0, table: Vec::new() },
        Filter::Tent { radius } => FilterTable { kind: FILTER_TENT, radius, norm: 1.0, table: Vec::new() },
        Filter::Gaussian { radius, .. }
        | Filter::Mitchell { radius, .. }
        | Filter::BlackmanHarris { radius }
        | Filter::Lanczos { radius } => tabulate(filter, radius),
    }
}

/// Steps of the integration over half the filter; many more than intervals.
const STEPS: usize = 1 << 15;

/// The integrals of |filter| and filter from 0 to x, at every step.
struct HalfIntegral {
    size: Vec<f64>,
    signed: Vec<f64>,
}

impl HalfIntegral {
    /// Simpson's rule on each step.
    fn new(filter: &Filter, radius: f64) -> HalfIntegral {
        let at = |i: f64| filter_value(filter, radius * i / STEPS as f64);
        let (mut size, mut signed) = (vec![0.0], vec![0.0]);
        for i in 0..STEPS {
            let low = i as f64;
            let (a, m, b) = (at(low), at(low + 0.5), at(low + 1.0));
            size.push(size[i] + (a.abs() + 4.0 * m.abs() + b.abs()) / 6.0);
            signed.push(signed[i] + (a + 4.0 * m + b) / 6.0);
        }
        HalfIntegral { size, signed }
    }

    /// The place, in steps, where the integral of |filter| reaches `target`, and the integral of the filter up to there.
    fn find(&self, target: f64) -> (f64, f64) {
        let after = self.size.partition_point(|&size| size < target).clamp(1, STEPS);
        let step = self.size[after] - self.size[after - 1];
        let fraction = if step > 0.0 { (target - self.size[after - 1]) / step } else { 0.0 };
        let signed = self.signed[after - 1] + fraction * (self.signed[after] - self.signed[after - 1]);
        ((after - 1) as f64 + fraction, signed)
    }
}

fn tabulate(filter: &Filter, radius: f32) -> FilterTable {
    debug_assert!(radius > 0.0);
    let half = FILTER_KNOTS as usize / 2;
    let integral = HalfIntegral::new(filter, radius as f64);
    let total = integral.size[STEPS];

    let mut positions = vec![0.0f32; 2 * half + 1];
    let mut signs = vec![0.0f32; 2 * half];
    let mut before = 0.0;
    for k in 1..=half {
        let (place, signed) = integral.find(total * k as f64 / half as f64);
        let position = if k == half { radius } else { (radius as f64 * place / STEPS as f64) as f32 };
        let sign = ((signed - before) * half as f64 / total).clamp(-1.0, 1.0) as f32;
        before = signed;
        (positions[half + k], positions[half - k]) = (position, -position);
        (signs[half + k - 1], signs[half - k]) = (sign, sign);
    }

    // From the rounded signs, so that weights average to 1.
    let mean: f64 = signs.iter().map(|&sign| sign as f64).sum::<f64>() / signs.len() as f64;
    positions.extend(signs);
    FilterTable { kind: FILTER_TABLE, radius, norm: (1.0 / (mean * mean)) as f32, table: positions }
}
