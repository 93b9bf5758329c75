//! Twins of warps, the tent filter, camera, texture coordinates and frames, in the order of
//! `shaders/kernels/parity/warp.comp`.

use super::{Family, In, Twin};
use crate::layout::Camera;
use crate::shading::camera::{camera_ray, through_lens};
use crate::shading::coordinate::{finite_or_zero, wrap_coordinate, wrap_texel};
use crate::shading::filter::sample_tent;
use crate::shading::frame::frame_from_tangent;
use crate::shading::sampling::{hash_u32, unit_float};
use crate::shading::warp::{
    cosine_hemisphere_pdf, cosine_hemisphere_to_square, disk_to_square, square_to_cosine_hemisphere, square_to_disk,
    square_to_uniform_hemisphere, square_to_uniform_sphere, square_to_uniform_triangle, uniform_hemisphere_pdf,
    uniform_sphere_pdf, uniform_sphere_to_square, uniform_triangle_to_square,
};
use crate::verify::inputs::Domain::{self, Below, Direction, Exponent, Range, Upper};
use glam::Vec2;

/// The bits of two sample points, as the samplers make them.
const POINT: [Domain; 2] = [Below(0), Below(0)];
/// Eye, right, up, forward, film point, kind, point of the lens.
const CAMERA: [Domain; 14] = {
    let side = Exponent(-6, 4);
    let eye = Exponent(-20, 20);
    let film = Range(-64.0, 1024.0);
    [eye, eye, eye, side, side, side, side, side, side, Direction, film, film, Below(2), Below(0)]
};

fn point(i: &In) -> Vec2 {
    Vec2::new(unit_float(i.u(0)), unit_float(i.u(1)))
}

/// 512 x 256 pixels, of the kind that argument word 14 names.
fn camera(i: &In) -> Camera {
    Camera {
        eye: i.v3(0),
        kind: i.u(14),
        right: i.v3(3),
        scale_x: 0.00390625,
        up: i.v3(6),
        scale_y: 0.0078125,
        forward: i.v3(9),
        lens_radius: 0.125,
        focus_distance: 3.0,
        shift_x: 0.3,
        shift_y: -0.7,
        ..Camera::default()
    }
}

/// A point of the lens from word 15.
fn on_lens(i: &In) -> Vec2 {
    square_to_disk(Vec2::new(unit_float(i.u(15)), unit_float(hash_u32(i.u(15)))))
}

pub const FAMILY: Family = Family {
    kernel: "parity/warp",
    twins: &[
        Twin {
            name: "square_to_disk",
            domains: &POINT,
            run: |i, o| {
                o.v2(square_to_disk(point(i)));
            },
        },
        Twin {
            name: "disk_to_square",
            domains: &[Range(-1.0, 1.0); 2],
            run: |i, o| {
                o.v2(disk_to_square(i.v2(0)));
            },
        },
        Twin {
            name: "square_to_cosine_hemisphere",
            domains: &POINT,
            run: |i, o| {
                o.v3(square_to_cosine_hemisphere(point(i)));
            },
        },
        Twin {
            name: "cosine_hemisphere_to_square",
            domains: &[Upper],
            run: |i, o| {
                o.v2(cosine_hemisphere_to_square(i.v3(0)));
            },
        },
        Twin {
            name: "square_to_uniform_hemisphere",
            domains: &POINT,
            run: |i, o| {
                o.v3(square_to_uniform_hemisphere(point(i)));
            },
        },
        Twin {
            name: "square_to_uniform_sphere",
            domains: &POINT,
            run: |i, o| {
                o.v3(square_to_uniform_sphere(point(i)));
            },
        },
        Twin {
            name: "uniform_sphere_to_square",
            domains: &[Direction],
            run: |i, o| {
                o.v2(uniform_sphere_to_square(i.v3(0)));
            },
        },
        Twin {
            name: "square_to_uniform_triangle uniform_triangle_to_square",
            domains: &POINT,
            run: |i, o| {
                o.v2(square_to_uniform_triangle(point(i))).v2(uniform_triangle_to_square(point(i)));
            },
        },
        Twin {
            name: "cosine_hemisphere_pdf uniform_hemisphere_pdf uniform_sphere_pdf",
            domains: &[Direction],
            run: |i, o| {
                let z = i.f(2);
                o.f(cosine_hemisphere_pdf(z)).f(uniform_hemisphere_pdf(z)).f(uniform_sphere_pdf());
            },
        },
        Twin {
            name: "sample_tent",
            domains: &[Below(0)],
            run: |i, o| {
                o.f(sample_tent(unit_float(i.u(0))));
            },
        },
        Twin {
            name: "camera_ray",
            domains: &CAMERA,
            run: |i, o| {
                let ray = camera_ray(&camera(i), i.f(12), i.f(13));
                o.v3(ray.origin).v3(ray.direction);
            },
        },
        // Infinities and NaNs are among these; subnormals are not: the function hands them on, and a device may not.
        Twin {
            name: "finite_or_zero",
            domains: &[Exponent(-126, 129)],
            run: |i, o| {
                o.f(finite_or_zero(i.f(0)));
            },
        },
        Twin {
            name: "wrap_coordinate",
            domains: &[Exponent(-60, 60), Below(3)],
            run: |i, o| {
                o.f(wrap_coordinate(i.f(0), i.u(1)));
            },
        },
        Twin {
            name: "wrap_texel",
            domains: &[Below(0), Below(65_535), Below(3)],
            run: |i, o| {
                o.u(wrap_texel(i.u(0) as i32, i.u(1) as i32 + 1, i.u(2)) as u32);
            },
        },
        Twin {
            name: "frame_from_tangent",
            domains: &[Direction, Exponent(-20, 20), Exponent(-20, 20), Exponent(-20, 20)],
            run: |i, o| {
                let frame = frame_from_tangent(i.v3(0), i.v3(3));
                o.v3(frame.tangent).v3(frame.bitangent);
            },
        },
        Twin {
            name: "through_lens",
            domains: &CAMERA,
            run: |i, o| {
                let ray = through_lens(&camera(i), camera_ray(&camera(i), i.f(12), i.f(13)), on_lens(i));
                o.v3(ray.origin).v3(ray.direction);
            },
        },
    ],
};
