//! Panes one behind another, seen through and shone through.

use super::common::empty_scene;
use super::scenes::render_cpu;
use super::{Mean, level, light, look_down, matte, pane, picture, same_by, same_on_the_device, sun};
use glam::Vec3;
use gonio::bake::bake;
use gonio::scene::*;
use std::f64::consts::PI;

const LAYERS: i32 = 64;
/// Bright, so that the film's steps are nothing beside what passes all layers.
const SUN: f32 = 2000.0;
const LIT: f64 = SUN as f64 / PI;
const K_T: f32 = 0.95;
const O_T: Rgb = Rgb::new(0.99, 0.97, 0.9);
const TREES: [Integrator; 2] = [Integrator::Local, Integrator::Whitted];
const ALL: [Integrator; 4] = [Integrator::Local, Integrator::Whitted, Integrator::Direct, Integrator::Path];

/// 64 level panes above a white floor, and the sun.
fn stack(integrator: Integrator, shadows: Shadows, transparency: Transparency) -> Scene {
    let mut scene = empty_scene();
    scene.settings =
        RenderSettings { integrator, shadows, samples: 4, min_weight: 0.0, max_depth: 2, ..scene.settings };
    scene.materials = vec![matte(Rgb::ONE), pane(Rgb::new(0.2, 0.4, 0.8), transparency)];
    level(&mut scene, 0.0, 0);
    for layer in 1..=LAYERS {
        level(&mut scene, 1.0 + 0.1 * layer as f32, 1);
    }
    scene.lights = vec![sun(SUN)];
    scene
}

fn filtered(k_t: f32, color: Rgb) -> Transparency {
    Transparency::Filtered { k_t, color }
}

/// Every pixel's channels within 1e-4 of the value: 64 products and the film's steps of 2^-22.
#[track_caller]
fn assert_all(scene: &Scene, wanted: [f64; 3], what: &str) {
    for pixel in picture(scene) {
        for (found, wanted) in pixel.iter().zip(wanted) {
            assert!((f64::from(*found) - wanted).abs() <= 1e-4 * wanted, "{what}: {found}, not {wanted}");
        }
    }
}

#[test]
fn sixty_four_layers_filter_a_shadow_ray_by_the_product_of_their_colours() {
    let power = |base: f32| f64::from(base).powi(LAYERS);
    for (transparency, tint) in
        [(filtered(K_T, O_T), O_T.to_array().map(power)), (Transparency::Interpolated { k_t: K_T }, [1.0; 3])]
    {
        for integrator in ALL {
            let mut scene = stack(integrator, Shadows::Filtered, transparency);
            // From below the panes.
            look_down(&mut scene, 0.5, 1.0);
            // What the floor sends up to the panes and they send down again, paths find as well.
            scene.settings.max_depth = 1;
            let wanted = tint.map(|tint| LIT * tint * power(K_T));
            assert_all(&scene, wanted, &format!("{integrator:?}, {transparency:?}"));
        }
    }
}

#[test]
fn sixty_four_layers_are_composed_from_front_to_back() {
    let k_t = f64::from(K_T);
    for integrator in TREES {
        let mut scene = stack(integrator, Shadows::Off, Transparency::Interpolated { k_t: K_T });
        look_down(&mut scene, 20.0, 1.0);
        // I = (1 - k) I_1 + k (...): a geometric series of equal panes, and the floor behind.
        let through = k_t.powi(LAYERS);
        let wanted = [0.2, 0.4, 0.8].map(|color| LIT * (color * (1.0 - through) + through));
        assert_all(&scene, wanted, &format!("{integrator:?}, interpolated"));

        let mut scene = stack(integrator, Shadows::Off, filtered(K_T, O_T));
        look_down(&mut scene, 20.0, 1.0);
        // I = I_1 + k O (...).
        let wanted = [(0.2, O_T.x), (0.4, O_T.y), (0.8, O_T.z)].map(|(color, tint)| {
            let ratio = k_t * f64::from(tint);
            let through = ratio.powi(LAYERS);
            LIT * (color * (1.0 - through) / (1.0 - ratio) + through)
        });
        assert_all(&scene, wanted, &format!("{integrator:?}, filtered"));
    }
}

#[test]
fn the_lectures_panes_cast_no_shadow_and_paths_find_no_lamp_behind_them() {
    for (integrator, wanted) in [(Integrator::Local, LIT), (Integrator::Direct, 0.0)] {
        let mut scene = stack(integrator, Shadows::Opaque, filtered(K_T, O_T));
        look_down(&mut scene, 0.5, 1.0);
        assert_all(&scene, [wanted; 3], &format!("{integrator:?}"));
    }
}

