//! Twins of rays and of what they meet, in the order of `shaders/kernels/parity/trace.comp`.
//!
//! Coordinates are normal numbers, as `bake` and `without_dust` leave them: what a device does with subnormals is free.

use super::{Family, In, Out, Twin};
use crate::layout::{Instance, KIND_MESH, Node, Ray};
use crate::trace::box_::{SLACK, axis_slack, box_interval, root_reach};
use crate::trace::ray::{
    LevelRay, component, lanes, object_origin, prepare_ray, transform_point, transform_transposed, transform_vector,
    within_reach,
};
use crate::trace::spawn::{spawn_ray, spawn_through};
use crate::trace::sphere::intersect_sphere;
use crate::trace::surface::Surface;
use crate::trace::triangle::intersect_triangle;
use crate::verify::inputs::Domain::{self, Below, Direction, Exponent, Range};
use glam::{Vec2, Vec3, Vec4};

/// A coordinate of ordinary size.
const PLAIN: Domain = Exponent(-20, 20);
/// A coordinate near a unit sphere or a triangle of about that size.
const NEAR: Domain = Exponent(-8, 2);
/// Any transform, and a point.
const PLACED: [Domain; 15] = [PLAIN; 15];
/// A transform and a point so small that `without_dust` has work.
const DUSTY: [Domain; 15] = {
    let mut domains = [PLAIN; 15];
    let small = Exponent(-64, -56);
    (domains[3], domains[7], domains[11]) = (small, small, small);
    (domains[12], domains[13], domains[14]) = (small, small, small);
    domains
};
/// Origin, corners, and the weights of corners 1 and 2 where the ray aims; some of them outside.
const AIMED: [Domain; 14] = {
    let mut domains = [NEAR; 14];
    (domains[12], domains[13]) = (Range(-0.25, 1.0), Range(-0.25, 1.0));
    domains
};
/// Position, normal, error and primitive of a surface; direction and length of the ray that leaves it.
const LEAVING: [Domain; 8] =
    [PLAIN, PLAIN, PLAIN, Direction, Exponent(-40, -10), Below(0), Direction, Exponent(-10, 99)];

fn rows(i: &In) -> [Vec4; 3] {
    [i.v4(0), i.v4(4), i.v4(8)]
}

/// A surface at argument words 0 to 7: position, normal, error, primitive.
fn surface(i: &In) -> Surface {
    Surface {
        position: i.v3(0),
        normal_geometric: i.v3(3),
        normal: i.v3(3),
        uv: Vec2::ZERO,
        color: Vec3::ONE,
        material: 0,
        object: 0,
        instance: 7,
        primitive: i.u(7),
        kind: KIND_MESH,
        error: i.f(6),
        cone_width: 0.25,
        cone_spread: 0.125,
    }
}

/// A ray from `origin` at the point of a triangle with the weights of argument words 12 and 13.
fn aimed_ray(i: &In, origin: Vec3, v0: Vec3, v1: Vec3, v2: Vec3) -> LevelRay {
    let (b1, b2) = (i.f(12), i.f(13));
    let target = (v0 * ((1.0 - b1) - b2) + v1 * b1) + v2 * b2;
    prepare_ray(origin, target - origin)
}

fn spawned(ray: Ray, o: &mut Out) {
    o.v3(ray.origin).f(ray.t_max).u(ray.skip_instance).u(ray.skip_primitive).u(ray.skip_inward).f(ray.direction.z);
}

pub const FAMILY: Family = Family {
    kernel: "parity/trace",
    twins: &[
        Twin {
            name: "component",
            domains: &[PLAIN, PLAIN, PLAIN, Below(3)],
            run: |i, o| {
                o.f(component(i.v3(0), i.u(3)));
            },
        },
        Twin {
            name: "prepare_ray",
            domains: &[PLAIN, PLAIN, PLAIN, Exponent(-38, 38), Exponent(-38, 38), Exponent(-38, 38)],
            run: |i, o| {
                let ray = prepare_ray(i.v3(0), i.v3(3));
                o.v3(ray.direction).v3(ray.inverse).u(ray.kz).u(ray.octant);
            },
        },
        Twin {
            name: "prepare_ray's shear",
            domains: &[PLAIN, PLAIN, PLAIN, Direction],
            run: |i, o| {
                let ray = prepare_ray(i.v3(0), i.v3(3));
                o.f(ray.sx).f(ray.sy).f(ray.sz).u(ray.kx).u(ray.ky);
            },
        },
        Twin {
            name: "within_reach",
            domains: &[Exponent(30, 42); 3],
            run: |i, o| {
                o.u(u32::from(within_reach(i.v3(0))));
            },
        },
        Twin {
            name: "transform_point transform_vector",
            domains: &PLACED,
            run: |i, o| {
                o.v3(transform_point(rows(i), i.v3(12))).v3(transform_vector(rows(i), i.v3(12)));
            },
        },
        Twin {
            name: "transform_transposed object_origin",
            domains: &DUSTY,
            run: |i, o| {
                let instance = Instance { to_object: rows(i), ..Instance::default() };
                o.v3(transform_transposed(rows(i), i.v3(12))).v3(object_origin(&instance, i.v3(12)));
            },
        },
        Twin {
            name: "box_interval axis_slack root_reach",
            domains: &[Direction, PLAIN, PLAIN, PLAIN, PLAIN, PLAIN, PLAIN, Exponent(-30, 0), Below(0x0010_0000)],
            run: |i, o| {
                let ray = prepare_ray(Vec3::ZERO, i.v3(0));
                let slack = axis_slack(&ray, i.f(9));
                let root =
                    Node { origin: i.v3(3), exponents_imask: 0x0068_6868 + (i.u(10) & 0x000f_0f0f), ..Node::default() };
                o.v2(box_interval(&ray, slack, lanes(i.v3(3)), lanes(i.v3(6)))).v3(slack).f(root_reach(&root, &ray));
            },
        },
        Twin {
            name: "intersect_triangle",
            domains: &AIMED,
            run: |i, o| {
                let (v0, v1, v2) = (i.v3(3), i.v3(6), i.v3(9));
                let ray = aimed_ray(i, i.v3(0), v0, v1, v2);
                o.v3(intersect_triangle(&ray, axis_slack(&ray, SLACK), &v0, &v1, &v2));
            },
        },
        Twin {
            name: "intersect_sphere",
            domains: &[NEAR, NEAR, NEAR, Direction, Exponent(-8, 8), Below(4)],
            run: |i, o| {
                let ray = prepare_ray(i.v3(0), i.v3(3) * i.f(6));
                o.f(intersect_sphere(&ray, i.u(7) & 1 != 0, i.u(7) & 2 != 0));
            },
        },
        Twin { name: "spawn_ray", domains: &LEAVING, run: |i, o| spawned(spawn_ray(&surface(i), i.v3(8), i.f(11)), o) },
        Twin {
            name: "spawn_through",
            domains: &LEAVING,
            run: |i, o| spawned(spawn_through(&surface(i), i.v3(8), i.f(11)), o),
        },
    ],
};
