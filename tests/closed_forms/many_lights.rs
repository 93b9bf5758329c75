//! A thousand point lights.

use super::common::{Random, empty_scene};
use super::{Mean, level, light, look_down, matte, picture, same_on_the_device};
use glam::{DVec3, Vec3};
use gonio::scene::*;
use std::f64::consts::PI;

const ALBEDO: f64 = 0.5;

/// A grey floor, 4 units wide in the picture, under 1,000 lamps at random places; every hundredth is 10,000 times as bright.
fn ballroom(integrator: Integrator) -> Scene {
    let mut random = Random::new(7);
    let mut scene = empty_scene();
    scene.settings = RenderSettings { integrator, samples: 16, max_depth: 1, ..scene.settings };
    scene.materials = vec![matte(Rgb::splat(ALBEDO as f32))];
    level(&mut scene, 0.0, 0);
    scene.lights = (0..1000)
        .map(|index| {
            let position = Vec3::new(random.range(-6.0, 6.0), random.range(3.0, 5.0), random.range(-6.0, 6.0));
            let bright = if index % 100 == 0 { 100.0 } else { 0.01 };
            light(LightKind::Point { position }, bright * random.range(0.5, 1.5))
        })
        .collect();
    look_down(&mut scene, 1.0, 4.0);
    scene
}

/// Radiance of a pixel's middle: the sum over all lamps in double precision.
fn radiance(scene: &Scene, index: usize) -> f64 {
    let at = |place: usize| (place as f64 + 0.5) / 4.0 - 2.0;
    // -z is up in the picture.
    let point = DVec3::new(at(index % 16), 0.0, at(index / 16));
    let of = |light: &Light| {
        let LightKind::Point { position } = light.kind else { panic!("{light:?}") };
        let way = position.as_dvec3() - point;
        f64::from(light.intensity.x) * way.y / way.length().powi(3) * ALBEDO / PI
    };
    scene.lights.iter().map(of).sum()
}

#[test]
fn a_thousand_lights_add_up_under_local_and_whitted() {
    for integrator in [Integrator::Local, Integrator::Whitted] {
        let scene = ballroom(integrator);
        for (index, pixel) in picture(&scene).into_iter().enumerate() {
            let wanted = radiance(&scene, index);
            // A quarter unit of floor is not quite flat in brightness.
            assert!(
                (f64::from(pixel[0]) - wanted).abs() < 3e-3 * wanted,
                "{integrator:?}, {index}: {pixel:?}, {wanted}"
            );
        }
    }
}

#[test]
fn paths_sample_a_thousand_lights_by_their_power() {
    let mut scene = ballroom(Integrator::Path);
    scene.settings.samples = 64;
    let pixels = picture(&scene);
    let ratio = |(index, pixel): (usize, &[f32; 4])| f64::from(pixel[0]) / radiance(&scene, index);
    let found = Mean::of(&pixels.iter().enumerate().map(ratio).collect::<Vec<f64>>());
    assert!((found.value - 1.0).abs() < 5.0 * found.error + 1e-3, "{found:?}");
    // Ten lamps of a thousand give nearly all light: chosen evenly, the error of 16,384 samples would be 8 %.
    assert!(found.error < 0.01, "{found:?}");
}

#[test]
fn a_thousand_lights_are_the_same_on_the_device() {
    for integrator in [Integrator::Whitted, Integrator::Path] {
        let mut scene = ballroom(integrator);
        scene.settings.samples = 2;
        scene.objects.push(Object {
            material: Some(MaterialId(0)),
            ..super::common::object(Geometry::Sphere, Transform::translate(Vec3::new(0.5, 0.8, 0.0)))
        });
        scene.camera.eye.y = 3.0;
        if !same_on_the_device(&scene, &format!("{integrator:?}")) {
            return;
        }
    }
}
