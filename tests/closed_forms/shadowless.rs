//! Objects that cast no shadow: the light of a scene is as if they were not there, however it is found.

use super::common::{empty_scene, object};
use super::scenes::render_cpu;
use super::{Mean, level, look_down, matte, mean, pane, same_on_the_device};
use glam::Vec3;
use gonio::bake::bake;
use gonio::scene::*;

/// A floor under a large lamp, so that samples of the lamp and of the floor both find much of its light; seen from below
/// everything else. `rough`: the floor is a rough metal and not matte.
fn lit_floor(shadows: Shadows, rough: bool) -> Scene {
    let mut scene = empty_scene();
    scene.settings = RenderSettings {
        integrator: Integrator::Path,
        shadows,
        samples: 256,
        max_depth: 1,
        rr_depth: 65,
        ..scene.settings
    };
    let metal = Fresnel::Conductor { eta: Rgb::splat(0.2), k: Rgb::splat(3.0) };
    let model = Model::RoughConductor {
        distribution: Distribution::TrowbridgeReitz,
        alpha_u: 0.2,
        alpha_v: 0.2,
        fresnel: metal,
        compensate: false,
    };
    let floor = if rough { Material { model, ..matte(Rgb::ONE) } } else { matte(Rgb::splat(0.6)) };
    let lamp = Material { emission: Rgb::splat(2.0), ..matte(Rgb::ZERO) };
    let tinted = Transparency::Filtered { k_t: 0.5, color: Rgb::new(1.0, 0.8, 0.2) };
    scene.materials = vec![floor, lamp, matte(Rgb::ZERO), pane(Rgb::ZERO, tinted)];
    level(&mut scene, 0.0, 0);
    ball(&mut scene, 1.5, Vec3::Y * 4.0, 1, true);
    look_down(&mut scene, 0.5, 1.0);
    scene
}

/// A ball that casts a shadow or does not.
fn ball(scene: &mut Scene, radius: f32, centre: Vec3, material: u32, casts_shadow: bool) {
    let place = Transform::scale(Vec3::splat(radius)).then(Transform::translate(centre));
    scene.objects.push(Object {
        material: Some(MaterialId(material)),
        casts_shadow: Some(casts_shadow),
        ..object(Geometry::Sphere, place)
    });
}

#[test]
fn one_that_is_in_nobodys_way_changes_no_bit() {
    for rough in [false, true] {
        let mut scene = lit_floor(Shadows::Opaque, rough);
        let sums = |scene: &Scene| render_cpu(scene, &bake(scene).expect("bakes")).sums().to_vec();
        let alone = sums(&scene);
        ball(&mut scene, 1.0, Vec3::Y * -5.0, 2, false);
        assert!(bake(&scene).expect("bakes").features.has_shadowless);
        assert!(alone == sums(&scene), "a ball below the floor, rough {rough}");
    }
}

#[test]
fn one_that_is_in_the_way_takes_nothing() {
    for shadows in [Shadows::Opaque, Shadows::Filtered] {
        for rough in [false, true] {
            let mut scene = lit_floor(shadows, rough);
            // Where shadow rays stop at panes, light behind one is found by chance alone, and a ball is in its way.
            if shadows == Shadows::Filtered {
                level(&mut scene, 2.2, 3);
            }
            let alone = mean(&scene);
            for material in [2, 3] {
                let mut scene = scene.clone();
                ball(&mut scene, 0.4, Vec3::Y * 1.4, material, false);
                let what = format!("{shadows:?}, rough {rough}, material {material}");
                assert_equal_means(mean(&scene), alone, &what);
                assert!(alone.value > 100.0 * alone.error, "{what}: {alone:?} is noise");
                if !same_on_the_device(&scene, &what) {
                    return;
                }
            }
        }
    }
}

#[test]
fn the_environment_is_seen_through_one_without_noise() {
    // A rough metal floor under a bright sky: nearly all of its light is found by what it scatters.
    let mut scene = lit_floor(Shadows::Opaque, true);
    scene.objects.truncate(1);
    scene.background = Background::Gradient { bottom: Rgb::ZERO, top: Rgb::splat(2.0) };
    if let Model::RoughConductor { alpha_u, alpha_v, .. } = &mut scene.materials[0].model {
        (*alpha_u, *alpha_v) = (0.02, 0.02);
    }
    let alone = mean(&scene);
    for material in [2, 3] {
        let mut scene = scene.clone();
        // Large enough to be behind every ray, and two of them, one behind the other.
        ball(&mut scene, 3.0, Vec3::Y * 4.0, material, false);
        ball(&mut scene, 3.0, Vec3::Y * 11.0, material, false);
        let found = mean(&scene);
        assert_equal_means(found, alone, &format!("material {material}"));
        assert!(found.error < 2.0 * alone.error, "material {material}: {found:?} beside {alone:?}");
        if !same_on_the_device(&scene, "the sky behind balls without shadows") {
            return;
        }
    }
}

#[test]
fn an_inner_interface_that_casts_no_shadow_does_not_count_light_twice() {
    // Water whose surface stands inside a glass: of its own surface there nothing is met.
    let mut scene = lit_floor(Shadows::Opaque, false);
    let absorption = Rgb::ZERO;
    scene.materials[2] =
        Material { model: Model::Dielectric { eta: 1.0, absorption }, priority: Some(2), ..matte(Rgb::ONE) };
    scene.materials[3] =
        Material { model: Model::Dielectric { eta: 1.0, absorption }, priority: Some(1), ..matte(Rgb::ONE) };
    let alone = mean(&scene);
    ball(&mut scene, 0.6, Vec3::Y * 1.4, 2, false);
    ball(&mut scene, 0.3, Vec3::Y * 1.4, 3, false);
    assert_equal_means(mean(&scene), alone, "water in a glass, both of index 1");
}

#[track_caller]
fn assert_equal_means(a: Mean, b: Mean, what: &str) {
    let error = (a.error * a.error + b.error * b.error).sqrt();
    assert!((a.value - b.value).abs() < 5.0 * error, "{what}: {a:?} and {b:?}");
}
