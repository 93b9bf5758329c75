//! The reflection models: reciprocity, energy, samplers against densities, and inputs at the edge.

use std::sync::LazyLock;

#[path = "common/chi_square.rs"]
mod chi_square;

use chi_square::{Random, chi_square, direction, integrate_hemisphere, sidak, test_sampler, upper_gamma};
use glam::{Vec2, Vec3};
use gonio::bake::SceneData;
use gonio::layout::{
    MATERIAL_CONDUCTOR, MATERIAL_D_1982, MATERIAL_LAFORTUNE, MODEL_BLINN_PHONG, MODEL_COOK_TORRANCE, MODEL_DIELECTRIC,
    MODEL_EMISSIVE, MODEL_LAMBERT, MODEL_MIRROR, MODEL_PHONG,
};
use gonio::shading::bsdf::SAMPLE_DELTA;
use gonio::shading::closure::Closure;
use gonio::shading::material::{
    albedo_closure, ambient_closure, eval_closure, is_delta, mirror_weight, pdf_closure, sample_closure,
};
use gonio::shading::microfacet::{pdf_beckmann, sample_beckmann};

/// These models need no table.
static NO_SCENE: LazyLock<SceneData> = LazyLock::new(SceneData::default);

/// Both lobes white, half and half; Cook-Torrance of two slopes and index 1.5.
fn white(model: u32) -> Closure {
    Closure {
        model,
        color: Vec3::ONE,
        specular_color: Vec3::ONE,
        k_a: 1.0,
        k_d: 0.5,
        k_s: 0.5,
        exponent: 12.0,
        eta: 1.5,
        alpha_u: 0.4,
        second_alpha_u: 0.2,
        weight: 0.4,
        second_weight: 0.6,
        ..Default::default()
    }
}

fn specular(model: u32) -> Closure {
    Closure { k_d: 0.0, k_s: 1.0, ..white(model) }
}

/// A metal that reflects all but .001 at every angle.
fn silver_white(m: f32) -> Closure {
    Closure {
        flags: MATERIAL_CONDUCTOR,
        metal_eta: Vec3::splat(0.000_1),
        metal_k: Vec3::splat(4.0),
        alpha_u: m,
        weight: 1.0,
        second_weight: 0.0,
        ..specular(MODEL_COOK_TORRANCE)
    }
}

/// Every reflecting model in the forms its flags give it.
fn all_models() -> Vec<(&'static str, Closure)> {
    vec![
        ("lambert", white(MODEL_LAMBERT)),
        ("phong", white(MODEL_PHONG)),
        ("phong, lafortune", Closure { flags: MATERIAL_LAFORTUNE, ..white(MODEL_PHONG) }),
        ("phong, specular", specular(MODEL_PHONG)),
        ("blinn-phong", white(MODEL_BLINN_PHONG)),
        ("blinn-phong, specular", specular(MODEL_BLINN_PHONG)),
        ("cook-torrance", white(MODEL_COOK_TORRANCE)),
        ("cook-torrance, 1982", Closure { flags: MATERIAL_D_1982, ..white(MODEL_COOK_TORRANCE) }),
        ("cook-torrance, metal", silver_white(0.25)),
    ]
}

fn value(material: &Closure, wo: Vec3, wi: Vec3) -> f64 {
    f64::from(eval_closure(&NO_SCENE.view(), material, wo, wi).y)
}

/// f = eval / cos, both ways.
fn brdf_both_ways(material: &Closure, wo: Vec3, wi: Vec3) -> (f64, f64) {
    (value(material, wo, wi) / f64::from(wi.z), value(material, wi, wo) / f64::from(wo.z))
}

/// Largest relative difference between f and its reverse over random pairs of directions.
fn largest_asymmetry(material: &Closure) -> f64 {
    let mut random = Random(7);
    let mut largest = 0.0f64;
    for _ in 0..1_000_000 {
        let (forth, back) = brdf_both_ways(material, random.upper_direction(), random.upper_direction());
        if forth.max(back) > 1e-12 {
            largest = largest.max((forth - back).abs() / forth.max(back));
        }
    }
    largest
}

/// Directional albedo by quadrature over the light's directions.
fn albedo(material: &Closure, wo: Vec3, parts: usize) -> f64 {
    integrate_hemisphere(&|wi| value(material, wo, wi), parts)
}

