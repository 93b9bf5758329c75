//! Lights: attenuation laws, cones, and points where a light has no direction.

use glam::Vec3;
use gonio::layout::{
    ATTENUATION_INVERSE_SQUARE, ATTENUATION_NONE, ATTENUATION_POLYNOMIAL, LIGHT_DIRECTIONAL, LIGHT_POINT, LIGHT_SPOT,
    Light, T_INFINITE,
};
use gonio::shading::light::sample_light;

fn lamp() -> Light {
    Light {
        position: Vec3::new(0.0, 0.0, 4.0),
        kind: LIGHT_POINT,
        direction: -Vec3::Z,
        intensity: Vec3::new(1.0, 2.0, 4.0),
        ..Default::default()
    }
}

fn spot(inner_degrees: f64, outer_degrees: f64, exponent: f32) -> Light {
    Light {
        kind: LIGHT_SPOT,
        attenuation: ATTENUATION_NONE,
        cos_inner: libm::cos(inner_degrees.to_radians()) as f32,
        cos_outer: libm::cos(outer_degrees.to_radians()) as f32,
        exponent,
        ..lamp()
    }
}

/// Red channel of a spot at a point seen from it `degrees` off its axis.
fn off_axis(light: &Light, degrees: f64) -> f32 {
    let x = 4.0 * libm::tan(degrees.to_radians()) as f32;
    sample_light(light, Vec3::new(x, 0.0, 0.0)).radiance.x
}

#[test]
fn a_point_light_falls_off_with_the_square_of_the_distance() {
    let sample = sample_light(&lamp(), Vec3::ZERO);
    assert_eq!((sample.wi, sample.distance), (Vec3::Z, 4.0));
    assert_eq!(sample.radiance.truncate(), Vec3::new(1.0, 2.0, 4.0) / 16.0);
    assert_eq!(sample.radiance.w, 0.0);
}

#[test]
fn the_lectures_attenuation_is_capped_at_one() {
    let light = Light { attenuation: ATTENUATION_POLYNOMIAL, c: Vec3::new(0.25, 0.25, 0.5), ..lamp() };
    // 1 / (.25 + .25 * 4 + .5 * 16)
    assert!((sample_light(&light, Vec3::ZERO).radiance.x - 1.0 / 9.25).abs() < 1e-7);
    // At distance .5 the polynomial is .5: 2 becomes 1.
    assert_eq!(sample_light(&light, Vec3::new(0.0, 0.0, 3.5)).radiance.x, 1.0);
    let nothing = Light { c: Vec3::ZERO, ..light };
    assert_eq!(sample_light(&nothing, Vec3::ZERO).radiance.x, 1.0);
    let none = Light { attenuation: ATTENUATION_NONE, ..lamp() };
    assert_eq!(sample_light(&none, Vec3::new(0.0, 300.0, 0.0)).radiance.x, 1.0);
}

#[test]
fn a_directional_light_has_one_direction_and_no_distance() {
    let light = Light { kind: LIGHT_DIRECTIONAL, attenuation: ATTENUATION_INVERSE_SQUARE, ..lamp() };
    for position in [Vec3::ZERO, Vec3::splat(1e6), light.position] {
        let sample = sample_light(&light, position);
        assert_eq!((sample.wi, sample.distance, sample.radiance.x), (Vec3::Z, T_INFINITE, 1.0));
    }
}

#[test]
fn a_hard_spot_ends_at_its_cone() {
    let light = spot(30.0, 30.0, 0.0);
    assert_eq!(off_axis(&light, 0.0), 1.0);
    assert_eq!(off_axis(&light, 29.99), 1.0);
    assert_eq!(off_axis(&light, 30.01), 0.0);
    assert_eq!(sample_light(&light, Vec3::new(0.0, 0.0, 8.0)).radiance.x, 0.0, "behind the lamp");
}

