//! Filter importance sampling: each camera sample is placed within its pixel's filter and touches that pixel only
//! (Ernst, Stamminger and Greiner 2006, "Filter Importance Sampling").

use glam::Vec2;

use super::math::*;
use crate::layout::{FILTER_BOX, FILTER_KNOTS, FILTER_TENT, SceneView, load_table};

/// Where in the pixel's filter a sample lies, and what it counts.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FilterSample {
    /// Pixels, from the pixel's centre.
    pub offset: Vec2,
    /// filter / density: 1 on average, negative in negative lobes.
    pub weight: f32,
}

/// A number in -1..1 with density 1 - |x|, for u in [0, 1).
#[inline]
pub fn sample_tent(u: f32) -> f32 {
    if u < 0.5 {
        return sqrt_(2.0 * u) - 1.0;
    }
    1.0 - sqrt_(2.0 - 2.0 * u)
}

/// One axis of a tabulated filter, u in [0, 1): x = offset in pixels, y = sign. A uniformly chosen interval of the
/// inverse CDF, a uniform place within: the density is constant in each interval. The sign is that of the filter, and
/// between -1 and 1 where the filter changes its sign within the interval.
#[inline]
pub fn sample_filter_table(scene: &SceneView, u: f32) -> Vec2 {
    let place = clamp_(u, 0.0, 0.99999994) * 256.0;
    let whole = place.floor();
    let interval = scene.header.filter_table + whole as u32;
    let low = load_table(scene, interval);
    let high = load_table(scene, interval + 1);
    let sign_ = load_table(scene, interval + (FILTER_KNOTS + 1));
    Vec2::new(low + (high - low) * (place - whole), sign_)
}

/// A sample of the scene's pixel filter for u in [0, 1)^2. Box and tent are exact; the error of tables is stated in
/// `bake/filter`.
#[inline]
pub fn sample_filter(scene: &SceneView, u: Vec2) -> FilterSample {
    let radius = scene.header.filter_radius;
    if scene.features.filter == FILTER_BOX {
        return FilterSample { offset: Vec2::new((2.0 * u.x - 1.0) * radius, (2.0 * u.y - 1.0) * radius), weight: 1.0 };
    }
    if scene.features.filter == FILTER_TENT {
        return FilterSample { offset: Vec2::new(sample_tent(u.x) * radius, sample_tent(u.y) * radius), weight: 1.0 };
    }
    let x = sample_filter_table(scene, u.x);
    let y = sample_filter_table(scene, u.y);
    FilterSample { offset: Vec2::new(x.x, y.x), weight: (x.y * y.y) * scene.header.filter_norm }
}
