//! Tables that bake makes of a lobe's directional albedo: a header of ALBEDO_HEADER floats, then ALBEDO_KNOTS values over
//! the square root of the cosine, which gathers the knots at grazing angles.
//!
//! The header: 0 and 1 hold the constants c of the Gaussian distributions of lobes 0 and 1; 2 the mean of the table,
//! 2 integral E(mu) mu dmu; 3 to 5 the mean Fresnel reflectance of each channel; 6 a plastic's inner reflectance.

use crate::layout::{ALBEDO_HEADER, ALBEDO_KNOTS, SceneView, load_table};
use crate::shading::math::{clamp_, min_, mix_, sqrt_};

/// The table's value at a cosine (clamped to 0..1), linear between the knots. `first`: first float of the header.
#[inline]
pub fn albedo_at(scene: &SceneView, first: u32, cos_theta: f32) -> f32 {
    let last = (ALBEDO_KNOTS - 1) as f32;
    let x = last * sqrt_(clamp_(cos_theta, 0.0, 1.0));
    let whole = min_(x.floor(), last - 1.0);
    let at = first + ALBEDO_HEADER + whole as u32;
    mix_(load_table(scene, at), load_table(scene, at + 1), x - whole)
}
