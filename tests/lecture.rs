//! The lecture's numbers and formulas (rows 14, 16, 22, 23), from the processor and from the device.

#[path = "common/device.rs"]
mod device;
#[path = "common/scenes.rs"]
mod scenes;

use glam::DVec3;
use gonio::bake::bake;
use gonio::layout::{DISTRIBUTION_PHONG, MATERIAL_ANISOTROPIC, MATERIAL_D_1982, MATERIAL_SCHLICK};
use gonio::render::vulkan::{VulkanOptions, VulkanRenderer};
use gonio::scene::Fresnel;
use gonio::scene::load::load;
use gonio::scene::load::toml::METALS;
use gonio::verify::inputs::ARGUMENTS;
use gonio::verify::twins::{Family, RESULTS, evaluate, evaluate_on, models, shading};
use std::f64::consts::{FRAC_1_PI, PI};

/// What both backends give for the function `name`; one of them alone where there is no device.
struct Sides {
    context: Option<device::Validated<gonio::render::vulkan::Context>>,
}

impl Sides {
    fn new() -> Self {
        Self { context: device::context() }
    }

    /// The results for each set of arguments, side by side. One dispatch: drivers take seconds for a kernel.
    fn words(&mut self, family: &Family, name: &str, sets: &[Vec<u32>]) -> Vec<Vec<[f32; RESULTS]>> {
        let number = family.twins.iter().position(|twin| twin.name == name).unwrap_or_else(|| panic!("{name}"));
        let mut inputs = vec![0; sets.len() * ARGUMENTS];
        for (set, input) in sets.iter().zip(inputs.chunks_mut(ARGUMENTS)) {
            input[..set.len()].copy_from_slice(set);
        }
        let mut sides = vec![evaluate(family, number, &inputs)];
        if let Some(context) = &mut self.context {
            sides.push(evaluate_on(context, family, number, &inputs).expect("the kernel runs"));
        }
        let result = |words: &Vec<u32>, set: usize| std::array::from_fn(|i| f32::from_bits(words[set * RESULTS + i]));
        (0..sets.len()).map(|set| sides.iter().map(|words| result(words, set)).collect()).collect()
    }

    fn floats(&mut self, name: &str, sets: &[Vec<f64>]) -> Vec<Vec<[f32; RESULTS]>> {
        let words = |set: &Vec<f64>| set.iter().map(|argument| (*argument as f32).to_bits()).collect();
        self.words(&shading::FAMILY, name, &sets.iter().map(words).collect::<Vec<_>>())
    }

    /// Both sides of a function of `parity/shading` give what is expected of each set of arguments, within a bound.
    #[track_caller]
    fn assert_near(&mut self, name: &str, cases: &[(Vec<f64>, Vec<f64>, f64)]) {
        let sets: Vec<Vec<f64>> = cases.iter().map(|(arguments, ..)| arguments.clone()).collect();
        for ((arguments, expected, bound), sides) in cases.iter().zip(self.floats(name, &sets)) {
            for (side, got) in sides.iter().enumerate() {
                for (got, expected) in got.iter().zip(expected) {
                    let got = f64::from(*got);
                    let near = (got - expected).abs() <= *bound;
                    assert!(near, "{name}{arguments:?}, side {side}: {got} for {expected}");
                }
            }
        }
    }
}

fn cos(degrees: f64) -> f64 {
    libm::cos(degrees.to_radians())
}

fn polar(degrees: f64, azimuth: f64) -> DVec3 {
    let (theta, phi) = (degrees.to_radians(), azimuth.to_radians());
    DVec3::new(libm::sin(theta) * libm::cos(phi), libm::sin(theta) * libm::sin(phi), libm::cos(theta))
}

