//! Clear bodies that overlap. Straight down through flat interfaces, Fresnel's reflectance is ((a - b) / (a + b))^2.

use super::common::{empty_scene, object};
use super::{Mean, assert_mean, look_down, mean, same_on_the_device};
use glam::Vec3;
use gonio::bake::bake;
use gonio::scene::*;

const AIR: f64 = 1.0;
const WATER: f64 = 1.333;
const GLASS: f64 = 1.5;
const DIAMOND: f64 = 2.417;

fn clear(eta: f64, absorption: f32, priority: Option<u32>) -> Material {
    let model = Model::Dielectric { eta: eta as f32, absorption: Rgb::splat(absorption) };
    Material { model, priority, ..super::matte(Rgb::ONE) }
}

/// Blocks from one height to another, each of its own material, over a white sky below; seen from above. Rays that have
/// turned up see nothing.
fn pile(integrator: Integrator, depth: u32, blocks: &[(f32, f32, Material)]) -> Scene {
    let mut scene = empty_scene();
    scene.settings = RenderSettings {
        integrator,
        samples: if integrator == Integrator::Path { 256 } else { 4 },
        max_depth: depth,
        min_weight: 0.0,
        rr_depth: 65,
        ..scene.settings
    };
    scene.background = Background::Gradient { bottom: Rgb::ONE, top: Rgb::ZERO };
    scene.materials.clear();
    scene.meshes = vec![shape::cuboid([8.0, 1.0, 8.0], 1)];
    for (index, (low, high, material)) in blocks.iter().enumerate() {
        scene.materials.push(material.clone());
        let height = Transform::scale(Vec3::new(1.0, high - low, 1.0));
        let place = height.then(Transform::translate(Vec3::Y * (0.5 * (low + high))));
        let block = object(Geometry::Mesh(MeshId(0)), place);
        scene.objects.push(Object { material: Some(MaterialId(index as u32)), ..block });
    }
    look_down(&mut scene, 5.0, 1.0);
    scene
}

/// What passes the interfaces between media of these indices, one after another.
fn passed(indices: &[f64]) -> f64 {
    let transmittance = |pair: &[f64]| 1.0 - ((pair[0] - pair[1]) / (pair[0] + pair[1])).powi(2);
    indices.windows(2).map(transmittance).product()
}

/// Light straight through `blocks` with as many refractions as `depth`, by both integrators.
#[track_caller]
fn assert_passes(depth: u32, blocks: &[(f32, f32, Material)], wanted: f64, what: &str) {
    for integrator in [Integrator::Whitted, Integrator::Path] {
        let found: Mean = mean(&pile(integrator, depth, blocks));
        assert_mean(found, wanted, &format!("{what}, {integrator:?}"));
    }
}

#[test]
fn a_drink_that_reaches_into_its_glass_touches_it() {
    let wanted = passed(&[AIR, GLASS, WATER, AIR]) * (-(0.5 * 1.0 + 0.25 * 0.9f64)).exp();
    let glass = (0.0, 1.0, clear(GLASS, 0.5, Some(1)));
    let drink = (-0.9, 0.2, clear(WATER, 0.25, None));
    // The order of objects says nothing.
    assert_passes(3, &[glass.clone(), drink.clone()], wanted, "glass first");
    assert_passes(3, &[drink, glass], wanted, "drink first");
}

#[test]
fn without_priorities_a_body_that_is_left_is_left_for_the_outside() {
    let glass = (0.0, 1.0, clear(GLASS, 0.5, None));
    let drink = (-0.9, 0.2, clear(WATER, 0.25, None));
    let scene = pile(Integrator::Whitted, 4, &[glass.clone(), drink.clone()]);
    assert!(!bake(&scene).unwrap().features.has_ranks);
    // Air to glass, "air" to drink, "glass" to air, drink to air; each body's absorption until the next interface.
    let wanted = passed(&[AIR, GLASS]) * passed(&[AIR, WATER]) * passed(&[GLASS, AIR]) * passed(&[WATER, AIR]);
    let absorbed = (-(0.5 * 0.8 + 0.25 * 0.2f64)).exp();
    assert_mean(mean(&scene), wanted * absorbed, "as before");
}

