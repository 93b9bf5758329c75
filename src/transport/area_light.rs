//! Triangles and spheres that glow, as seen from a point: sampling and density.

use crate::layout::{EMITTER_ONE_SIDED, Emitter, Instance};
use crate::shading::frame::{frame_from_normal, to_world};
use crate::shading::light::{LightSample, no_light};
use crate::shading::math::{INV_FOUR_PI, INV_TWO_PI, cos_turns, div, dot3, length3, max_, min_, rcp, sin_turns, sqrt_};
use crate::shading::spectrum::spectrum_from_rgb;
use crate::shading::warp::{square_to_uniform_sphere, square_to_uniform_triangle};
use crate::trace::ray::{transform_point, transform_vector};
use glam::{Vec2, Vec3};

/// A triangle seen under a smaller cosine is not sampled: its light through so thin a slit is nothing.
const COS_LEAST: f32 = 1.0e-6;
/// From closer to the unit sphere than this squared distance from its centre, or from inside, points are drawn on all of
/// it; from farther away in the cone of its visible cap.
const OUTSIDE: f32 = 1.0001;

/// Density per solid angle of a point drawn with `density` per area, seen at squared distance `distance2` under the
/// cosine `cos_light` between the surface's normal and the direction to it.
#[inline]
pub fn area_to_solid_angle(density: f32, distance2: f32, cos_light: f32) -> f32 {
    if cos_light < COS_LEAST { 0.0 } else { div(density * distance2, cos_light) }
}

/// A point of a triangle, uniform on its area, as seen from `position`. `u`: 0..1 each, excluding 1.
#[inline]
pub fn sample_triangle_light(emitter: &Emitter, position: Vec3, u: Vec2) -> LightSample {
    let b = square_to_uniform_triangle(u);
    let to_light = (emitter.corner - position) + (emitter.edge1 * b.x + emitter.edge2 * b.y);
    let distance = length3(to_light);
    let wi = to_light * rcp(distance);
    let cos_signed = -dot3(emitter.normal, wi);
    let one_sided = (emitter.flags & EMITTER_ONE_SIDED) != 0;
    let cos_light = if one_sided { cos_signed } else { cos_signed.abs() };
    let pdf = area_to_solid_angle(emitter.density, distance * distance, cos_light);
    if pdf <= 0.0 {
        return no_light();
    }
    let radiance = spectrum_from_rgb(emitter.radiance) * rcp(pdf);
    LightSample { wi, distance, radiance, pdf_solid_angle: pdf }
}

/// Solid angle at `direction` (object space, any length) over that of its image under the instance's transform.
#[inline]
pub fn solid_angle_ratio(instance: &Instance, direction: Vec3) -> f32 {
    let image = transform_vector(instance.to_world, direction);
    // Scaled to unit length first, so that neither tiny nor huge transforms leave the range of floats.
    let scale = div(length3(direction), length3(image));
    let [x, y, z] = instance.to_world.map(|row| row.truncate() * scale);
    let determinant = (x.x * (y.y * z.z - y.z * z.y) + x.y * (y.z * z.x - y.x * z.z)) + x.z * (y.x * z.y - y.y * z.x);
    rcp(determinant.abs())
}

/// 1 - cos of the half angle of the cone that the unit sphere fills from squared distance `distance2` (> 1).
#[inline]
pub fn cone_height(distance2: f32) -> f32 {
    let sin2 = rcp(distance2);
    sin2 * rcp(1.0 + sqrt_(max_(1.0 - sin2, 0.0)))
}

/// The point of the unit sphere that the direction `u` of the cone of its visible cap meets first from `origin`.
/// Source: Shirley, Wang and Zimmerman 1996, "Monte Carlo Techniques for Direct Lighting Calculations"; in the form of
/// Pharr, Jakob and Humphreys 2023, "Physically Based Rendering", section 6.2.4, which does not cancel for small cones.
#[inline]
pub fn cone_point(origin: Vec3, distance2: f32, u: Vec2) -> Vec3 {
    let height = u.x * cone_height(distance2);
    let cos_theta = 1.0 - height;
    let sin2_theta = height * (2.0 - height);
    let distance = sqrt_(distance2);
    // sin theta max = 1 / distance.
    let cos_alpha = sin2_theta * distance + cos_theta * sqrt_(max_(1.0 - sin2_theta * distance2, 0.0));
    let cos_bounded = min_(cos_alpha, 1.0);
    let sin_alpha = sqrt_(max_((1.0 - cos_bounded) * (1.0 + cos_bounded), 0.0));
    let to_viewer = frame_from_normal(origin * rcp(distance));
    to_world(to_viewer, Vec3::new(sin_alpha * cos_turns(u.y), sin_alpha * sin_turns(u.y), cos_bounded))
}

/// Density per solid angle of object space with which `sample_sphere_light` draws the point that `to_point` (not zero)
/// leads to from `origin`, all in the sphere's object space.
#[inline]
pub fn sphere_pdf(origin: Vec3, to_point: Vec3) -> f32 {
    let distance2 = dot3(origin, origin);
    if distance2 > OUTSIDE {
        return INV_TWO_PI * rcp(cone_height(distance2));
    }
    let length = length3(to_point);
    let normal = origin + to_point;
    let cos_light = dot3(normal, to_point).abs() * rcp(length);
    area_to_solid_angle(INV_FOUR_PI, length * length, cos_light)
}

/// A point of the sphere (under a transform: of the ellipsoid) that `instance` places, as seen from `position`.
#[inline]
pub fn sample_sphere_light(emitter: &Emitter, instance: &Instance, position: Vec3, u: Vec2) -> LightSample {
    let origin = transform_point(instance.to_object, position);
    let distance2 = dot3(origin, origin);
    let outside = distance2 > OUTSIDE;
    if !outside && (emitter.flags & EMITTER_ONE_SIDED) != 0 {
        return no_light();
    }
    let point = if outside { cone_point(origin, distance2, u) } else { square_to_uniform_sphere(u) };
    let to_point = point - origin;
    let to_light = transform_vector(instance.to_world, to_point);
    let distance = length3(to_light);
    let wi = to_light * rcp(distance);
    let pdf = (emitter.density * sphere_pdf(origin, to_point)) * solid_angle_ratio(instance, to_point);
    if pdf <= 0.0 || distance <= 0.0 {
        return no_light();
    }
    LightSample { wi, distance, radiance: spectrum_from_rgb(emitter.radiance) * rcp(pdf), pdf_solid_angle: pdf }
}