#[test]
fn fresnel_reflectances_are_the_printed_ones() {
    let mut sides = Sides::new();
    let dielectric = [
        (vec![cos(45.0), 1.5], vec![0.050_239_9], 5e-8),
        (vec![cos(10.0), 1.0 / 1.5], vec![0.040_083_0], 5e-8),
        // Brewster, 56.310 degrees: half of r_s^2 = (5 / 13)^2 alone; critical, 41.810 degrees.
        (vec![cos(56.310), 1.5], vec![25.0 / 338.0], 5e-7),
        (vec![cos(41.811), 1.0 / 1.5], vec![1.0], 0.0),
    ];
    sides.assert_near("fresnel_dielectric", &dielectric);
    let below = sides.floats("fresnel_dielectric", &[vec![cos(41.809), 1.0 / 1.5]]);
    assert!(below[0].iter().all(|side| side[0] < 0.99), "{below:?}");
    // Copper at 650, 550 and 450 nm (Johnson and Christy 1972), at normal incidence and at 85 degrees.
    let copper = [0.237_797_85, 1.006_626_9, 1.240_441_2, 3.626_414_5, 2.582_307_5, 2.392_941_2];
    let mut conductor = vec![
        ([&[1.0], &copper[..]].concat(), vec![0.9352, 0.6235, 0.5383], 5e-5),
        ([&[cos(85.0)], &copper[..]].concat(), vec![0.960, 0.832, 0.797], 5e-4),
    ];
    // Metals under D65 at normal incidence, linear sRGB: gold's red, 1.022, is beyond what any surface reflects.
    for (symbol, expected) in [
        ("Cu", [0.955, 0.638, 0.537]),
        ("Au", [0.99, 0.783, 0.342]),
        ("Ag", [0.971, 0.960, 0.913]),
        ("Al", [0.913, 0.922, 0.922]),
    ] {
        let metal = METALS.iter().find(|(name, _)| *name == symbol).expect("a metal").1;
        let Fresnel::Conductor { eta, k } = metal.fresnel() else { panic!("{symbol}") };
        let arguments = [1.0f32].into_iter().chain(eta.to_array()).chain(k.to_array()).map(f64::from);
        conductor.push((arguments.collect(), expected.to_vec(), 1e-4));
    }
    sides.assert_near("fresnel_conductor3", &conductor);
}

#[test]
fn beckmann_s_distribution_has_the_printed_values() {
    let at = |m: f64, degrees: f64| libm::exp(-(libm::tan(degrees.to_radians()) / m).powi(2)) / (m * m);
    let mut cases = vec![
        (vec![1.0, 0.1], vec![31.830_987_9], 5e-6),
        // The cosine's last digit counts 1e-6 of it.
        (vec![libm::cos(PI / 19.0), 0.1], vec![2.076_730_7], 1e-4),
    ];
    for (m, degrees) in [(0.2, 20.0), (0.4, 35.0), (0.6, 60.0)] {
        let expected = at(m, degrees) * FRAC_1_PI / cos(degrees).powi(4);
        cases.push((vec![cos(degrees), m], vec![expected], 1e-5 * expected));
    }
    Sides::new().assert_near("beckmann_d", &cases);
}