#[test]
fn a_body_within_another_is_seen_if_it_ranks_higher_and_is_not_there_otherwise() {
    let water = |priority| (-1.0, 1.0, clear(WATER, 0.1, Some(priority)));
    let stone = |priority| (-0.5, 0.5, clear(DIAMOND, 0.3, Some(priority)));
    let seen = passed(&[AIR, WATER, DIAMOND, WATER, AIR]) * (-(0.1 + 0.3f64)).exp();
    assert_passes(4, &[water(1), stone(2)], seen, "stone wins");
    assert_passes(2, &[water(2), stone(1)], passed(&[AIR, WATER, AIR]) * (-0.2f64).exp(), "water wins");
    // Of equals the later material.
    assert_passes(4, &[water(3), stone(3)], seen, "the stone is later");
    assert_passes(2, &[stone(3), water(3)], passed(&[AIR, WATER, AIR]) * (-0.2f64).exp(), "the water is later");
}

#[test]
fn pieces_of_one_material_merge() {
    let mut scene = pile(Integrator::Whitted, 2, &[(-1.0, 0.5, clear(GLASS, 0.2, Some(0)))]);
    let other = Transform::scale(Vec3::new(1.0, 1.5, 1.0)).then(Transform::translate(Vec3::Y * 0.25));
    scene.objects.push(Object { transform: other, ..scene.objects[0].clone() });
    assert_mean(mean(&scene), passed(&[AIR, GLASS, AIR]) * (-0.4f64).exp(), "two blocks as one");
}

#[test]
fn four_media_at_once_are_remembered() {
    let blocks: Vec<_> = (0..4u8)
        .map(|i| {
            let reach = 2.0 - 0.4 * f32::from(i);
            (-reach, reach, clear(1.2 + 0.3 * f64::from(i), 0.0, Some(u32::from(i) + 10)))
        })
        .collect();
    let wanted = passed(&[1.0, 1.2, 1.5, 1.8, 2.1, 1.8, 1.5, 1.2, 1.0]);
    assert_passes(8, &blocks, wanted, "onion");
}

#[test]
fn nested_media_are_the_same_on_the_device() {
    let rough = Model::RoughDielectric {
        distribution: Distribution::TrowbridgeReitz,
        alpha_u: 0.2,
        alpha_v: 0.2,
        eta: 1.34,
        absorption: Rgb::new(0.1, 0.5, 0.9),
    };
    for integrator in [Integrator::Whitted, Integrator::Path] {
        let mut scene = pile(
            integrator,
            9,
            &[
                (-1.0, 1.0, clear(GLASS, 0.2, Some(5))),
                (-0.4, 1.3, Material { model: rough.clone(), ..clear(WATER, 0.0, None) }),
                (-0.2, 0.2, clear(WATER, 0.4, Some(7))),
            ],
        );
        let ball = object(Geometry::Sphere, Transform::translate(Vec3::new(0.5, 0.9, 0.2)));
        scene.objects.push(Object { material: Some(MaterialId(2)), ..ball });
        scene.settings.samples = 8;
        scene.camera = Camera {
            eye: Vec3::new(3.0, 6.0, 9.0),
            projection: Projection::Perspective { fov_y: 0.9 },
            up: Vec3::Y,
            ..scene.camera
        };
        if !same_on_the_device(&scene, &format!("{integrator:?}")) {
            return;
        }
    }
}

#[test]
fn more_clear_materials_than_there_are_ranks_are_refused() {
    let many: Vec<_> = (0..256).map(|_| (0.0, 1.0, clear(GLASS, 0.0, Some(1)))).collect();
    let error = bake(&pile(Integrator::Path, 4, &many)).unwrap_err().to_string();
    assert_eq!(error, "256 clear materials nest by priority; at most 255 are possible");
    bake(&pile(Integrator::Path, 4, &many[1..])).expect("255 fit");
}
