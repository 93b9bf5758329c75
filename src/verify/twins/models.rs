//! Twins of the reflection models, in the order of `shaders/kernels/parity/models.comp`: each model's eval and pdf,
//! then its sample, by the same numbers as `MODEL_*`.

use super::{Family, In, Out, Twin};
use crate::layout::{
    MODEL_BLINN_PHONG, MODEL_COOK_TORRANCE, MODEL_DIELECTRIC, MODEL_EMISSIVE, MODEL_LAMBERT, MODEL_MIRROR, MODEL_PHONG,
    Material,
};
use crate::shading::material::{
  albedo_material, ambient_material, emission_material, eval_material, is_delta, mirror_weight, pdf_material, sample_material,
};
use crate::verify::inputs::Domain::{self, Below, Range, Upper};
use glam::Vec3;

/// wo, wi (or u and u_lobe), exponent, k_s, eta, k, slopes, flags.
const MATERIAL: [Domain; 9] = [
    Upper,
    Upper,
    Range(0.0, 2000.0),
    Range(0.0, 1.0),
    Range(0.1, 4.0),
    Range(0.0, 8.0),
    Range(1.0e-3, 2.0),
    Range(1.0e-3, 2.0),
    Below(32),
];

fn material(i: &In, model: u32) -> Material {
    Material {
        color: Vec3::new(0.75, 0.5, 0.1),
        model,
        specular_color: Vec3::new(1.0, 0.9, 0.8),
        exponent: i.f(6),
        k_a: 0.5,
        k_d: 1.0 - i.f(7),
        k_s: i.f(7),
        k_r: 0.25,
        eta: Vec3::new(i.f(8), i.f(8) * 0.75, i.f(8) * 1.25),
        m0: i.f(10),
        k: Vec3::new(i.f(9), i.f(9) * 0.5, i.f(9) * 0.25),
        m1: i.f(11),
        w0: 0.625,
        w1: 0.375,
        flags: i.u(12),
        ..Material::default()
    }
}

fn eval(i: &In, o: &mut Out, model: u32) {
    let m = material(i, model);
    o.v4(eval_material(&m, i.v3(0), i.v3(3))).f(pdf_material(&m, i.v3(0), i.v3(3)));
}

fn sample(i: &In, o: &mut Out, model: u32) {
    let s = sample_material(&material(i, model), i.v3(0), i.v2(3).abs(), i.f(5));
    o.v3(s.wi).f(s.pdf);
}

fn rest(i: &In, o: &mut Out, model: u32) {
    let m = material(i, model);
    o.f(ambient_material(&m).x).f(albedo_material(&m).y).v4(mirror_weight(&m, i.f(5))).u(u32::from(is_delta(&m)));
    o.f(emission_material(&m).x);
}

macro_rules! model {
    ($eval:literal, $sample:literal, $rest:literal, $model:expr) => {
        [
            Twin { name: $eval, domains: &MATERIAL, run: |i, o| eval(i, o, $model) },
            Twin { name: $sample, domains: &MATERIAL, run: |i, o| sample(i, o, $model) },
            Twin { name: $rest, domains: &MATERIAL, run: |i, o| rest(i, o, $model) },
        ]
    };
}

const TWINS: [[Twin; 3]; 7] = [
    model!("eval_lambert pdf_lambert", "sample_lambert", "lambert's rest", MODEL_LAMBERT),
    model!("eval_phong pdf_phong", "sample_phong", "phong's rest", MODEL_PHONG),
    model!("eval_blinn_phong pdf_blinn_phong", "sample_blinn_phong", "blinn-phong's rest", MODEL_BLINN_PHONG),
    model!("eval_cook_torrance pdf_cook_torrance", "sample_cook_torrance", "cook-torrance's rest", MODEL_COOK_TORRANCE),
    model!("a mirror's eval", "a mirror's sample", "a mirror's rest", MODEL_MIRROR),
    model!("a dielectric's eval", "a dielectric's sample", "a dielectric's rest", MODEL_DIELECTRIC),
    model!("an emitter's eval", "an emitter's sample", "an emitter's rest", MODEL_EMISSIVE),
];

pub const FAMILY: Family = Family { kernel: "parity/models", twins: TWINS.as_flattened() };