#[test]
fn sixty_four_layers_are_the_same_on_the_device_however_rays_are_batched() {
    // A shadow ray passes one pane a round. Small chunks have small queues, where those on their way hold up the rest: hundreds
    // of rounds instead of 130. Branches and paths take turns in one way each.
    let ways: [(Integrator, &[super::Path]); 4] = [
        (Integrator::Local, &[super::ANY_CHUNK]),
        (Integrator::Whitted, &[super::SMALL_CHUNKS]),
        (Integrator::Direct, &[super::ANY_CHUNK]),
        (Integrator::Path, &[super::SMALL_CHUNKS]),
    ];
    for (integrator, paths) in ways {
        let mut scene = stack(integrator, Shadows::Filtered, filtered(K_T, O_T));
        look_down(&mut scene, 20.0, 30.0);
        (scene.film.width, scene.film.height, scene.settings.samples) = (9, 7, 2);
        // More shadow rays than a chunk of 100 has room for.
        scene.lights = vec![sun(2.0), light(LightKind::Point { position: Vec3::new(1.0, 9.0, 2.0) }, 30.0), sun(0.5)];
        if !same_by(&scene, paths, &format!("{integrator:?}")) {
            return;
        }
    }
}

/// A glossy floor under two panes and a lamp of some size.
fn lamp_behind_panes(shadows: Shadows) -> Scene {
    let mut scene = empty_scene();
    scene.settings =
        RenderSettings { integrator: Integrator::Direct, shadows, samples: 256, max_depth: 1, ..scene.settings };
    let gloss = Model::RoughConductor {
        distribution: Distribution::TrowbridgeReitz,
        alpha_u: 0.15,
        alpha_v: 0.15,
        fresnel: Fresnel::Schlick { f0: Rgb::splat(0.9) },
        compensate: false,
    };
    scene.materials = vec![
        Material { model: gloss, ..matte(Rgb::ONE) },
        pane(Rgb::ZERO, filtered(0.8, Rgb::new(1.0, 0.5, 0.25))),
        Material { emission: Rgb::splat(5.0), ..matte(Rgb::ZERO) },
    ];
    level(&mut scene, 0.0, 0);
    level(&mut scene, 0.6, 1);
    level(&mut scene, 0.9, 1);
    let lamp = super::common::object(Geometry::Sphere, Transform::scale(Vec3::splat(0.4)));
    let lamp = Object { material: Some(MaterialId(2)), ..lamp };
    let there = |x: f32| Transform::scale(Vec3::splat(0.4)).then(Transform::translate(Vec3::new(x, 2.0, 0.0)));
    scene.objects.push(Object { transform: there(-0.6), ..lamp.clone() });
    scene.objects.push(Object {
        geometry: Geometry::Mesh(MeshId(1)),
        transform: Transform::scale(Vec3::splat(0.7)).then(there(0.6)),
        ..lamp
    });
    scene.meshes.push(super::common::globe(6));
    look_down(&mut scene, 0.5, 1.0);
    scene
}

/// The lamp's picture times `factor` less `other`, pixel by pixel, is noise about zero, and small beside the picture.
#[track_caller]
fn assert_same_light(channel: usize, factor: f64, picture_of: &Scene, other: &Scene) {
    let (a, b) = (picture(picture_of), picture(other));
    let value = |pixel: &[f32; 4]| f64::from(pixel[channel]);
    let differences: Vec<f64> = a.iter().zip(&b).map(|(a, b)| factor * value(a) - value(b)).collect();
    let bright = b.iter().map(value).sum::<f64>() / b.len() as f64;
    let found = Mean::of(&differences);
    assert!(found.value.abs() < 5.0 * found.error, "channel {channel}: {found:?} beside {bright}");
    assert!(bright > 50.0 * found.error, "channel {channel}: noise of {found:?} beside {bright}");
}

#[test]
fn a_lamp_behind_panes_is_as_bright_by_chance_as_by_filtered_shadow_rays() {
    // Opaque: the lamp is found through the panes by scattered rays alone. Filtered: by both ways, weighted.
    let [by_chance, by_both] = [Shadows::Opaque, Shadows::Filtered].map(lamp_behind_panes);
    for channel in 0..3 {
        assert_same_light(channel, 1.0, &by_chance, &by_both);
    }
}

#[test]
fn two_panes_weaken_a_lamp_by_both_their_factors() {
    let colored = lamp_behind_panes(Shadows::Filtered);
    let mut clear = lamp_behind_panes(Shadows::Filtered);
    clear.materials[1].transparency = Some(filtered(1.0, Rgb::ONE));
    for (channel, tint) in [(0, 0.8), (1, 0.4), (2, 0.2)] {
        assert_same_light(channel, tint * tint, &clear, &colored);
    }
}