/// The same over angles, with points gathered at the horizon and at the plane of incidence, where a metal seen at
/// grazing incidence has a ridge. `wo` has azimuth 0.
fn albedo_by_angle(material: &Closure, wo: Vec3, parts: u32) -> f64 {
    use std::f64::consts::{FRAC_PI_2, PI};
    let step = 1.0 / f64::from(parts);
    let mut sum = 0.0;
    for i in 0..parts {
        let theta = FRAC_PI_2 * (f64::from(i) + 0.5) * step;
        for j in 0..parts {
            // phi = pi - pi t^3, twice for both sides of the plane
            let t = (f64::from(j) + 0.5) * step;
            let measure = libm::sin(theta) * FRAC_PI_2 * 6.0 * PI * t * t;
            sum += measure * value(material, wo, direction(libm::cos(theta), PI - PI * t * t * t));
        }
    }
    sum * step * step
}

#[test]
fn lambert_lafortune_and_cook_torrance_are_reciprocal_on_a_million_pairs() {
    for (name, material) in all_models() {
        if matches!(material.model, MODEL_LAMBERT | MODEL_COOK_TORRANCE) || material.flags == MATERIAL_LAFORTUNE {
            let asymmetry = largest_asymmetry(&material);
            assert!(asymmetry < 1e-5, "{name}: {asymmetry:e}");
        }
    }
}

#[test]
fn phong_and_blinn_as_printed_are_not_reciprocal_though_their_lobes_are_symmetric() {
    for model in [MODEL_PHONG, MODEL_BLINN_PHONG] {
        let material = specular(model);
        assert!(largest_asymmetry(&material) > 0.5, "model {model}");
        let (wo, wi) = (direction(0.9, 0.3), direction(0.4, 2.9));
        assert_eq!(value(&material, wo, wi), value(&material, wi, wo), "model {model}");
    }
}

#[test]
fn phong_as_printed_has_no_bound_on_its_albedo_and_lafortune_has() {
    // (n + 2) / (2 pi) is below 1 / pi for no n > 0: as printed the lobe reflects 2 / (n + 1) at normal incidence.
    let printed = Closure { exponent: 0.5, ..specular(MODEL_PHONG) };
    assert!((albedo(&printed, Vec3::Z, 64) - 2.0 / 1.5).abs() < 1e-3);
    for exponent in [0.0, 0.5, 1.0, 8.0, 64.0] {
        let lafortune = Closure { exponent, flags: MATERIAL_LAFORTUNE, ..specular(MODEL_PHONG) };
        for z in [1.0, 0.7, 0.3, 0.02] {
            let reflected = albedo(&lafortune, direction(z, 1.0), 64);
            assert!(reflected <= 1.0 + 1e-4, "n {exponent} z {z}: {reflected}");
            if z == 1.0 {
                assert!((reflected - 1.0).abs() < 1e-4, "n {exponent}: {reflected}");
            }
        }
    }
}

#[test]
fn lambert_reflects_exactly_its_colour_from_every_side() {
    let material = Closure { color: Vec3::new(0.2, 0.6, 1.0), k_d: 1.0, ..white(MODEL_LAMBERT) };
    for z in [1.0, 0.5, 0.01] {
        assert!((albedo(&material, direction(z, 0.4), 16) - 0.6).abs() < 1e-6);
    }
    // Radiance independent of the viewer: the same bits.
    let wi = direction(0.7, 1.0);
    let seen = [0.9, 0.5, 0.1].map(|z| value(&material, direction(z, 2.0), wi));
    assert!(seen[0] == seen[1] && seen[1] == seen[2]);
}

#[test]
fn cook_torrance_reflects_no_more_than_it_receives() {
    for m in [0.15f32, 0.3, 0.6, 1.0] {
        let metal = silver_white(m);
        let plastic =
            Closure { k_d: 0.9, k_s: 0.1, alpha_u: m, weight: 1.0, second_weight: 0.0, ..white(MODEL_COOK_TORRANCE) };
        for degrees in [0.0f64, 20.0, 40.0, 60.0, 75.0, 85.0, 89.0] {
            let wo = direction(libm::cos(degrees.to_radians()), 0.0);
            for (name, material) in [("metal", &metal), ("plastic", &plastic)] {
                let reflected = albedo_by_angle(material, wo, 256);
                assert!(reflected <= 1.001, "{name} m {m} at {degrees}: {reflected}");
            }
        }
        // At normal incidence a smooth white metal loses almost nothing: the bound is not met by being dark.
        let reflected = albedo_by_angle(&metal, Vec3::Z, 256);
        assert!(m > 0.3 || reflected > 0.98, "m {m}: {reflected}");
    }
}

