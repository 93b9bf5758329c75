//! What a ray has hit.

use super::ray::{object_origin, transform_point, transform_transposed, transform_vector};
use crate::layout::{Hit, INVALID, Instance, KIND_SPHERE, Ray, SceneView, load_face, load_instance, load_vertex};
use crate::shading::math::{INV_PI, INV_TWO_PI, acos_, atan2_, clamp_, cross3, dot3, max_, normalize3};
use glam::{Vec2, Vec3};

/// 2^-19: bound of a surface point's error relative to the size of the numbers it was made from (32 roundings: the
/// point's own, and those of bringing it into object space again).
const POSITION_ERROR: f32 = 1.9073486e-6;
/// Edges this close to parallel (sine) have no normal of their own in single precision.
const FLAT_LEAST: f32 = 1.0e-7;

/// A point on a surface, world space.
#[derive(Clone, Copy, Debug)]
pub struct Surface {
    pub position: Vec3,
    /// Unit, leaves the side from which the corners are counter-clockwise in object space (the outside of a closed
    /// mesh, and of a sphere); a mirroring transform keeps the outside outside.
    pub normal_geometric: Vec3,
    /// Unit, interpolated, on the same side as `normal_geometric`.
    pub normal: Vec3,
    /// v = 0 at the bottom of an image.
    pub uv: Vec2,
    /// Linear factor on the base colour.
    pub color: Vec3,
    /// The instance's material, or the face's.
    pub material: u32,
    pub object: u32,
    pub instance: u32,
    pub primitive: u32,
    /// `KIND_*`.
    pub kind: u32,
    /// Bound of the distance between `position` and the surface as rays see it, world units.
    pub error: f32,
    /// Width of the ray's cone here, and what it grows by per unit of distance.
    pub cone_width: f32,
    pub cone_spread: f32,
}

/// `v` made unit; `otherwise` if it is (as good as) zero.
fn unit_or(v: Vec3, otherwise: Vec3) -> Vec3 {
    let n = normalize3(v);
    if dot3(n, n) > 0.5 { n } else { otherwise }
}

/// A normal of object space in world space (inverse transpose), unit.
fn world_normal(instance: &Instance, normal: Vec3, otherwise: Vec3) -> Vec3 {
    unit_or(transform_transposed(instance.to_object, normal), otherwise)
}

/// The bound of `Surface.error` for a point whose object-space coordinates stay below `size`.
fn position_error(instance: &Instance, size: Vec3) -> f32 {
    let m = instance.to_world;
    let x = ((m[0].x.abs() * size.x + m[0].y.abs() * size.y) + m[0].z.abs() * size.z) + m[0].w.abs();
    let y = ((m[1].x.abs() * size.x + m[1].y.abs() * size.y) + m[1].z.abs() * size.z) + m[1].w.abs();
    let z = ((m[2].x.abs() * size.x + m[2].y.abs() * size.y) + m[2].z.abs() * size.z) + m[2].w.abs();
    max_(max_(x, y), z) * POSITION_ERROR
}

/// Longitude and latitude of a point on the unit sphere: u grows to the right as seen from outside with y up, 0.5
/// towards +z; v from 0 at -y to 1 at +y.
fn sphere_uv(p: Vec3) -> Vec2 {
    let u = if p.x == 0.0 && p.z == 0.0 { 0.5 } else { 0.5 + atan2_(p.x, p.z) * INV_TWO_PI };
    Vec2::new(u, acos_(clamp_(-p.y, -1.0, 1.0)) * INV_PI)
}

fn sphere_surface(instance: &Instance, ray: &Ray, hit: &Hit) -> Surface {
    let origin = object_origin(instance, ray.origin);
    let along = transform_vector(instance.to_object, ray.direction);
    let point = unit_or(origin + along * hit.t, Vec3::Z);
    let normal = world_normal(instance, point, Vec3::Z);
    Surface {
        position: transform_point(instance.to_world, point),
        normal_geometric: normal,
        normal,
        uv: sphere_uv(point),
        color: Vec3::ONE,
        material: instance.material,
        object: instance.object,
        instance: hit.instance,
        primitive: 0,
        kind: instance.kind,
        error: position_error(instance, Vec3::ONE),
        cone_width: ray.cone_width + ray.cone_spread * hit.t,
        cone_spread: ray.cone_spread,
    }
}