#[test]
fn a_white_metal_of_other_facets_has_their_printed_and_their_own_values() {
    let metal = |v: DVec3, l: DVec3, flags: u32, along: f64, across: f64| {
        let mut words =
            [v.x, v.y, v.z, l.x, l.y, l.z, 0.0, 1.0, 1.0, 0.0, along, 0.0].map(|x| (x as f32).to_bits()).to_vec();
        words.extend([MATERIAL_SCHLICK | flags, (across as f32).to_bits()]);
        words
    };
    // Beckmann's slopes .1 and .3, lit and seen along the normal: D(0) G F / 4 = D(0) / 4.
    let mut sets = vec![metal(DVec3::Z, DVec3::Z, MATERIAL_ANISOTROPIC, 0.1, 0.3)];
    // Phong's cos^2, alpha^2 = 1/2, each direction masked by Smith's 1 / (1 + Lambda). Of slopes like these Lambda is
    // C (tan sin^3 / 3 - S), S the integral of sin^3 up to theta, and C = 3/4.
    let angles = [(70.0, 50.0), (40.0, 85.0), (20.0, 20.0)];
    let alpha = libm::sqrt(0.5);
    for (view, light) in angles {
        sets.push(metal(
            polar(view, 0.0),
            polar(light, 170.0),
            DISTRIBUTION_PHONG << models::DISTRIBUTION_AT,
            alpha,
            alpha,
        ));
    }
    let results = Sides::new().words(&models::FAMILY, "eval_rough_conductor pdf_rough_conductor", &sets);
    let masked = |w: DVec3| {
        let sin = w.truncate().length();
        1.0 / (1.0 + 0.75 * (sin.powi(4) / (3.0 * w.z) - (2.0 / 3.0 - w.z + w.z.powi(3) / 3.0)))
    };
    let mut expected = vec![(10.6103 / 4.0, 2e-5)];
    for (view, light) in angles {
        let (v, l) = (polar(view, 0.0), polar(light, 170.0));
        let d = 4.0 / (2.0 * PI) * (l + v).normalize().z.powi(2);
        // Lambda is a fit within 1 % for each direction.
        expected.push((d * masked(v) * masked(l) / (4.0 * v.z), 0.02));
    }
    for (sides, (expected, bound)) in results.iter().zip(expected) {
        for (side, got) in sides.iter().enumerate() {
            let got = f64::from(got[0]);
            assert!((got - expected).abs() < bound * expected, "side {side}: {got} for {expected}");
        }
        assert!(
            sides
                .iter()
                .all(|side| side[..5].iter().map(|x| x.to_bits()).eq(sides[0][..5].iter().map(|x| x.to_bits())))
        );
    }
}

/// min(1, 2(N.H)(N.V)/(V.H), 2(N.H)(N.L)/(V.H)) (row 16).
fn grooves(l: DVec3, v: DVec3) -> f64 {
    let h = (l + v).normalize();
    1f64.min(2.0 * h.z * v.z / v.dot(h)).min(2.0 * h.z * l.z / v.dot(h))
}

/// Light and view, degrees: in the plane, to both sides of it, grazing, facing each other.
const ANGLES: [[f64; 4]; 7] = [
    [30.0, 180.0, 50.0, 0.0],
    [30.0, 180.0, 30.0, 0.0],
    [70.0, 180.0, 80.0, 10.0],
    [5.0, 90.0, 60.0, 200.0],
    [45.0, 0.0, 45.0, 90.0],
    [60.0, 30.0, 60.0, 30.0],
    [85.0, 180.0, 40.0, 0.0],
];

#[test]
fn masking_is_row_16_s_formula() {
    let case = |[light, light_phi, view, view_phi]: [f64; 4]| {
        let (l, v) = (polar(light, light_phi), polar(view, view_phi));
        let h = (l + v).normalize();
        (vec![h.z, v.z, v.dot(h), l.z], vec![grooves(l, v)], 1e-6)
    };
    let cases = ANGLES.map(case);
    let below_one = cases.iter().filter(|(_, expected, _)| expected[0] < 1.0).count();
    assert!((2..6).contains(&below_one), "both sides of the kink: {below_one}");
    Sides::new().assert_near("v_cavity_g", &cases);
}

