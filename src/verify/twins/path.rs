//! Twins of the environment's grid, of lights with a size and of a path's decisions, in the order of
//! `shaders/kernels/parity/path.comp`.

use super::{Family, In, Out, Twin};
use crate::layout::{EMITTER_TRIANGLE, Emitter, Instance, KIND_MESH};
use crate::shading::environment::{
    bilinear, equirectangular_direction, equirectangular_uv, gradient_pdf, grid_place, grid_uv, rotate_from, rotate_to,
    sample_linear,
};
use crate::shading::interior::{cross_interface, interior_add, interior_remove, interior_top};
use crate::shading::light::{LightSample, no_light};
use crate::shading::math::{cross3, dot3, normalize3};
use crate::trace::surface::Surface;
use crate::transport::area_light::{
    area_to_solid_angle, cone_height, cone_point, sample_sphere_light, sample_triangle_light, solid_angle_ratio,
    sphere_pdf,
};
use crate::transport::weight::{consistent, power_heuristic, survival};
use crate::verify::inputs::Domain::{self, Below, Direction, Exponent, Range};
use glam::{Vec2, Vec3, Vec4};

const UNIT: Domain = Range(0.0, 1.0);
/// A coordinate of a light of ordinary size near the point it lights.
const NEAR: Domain = Exponent(-8, 4);
/// Anything a density or a weight may be.
const ANY: Domain = Exponent(-60, 60);
/// Corner and edges, or the rows of a linear map; the point lit; two random numbers; flags.
const LIGHT: [Domain; 15] = {
    let mut domains = [NEAR; 15];
    (domains[12], domains[13], domains[14]) = (UNIT, UNIT, Below(4));
    domains
};

fn emitter(i: &In) -> Emitter {
    let (edge1, edge2) = (i.v3(3), i.v3(6));
    Emitter {
        corner: i.v3(0),
        kind: EMITTER_TRIANGLE,
        edge1,
        edge2,
        normal: normalize3(cross3(edge1, edge2)),
        density: 0.375,
        radiance: Vec3::new(2.0, 1.0, 0.5),
        flags: i.u(14),
        ..Emitter::default()
    }
}

fn instance(i: &In) -> Instance {
    let rows = [0, 3, 6].map(|at| i.v3(at).extend(0.25));
    Instance { to_world: rows, to_object: rows, ..Instance::default() }
}

fn light(lit: LightSample, o: &mut Out) {
    o.v3(lit.wi).f(lit.distance).v3(lit.radiance.truncate()).f(lit.pdf_solid_angle);
}

fn rows(i: &In) -> [Vec4; 3] {
    [0, 3, 6].map(|at| i.v3(at).extend(0.0))
}

fn surface(normal: Vec3) -> Surface {
    Surface {
        position: Vec3::ZERO,
        normal_geometric: normal,
        normal,
        uv: Vec2::ZERO,
        color: Vec3::ONE,
        material: 0,
        object: 0,
        instance: 0,
        primitive: 0,
        kind: KIND_MESH,
        error: 0.0,
        cone_width: 0.0,
        cone_spread: 0.0,
    }
}