fn triangle_surface(scene: &SceneView, instance: &Instance, ray: &Ray, hit: &Hit) -> Surface {
    let face = load_face(scene, instance.first_face + hit.primitive);
    let p0 = load_vertex(scene, face.i0);
    let p1 = load_vertex(scene, face.i1);
    let p2 = load_vertex(scene, face.i2);
    let b1 = hit.b1;
    let b2 = hit.b2;
    let b0 = max_((1.0 - b1) - b2, 0.0);
    let point = (p0.position * b0 + p1.position * b1) + p2.position * b2;
    let size = Vec3::new(
        max_(max_(p0.position.x.abs(), p1.position.x.abs()), p2.position.x.abs()),
        max_(max_(p0.position.y.abs(), p1.position.y.abs()), p2.position.y.abs()),
        max_(max_(p0.position.z.abs(), p1.position.z.abs()), p2.position.z.abs()),
    );
    // Unit edges, so that the cross product of a tiny triangle is not lost.
    let side = cross3(unit_or(p1.position - p0.position, Vec3::ZERO), unit_or(p2.position - p0.position, Vec3::ZERO));
    let flat = max_(max_(side.x.abs(), side.y.abs()), side.z.abs()) < FLAT_LEAST;
    let geometric = world_normal(instance, if flat { p0.normal } else { side }, Vec3::Z);
    let smooth = (p0.normal * b0 + p1.normal * b1) + p2.normal * b2;
    let normal = world_normal(instance, smooth, geometric);
    Surface {
        position: transform_point(instance.to_world, point),
        normal_geometric: geometric,
        normal: if dot3(normal, geometric) < 0.0 { -normal } else { normal },
        uv: Vec2::new((p0.u * b0 + p1.u * b1) + p2.u * b2, (p0.v * b0 + p1.v * b1) + p2.v * b2),
        color: (p0.color * b0 + p1.color * b1) + p2.color * b2,
        material: if instance.material == INVALID { face.material } else { instance.material },
        object: instance.object,
        instance: hit.instance,
        primitive: hit.primitive,
        kind: instance.kind,
        error: position_error(instance, size),
        cone_width: ray.cone_width + ray.cone_spread * hit.t,
        cone_spread: ray.cone_spread,
    }
}

/// Where the texture coordinate u grows on `surface`, world space, any length; zero where it has no direction.
pub fn surface_tangent(scene: &SceneView, surface: &Surface) -> Vec3 {
    let instance = load_instance(scene, surface.instance);
    if instance.kind == KIND_SPHERE {
        let point = transform_point(instance.to_object, surface.position);
        return transform_vector(instance.to_world, Vec3::new(point.z, 0.0, -point.x));
    }
    let face = load_face(scene, instance.first_face + surface.primitive);
    let p0 = load_vertex(scene, face.i0);
    let p1 = load_vertex(scene, face.i1);
    let p2 = load_vertex(scene, face.i2);
    let dv1 = p1.v - p0.v;
    let dv2 = p2.v - p0.v;
    let area = (p1.u - p0.u) * dv2 - (p2.u - p0.u) * dv1;
    let along = (p1.position - p0.position) * dv2 - (p2.position - p0.position) * dv1;
    transform_vector(instance.to_world, if area < 0.0 { -along } else { along })
}

/// The surface at `hit`, which `trace_closest` found for `ray` (not a miss). The position is recomputed from the
/// barycentric weights or, on a sphere, pushed onto it, and does not inherit the error of t.
pub fn surface_at(scene: &SceneView, ray: &Ray, hit: &Hit) -> Surface {
    let instance = load_instance(scene, hit.instance);
    if instance.kind == KIND_SPHERE {
        sphere_surface(&instance, ray, hit)
    } else {
        triangle_surface(scene, &instance, ray, hit)
    }
}