#[test]
fn a_soft_spot_falls_smoothly_between_its_edges() {
    let light = spot(20.0, 40.0, 0.0);
    assert_eq!(off_axis(&light, 19.9), 1.0);
    assert_eq!(off_axis(&light, 40.1), 0.0);
    // Half way in the cosine the smooth step is one half.
    let middle = (0.5 * (libm::cos(20f64.to_radians()) + libm::cos(40f64.to_radians()))).acos().to_degrees();
    assert!((off_axis(&light, middle) - 0.5).abs() < 1e-5);
    let falls = (20..=40).map(|degrees| off_axis(&light, f64::from(degrees))).collect::<Vec<_>>();
    assert!(falls.windows(2).all(|pair| pair[0] >= pair[1]));
    assert!(falls[0] > 0.999_999 && falls[20] < 1e-6);
}

#[test]
fn warns_exponent_narrows_the_beam() {
    for (exponent, expected) in [(0.0, 1.0), (1.0, 0.5), (2.0, 0.25), (8.0, 0.003_906_25)] {
        assert!((off_axis(&spot(80.0, 80.0, exponent), 60.0) - expected).abs() < 2e-6, "p = {exponent}");
    }
    // A cone wider than a half space: the cosine is negative, and no power of it may be a NaN.
    let wide = spot(180.0, 180.0, 3.0);
    assert_eq!(sample_light(&wide, Vec3::new(0.0, 1.0, 8.0)).radiance.x, 0.0);
    assert_eq!(sample_light(&spot(180.0, 180.0, 0.0), Vec3::new(0.0, 1.0, 8.0)).radiance.x, 1.0);
}

#[test]
fn directions_to_a_light_are_unit() {
    for exponent in -11..=14 {
        let size = libm::powf(10.0, exponent as f32);
        let light = Light { position: Vec3::new(0.3, -0.7, 0.2) * size, ..lamp() };
        let sample = sample_light(&light, Vec3::ZERO);
        assert!((sample.wi.length() - 1.0).abs() < 3e-7, "{size:e}: {}", sample.wi);
        assert!((sample.distance / (size * 0.787_400_8) - 1.0).abs() < 1e-6, "{size:e}: {}", sample.distance);
    }
}

#[test]
fn a_light_on_the_surface_or_out_of_reach_gives_nothing() {
    for kind in [LIGHT_POINT, LIGHT_SPOT] {
        for attenuation in [ATTENUATION_INVERSE_SQUARE, ATTENUATION_POLYNOMIAL, ATTENUATION_NONE] {
            let light = Light { kind, attenuation, ..lamp() };
            for position in [light.position, light.position + Vec3::X * 1e-30, Vec3::X * 1e18, Vec3::X * 1e30] {
                let sample = sample_light(&light, position);
                assert_eq!(sample.radiance.to_array(), [0.0; 4], "{position}");
                assert!(sample.wi.is_normalized() && sample.distance.is_finite());
            }
        }
    }
}

#[test]
fn flaps_keep_the_light_between_their_planes() {
    for kind in [LIGHT_POINT, LIGHT_DIRECTIONAL, LIGHT_SPOT] {
        let open = Light { cos_outer: -1.0, cos_inner: -1.0, attenuation: ATTENUATION_NONE, kind, ..lamp() };
        let flaps =
            Light { flaps_min: Vec3::new(-1.0, -T_INFINITE, 0.5), flaps_max: Vec3::new(2.0, 3.0, T_INFINITE), ..open };
        for (position, lit) in [
            (Vec3::new(0.0, 0.0, 1.0), true),
            // On the planes themselves.
            (Vec3::new(-1.0, 3.0, 0.5), true),
            (Vec3::new(2.0, -900.0, 900.0), true),
            (Vec3::new(-1.001, 0.0, 1.0), false),
            (Vec3::new(2.001, 0.0, 1.0), false),
            (Vec3::new(0.0, 3.001, 1.0), false),
            (Vec3::new(0.0, 0.0, 0.499), false),
        ] {
            let wanted = if lit { sample_light(&open, position).radiance } else { [0.0; 4].into() };
            assert_eq!(sample_light(&flaps, position).radiance, wanted, "kind {kind} at {position}");
            assert!(!lit || wanted.x > 0.0, "kind {kind} at {position}");
        }
    }
}
