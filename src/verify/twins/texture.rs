//! Twins of textures, patterns and what they do to materials and normals, in the order of
//! `shaders/kernels/parity/texture.comp`.

use super::{Family, In, Twin};
use crate::layout::Texture;
use crate::shading::closure::Closure;
use crate::shading::coordinate::{texture_uv, texture_vector};
use crate::shading::footprint::{
    Footprint, UvGradients, cone_footprint, mapped_normal, raised_normal, texture_gradients, uv_gradients,
};
use crate::shading::parameter::{apply_parameter, channel_value};
use crate::shading::pattern::{checker, fractal_noise, gradient_noise, pattern_share, square_mean, zone_plate};
use crate::shading::texture::texture_detail;
use crate::trace::tangent::{sphere_tangents, triangle_tangents};
use crate::verify::inputs::Domain::{self, Below, Direction, Exponent, Range};
use glam::Vec3;

/// A coordinate or a size of ordinary magnitude, either sign.
const PLAIN: Domain = Exponent(-20, 20);
const UNIT: Domain = Range(0.0, 1.0);
/// A texture's size and place, and a pair of coordinates.
const PLACED: [Domain; 8] = [Below(8192), PLAIN, PLAIN, PLAIN, PLAIN, PLAIN, PLAIN, PLAIN];

/// A texture whose size argument word 0 gives, and words 1 to 3 its scale and shear.
fn texture(i: &In) -> Texture {
    Texture {
        width: i.u(0) + 1,
        height: (i.u(0) >> 1) + 1,
        level_count: i.u(0) & 7,
        format: i.u(0) & 3,
        scale_u: i.f(1),
        scale_v: i.f(2),
        shear_u: i.f(3),
        shear_v: 0.25,
        offset_u: 0.5,
        offset_v: -2.0,
        ..Texture::default()
    }
}

/// The gradients at words 3 to 8, across the normal at word 0.
fn gradients(i: &In) -> UvGradients {
    uv_gradients(i.v3(3), i.v3(6), i.v3(0))
}

pub const FAMILY: Family = Family {
    kernel: "parity/texture",
    twins: &[
        Twin {
            name: "texture_uv texture_vector",
            domains: &PLACED,
            run: |i, o| {
                o.v2(texture_uv(&texture(i), i.v2(4))).v2(texture_vector(&texture(i), i.v2(4)));
            },
        },
        Twin {
            name: "texture_detail",
            domains: &PLACED,
            run: |i, o| {
                let detail = texture_detail(&texture(i), Footprint { along: i.v2(4), across: i.v2(6) });
                o.v2(detail.spacing).f(detail.width).u(detail.probes);
            },
        },
        Twin {
            name: "uv_gradients texture_gradients",
            domains: &[Direction, PLAIN, PLAIN, PLAIN, PLAIN, PLAIN, PLAIN],
            run: |i, o| {
                let scaled = Texture { scale_u: 2.0, scale_v: -0.5, shear_u: 0.25, shear_v: 3.0, ..Texture::default() };
                let own = texture_gradients(&scaled, gradients(i));
                o.v3(own.u).v3(own.v);
            },
        },
        Twin {
            name: "cone_footprint",
            domains: &[Direction, PLAIN, PLAIN, PLAIN, PLAIN, PLAIN, PLAIN, Direction, Exponent(-20, 4)],
            run: |i, o| {
                let footprint = cone_footprint(gradients(i), i.v3(0), i.v3(9), i.f(12).abs());
                o.v2(footprint.along).v2(footprint.across);
            },
        },
        Twin {
            name: "mapped_normal",
            domains: &[Direction, PLAIN, PLAIN, PLAIN, PLAIN, PLAIN, PLAIN, UNIT, UNIT, UNIT, Range(0.0, 4.0)],
            run: |i, o| {
                o.v3(mapped_normal(i.v3(0), gradients(i), i.v3(9), i.f(12)));
            },
        },
        Twin {
            name: "raised_normal",
            domains: &[Direction, PLAIN, PLAIN, PLAIN, PLAIN, PLAIN, PLAIN, PLAIN, PLAIN],
            run: |i, o| {
                o.v3(raised_normal(i.v3(0), gradients(i), i.f(9), i.f(10)));
            },
        },
        Twin {
            name: "triangle_tangents",
            domains: &[PLAIN; 10],
            run: |i, o| {
                let tangents = triangle_tangents(i.v3(0), i.v3(3), i.v2(6), i.v2(8));
                o.v3(tangents.dp_du).v3(tangents.dp_dv);
            },
        },
        Twin {
            name: "sphere_tangents",
            domains: &[Direction],
            run: |i, o| {
                let tangents = sphere_tangents(i.v3(0));
                o.v3(tangents.dp_du).v3(tangents.dp_dv);
            },
        },
        Twin {
            name: "square_mean checker zone_plate",
            domains: &[PLAIN, PLAIN, Exponent(-20, 4)],
            run: |i, o| {
                let width = i.f(2).abs();
                o.f(square_mean(i.f(0), width)).f(checker(i.v2(0), width)).f(zone_plate(i.v2(0)));
            },
        },
        Twin {
            name: "gradient_noise fractal_noise",
            domains: &[PLAIN, PLAIN, UNIT, UNIT, Below(0), Below(18)],
            run: |i, o| {
                o.f(gradient_noise(i.v2(0), i.u(4))).f(fractal_noise(i.v2(0), i.u(5), i.f(2), i.u(4), i.f(3)));
            },
        },
        Twin {
            name: "pattern_share",
            domains: &[PLAIN, PLAIN, UNIT, Exponent(-20, 1), Below(0), Below(18), Below(8)],
            run: |i, o| {
                o.f(pattern_share(i.u(6), i.v2(0), i.u(5), i.f(2), i.u(4), i.f(3).abs()));
            },
        },
        Twin {
            name: "channel_value",
            domains: &[UNIT, UNIT, UNIT, UNIT, Below(6)],
            run: |i, o| {
                o.v3(channel_value(i.v4(0), i.u(4)));
            },
        },
        Twin {
            name: "apply_parameter",
            domains: &[UNIT, UNIT, UNIT, Below(20), UNIT],
            run: |i, o| {
                let mut c = Closure {
                    color: Vec3::new(0.75, 0.5, 0.1),
                    specular_color: Vec3::new(1.0, 0.9, 0.8),
                    emission: Vec3::new(3.0, 2.0, 1.0),
                    alpha_u: 0.25,
                    alpha_v: 0.125,
                    second_alpha_u: 0.5,
                    second_alpha_v: 0.375,
                    k_t: 0.25,
                    blend: 0.9375,
                    roughness: 0.1875,
                    metallic: 0.75,
                    anisotropic: 0.5,
                    spec_trans: 0.25,
                    spec_tint: 0.125,
                    sheen: 0.75,
                    sheen_tint: 0.875,
                    flatness: 0.375,
                    clearcoat: 0.625,
                    clearcoat_gloss: 1.0,
                    ..Closure::default()
                };
                apply_parameter(&mut c, i.u(3), i.v3(0), i.f(4));
                o.v3(c.color).f(c.specular_color.x).f(c.emission.y + c.roughness).f(c.alpha_u + c.second_alpha_v);
                o.f((c.k_t + c.blend) + ((c.anisotropic + c.spec_trans) + (c.spec_tint + c.metallic)));
                let shares = (c.sheen + c.sheen_tint) + (c.flatness + c.clearcoat);
                o.f(shares + (c.clearcoat_gloss + (c.second_alpha_u + c.alpha_v)));
            },
        },
    ],
};
