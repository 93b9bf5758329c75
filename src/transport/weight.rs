//! Decisions of a path that need no scene.

use crate::shading::math::{TINY, div, dot3, min_, rcp};
use crate::shading::spectrum::{Spectrum, spectrum_max};
use crate::trace::surface::Surface;
use glam::Vec3;

/// The largest probability of surviving Russian roulette: no path is endless between perfect mirrors.
const SURVIVAL_MOST: f32 = 0.95;

/// Weight of the first of two ways to draw a direction, with densities `own` and `other`: the power heuristic with
/// exponent 2 (Veach 1997, "Robust Monte Carlo Methods for Light Transport Simulation", section 9.2.4). `own` > 0.
#[inline]
pub fn power_heuristic(own: f32, other: f32) -> f32 {
    let ratio = div(other, own);
    rcp(1.0 + ratio * ratio)
}

/// Probability 0..1 that a path goes on after Russian roulette: its throughput, without the compression of light inside a
/// medium of index `eta`.
#[inline]
pub fn survival(throughput: Spectrum, eta: f32) -> f32 {
    min_(spectrum_max(throughput) * (eta * eta), SURVIVAL_MOST)
}

/// Whether light may go from `wo` to `wi` (world): on the shading frame and on the surface itself they must be on the same
/// side for reflection, on different sides for transmission. Else light would leak through the surface. Neither, where a
/// product of cosines is below TINY: devices may flush it to zero.
#[inline]
pub fn consistent(surface: &Surface, wo: Vec3, wi: Vec3, wo_local: Vec3, wi_local: Vec3) -> bool {
    let geometric = dot3(surface.normal_geometric, wo) * dot3(surface.normal_geometric, wi);
    let shading = wo_local.z * wi_local.z;
    (geometric >= TINY && shading >= TINY) || (geometric <= -TINY && shading <= -TINY)
}
