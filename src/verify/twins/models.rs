//! Twins of the reflection models, in the order of `shaders/kernels/parity/models.comp`: each model's eval and pdf,
//! then its sample, by the same numbers as `MODEL_*`.

use super::{Family, In, Out, Twin};
use crate::layout::{
    Features, MODEL_ASHIKHMIN_SHIRLEY, MODEL_BLEND, MODEL_BLINN_PHONG, MODEL_CONDUCTOR, MODEL_COOK_TORRANCE,
    MODEL_DIELECTRIC, MODEL_EMISSIVE, MODEL_EON, MODEL_KELEMEN, MODEL_LAMBERT, MODEL_MEASURED, MODEL_MIRROR,
    MODEL_NULL, MODEL_OREN_NAYAR, MODEL_PHONG, MODEL_PLASTIC, MODEL_PRINCIPLED, MODEL_ROUGH_CONDUCTOR,
    MODEL_ROUGH_DIELECTRIC, MODEL_ROUGH_PLASTIC, MODEL_TABULATED, MODEL_THIN_DIELECTRIC, MODEL_WARD, SceneHeader,
    SceneView,
};
use crate::shading::closure::Closure;
use crate::shading::material::{
    albedo_closure, ambient_closure, eval_closure, is_delta, is_refracting, mirror_weight, own_weight, pane_tint,
    pdf_closure, sample_closure,
};
use crate::shading::sampling::{hash_u32, unit_float};
use crate::verify::inputs::Domain::{self, Below, Direction, Range};
use glam::Vec3;
use std::sync::LazyLock;

/// wo, wi (or u and u_lobe), exponent, k_s, eta, k, slopes, flags, slope and exponent across, the extra parameter.
const MATERIAL: [Domain; 12] = [
    Direction,
    Direction,
    Range(0.0, 2000.0),
    Range(0.0, 1.0),
    Range(0.1, 4.0),
    Range(0.0, 8.0),
    Range(1.0e-3, 2.0),
    Range(1.0e-3, 2.0),
    Below(1 << 20),
    Range(1.0e-3, 2.0),
    Range(0.0, 2000.0),
    Range(0.0, 1.0),
];

/// Table entries that models may ask for; a MERL table is the largest.
const TABLE: usize = TABLE_AT as usize + 8 + 90 + 3 * 90 * 90 * 180;
/// Where the models' tables begin.
const TABLE_AT: u32 = 64;

/// Where the head of a table for directions of light begins: counts, then knots, light angles and view angles rising, cosines falling.
const TABULATED_AT: u32 = 16;
const COUNTS: [f32; 5] = [5.0, 6.0, 7.0, 8.0, 2.0];

/// What `load_table` gives in the kernel: that head, and a hash of the index everywhere else.
static TABLES: LazyLock<Vec<f32>> = LazyLock::new(|| (0..TABLE as u32).map(table_entry).collect());
static HEADER: LazyLock<SceneHeader> = LazyLock::new(SceneHeader::default);
static FEATURES: LazyLock<Features> = LazyLock::new(Features::default);

fn table_entry(index: u32) -> f32 {
    let at = index.wrapping_sub(TABULATED_AT);
    match at {
        0..5 => COUNTS[at as usize],
        5..17 => (at - 5) as f32 * 0.13,
        17..24 => 1.0 - (at - 17) as f32 * 0.14,
        _ => unit_float(hash_u32(index)),
    }
}

fn tables() -> SceneView<'static> {
    SceneView::of_tables(&HEADER, &FEATURES, &TABLES)
}

/// Where the flags' argument keeps `DISTRIBUTION_*` of the facets, and above it that of the second lobe.
pub const DISTRIBUTION_AT: u32 = 16;

fn make_closure(i: &In, model: u32) -> Closure {
    Closure {
        model,
        flags: i.u(12),
        color: Vec3::new(0.75, 0.5, 0.1),
        specular_color: Vec3::new(1.0, 0.9, 0.8),
        k_a: 0.5,
        k_d: 1.0 - i.f(7),
        k_s: i.f(7),
        k_r: 0.25,
        exponent: i.f(6),
        exponent_v: i.f(14),
        sigma: i.f(15),
        distribution: (i.u(12) >> DISTRIBUTION_AT) & 3,
        second_distribution: (i.u(12) >> 18) & 3,
        alpha_u: i.f(10),
        alpha_v: i.f(13),
        second_alpha_u: i.f(11),
        second_alpha_v: 0.25,
        weight: 0.625,
        second_weight: 0.375,
        eta: i.f(8),
        metal_eta: Vec3::new(i.f(8), i.f(8) * 0.75, i.f(8) * 1.25),
        metal_k: Vec3::new(i.f(9), i.f(9) * 0.5, i.f(9) * 0.25),
        f0: Vec3::new(i.f(8), i.f(8) * 0.75, i.f(8) * 1.25),
        table: if model == MODEL_TABULATED { TABULATED_AT } else { TABLE_AT },
        inner_reflectance: i.f(15),
        roughness: i.f(10),
        metallic: i.f(15),
        anisotropic: i.f(9) * 0.125,
        spec_trans: i.f(9) * 0.0625,
        spec_tint: i.f(9) * 0.03125,
        sheen: 0.625,
        sheen_tint: 0.375,
        flatness: 1.0 - i.f(7),
        clearcoat: i.f(7),
        clearcoat_gloss: i.f(6) * 0.0005,
        blend: i.f(15),
        first_part: 0,
        first_leaves: 0,
        leaf_count: 0,
        share: 1.0,
        absorption: Vec3::ZERO,
        rank: 0,
        emission: Vec3::ZERO,
        k_t: 0.375,
        transmit_color: Vec3::new(0.5, 0.25, 0.75),
    }
}