#[test]
fn the_1982_distribution_is_four_times_brighter() {
    let modern = specular(MODEL_COOK_TORRANCE);
    let printed = Closure { flags: MATERIAL_D_1982, ..modern };
    let (wo, wi) = (direction(0.8, 0.1), direction(0.6, 3.0));
    assert!(value(&modern, wo, wi) > 0.0);
    assert_eq!(value(&printed, wo, wi), 4.0 * value(&modern, wo, wi));
}

#[test]
fn cook_torrance_is_the_formula_of_the_lecture() {
    // R_s = D G F / (4 (N.L)(N.V)) written out in double precision, both lobes.
    let material = specular(MODEL_COOK_TORRANCE);
    let mut random = Random(3);
    for _ in 0..2000 {
        let (wo, wi) = (random.upper_direction(), random.upper_direction());
        let (v, l) = (wo.as_dvec3(), wi.as_dvec3());
        let h = (v + l).normalize();
        let (n_h, v_h) = (h.z, v.dot(h));
        let d = |m: f64| {
            let tan = libm::tan(libm::acos(n_h));
            libm::exp(-(tan / m).powi(2)) / (std::f64::consts::PI * m * m * n_h.powi(4))
        };
        let g = 1f64.min(2.0 * n_h * v.z / v_h).min(2.0 * n_h * l.z / v_h);
        let root = libm::sqrt(1.5f64 * 1.5 - 1.0 + v_h * v_h);
        let (r_s, r_p) = ((v_h - root) / (v_h + root), (2.25 * v_h - root) / (2.25 * v_h + root));
        let f = 0.5 * (r_s * r_s + r_p * r_p);
        let expected = (0.4 * d(0.4) + 0.6 * d(0.2)) * g * f / (4.0 * v.z);
        let got = value(&material, wo, wi);
        assert!((got - expected).abs() < 1e-4 * expected + 1e-9, "{wo} {wi}: {got} {expected}");
    }
}

#[test]
fn the_specular_peak_moves_beyond_the_mirror_angle_at_grazing_incidence() {
    // Cook and Torrance 1982: for light at 70 degrees and m = .3 the largest reflection is nearer the horizon.
    // Phong's stays in the mirror direction.
    let cook_torrance = Closure { alpha_u: 0.3, weight: 1.0, second_weight: 0.0, ..specular(MODEL_COOK_TORRANCE) };
    let wi = direction(libm::cos(70f64.to_radians()), 0.0);
    let peak = |material: &Closure| {
        let at = |degrees: &i32| {
            let wo = direction(libm::cos(f64::from(*degrees).to_radians()), std::f64::consts::PI);
            value(material, wo, wi)
        };
        (0..90).max_by(|a, b| at(a).total_cmp(&at(b))).unwrap()
    };
    assert_eq!(peak(&specular(MODEL_PHONG)), 70);
    assert!(peak(&cook_torrance) > 72, "{}", peak(&cook_torrance));
}

#[test]
fn the_chi_square_test_has_the_textbooks_p_values() {
    // Abramowitz and Stegun 1964, table 26.7: Q(chi^2 | nu).
    for (statistic, degrees, expected) in
        [(1.0, 1, 0.317_31), (3.841_46, 1, 0.05), (10.0, 5, 0.075_24), (20.0, 30, 0.916_54)]
    {
        let p = upper_gamma(0.5 * f64::from(degrees), 0.5 * statistic);
        assert!((p - expected).abs() < 1e-5, "{statistic} {degrees}: {p}");
    }
    // (30 - 25)^2 / 25 + (20 - 25)^2 / 25 = 2, one degree of freedom.
    let result = chi_square(&[30, 20], &[25.0, 25.0]);
    assert_eq!((result.statistic, result.degrees_of_freedom), (2.0, 1));
    assert!((result.p_value - 0.157_30).abs() < 1e-5);
    assert!((1.0 - libm::pow(1.0 - sidak(1e-3, 27), 27.0) - 1e-3).abs() < 1e-9);
}

