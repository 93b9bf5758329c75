//! Exposure, tone curves, sRGB, integers.

use gonio::film::Image;
use gonio::film::display::{Display, encode, quantise, srgb_decode, srgb_encode, tone_map};
use gonio::film::tone::{TONEMAP_NAMES, tone_curve, tonemap_from_name, tonemap_name};
use gonio::scene::ToneMap;

fn image(pixels: &[[f32; 4]]) -> Image {
    Image { width: pixels.len() as u32, height: 1, pixels: pixels.to_vec() }
}

fn shown(tonemap: ToneMap, exposure: f32, pixels: &[[f32; 4]]) -> Vec<[f64; 4]> {
    tone_map(&image(pixels), &Display { tonemap, exposure, gamma: None, transparent: false })
}

#[test]
fn clamp_keeps_light_up_to_one_after_exposure() {
    let pixels = [[0.25, 1.5, -2.0, 0.5], [f32::NAN, f32::INFINITY, 0.0, 0.0]];
    assert_eq!(shown(ToneMap::Clamp, 0.0, &pixels), [[0.25, 1.0, 0.0, 1.0], [0.0, 1.0, 0.0, 1.0]]);
    assert_eq!(shown(ToneMap::Clamp, -1.0, &pixels)[0], [0.125, 0.75, 0.0, 1.0]);
    assert_eq!(shown(ToneMap::Clamp, 2.0, &pixels)[0], [1.0, 1.0, 0.0, 1.0]);
}

#[test]
fn normalise_makes_the_largest_channel_two_to_the_exposure() {
    let pixels = [[1.0, 4.0, -8.0, 1.0], [2.0, 0.0, 3.0, 1.0]];
    assert_eq!(shown(ToneMap::Normalise, 0.0, &pixels), [[0.25, 1.0, 0.0, 1.0], [0.5, 0.0, 0.75, 1.0]]);
    assert_eq!(shown(ToneMap::Normalise, -1.0, &pixels)[0], [0.125, 0.5, 0.0, 1.0]);
    assert_eq!(shown(ToneMap::Normalise, 0.0, &[[0.0; 4]; 2]), [[0.0, 0.0, 0.0, 1.0]; 2]);
}

#[test]
fn reinhard_maps_luminance_l_to_l_over_one_plus_l_and_keeps_the_hue() {
    for l in [0.0f32, 0.25, 1.0, 3.0, 1000.0] {
        let [r, g, b, _] = shown(ToneMap::Reinhard, 0.0, &[[l, l, l, 1.0]])[0];
        let expected = f64::from(l) / (1.0 + f64::from(l));
        assert!((r - expected).abs() < 1e-12 && r == g && g == b, "{l}: {r} {expected}");
    }
    let [r, g, _, _] = shown(ToneMap::Reinhard, 0.0, &[[0.5, 0.25, 0.125, 1.0]])[0];
    assert!((r / g - 2.0).abs() < 1e-12);
    // One stop doubles the light before the curve.
    assert!((shown(ToneMap::Reinhard, 1.0, &[[1.0; 4]])[0][0] - 2.0 / 3.0).abs() < 1e-12);
    assert!(shown(ToneMap::Reinhard, 0.0, &[[f32::INFINITY, 0.0, 0.0, 1.0]])[0].iter().all(|v| v.is_finite()));
}

/// Khronos' UnlitTest through the ACES fit with light divided by .6 and gamma 2.2, as Cycles and Babylon.js store it.
#[test]
fn aces_shows_the_unlit_test_as_other_renderers_do() {
    let half = srgb_decode(128.0 / 255.0) as f32;
    let stops = (1.0f32 / 0.6).log2();
    let display = Display { tonemap: ToneMap::Aces, exposure: stops, gamma: Some(2.2), transparent: false };
    let codes = encode(&image(&[[1.0, half, 0.0, 1.0], [0.0, half, 1.0, 1.0]]), &display, 255);
    // Their WebP files say (238, 150, 37) and (38, 140, 224); lossy compression moves a code by up to three.
    for (code, want) in codes.iter().flat_map(|p| &p[..3]).zip([238, 150, 37, 38, 140, 224]) {
        assert!(code.abs_diff(want) <= 3, "{codes:?}");
    }
}

#[test]
fn aces_shows_middle_grey_as_a_tenth_and_loses_hue_at_the_top() {
    let grey = tone_curve(ToneMap::Aces, [0.18; 3]);
    assert!(grey.iter().all(|v| (v - 0.105).abs() < 0.001), "{grey:?}");
    assert_eq!(tone_curve(ToneMap::Aces, [0.0; 3]).map(|v| v < 1e-3), [true; 3]);
    assert_eq!(tone_curve(ToneMap::Aces, [f64::from(f32::MAX); 3]), [1.0; 3]);
    let [r, g, _] = tone_curve(ToneMap::Aces, [100.0, 1.0, 1.0]);
    assert!(r == 1.0 && g > 0.3, "{r} {g}");
}