#[test]
fn cook_torrance_is_row_14_s_formula() {
    let (m, k_s, eta) = (0.35, 0.6, 1.5);
    let (mut sets, mut expected) = (Vec::new(), Vec::new());
    for flags in [0, MATERIAL_D_1982] {
        for [light, light_phi, view, view_phi] in ANGLES {
            let (l, v) = (polar(light, light_phi), polar(view, view_phi));
            let h = (l + v).normalize();
            let tan2 = (1.0 - h.z * h.z) / (h.z * h.z);
            // R_s = D G F / (pi N.V), the N.L cancelled, with the lecture's D = e^-(tan a / m)^2 / (4 m^2 cos^4 a).
            let d = libm::exp(-tan2 / (m * m)) / (4.0 * m * m * h.z.powi(4));
            let (c, g) = (v.dot(h), libm::sqrt(eta * eta - 1.0 + v.dot(h).powi(2)));
            let f = 0.5 * ((g - c) / (g + c)).powi(2) * (1.0 + ((c * (g + c) - 1.0) / (c * (g - c) + 1.0)).powi(2));
            let r_s = d * grooves(l, v) * f / (PI * v.z) * if flags == 0 { 1.0 } else { 4.0 };
            // The parity material's O_d is .75 in red, its O_s 1; both lobes have the slope m.
            expected.push((1.0 - k_s) * 0.75 * FRAC_1_PI * l.z + k_s * r_s);
            let mut words: Vec<u32> = [v.x, v.y, v.z, l.x, l.y, l.z, 0.0, k_s, eta, 0.0, m, m]
                .map(|argument| (argument as f32).to_bits())
                .to_vec();
            words.extend([flags, (m as f32).to_bits()]);
            sets.push(words);
        }
    }
    let results = Sides::new().words(&models::FAMILY, "eval_cook_torrance pdf_cook_torrance", &sets);
    for (case, (sides, expected)) in results.iter().zip(expected).enumerate() {
        for (side, got) in sides.iter().enumerate() {
            let got = f64::from(got[0]);
            assert!((got - expected).abs() < 1e-5 * expected, "case {case}, side {side}: {got} for {expected}");
        }
    }
}

#[test]
fn refraction_is_row_23_s_formula() {
    let mut cases = Vec::new();
    for (eta_i, eta_t) in [(1.0, 1.5), (1.5, 1.0), (1.0, 2.417), (1.333, 1.5)] {
        for degrees in [0.0, 10.0, 30.0, 41.0, 41.8, 41.82, 60.0, 85.0] {
            cases.push((eta_i, eta_t, degrees, polar(degrees, 25.0)));
        }
    }
    let sets: Vec<Vec<f64>> = cases.iter().map(|(i, t, _, l)| vec![l.x, l.y, l.z, t / i]).collect();
    for ((eta_i, eta_t, degrees, l), sides) in cases.into_iter().zip(Sides::new().floats("refract_local", &sets)) {
        let ratio: f64 = eta_i / eta_t;
        let cos2_t = 1.0 - ratio * ratio * (1.0 - l.z * l.z);
        for got in sides {
            assert_eq!(got[4].to_bits() == 1, cos2_t < 0.0, "{eta_i} {eta_t} {degrees}: total");
            if cos2_t < 0.0 {
                continue;
            }
            let t = DVec3::Z * (ratio * l.z - libm::sqrt(cos2_t)) - l * ratio;
            let got = DVec3::new(got[0].into(), got[1].into(), got[2].into());
            // Next to the critical angle the root has an endless slope.
            let bound = if cos2_t < 1e-2 { 2e-4 } else { 2e-6 };
            assert!((got - t).length() < bound, "{eta_i} {eta_t} {degrees}: {got} for {t}");
            let sines = [eta_i * libm::sin(degrees.to_radians()), eta_t * got.truncate().length()];
            assert!((sines[0] - sines[1]).abs() < 1e-3, "Snell: {sines:?}");
        }
    }
}