#[test]
fn lamps_behind_panes_are_the_same_on_the_device() {
    let mut scene = lamp_behind_panes(Shadows::Filtered);
    scene.settings = RenderSettings { integrator: Integrator::Path, samples: 8, max_depth: 4, ..scene.settings };
    same_on_the_device(&scene, "two panes, path");
}

#[test]
fn holes_that_a_texture_cuts_let_filtered_shadow_rays_through() {
    let mut scene = stack(Integrator::Local, Shadows::Filtered, Transparency::Interpolated { k_t: 0.0 });
    let squares = Pattern { kind: PatternKind::Checker, colors: [Rgb::ZERO, Rgb::ONE] };
    scene.textures = vec![Texture { scale: [5.0, 5.0], ..Texture::pattern("squares", squares) }];
    let opacity =
        TextureBinding { parameter: Parameter::Opacity, texture: TextureId(0), channel: Channel::R, scale: 1.0 };
    scene.materials[1] = Material { textures: vec![opacity], ..matte(Rgb::ONE) };
    scene.objects.truncate(2);
    look_down(&mut scene, 0.5, 8.0);
    let lit = picture(&scene).iter().filter(|pixel| (f64::from(pixel[0]) / LIT - 1.0).abs() < 1e-4).count();
    let dark = picture(&scene).iter().filter(|pixel| pixel[0] == 0.0).count();
    assert_eq!((lit, dark), (128, 128), "4 x 4 fields of 4 x 4 pixels, half of them holes");
    scene.settings.shadows = Shadows::Opaque;
    assert_all(&scene, [0.0; 3], "the shadow of the whole pane");
}

/// Squares that a texture cuts out of a material.
fn squares() -> (Texture, TextureBinding) {
    let pattern = Pattern { kind: PatternKind::Checker, colors: [Rgb::ZERO, Rgb::ONE] };
    let binding =
        TextureBinding { parameter: Parameter::Opacity, texture: TextureId(0), channel: Channel::R, scale: 1.0 };
    (Texture { scale: [7.0, 3.0], ..Texture::pattern("squares", pattern) }, binding)
}

#[test]
fn holes_of_a_lamp_emit_nothing_however_it_is_sampled() {
    for shadows in [Shadows::Opaque, Shadows::Filtered] {
        let mut scene = lamp_behind_panes(shadows);
        let (texture, binding) = squares();
        scene.textures = vec![texture];
        scene.materials[2].textures = vec![binding];
        scene.objects.truncate(1);
        scene.meshes[0] = shape::quad([20.0, 20.0], 1);
        level(&mut scene, 2.0, 2);
        scene.objects[1].transform =
            Transform::scale(Vec3::new(0.08, 1.0, 0.1)).then(Transform::translate(Vec3::new(0.3, 2.0, 0.2)));
        let both = bake(&scene).expect("bakes");
        // Without emitters every direction comes from the surface, and counts in full.
        let by_chance = both.altered(|data| {
            data.header.emitter_count = 0;
            data.instances.iter_mut().for_each(|instance| instance.light_density = 0.0);
        });
        let mean = |data| Mean::of_channel(&render_cpu(&scene, data).resolve().pixels, 1);
        let (both, by_chance) = (mean(&both), mean(&by_chance));
        let error = (both.error * both.error + by_chance.error * by_chance.error).sqrt();
        assert!((both.value - by_chance.value).abs() < 5.0 * error, "{shadows:?}: {both:?} {by_chance:?}");
        assert!(both.value > 30.0 * error, "{shadows:?}: {both:?} is noise");
    }
}

#[test]
fn what_casts_no_shadow_takes_nothing_of_a_lamp_whatever_holes_it_has() {
    let mut scene = lamp_behind_panes(Shadows::Opaque);
    scene.settings.max_depth = 1;
    let (texture, binding) = squares();
    scene.textures = vec![texture];
    scene.materials[1] = Material { textures: vec![binding], casts_shadow: Some(false), ..matte(Rgb::ZERO) };
    let mut without = scene.clone();
    without.objects.retain(|object| object.material != Some(MaterialId(1)));
    let (with, without) = (picture(&scene), picture(&without));
    let differences: Vec<f64> = with.iter().zip(&without).map(|(a, b)| f64::from(a[1]) - f64::from(b[1])).collect();
    let found = Mean::of(&differences);
    let bright = without.iter().map(|pixel| f64::from(pixel[1])).sum::<f64>() / 256.0;
    assert!(found.value.abs() < 5.0 * found.error && bright > 30.0 * found.error, "{found:?} beside {bright}");
}
