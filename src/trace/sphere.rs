//! The analytic unit sphere.

use super::box_::{SPHERE_SLACK, axis_slack, box_interval};
use super::ray::{LevelRay, lanes};
use crate::shading::math::{clamp_, dot3, max_, rcp, sqrt_};
use glam::Vec3;

/// Where the ray meets the unit sphere at the origin of its space: the smallest t > 0 among the roots that count, in
/// units of the ray's direction (not unit here); -1 for none. `near_counts`, `far_counts`: a ray that leaves the sphere
/// says by side, not by an epsilon, which roots are its own start (`Ray.skip_inward`).
/// Source: Haines, Guenther and Akenine-Moeller 2019, "Precision Improvements for Ray/Sphere Intersection" (Ray Tracing
/// Gems, chapter 7): the discriminant from the point of closest approach (equation 5), the roots without cancellation
/// (equations 9 and 10). The closest point is off per axis by at most 2^-24 (|o| + 16 |d| (|o.kz| + 1) / |d.kz|).
#[inline(always)]
pub fn intersect_sphere(ray: &LevelRay, near_counts: bool, far_counts: bool) -> f32 {
    let o = ray.origin;
    let d = ray.direction;
    let a = dot3(d, d);
    let b = -dot3(o, d);
    let scale = rcp(a);
    let closest = o + d * (b * scale);
    let discriminant = 1.0 - dot3(closest, closest);
    if discriminant < 0.0 {
        return -1.0;
    }
    let root = sqrt_(a * discriminant);
    let q = if b < 0.0 { b - root } else { b + root };
    if q == 0.0 {
        return -1.0;
    }
    let c = dot3(o, o) - 1.0;
    let t0 = c * rcp(q);
    let t1 = q * scale;
    let near = if b < 0.0 { t1 } else { t0 };
    let far = if b < 0.0 { t0 } else { t1 };
    let reach = max_(max_(o.x.abs(), o.y.abs()), o.z.abs()) + 1.0;
    let slack = axis_slack(ray, reach * SPHERE_SLACK);
    let interval = box_interval(ray, slack, lanes(-Vec3::ONE - o), lanes(Vec3::ONE - o));
    if interval.x > interval.y {
        return -1.0;
    }
    let near = clamp_(near, interval.x, interval.y);
    let far = clamp_(far, interval.x, interval.y);
    if near_counts && near > 0.0 {
        return near;
    }
    if far_counts && far > 0.0 {
        return far;
    }
    -1.0
}