pub const FAMILY: Family = Family {
    kernel: "parity/path",
    twins: &[
        Twin {
            name: "sample_linear",
            domains: &[UNIT, Range(0.0, 100.0), Range(0.0, 100.0)],
            run: |i, o| {
                o.f(sample_linear(i.f(0), i.f(1), i.f(2)));
            },
        },
        Twin {
            name: "bilinear",
            domains: &[NEAR, NEAR, NEAR, NEAR, UNIT, UNIT],
            run: |i, o| {
                o.f(bilinear(i.f(0), i.f(1), i.f(2), i.f(3), i.f(4), i.f(5)));
            },
        },
        Twin {
            name: "rotate_to rotate_from",
            domains: &[Direction; 4],
            run: |i, o| {
                o.v3(rotate_to(rows(i), i.v3(9))).v3(rotate_from(rows(i), i.v3(9)));
            },
        },
        Twin {
            name: "equirectangular_direction",
            domains: &[UNIT; 2],
            run: |i, o| {
                o.v3(equirectangular_direction(i.v2(0)));
            },
        },
        Twin {
            name: "equirectangular_uv",
            domains: &[Direction],
            run: |i, o| {
                o.v2(equirectangular_uv(i.v3(0)));
            },
        },
        Twin {
            name: "grid_place grid_uv",
            domains: &[UNIT, UNIT, UNIT, Below(65_535), Below(65_535)],
            run: |i, o| {
                let (width, height) = (i.u(3) + 1, i.u(4) + 1);
                let place = grid_place(width, height, i.v2(0));
                o.u(place.column).u(place.row).f(place.x).f(place.y).v2(grid_uv(width, height, place));
            },
        },
        Twin {
            name: "gradient_pdf",
            domains: &[Range(0.0, 100.0), Range(0.0, 100.0), UNIT],
            run: |i, o| {
                o.f(gradient_pdf(i.v2(0), i.f(2)));
            },
        },
        Twin {
            name: "power_heuristic",
            domains: &[ANY, ANY],
            run: |i, o| {
                o.f(power_heuristic(i.f(0).abs(), i.f(1).abs()));
            },
        },
        Twin {
            name: "area_to_solid_angle",
            domains: &[NEAR, NEAR, UNIT],
            run: |i, o| {
                o.f(area_to_solid_angle(i.f(0).abs(), i.f(1).abs(), i.f(2)));
            },
        },
        Twin {
            name: "sample_triangle_light",
            domains: &LIGHT,
            run: |i, o| light(sample_triangle_light(&emitter(i), i.v3(9), i.v2(12)), o),
        },
        Twin {
            name: "solid_angle_ratio",
            domains: &[NEAR; 12],
            run: |i, o| {
                o.f(solid_angle_ratio(&instance(i), i.v3(9)));
            },
        },
        Twin {
            name: "cone_height cone_point",
            domains: &[NEAR, NEAR, NEAR, UNIT, UNIT],
            run: |i, o| {
                let distance2 = 1.0001 + dot3(i.v3(0), i.v3(0));
                o.f(cone_height(distance2)).v3(cone_point(i.v3(0), distance2, i.v2(3)));
            },
        },
        Twin {
            name: "sphere_pdf",
            domains: &[NEAR; 6],
            run: |i, o| {
                o.f(sphere_pdf(i.v3(0), i.v3(3)));
            },
        },
        Twin {
            name: "sample_sphere_light",
            domains: &LIGHT,
            run: |i, o| light(sample_sphere_light(&emitter(i), &instance(i), i.v3(9), i.v2(12)), o),
        },
        Twin {
            name: "survival",
            domains: &[ANY, ANY, ANY, ANY, Range(0.3, 3.0)],
            run: |i, o| {
                o.f(survival(i.v3(0).abs().extend(i.f(3).abs()), i.f(4)));
            },
        },
        Twin {
            name: "consistent",
            domains: &[Direction; 5],
            run: |i, o| {
                o.u(u32::from(consistent(&surface(i.v3(0)), i.v3(3), i.v3(6), i.v3(9), i.v3(12))));
            },
        },
        Twin {
            name: "no_light",
            domains: &[],
            run: |_, o| {
                o.f(no_light().pdf_solid_angle).v3(no_light().wi);
            },
        },
        Twin {
            name: "interior_add interior_remove interior_top cross_interface",
            domains: &[Below(0), Below(4), Below(21), Below(5), Below(2)],
            run: |i, o| {
                // Few ranks, so that those asked for are often there.
                let list = i.u(0) & 0x0303_0303;
                let rank = i.u(1) + 1;
                o.u(interior_add(list, rank)).u(interior_remove(list, rank)).u(interior_top(list));
                o.u(cross_interface(list, i.u(3), i.u(4) != 0));
            },
        },
    ],
};
