//! The watertight ray-triangle test.

use super::box_::box_interval;
use super::ray::{LevelRay, lanes};
use crate::shading::math::{clamp_, min_, rcp};
use glam::Vec3;
use wide::f32x4;

/// Edge functions smaller than this (2^-86) count as 0, "on the edge": their products may have lost bits to subnormals.
const EDGE_LEAST: f32 = 1.2924697e-26;

const TRIANGLE_MISS: Vec3 = Vec3::new(-1.0, 0.0, 0.0);

/// Twice the signed areas of (c, b), (a, c) and (b, a) as seen along the ray, of the corners in lanes 0 to 2 of `x` and `y`;
/// the device computes them one by one. The area of (q, p) is exactly the negative of that of (p, q), so a ray between two
/// triangles that share an edge is on one side for one of them. Lane 3 becomes 0 or a NaN, which is on neither side.
#[inline(always)]
fn signed_area(x: f32x4, y: f32x4) -> f32x4 {
    let p = |v: f32x4| f32x4::new([v.to_array()[2], v.to_array()[0], v.to_array()[1], v.to_array()[3]]);
    let q = |v: f32x4| f32x4::new([v.to_array()[1], v.to_array()[2], v.to_array()[0], v.to_array()[3]]);
    let area = p(x) * q(y) - p(y) * q(x);
    area & !area.abs().simd_lt(f32x4::splat(EDGE_LEAST))
}

/// Where the ray meets the triangle `v0`, `v1`, `v2` (same space as the ray): (t, b1, b2) with the weights of corners
/// 1 and 2 in 0..1 and t > 0 in units of the ray's direction; t = -1 for a miss. `slack`: the `axis_slack` of the mesh
/// (`box_`, the bound, step 3). Both sides count. An edge value of 0 is
/// inside, so a ray through a shared edge or corner hits at least one of the triangles there.
/// Source: Woop, Benthin and Wald 2013, "Watertight Ray/Triangle Intersection", without the fallback to double
/// precision (single precision never gets a sign wrong, only to 0). t is kept in the interval of the triangle's own
/// box (`box_interval`), where it is except for triangles seen so edge-on that their weights are rounding noise.
#[inline(always)]
pub fn intersect_triangle(ray: &LevelRay, slack: Vec3, v0: &Vec3, v1: &Vec3, v2: &Vec3) -> Vec3 {
    let corners: [&[f32; 3]; 3] = [v0.as_ref(), v1.as_ref(), v2.as_ref()];
    let along = |k: u32| {
        let k = (k as usize).min(2);
        f32x4::new([corners[0][k], corners[1][k], corners[2][k], 0.0])
    };
    let [origin_x, origin_y, origin_z] = ray.permuted_origin.to_array();
    // Section 3.3: shear and permute.
    let z = along(ray.kz) - f32x4::splat(origin_z);
    let x = (along(ray.kx) - f32x4::splat(origin_x)) - f32x4::splat(ray.sx) * z;
    let y = (along(ray.ky) - f32x4::splat(origin_y)) - f32x4::splat(ray.sy) * z;
    // Section 3.4: scaled barycentric coordinates.
    let areas = signed_area(x, y);
    let negative = areas.simd_lt(f32x4::ZERO).to_bitmask();
    let positive = areas.simd_gt(f32x4::ZERO).to_bitmask();
    if negative != 0 && positive != 0 {
        return TRIANGLE_MISS;
    }
    let [u, v, w, _] = areas.to_array();
    let sum = (u + v) + w;
    if sum == 0.0 {
        return TRIANGLE_MISS;
    }
    let scale = rcp(sum);
    // rcp may err by an ulp: a weight is at most 1.
    let b0 = min_(u * scale, 1.0);
    let b1 = min_(v * scale, 1.0);
    let b2 = min_(w * scale, 1.0);
    let [az, bz, cz, _] = z.to_array();
    let origin = lanes(ray.origin);
    let (a, b, c) = (lanes(*v0) - origin, lanes(*v1) - origin, lanes(*v2) - origin);
    let low = a.fast_min(b).fast_min(c);
    let high = a.fast_max(b).fast_max(c);
    let interval = box_interval(ray, slack, low, high);
    if interval.x > interval.y {
        return TRIANGLE_MISS;
    }
    let t = clamp_(((b0 * az + b1 * bz) + b2 * cz) * ray.sz, interval.x, interval.y);
    if t > 0.0 { Vec3::new(t, b1, b2) } else { TRIANGLE_MISS }
}
