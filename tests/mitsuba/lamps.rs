//! Colours of light, and lamps whose surface is not all there.

use super::{LEAST, material, read};
use gonio::scene::*;

#[test]
fn light_of_a_flat_spectrum_is_a_little_purple_and_numbers_and_colours_are_white() {
    let radiance = |text: &str| match read(&format!("{LEAST}<emitter type=\"constant\">{text}</emitter>")).background {
        Background::Gradient { bottom, .. } => bottom,
        other => panic!("{other:?}"),
    };
    // As Mitsuba 3.9's scalar_rgb has them.
    let flat = radiance("<spectrum name=\"radiance\" value=\"3\"/>");
    assert!((flat - Rgb::new(3.61438, 2.84487, 2.72675)).abs().max_element() < 1e-5, "{flat}");
    for white in [
        "<float name=\"radiance\" value=\"3\"/>",
        "<rgb name=\"radiance\" value=\"3\"/>",
        "<spectrum name=\"radiance\" type=\"uniform\"><float name=\"value\" value=\"3\"/></spectrum>",
        "<spectrum name=\"radiance\" type=\"d65\"><float name=\"scale\" value=\"3\"/></spectrum>",
    ] {
        assert_eq!(radiance(white), Rgb::splat(3.0), "{white}");
    }
    let wall = material("<bsdf type=\"diffuse\"><spectrum name=\"reflectance\" value=\"0.3\"/></bsdf>");
    assert_eq!(wall.color, Rgb::splat(0.3));
}

#[test]
fn lamps_of_nothing_and_of_masks_emit_as_whole_ones() {
    let emitter = "<emitter type=\"area\"><rgb name=\"radiance\" value=\"2\"/></emitter>";
    let clear = Some(Transparency::Filtered { k_t: 1.0, color: Rgb::ONE });
    for nothing in [
        "<bsdf type=\"null\"/>",
        "<bsdf type=\"mask\"><float name=\"opacity\" value=\"0\"/><bsdf type=\"diffuse\"/></bsdf>",
    ] {
        let lamp = material(&format!("{nothing}{emitter}"));
        assert_eq!((lamp.transparency, lamp.emission, lamp.color), (clear, Rgb::splat(2.0), Rgb::ZERO), "{nothing}");
    }
    let mask = "<bsdf type=\"mask\"><float name=\"opacity\" value=\"0.25\"/><bsdf type=\"diffuse\"/></bsdf>";
    let lamp = material(&format!("{mask}{emitter}"));
    assert_eq!((lamp.opacity, lamp.emission), (0.25, Rgb::splat(8.0)), "a quarter is covered");
}

#[test]
fn lights_of_no_size_pass_holes_under_volumetric_integrators_only() {
    for (kind, shadows) in [
        ("path", Shadows::Opaque),
        ("direct", Shadows::Opaque),
        ("volpath", Shadows::Filtered),
        ("volpathmis", Shadows::Filtered),
    ] {
        assert_eq!(read(&format!("{LEAST}<integrator type=\"{kind}\"/>")).settings.shadows, shadows, "{kind}");
    }
}
