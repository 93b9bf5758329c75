//! The watertight ray-triangle test.

use super::box_::box_interval;
use super::ray::{LevelRay, component};
use crate::shading::math::{clamp_, max_, min_, rcp};
use glam::Vec3;

/// Edge functions smaller than this (2^-86) count as 0, "on the edge": their products may have lost bits to subnormals.
const EDGE_LEAST: f32 = 1.2924697e-26;

const TRIANGLE_MISS: Vec3 = Vec3::new(-1.0, 0.0, 0.0);

/// Twice the signed area of (p, q) as seen along the ray. `signed_area(q, p)` is exactly its negative, so a ray
/// between two triangles that share an edge is on one side for one of them.
#[inline(always)]
fn signed_area(px: f32, py: f32, qx: f32, qy: f32) -> f32 {
    let area = px * qy - py * qx;
    if area.abs() < EDGE_LEAST { 0.0 } else { area }
}

/// Where the ray meets the triangle `v0`, `v1`, `v2` (same space as the ray): (t, b1, b2) with the weights of corners
/// 1 and 2 in 0..1 and t > 0 in units of the ray's direction; t = -1 for a miss. Both sides count. An edge value of 0 is
/// inside, so a ray through a shared edge or corner hits at least one of the triangles there.
/// Source: Woop, Benthin and Wald 2013, "Watertight Ray/Triangle Intersection", without the fallback to double
/// precision (single precision never gets a sign wrong, only to 0). t is kept in the interval of the triangle's own
/// box (`box_interval`), where it is except for triangles seen so edge-on that their weights are rounding noise.
#[inline(always)]
pub fn intersect_triangle(ray: &LevelRay, v0: Vec3, v1: Vec3, v2: Vec3) -> Vec3 {
    let a = v0 - ray.origin;
    let b = v1 - ray.origin;
    let c = v2 - ray.origin;
    // Section 3.3: shear and permute.
    let az = component(a, ray.kz);
    let bz = component(b, ray.kz);
    let cz = component(c, ray.kz);
    let ax = component(a, ray.kx) - ray.sx * az;
    let ay = component(a, ray.ky) - ray.sy * az;
    let bx = component(b, ray.kx) - ray.sx * bz;
    let by = component(b, ray.ky) - ray.sy * bz;
    let cx = component(c, ray.kx) - ray.sx * cz;
    let cy = component(c, ray.ky) - ray.sy * cz;
    // Section 3.4: scaled barycentric coordinates.
    let u = signed_area(cx, cy, bx, by);
    let v = signed_area(ax, ay, cx, cy);
    let w = signed_area(bx, by, ax, ay);
    if (u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0) {
        return TRIANGLE_MISS;
    }
    let sum = (u + v) + w;
    if sum == 0.0 {
        return TRIANGLE_MISS;
    }
    let scale = rcp(sum);
    // rcp may err by an ulp: a weight is at most 1.
    let b0 = min_(u * scale, 1.0);
    let b1 = min_(v * scale, 1.0);
    let b2 = min_(w * scale, 1.0);
    let low = Vec3::new(min_(min_(a.x, b.x), c.x), min_(min_(a.y, b.y), c.y), min_(min_(a.z, b.z), c.z));
    let high = Vec3::new(max_(max_(a.x, b.x), c.x), max_(max_(a.y, b.y), c.y), max_(max_(a.z, b.z), c.z));
    let interval = box_interval(ray, low, high);
    if interval.x > interval.y {
        return TRIANGLE_MISS;
    }
    let t = clamp_(((b0 * az + b1 * bz) + b2 * cz) * ray.sz, interval.x, interval.y);
    if t > 0.0 { Vec3::new(t, b1, b2) } else { TRIANGLE_MISS }
}
