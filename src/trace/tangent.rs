//! How the texture coordinates of a surface run.

use super::ray::{transform_point, transform_vector};
use super::surface::Surface;
use crate::layout::{Hit, KIND_SPHERE, SceneView, load_face, load_instance, load_vertex};
use crate::shading::coordinate::finite_or_zero;
use crate::shading::footprint::{UvGradients, uv_gradients};
use crate::shading::math::{HUGE, PI, TINY, TWO_PI, rcp, sqrt_};
use glam::{Vec2, Vec3};

/// Change of position per unit of u and of v. Zero where the coordinates do not determine it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tangents {
    pub dp_du: Vec3,
    pub dp_dv: Vec3,
}

/// The tangents of a triangle with the edges `edge1` and `edge2` from corner 0, along which the coordinates change by
/// `uv1` and `uv2`.
#[inline]
pub fn triangle_tangents(edge1: Vec3, edge2: Vec3, uv1: Vec2, uv2: Vec2) -> Tangents {
    let area = finite_or_zero(uv1.x * uv2.y - uv1.y * uv2.x);
    if area.abs() < TINY || area.abs() > HUGE {
        return Tangents { dp_du: Vec3::ZERO, dp_dv: Vec3::ZERO };
    }
    let scale = rcp(area);
    Tangents { dp_du: (edge1 * uv2.y - edge2 * uv1.y) * scale, dp_dv: (edge2 * uv1.x - edge1 * uv2.x) * scale }
}

/// The tangents of the unit sphere at `p`, with longitude and latitude as coordinates (`sphere_uv`).
#[inline]
pub fn sphere_tangents(p: Vec3) -> Tangents {
    let radius = sqrt_(p.x * p.x + p.z * p.z);
    // Zero at the poles.
    let slant = (p.y * PI) * rcp(radius);
    Tangents {
        dp_du: Vec3::new(p.z * TWO_PI, 0.0, -(p.x * TWO_PI)),
        dp_dv: Vec3::new(-(p.x * slant), radius * PI, -(p.z * slant)),
    }
}

/// The gradients of the texture coordinates across the shading normal of `surface`, found for `hit`.
pub fn gradients_at(scene: &SceneView, surface: &Surface, hit: &Hit) -> UvGradients {
    let instance = load_instance(scene, hit.instance);
    let tangents = if instance.kind == KIND_SPHERE {
        sphere_tangents(transform_point(instance.to_object, surface.position))
    } else {
        let face = load_face(scene, instance.first_face + hit.primitive);
        let p0 = load_vertex(scene, face.i0);
        let p1 = load_vertex(scene, face.i1);
        let p2 = load_vertex(scene, face.i2);
        triangle_tangents(
            p1.position - p0.position,
            p2.position - p0.position,
            Vec2::new(p1.u - p0.u, p1.v - p0.v),
            Vec2::new(p2.u - p0.u, p2.v - p0.v),
        )
    };
    uv_gradients(
        transform_vector(instance.to_world, tangents.dp_du),
        transform_vector(instance.to_world, tangents.dp_dv),
        surface.normal,
    )
}