#[test]
fn the_chi_square_test_rejects_a_density_that_is_a_little_off() {
    let wo = direction(0.7, 0.5);
    let material = specular(MODEL_PHONG);
    for wrong_exponent in [11.0, 13.0] {
        let wrong = Closure { exponent: wrong_exponent, ..material };
        let mut random = Random(11);
        let (result, _) = test_sampler(
            60_000,
            || {
                let sample = sample_closure(&NO_SCENE.view(), &material, wo, random.unit2(), random.unit());
                (sample.pdf > 0.0).then_some(sample.wi)
            },
            &|wi| f64::from(pdf_closure(&NO_SCENE.view(), &wrong, wo, wi)),
        );
        assert!(result.p_value < 1e-6, "{wrong_exponent}: {result:?}");
    }
}

#[test]
fn every_sampler_follows_its_density() {
    let models = all_models();
    let views = [1.0, 0.7, 0.15];
    let significance = sidak(1e-3, models.len() * views.len());
    for (name, material) in &models {
        for z in views {
            let wo = direction(z, 0.5);
            let mut random = Random(11);
            let (result, integral) = test_sampler(
                60_000,
                || {
                    let sample = sample_closure(&NO_SCENE.view(), material, wo, random.unit2(), random.unit());
                    (sample.pdf > 0.0).then_some(sample.wi)
                },
                &|wi| f64::from(pdf_closure(&NO_SCENE.view(), material, wo, wi)),
            );
            assert!(result.p_value > significance, "{name} at {z}: {result:?}");
            assert!(integral < 1.0 + 1e-3, "{name} at {z}: pdf integrates to {integral}");
            // Only lobes that reach below the horizon lose samples.
            assert!(z < 0.9 || integral > 0.94, "{name} at {z}: pdf integrates to {integral}");
        }
    }
}

#[test]
fn the_beckmann_sampler_follows_its_density() {
    for m in [0.15f32, 0.5, 1.0] {
        let mut random = Random(5);
        let (result, integral) =
            test_sampler(60_000, || Some(sample_beckmann(random.unit2(), m)), &|wm| f64::from(pdf_beckmann(wm, m)));
        assert!(result.p_value > sidak(1e-3, 3), "m {m}: {result:?}");
        assert!((integral - 1.0).abs() < 1e-4, "m {m}: {integral}");
    }
}

#[test]
fn samples_weighted_by_eval_over_pdf_give_the_albedo() {
    for (name, material) in all_models() {
        for z in [0.9, 0.4] {
            let wo = direction(z, 2.0);
            let (mut sum, mut squares) = (0.0, 0.0);
            let mut random = Random(23);
            let count = 40_000;
            for _ in 0..count {
                let sample = sample_closure(&NO_SCENE.view(), &material, wo, random.unit2(), random.unit());
                assert!((sample.wi.length() - 1.0).abs() < 2e-6, "{name}: {}", sample.wi);
                if sample.pdf > 0.0 {
                    assert_eq!(sample.pdf, pdf_closure(&NO_SCENE.view(), &material, wo, sample.wi), "{name}");
                    let weight = value(&material, wo, sample.wi) / f64::from(sample.pdf);
                    sum += weight;
                    squares += weight * weight;
                }
            }
            let mean = sum / f64::from(count);
            let error = libm::sqrt((squares / f64::from(count) - mean * mean).max(0.0) / f64::from(count));
            let expected = albedo(&material, wo, 64);
            assert!((mean - expected).abs() < 4.5 * error + 1e-3, "{name} at {z}: {mean} +- {error}, {expected}");
        }
    }
}

#[test]
fn nothing_reflects_to_or_from_below_the_horizon() {
    let (above, below, horizon) = (direction(0.5, 0.0), -direction(0.5, 1.0), Vec3::X);
    for (name, material) in all_models() {
        for (wo, wi) in [(above, below), (below, above), (below, below), (above, horizon), (horizon, above)] {
            assert_eq!(value(&material, wo, wi), 0.0, "{name}");
            assert_eq!(pdf_closure(&NO_SCENE.view(), &material, wo, wi), 0.0, "{name}");
        }
        assert_eq!(sample_closure(&NO_SCENE.view(), &material, below, Vec2::splat(0.4), 0.4).pdf, 0.0, "{name}");
    }
}