/// The middle of the picture of a scene, from both backends: film values, red, green and blue.
fn middle(text: &str) -> Vec<[f64; 3]> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("a.toml");
    std::fs::write(&file, text).expect("writable");
    let scene = load(&file, &[]).unwrap_or_else(|error| panic!("{error}"));
    let data = bake(&scene).expect("baked");
    let mut films = vec![scenes::render_cpu(&scene, &data)];
    if device::context().is_some() {
        let renderer = VulkanRenderer::new(&data, VulkanOptions { validate: true, ..VulkanOptions::default() });
        let renderer = renderer.expect("a renderer");
        let messages = renderer.messages();
        let mut renderer = device::Validated::new(renderer, messages);
        films.push(scenes::render(&mut *renderer, &scene, &data, 0..scene.settings.samples));
    }
    let pixel = scene.film.width * scene.film.height / 2 + scene.film.width / 2;
    let seen = |film: &gonio::film::Film| film.resolve().pixels[pixel as usize];
    films.iter().map(seen).map(|pixel| [pixel[0], pixel[1], pixel[2]].map(f64::from)).collect()
}

/// Unpolarised reflectance of a metal, in double precision.
fn conductor(c: f64, eta: f64, k: f64) -> f64 {
    let s2 = 1.0 - c * c;
    let a0 = eta * eta - k * k - s2;
    let ab = libm::sqrt(a0 * a0 + 4.0 * eta * eta * k * k);
    let a = libm::sqrt(0.5 * (ab + a0));
    let r_s = (ab + c * c - 2.0 * a * c) / (ab + c * c + 2.0 * a * c);
    let (t3, t4) = (c * c * ab + s2 * s2, 2.0 * a * c * s2);
    0.5 * (r_s + r_s * (t3 - t4) / (t3 + t4))
}

#[test]
fn the_vases_of_1982_have_the_radiance_of_their_formula() {
    // Copper: s = 1, d = 0, m = .4 (w .4) and .2 (w .6). Plastic: s = .1, d = .9, m = .15. Two lights of one radiance and solid
    // angles of 1e-4 and 2e-4: here 10,000 W / (m^2 sr).
    let copper = "metal = \"Cu\"\nlobes = [{ m = 0.4, weight = 0.4 }, { m = 0.2, weight = 0.6 }]\n";
    let plastic = "color = [0.65, 0.06, 0.05]\neta = 1.5\nm = 0.15\nk_s = 0.1\n";
    let Fresnel::Conductor { eta, k } = METALS[0].1.fresnel() else { panic!("{METALS:?}") };
    let v = polar(35.0, 0.0);
    for mirrored in [30.0, 50.0] {
        let lights = [(polar(mirrored, 180.0), 1e-4), (polar(55.0, 160.0), 2e-4)];
        for (keys, lobes, s, o_d) in [
            (copper, vec![(0.4, 0.4), (0.2, 0.6)], 1.0, [0.0; 3]),
            (plastic, vec![(0.15, 1.0)], 0.1, [0.65, 0.06, 0.05]),
        ] {
            let mut text = format!(
                "[render]\nintegrator = \"local\"\nintensity = \"radiometric\"\nsamples = 4\n[film]\nsize = [8, 8]\n\
                 filter = \"box\"\n[camera]\nprojection = \"orthographic\"\neye = [{}, {}, {}]\nheight = 0.1\n[[material]]\n\
                 name = \"vase\"\nmodel = \"cook-torrance\"\n{keys}[[object]]\nshape = \"quad\"\nrotate = [1, 0, 0, 90]\n\
                 material = \"vase\"\n",
                v.x, v.y, v.z
            );
            for (l, solid_angle) in lights {
                text.push_str(&format!(
                    "[[light]]\ntype = \"directional\"\ndirection = [{}, {}, {}]\nintensity = {}\n",
                    -l.x,
                    -l.y,
                    -l.z,
                    1e4 * solid_angle
                ));
            }
            let expected: [f64; 3] = std::array::from_fn(|c| {
                let of = |(l, solid_angle): (DVec3, f64)| {
                    let h = (l + v).normalize();
                    let tan2 = (1.0 - h.z * h.z) / (h.z * h.z);
                    let lobe = |(m, w): &(f64, f64)| w * libm::exp(-tan2 / (m * m)) / (4.0 * m * m * h.z.powi(4));
                    let d: f64 = lobes.iter().map(lobe).sum();
                    let metal = s == 1.0;
                    let (n, k) = if metal { (eta[c].into(), k[c].into()) } else { (1.5, 0.0) };
                    let r_s = d * grooves(l, v) * conductor(v.dot(h), n, k) / (PI * v.z * l.z);
                    1e4 * l.z * solid_angle * (s * r_s + (1.0 - s) * o_d[c] * FRAC_1_PI)
                };
                lights.into_iter().map(of).sum()
            });
            for (side, got) in middle(&text).into_iter().enumerate() {
                let near = |c: usize| (got[c] - expected[c]).abs() < 2e-5 * expected[c] + 1e-6;
                assert!((0..3).all(near), "{keys}{mirrored}, side {side}: {got:?} for {expected:?}");
            }
        }
    }
}