fn eval(i: &In, o: &mut Out, model: u32) {
    let (scene, c) = (tables(), make_closure(i, model));
    o.v4(eval_closure(&scene, &c, i.v3(0), i.v3(3))).f(pdf_closure(&scene, &c, i.v3(0), i.v3(3)));
}

fn sample(i: &In, o: &mut Out, model: u32) {
    let s = sample_closure(&tables(), &make_closure(i, model), i.v3(0), i.v2(3).abs(), i.f(5).abs());
    o.v3(s.wi).f(s.pdf).v3(s.weight.truncate()).u(s.eta.to_bits() ^ s.flags);
}

fn rest(i: &In, o: &mut Out, model: u32) {
    let c = make_closure(i, model);
    let kinds = u32::from(is_delta(&c)) | u32::from(is_refracting(c.model)) << 1;
    o.f(ambient_closure(&c).x).f(albedo_closure(&c).y + pane_tint(&c).y).v4(mirror_weight(&c, i.f(5))).u(kinds);
    o.f(c.emission.x + own_weight(c.flags, c.k_t));
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

const TWINS: [[Twin; 3]; 23] = [
    model!("eval_lambert pdf_lambert", "sample_lambert", "lambert: rest", MODEL_LAMBERT),
    model!("eval_phong pdf_phong", "sample_phong", "phong: rest", MODEL_PHONG),
    model!("eval_blinn_phong pdf_blinn_phong", "sample_blinn_phong", "blinn_phong: rest", MODEL_BLINN_PHONG),
    model!("eval_cook_torrance pdf_cook_torrance", "sample_cook_torrance", "cook_torrance: rest", MODEL_COOK_TORRANCE),
    model!("a mirror: eval", "a mirror: sample", "a mirror: rest", MODEL_MIRROR),
    model!("a dielectric: eval", "a dielectric: sample", "a dielectric: rest", MODEL_DIELECTRIC),
    model!("an emitter: eval", "an emitter: sample", "an emitter: rest", MODEL_EMISSIVE),
    model!("eval_oren_nayar pdf_oren_nayar", "sample_oren_nayar", "oren_nayar: rest", MODEL_OREN_NAYAR),
    model!("eval_ward pdf_ward", "sample_ward", "ward: rest", MODEL_WARD),
    model!("eval_ashikhmin pdf_ashikhmin", "sample_ashikhmin", "ashikhmin: rest", MODEL_ASHIKHMIN_SHIRLEY),
    model!("eval_kelemen pdf_kelemen", "sample_kelemen", "kelemen: rest", MODEL_KELEMEN),
    model!("a smooth metal: eval", "a smooth metal: sample", "a smooth metal: rest", MODEL_CONDUCTOR),
    model!(
        "eval_rough_conductor pdf_rough_conductor",
        "sample_rough_conductor",
        "rough_conductor: rest",
        MODEL_ROUGH_CONDUCTOR
    ),
    model!(
        "eval_rough_dielectric pdf_rough_dielectric",
        "sample_rough_dielectric",
        "rough_dielectric: rest",
        MODEL_ROUGH_DIELECTRIC
    ),
    model!("a thin pane: eval", "a thin pane: sample", "a thin pane: rest", MODEL_THIN_DIELECTRIC),
    model!("eval_plastic pdf_plastic", "sample_plastic", "plastic: rest", MODEL_PLASTIC),
    model!("eval_rough_plastic pdf_rough_plastic", "sample_rough_plastic", "rough_plastic: rest", MODEL_ROUGH_PLASTIC),
    model!("eval_principled pdf_principled", "sample_principled", "principled: rest", MODEL_PRINCIPLED),
    model!("eval_measured pdf_measured", "sample_measured", "measured: rest", MODEL_MEASURED),
    model!("nothing: eval", "nothing: sample", "nothing: rest", MODEL_NULL),
    model!("a blend: eval", "a blend: sample", "a blend: rest", MODEL_BLEND),
    model!("eval_tabulated pdf_tabulated", "sample_tabulated", "tabulated: rest", MODEL_TABULATED),
    model!("eval_eon pdf_eon", "sample_eon", "eon: rest", MODEL_EON),
];

pub const FAMILY: Family = Family { kernel: "parity/models", twins: TWINS.as_flattened() };