/// The sigmoid passes .5 with slope 2 at middle grey, ten of its 16.5 stops from black (Sobotka 2022).
#[test]
fn agx_shows_middle_grey_in_the_middle_and_keeps_grey_grey() {
    let encoded = |light: f64| {
        let [r, g, b] = tone_curve(ToneMap::Agx, [light; 3]).map(|v| v.powf(1.0 / 2.2));
        // The published matrices are inverses of each other to three digits.
        assert!((r - g).abs() < 3e-4 && (g - b).abs() < 3e-4, "{r} {g} {b}");
        g
    };
    assert!((encoded(0.18) - 0.5).abs() < 0.004, "{}", encoded(0.18));
    let slope = (encoded(0.18 * 2f64.powf(0.1)) - encoded(0.18 * 2f64.powf(-0.1))) / (0.2 / 16.5);
    assert!((slope - 2.0).abs() < 0.1, "{slope}");
    assert!(encoded(0.0) < 0.003 && encoded(1e-9) < 0.003);
    assert!(encoded(0.18 * 2f64.powf(6.5)) > 0.99 && encoded(f64::from(f32::MAX)) > 0.99);
}

#[test]
fn curves_rise_and_agx_fades_bright_colours_to_white() {
    for (name, curve) in TONEMAP_NAMES {
        // AgX's polynomial dips by its own error below its eighth stop.
        let stops: Vec<f64> = (-20..=100).map(|i| tone_curve(curve, [2f64.powf(f64::from(i) / 10.0); 3])[1]).collect();
        assert!(stops.windows(2).all(|pair| pair[0] <= pair[1]), "{name}: {stops:?}");
    }
    let ratio = |curve, light: f64| {
        let [r, g, _] = tone_curve(curve, [light, light * 0.1, light * 0.1]);
        g / r
    };
    assert!(ratio(ToneMap::Agx, 16.0) > 0.7 && ratio(ToneMap::Agx, 0.1) < 0.3);
    assert!((ratio(ToneMap::Reinhard, 1.0) - 0.1).abs() < 1e-12);
}

#[test]
fn a_gamma_replaces_the_srgb_curve_and_leaves_alpha_alone() {
    let display = |gamma| Display { tonemap: ToneMap::Clamp, exposure: 0.0, gamma, transparent: true };
    let pixels = image(&[[0.25, 0.5, 1.0, 1.0], [0.0, 0.25, 0.5, 0.5]]);
    assert_eq!(encode(&pixels, &display(Some(2.0)), 255), [[128, 180, 255, 255], [0, 180, 255, 128]]);
    assert_eq!(encode(&pixels, &display(Some(1.0)), 100), [[25, 50, 100, 100], [0, 50, 100, 50]]);
    assert_eq!(encode(&pixels, &display(None), 255)[0], [137, 188, 255, 255]);
}

#[test]
fn transparent_pictures_are_unpremultiplied_before_the_curve() {
    let display = |tonemap| Display { tonemap, exposure: 0.0, gamma: None, transparent: true };
    let pixels = image(&[[0.25, 0.5, 0.0, 0.5], [0.5, 0.5, 0.5, 0.0], [2.0, 0.0, 0.0, 1.0]]);
    let clamped = tone_map(&pixels, &display(ToneMap::Clamp));
    assert_eq!(clamped, [[0.5, 1.0, 0.0, 0.5], [0.0; 4], [1.0, 0.0, 0.0, 1.0]]);
    let normalised = tone_map(&pixels, &display(ToneMap::Normalise));
    assert_eq!(normalised[0], [0.25, 0.5, 0.0, 0.5]);
    assert_eq!(encode(&pixels, &display(ToneMap::Clamp), 255)[0], [188, 255, 0, 128]);
}

#[test]
fn srgb_has_the_values_of_its_standard() {
    let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-6, "{a} {b}");
    close(srgb_encode(0.0), 0.0);
    close(srgb_encode(1.0), 1.0);
    close(srgb_encode(0.5), 0.735_357);
    close(srgb_encode(0.18), 0.461_356);
    close(srgb_encode(0.002), 0.025_84);
    close(srgb_decode(0.5), 0.214_041);
    close(srgb_decode(0.04), 0.003_095_975);
}

#[test]
fn every_code_survives_linear_light() {
    for max in [255u16, 65_535] {
        for code in 0..=max {
            let linear = srgb_decode(f64::from(code) / f64::from(max)) as f32;
            assert_eq!(quantise(srgb_encode(f64::from(linear)), max), code);
        }
    }
}

#[test]
fn quantising_rounds_to_the_nearest_code_and_saturates() {
    let cases =
        [(0.0, 0), (1.0, 255), (0.5, 128), (0.499 / 255.0, 0), (0.5 / 255.0, 1), (-1.0, 0), (7.0, 255), (f64::NAN, 0)];
    cases.iter().for_each(|(value, code)| assert_eq!(quantise(*value, 255), *code, "{value}"));
}

#[test]
fn displayed_codes_are_these_on_every_machine() {
    let pixels: Vec<[f32; 4]> = (0..1 << 14).map(|i| [i as f32 / 16_000.0, i as f32 / 777.0, 0.01, 1.0]).collect();
    let display = Display { tonemap: ToneMap::Reinhard, exposure: 0.7, gamma: None, transparent: false };
    let codes = encode(&image(&pixels), &display, 65_535);
    let bytes: Vec<u8> = codes.iter().flatten().flat_map(|code| code.to_le_bytes()).collect();
    assert_eq!(blake3::hash(&bytes).to_string()[..16], *"1c9b970472d80d58");
}

#[test]
fn tone_curves_are_known_by_the_names_they_have() {
    for (name, curve) in TONEMAP_NAMES {
        assert_eq!((tonemap_name(curve), tonemap_from_name(name)), (name, Ok(curve)));
    }
    assert_eq!(tonemap_from_name("filmic").unwrap_err(), "allowed: clamp, normalise, reinhard, aces, agx");
}
