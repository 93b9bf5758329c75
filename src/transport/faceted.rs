//! Flat and Gouraud shading (row 8): a triangle is shaded at its centroid or at its corners instead of at the hit.
//! Source: Gouraud 1971, "Continuous Shading of Curved Surfaces".

use super::DITHER_CORNER;
use super::local::{COS_VIEW_MIN, ShadingPoint};
use crate::layout::{CAMERA_PERSPECTIVE, Hit, INSTANCE_FLAT, INSTANCE_GOURAUD, INVALID, Ray, SceneView};
use crate::shading::math::{dot3, max_, normalize3};
use crate::trace::surface::{Surface, surface_at};
use glam::Vec3;

/// Barycentric weight of the centroid, 1/3.
const THIRD: f32 = 0.33333334;
/// A shadow ray leaves a corner along its normal by this many error bounds: one above each triangle there whose normal
/// is within 75 degrees of the corner's.
const CORNER_LIFT: f32 = 4.0;

/// Whether an instance with these flags is shaded elsewhere than at its hits.
pub fn faceted(flags: u32) -> bool {
    (flags & (INSTANCE_FLAT | INSTANCE_GOURAUD)) != 0
}

/// At how many points a hit is shaded.
pub fn shading_points(flags: u32) -> u32 {
    if (flags & INSTANCE_GOURAUD) != 0 { 3 } else { 1 }
}

/// Unit direction from `position` to the camera. What is shaded at a corner or centroid is seen from there, not along
/// the ray, so that it is the same for every ray that hits the triangle.
pub fn to_camera(scene: &SceneView, position: Vec3) -> Vec3 {
    let camera = scene.header.camera;
    if camera.kind == CAMERA_PERSPECTIVE {
        return normalize3(camera.eye - position);
    }
    -normalize3(camera.forward)
}

/// Point number `index` at which `hit` of `ray` is shaded. `here`: the surface there. `flags`: of the hit instance.
pub fn shading_point(scene: &SceneView, ray: &Ray, hit: &Hit, here: &Surface, flags: u32, index: u32) -> ShadingPoint {
    if !faceted(flags) {
        return ShadingPoint {
            surface: *here,
            hit: *hit,
            shadow_from: *here,
            wo: -ray.direction,
            share: 1.0,
            dither: 0,
        };
    }
    let mut at = *hit;
    let mut share = 1.0;
    if (flags & INSTANCE_FLAT) != 0 {
        at.b1 = THIRD;
        at.b2 = THIRD;
    }
    if (flags & INSTANCE_GOURAUD) != 0 {
        at.b1 = if index == 1 { 1.0 } else { 0.0 };
        at.b2 = if index == 2 { 1.0 } else { 0.0 };
        share = if index == 1 {
            hit.b1
        } else if index == 2 {
            hit.b2
        } else {
            max_((1.0 - hit.b1) - hit.b2, 0.0)
        };
    }
    let mut surface = surface_at(scene, ray, &at);
    let mut wo = to_camera(scene, surface.position);
    if (flags & INSTANCE_FLAT) != 0 {
        surface.normal = surface.normal_geometric;
    }
    // A corner beyond the silhouette keeps its normal, and so its diffuse light; the view is bent.
    let side = if dot3(surface.normal_geometric, wo) < 0.0 { -1.0 } else { 1.0 };
    let normal = surface.normal * side;
    let cos_view = dot3(normal, wo);
    if cos_view < COS_VIEW_MIN {
        wo = normalize3(wo + normal * (COS_VIEW_MIN - cos_view));
    }
    let mut shadow_from = surface;
    if (flags & INSTANCE_GOURAUD) != 0 {
        // The same shadow ray for every triangle that shares the corner, or the picture would break at its edges.
        shadow_from.normal_geometric = surface.normal;
        shadow_from.primitive = INVALID;
        shadow_from.error = surface.error * CORNER_LIFT;
    }
    ShadingPoint { surface, hit: at, shadow_from, wo, share, dither: index * DITHER_CORNER }
}
