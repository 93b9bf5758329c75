//! The unit square bent onto disks, hemispheres, spheres and triangles.
//!
//! Points `u` come from [0, 1)^2; hemispheres and spheres have their pole at +z. Densities are per solid angle, and
//! uniform unless said otherwise.

use glam::{Vec2, Vec3};

use super::math::*;

/// A point of the unit disk; concentric squares become concentric circles (Shirley and Chiu 1997, "A low distortion
/// map between disk and square").
#[inline]
pub fn square_to_disk(u: Vec2) -> Vec2 {
    let a = 2.0 * u.x - 1.0;
    let b = 2.0 * u.y - 1.0;
    let wide = a.abs() > b.abs();
    let radius = if wide { a } else { b };
    // The angle from the nearer axis, an eighth of a turn at most.
    let turns = 0.125 * div(if wide { b } else { a }, radius);
    let major = radius * cos_turns(turns);
    let minor = radius * sin_turns(turns);
    if wide { Vec2::new(major, minor) } else { Vec2::new(minor, major) }
}

/// The inverse of `square_to_disk`, within 1e-6 in the disk.
#[inline]
pub fn disk_to_square(p: Vec2) -> Vec2 {
    let wide = p.x.abs() > p.y.abs();
    let major = if wide { p.x } else { p.y };
    let minor = if wide { p.y } else { p.x };
    let radius = sqrt_(dot2(p, p));
    // 8 / (2 pi): -1..1 for an eighth of a turn each way.
    let turned = 1.27323949 * atan2_(minor, major.abs());
    let a = 0.5 + 0.5 * (if major < 0.0 { -radius } else { radius });
    let b = 0.5 + 0.5 * (turned * radius);
    if wide { Vec2::new(a, b) } else { Vec2::new(b, a) }
}

/// A direction with density cos / pi: the disk lifted onto the hemisphere (Malley's method).
#[inline]
pub fn square_to_cosine_hemisphere(u: Vec2) -> Vec3 {
    let p = square_to_disk(u);
    Vec3::new(p.x, p.y, sqrt_(1.0 - dot2(p, p)))
}

/// cos / pi; 0 below the horizon.
#[inline]
pub fn cosine_hemisphere_pdf(cos_theta: f32) -> f32 {
    max_(cos_theta, 0.0) * INV_PI
}

/// The inverse of `square_to_cosine_hemisphere`, within 1e-6.
#[inline]
pub fn cosine_hemisphere_to_square(w: Vec3) -> Vec2 {
    disk_to_square(Vec2::new(w.x, w.y))
}

/// A direction of the upper hemisphere: u.x is 1 - height, u.y the azimuth (Archimedes' hat box).
#[inline]
pub fn square_to_uniform_hemisphere(u: Vec2) -> Vec3 {
    // 1 - z^2 for z = 1 - u.x, without cancellation.
    let radius = sqrt_(u.x * (2.0 - u.x));
    Vec3::new(radius * cos_turns(u.y), radius * sin_turns(u.y), 1.0 - u.x)
}

/// 1 / (2 pi); 0 below the horizon.
#[inline]
pub fn uniform_hemisphere_pdf(cos_theta: f32) -> f32 {
    if cos_theta > 0.0 { INV_TWO_PI } else { 0.0 }
}

/// A direction: u.x is the height from the top downwards, u.y the azimuth.
#[inline]
pub fn square_to_uniform_sphere(u: Vec2) -> Vec3 {
    // 1 - z^2 for z = 1 - 2 u.x, without cancellation.
    let radius = 2.0 * sqrt_(u.x * (1.0 - u.x));
    Vec3::new(radius * cos_turns(u.y), radius * sin_turns(u.y), 1.0 - 2.0 * u.x)
}

/// 1 / (4 pi).
#[inline]
pub fn uniform_sphere_pdf() -> f32 {
    INV_FOUR_PI
}

/// The inverse of `square_to_uniform_sphere`, within 1e-6 (u.y is 0 at the poles, and 1 may stand for 0).
#[inline]
pub fn uniform_sphere_to_square(w: Vec3) -> Vec2 {
    let turns = INV_TWO_PI * atan2_(w.y, w.x);
    Vec2::new(0.5 - 0.5 * w.z, if turns < 0.0 { turns + 1.0 } else { turns })
}

/// Barycentric coordinates of the second and third corner, both >= 0, sum < 1 (Heitz 2019, "A Low-Distortion Map
/// Between Triangle and Square").
#[inline]
pub fn square_to_uniform_triangle(u: Vec2) -> Vec2 {
    if u.y > u.x {
        let half_ = 0.5 * u.x;
        return Vec2::new(half_, u.y - half_);
    }
    let half_ = 0.5 * u.y;
    Vec2::new(u.x - half_, half_)
}

/// The inverse of `square_to_uniform_triangle`.
#[inline]
pub fn uniform_triangle_to_square(b: Vec2) -> Vec2 {
    if b.y > b.x {
        return Vec2::new(2.0 * b.x, b.y + b.x);
    }
    Vec2::new(b.x + b.y, 2.0 * b.y)
}