#[test]
fn every_model_is_finite_at_the_edges_of_its_parameters_and_directions() {
    let zs = [0.0, 1e-9, 9e-7, 1.1e-6, 1e-5, 1e-3, 0.5, 0.999_999, 1.0];
    let us = [0.0f32, 1e-7, 0.5, 0.999_999_94];
    for (name, base) in all_models() {
        for (exponent, m) in [(0.0, 0.0), (1e-3, 1e-4), (1.0, 1.0), (64.0, 10.0), (1e5, 0.05), (1e9, 1e-3)] {
            for (k_d, k_s) in [(0.5, 0.5), (0.0, 0.0), (0.0, 1.0)] {
                let material = Closure { exponent, alpha_u: m, second_alpha_u: m, k_d, k_s, ..base };
                for a in zs {
                    let wo = direction(a, 0.0);
                    for b in zs {
                        for phi in [0.0, 1.0, std::f64::consts::PI] {
                            let wi = direction(b, phi);
                            let (eval, pdf) =
                                (value(&material, wo, wi), pdf_closure(&NO_SCENE.view(), &material, wo, wi));
                            assert!(eval.is_finite() && eval >= 0.0, "{name} {wo} {wi}: {eval}");
                            assert!(pdf.is_finite() && pdf >= 0.0, "{name} {wo} {wi}: {pdf}");
                        }
                    }
                    for u in us {
                        for v in us {
                            let sample = sample_closure(&NO_SCENE.view(), &material, wo, Vec2::new(u, v), 0.3);
                            assert!(sample.wi.is_finite() && sample.pdf.is_finite(), "{name} {wo} {u} {v}");
                        }
                    }
                }
            }
        }
    }
}

#[test]
fn phong_of_exponent_zero_is_constant_and_large_exponents_are_sharp() {
    let flat = Closure { exponent: 0.0, ..specular(MODEL_PHONG) };
    let (wo, away) = (direction(0.3, 0.0), direction(0.3, 0.0));
    assert_eq!(value(&flat, wo, away) as f32, std::f32::consts::FRAC_1_PI);
    let sharp = Closure { exponent: 64.0, ..specular(MODEL_PHONG) };
    let mirror = Vec3::new(-wo.x, -wo.y, wo.z);
    assert!((value(&sharp, wo, mirror) - std::f64::consts::FRAC_1_PI).abs() < 1e-5);
    assert_eq!(value(&sharp, wo, away), 0.0);
}

#[test]
fn mirror_and_dielectric_have_lobes_of_zero_width_only() {
    for model in [MODEL_MIRROR, MODEL_DIELECTRIC, MODEL_EMISSIVE] {
        let material = white(model);
        assert_eq!(value(&material, Vec3::Z, Vec3::Z), 0.0);
        assert_eq!(pdf_closure(&NO_SCENE.view(), &material, Vec3::Z, Vec3::Z), 0.0);
        let sample = sample_closure(&NO_SCENE.view(), &material, Vec3::Z, Vec2::splat(0.5), 0.5);
        assert_eq!(sample.pdf > 0.0, model != MODEL_EMISSIVE);
        assert_eq!(sample.flags & SAMPLE_DELTA != 0, model != MODEL_EMISSIVE);
        assert_eq!(ambient_closure(&material).x, 0.0);
        assert_eq!(is_delta(&material), model != MODEL_EMISSIVE);
    }
}

#[test]
fn the_mirror_branch_and_the_albedo_weigh_as_documented() {
    let color = Vec3::new(0.1, 0.2, 0.4);
    let colored = |model| Closure { color, k_r: 0.5, ..white(model) };
    assert_eq!(mirror_weight(&colored(MODEL_MIRROR), 0.5).truncate(), color);
    assert_eq!(mirror_weight(&colored(MODEL_PHONG), 0.5).truncate(), Vec3::splat(0.5));
    assert_eq!(mirror_weight(&colored(MODEL_PHONG), -0.5).truncate(), Vec3::ZERO);
    assert_eq!(mirror_weight(&colored(MODEL_DIELECTRIC), 0.5).truncate(), Vec3::ZERO);
    assert_eq!(ambient_closure(&colored(MODEL_COOK_TORRANCE)).truncate(), color);
    assert_eq!(albedo_closure(&colored(MODEL_LAMBERT)).truncate(), color * 0.5);
    assert_eq!(albedo_closure(&colored(MODEL_MIRROR)).truncate(), color);
    // k_d O_d + k_s F(0), F(0) = .04.
    let plastic = albedo_closure(&colored(MODEL_COOK_TORRANCE)).truncate();
    assert!((plastic - (color * 0.5 + 0.02)).abs().max_element() < 1e-6);
    assert_eq!(albedo_closure(&Closure { k_d: 9.0, ..colored(MODEL_LAMBERT) }).z, 1.0);
}
