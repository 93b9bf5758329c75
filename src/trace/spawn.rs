//! Rays that start on a surface.

use super::surface::Surface;
use crate::layout::Ray;
use crate::shading::math::dot3;
use glam::Vec3;

/// A ray that leaves `surface` along `direction` (unit) and ends at `t_max`. It starts off the surface by its error
/// bound, along the geometric normal on the direction's side, so that rounding cannot put it on the wrong side of a
/// neighbour; the triangle (or the sphere's own root) it leaves is named, not found by an epsilon. Its cone goes on as
/// from a flat mirror: too narrow after a rough or convex surface, which costs noise and no sharpness.
/// Source: after Waechter and Binder 2019, "A Fast and Robust Method for Avoiding Self-Intersection" (Ray Tracing Gems,
/// chapter 6), with the bound of this surface's own arithmetic instead of a fixed number of ulps.
pub fn spawn_ray(surface: &Surface, direction: Vec3, t_max: f32) -> Ray {
    let inward = dot3(direction, surface.normal_geometric) < 0.0;
    let offset = if inward { -surface.error } else { surface.error };
    Ray {
        origin: surface.position + surface.normal_geometric * offset,
        t_max,
        direction,
        skip_instance: surface.instance,
        skip_primitive: surface.primitive,
        skip_inward: if inward { 1 } else { 0 },
        cone_width: surface.cone_width,
        cone_spread: surface.cone_spread,
    }
}

/// The same ray, gone on straight through `surface`: `direction` is its own, `t_max` counts from the surface.
pub fn spawn_through(surface: &Surface, direction: Vec3, t_max: f32) -> Ray {
    spawn_ray(surface, direction, t_max)
}