#[test]
fn the_sum_over_lights_is_row_5_s_formula() {
    let (k_a, k_d, k_s, n) = (0.5, 0.6, 0.35, 12);
    let (o_d, o_s, i_a) = ([0.8, 0.5, 0.2], [1.0, 0.9, 0.7], [0.3, 0.2, 0.1]);
    let eye = DVec3::new(1.0, 0.5, 4.0);
    // Place, I_p, its attenuation and what that leaves at distance d.
    type Law = fn(f64) -> f64;
    let lights: [(DVec3, f64, &str, Law); 4] = [
        (DVec3::new(-1.0, 0.2, 3.0), 2.0, "[0.2, 0.1, 0.3]", |d| 1f64.min(1.0 / (0.2 + 0.1 * d + 0.3 * d * d))),
        (DVec3::new(0.5, -0.3, 0.6), 0.25, "[0.2, 0.1, 0.3]", |d| 1f64.min(1.0 / (0.2 + 0.1 * d + 0.3 * d * d))),
        (DVec3::new(2.0, 1.0, 2.0), 3.0, "\"inverse-square\"", |d| 1.0 / (d * d)),
        (DVec3::new(-2.0, -1.0, 1.0), 0.4, "\"none\"", |_| 1.0),
    ];
    for model in ["phong", "blinn-phong"] {
        let mut text = format!(
            "[render]\nintegrator = \"whitted\"\nintensity = \"lecture\"\nambient = {i_a:?}\nsamples = 4\n[film]\nsize = [8, 8]\n\
             filter = \"box\"\n[camera]\nprojection = \"orthographic\"\neye = [{}, {}, {}]\nheight = 1e-4\n[[material]]\n\
             name = \"m\"\nmodel = \"{model}\"\ncolor = {o_d:?}\nspecular_color = {o_s:?}\nk_a = {k_a}\nk_d = {k_d}\nk_s = {k_s}\n\
             exponent = {n}\n[[object]]\nshape = \"quad\"\nrotate = [1, 0, 0, 90]\nmaterial = \"m\"\n",
            eye.x, eye.y, eye.z
        );
        for (place, i_p, law, _) in &lights {
            text.push_str(&format!(
                "[[light]]\ntype = \"point\"\nposition = [{}, {}, {}]\nintensity = {i_p}\nattenuation = {law}\n",
                place.x, place.y, place.z
            ));
        }
        let v = eye.normalize();
        let expected: [f64; 3] = std::array::from_fn(|c| {
            let of = |(place, i_p, _, attenuate): &(DVec3, f64, &str, Law)| {
                let l = place.normalize();
                let highlight = match model {
                    "phong" => v.dot(DVec3::Z * (2.0 * l.z) - l).max(0.0),
                    _ => (l + v).normalize().z,
                };
                attenuate(place.length()) * i_p * (k_d * o_d[c] * l.z + k_s * o_s[c] * highlight.powi(n))
            };
            i_a[c] * k_a * o_d[c] + lights.iter().map(of).sum::<f64>()
        });
        for (side, got) in middle(&text).into_iter().enumerate() {
            let near = |c: usize| (got[c] - expected[c]).abs() < 1e-4 * expected[c];
            assert!((0..3).all(near), "{model}, side {side}: {got:?} for {expected:?}");
        }
    }
}

