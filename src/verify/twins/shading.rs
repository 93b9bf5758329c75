//! Twins of Fresnel terms, microfacets, dielectrics and lights, in the order of `shaders/kernels/parity/shading.comp`.

use super::{Family, In, Twin};
use crate::layout::{Light, T_INFINITE};
use crate::shading::dielectric::{refract_local, transmittance};
use crate::shading::frame::{frame_from_normal, to_local, to_world};
use crate::shading::fresnel::{fresnel_conductor, fresnel_conductor3, fresnel_dielectric};
use crate::shading::light::{attenuate, sample_light, spot_factor};
use crate::shading::lobe::{cos_power, pdf_cos_power, reflect_about, sample_cos_power, turn_to};
use crate::shading::microfacet::{
    beckmann_d, beckmann_lobes_d_slope, pdf_beckmann, sample_beckmann, tan2_theta, v_cavity_g,
};
use crate::verify::inputs::Domain::{self, Below, Direction, Exponent, Range, Upper};
use glam::Vec3;

const UNIT: Domain = Range(0.0, 1.0);

/// A light of any kind around the origin; argument words 3 to 10 say which.
fn light(i: &In) -> Light {
    Light {
        position: Vec3::new(0.5, 2.0, -1.0),
        kind: i.u(3),
        direction: i.v3(5),
        attenuation: i.u(4),
        intensity: Vec3::new(3.0, 2.0, 0.25),
        cos_outer: i.f(8) * 0.5,
        c: Vec3::new(0.25, 0.5, 0.125),
        cos_inner: i.f(8),
        flaps_min: Vec3::new(-1.0, -T_INFINITE, -2.0),
        exponent: i.f(9),
        flaps_max: Vec3::new(T_INFINITE, 3.0, 2.0),
        casts_shadow: 1,
        ..Light::default()
    }
}

const LIGHT: [Domain; 8] =
    [Exponent(-4, 6), Exponent(-4, 6), Exponent(-4, 6), Below(3), Below(3), Direction, UNIT, Range(0.0, 64.0)];

pub const FAMILY: Family = Family {
    kernel: "parity/shading",
    twins: &[
        Twin {
            name: "fresnel_dielectric",
            domains: &[UNIT, Range(0.3, 3.5)],
            run: |i, o| {
                o.f(fresnel_dielectric(i.f(0), i.f(1)));
            },
        },
        Twin {
            name: "fresnel_conductor",
            domains: &[UNIT, Range(0.05, 6.0), Range(0.0, 9.0)],
            run: |i, o| {
                o.f(fresnel_conductor(i.f(0), i.f(1), i.f(2)));
            },
        },
        Twin {
            name: "fresnel_conductor3",
            domains: &[
                UNIT,
                Range(0.05, 6.0),
                Range(0.05, 6.0),
                Range(0.05, 6.0),
                Range(0.0, 9.0),
                Range(0.0, 9.0),
                Range(0.0, 9.0),
            ],
            run: |i, o| {
                o.v3(fresnel_conductor3(i.f(0), i.v3(1), i.v3(4)));
            },
        },
        Twin {
            name: "tan2_theta",
            domains: &[Upper],
            run: |i, o| {
                o.f(tan2_theta(i.v3(0)));
            },
        },
        Twin {
            name: "beckmann_d",
            domains: &[UNIT, Range(1.0e-3, 2.0)],
            run: |i, o| {
                o.f(beckmann_d(i.f(0), i.f(1)));
            },
        },
        Twin {
            name: "beckmann_lobes_d_slope",
            domains: &[Exponent(-20, 20), Range(1.0e-3, 2.0), Range(1.0e-3, 2.0), UNIT, UNIT],
            run: |i, o| {
                o.f(beckmann_lobes_d_slope(i.f(0).abs(), i.f(1), i.f(2), i.f(3), i.f(4)));
            },
        },
        Twin {
            name: "v_cavity_g",
            domains: &[UNIT; 4],
            run: |i, o| {
                o.f(v_cavity_g(i.f(0), i.f(1), i.f(2), i.f(3)));
            },
        },
        Twin {
            name: "sample_beckmann",
            domains: &[UNIT, UNIT, Range(1.0e-3, 2.0)],
            run: |i, o| {
                o.v3(sample_beckmann(i.v2(0), i.f(2)));
            },
        },
        Twin {
            name: "pdf_beckmann",
            domains: &[Upper, Range(1.0e-3, 2.0)],
            run: |i, o| {
                o.f(pdf_beckmann(i.v3(0), i.f(3)));
            },
        },
        Twin {
            name: "refract_local",
            domains: &[Upper, Range(0.3, 3.5)],
            run: |i, o| {
                let r = refract_local(i.v3(0), i.f(3));
                o.v3(r.wt).f(r.cos_t).u(u32::from(r.total));
            },
        },
        Twin {
            name: "transmittance",
            domains: &[Exponent(-20, 8), Exponent(-20, 8), Exponent(-20, 8), Exponent(-10, 60)],
            run: |i, o| {
                o.v4(transmittance(i.v3(0).abs(), i.f(3).abs()));
            },
        },
        Twin {
            name: "cos_power",
            domains: &[UNIT, Range(0.0, 4000.0)],
            run: |i, o| {
                o.f(cos_power(i.f(0), i.f(1)));
            },
        },
        Twin {
            name: "sample_cos_power",
            domains: &[UNIT, UNIT, Range(0.0, 4000.0)],
            run: |i, o| {
                o.v3(sample_cos_power(i.v2(0), i.f(2)));
            },
        },
        Twin {
            name: "pdf_cos_power",
            domains: &[UNIT, Range(0.0, 4000.0)],
            run: |i, o| {
                o.f(pdf_cos_power(i.f(0), i.f(1)));
            },
        },
        Twin {
            name: "reflect_about",
            domains: &[Direction, Direction],
            run: |i, o| {
                o.v3(reflect_about(i.v3(0), i.v3(3)));
            },
        },
        Twin {
            name: "turn_to",
            domains: &[Direction, Upper],
            run: |i, o| {
                o.v3(turn_to(i.v3(0), i.v3(3)));
            },
        },
        Twin {
            name: "to_local to_world",
            domains: &[Direction, Direction],
            run: |i, o| {
                let frame = frame_from_normal(i.v3(0));
                o.v3(to_local(frame, i.v3(3))).v3(to_world(frame, i.v3(3)));
            },
        },
        Twin {
            name: "attenuate spot_factor",
            domains: &LIGHT,
            run: |i, o| {
                let l = light(i);
                o.f(attenuate(&l, i.f(0).abs(), i.f(0) * i.f(0))).f(spot_factor(&l, i.f(5)));
            },
        },
        Twin {
            name: "sample_light",
            domains: &LIGHT,
            run: |i, o| {
                let s = sample_light(&light(i), i.v3(0));
                o.v3(s.wi).f(s.distance).v4(s.radiance);
            },
        },
    ],
};