#[test]
fn panes_are_row_22_s_formula_in_each_order() {
    // Name, O_d, k_t, O_t; the light comes from behind the eye, at 60 degrees: N.L = 1/2, I_p = 1.
    let red = ("red", [0.9, 0.2, 0.1], 0.4, [1.0, 0.3, 0.2]);
    let green = ("green", [0.1, 0.8, 0.3], 0.7, [0.2, 1.0, 0.4]);
    let blue = ("blue", [0.2, 0.3, 0.9], 0.55, [0.3, 0.4, 1.0]);
    let background = [0.35, 0.45, 0.25];
    for filtered in [false, true] {
        for order in [vec![red, green], vec![green, red], vec![red, green, blue], vec![blue, green, red]] {
            let mut text = format!(
                "[render]\nintegrator = \"whitted\"\nintensity = \"lecture\"\nsamples = 4\nmin_weight = 0\n\
                 [film]\nsize = [8, 8]\nfilter = \"box\"\n[background]\ncolor = {background:?}\n\
                 [camera]\nprojection = \"orthographic\"\neye = [0, 0, 5]\nheight = 1\n\
                 [[light]]\ntype = \"directional\"\ndirection = [-0.8660254037844386, 0, -0.5]\nintensity = 1\n"
            );
            for (depth, (name, color, k_t, transmitted)) in order.iter().enumerate() {
                let mode = match filtered {
                    true => format!("transparency_mode = \"filtered\"\ntransparency_color = {transmitted:?}\n"),
                    false => String::new(),
                };
                text.push_str(&format!(
                    "[[material]]\nname = \"{name}\"\ncolor = {color:?}\nk_t = {k_t}\nk_a = 0\n{mode}[[object]]\n\
                     shape = \"quad\"\nsize = [4, 4]\nrotate = [1, 0, 0, 90]\ntranslate = [0, 0, {}]\nmaterial = \"{name}\"\n",
                    1.0 - depth as f64
                ));
            }
            let expected: [f64; 3] = std::array::from_fn(|c| {
                // From the back: I = (1 - k_t1) I_1 + k_t1 I_2, or I_1 + k_t1 O_t1 I_2.
                order.iter().rev().fold(background[c], |behind, (_, color, k_t, transmitted)| {
                    let own = color[c] * 0.5;
                    if filtered { own + k_t * transmitted[c] * behind } else { (1.0 - k_t) * own + k_t * behind }
                })
            });
            for (side, got) in middle(&text).into_iter().enumerate() {
                let near = |c: usize| (got[c] - expected[c]).abs() < 2e-6;
                assert!((0..3).all(near), "filtered {filtered}, side {side}: {got:?} for {expected:?}");
            }
        }
    }
}

#[test]
fn a_sphere_of_reflectance_one_half_lit_from_its_centre_reaches_1_minus_2_to_the_minus_n() {
    for depth in [1, 2, 5] {
        let text = format!(
            "[render]\nintegrator = \"path\"\nintensity = \"radiometric\"\nsamples = 16\nmax_depth = {depth}\n\
             rr_depth = 64\n[film]\nsize = [8, 8]\nfilter = \"box\"\n[camera]\neye = [0.3, 0.1, -0.2]\ntarget = [0, 1, 0.5]\n\
             [[material]]\nname = \"half\"\ncolor = 0.5\n[[object]]\nshape = \"sphere\"\nmaterial = \"half\"\n\
             [[light]]\ntype = \"point\"\nposition = [0, 0, 0]\nintensity = 3.141592653589793\n"
        );
        for (side, got) in middle(&text).into_iter().enumerate() {
            let expected = 1.0 - 0.5f64.powi(depth);
            assert!((got[1] - expected).abs() < 1e-4, "{depth} events, side {side}: {got:?} for {expected}");
        }
    }
}
