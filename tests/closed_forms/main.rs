//! Pictures with a closed form: the lens, many lights, panes and their shadows, nested media. On the CPU backend, and bit for
//! bit on the device.

#[path = "../common/mod.rs"]
mod common;
#[path = "../common/device.rs"]
mod device;
mod leaning;
mod lens;
mod many_lights;
mod nested;
mod panes;
#[path = "../common/scenes.rs"]
mod scenes;
mod shadowless;
#[path = "../common/statistics.rs"]
mod statistics;

use glam::Vec3;
use gonio::bake::bake;
use gonio::render::vulkan::{FetchChoice, VulkanOptions, VulkanRenderer};
use gonio::scene::*;
use scenes::{assert_same, render, render_cpu};
use statistics::Mean;

/// The picture on the CPU backend.
fn picture(scene: &Scene) -> Vec<[f32; 4]> {
    render_cpu(scene, &bake(scene).expect("bakes")).resolve().pixels
}

/// Of the green channel.
fn mean(scene: &Scene) -> Mean {
    Mean::of_channel(&picture(scene), 1)
}

/// 2e-5 of the value for rounding.
#[track_caller]
fn assert_mean(found: Mean, wanted: f64, what: &str) {
    found.assert_is(wanted, 2.0e-5, what);
}

/// A memory path of the device, and the most rays a chunk may have.
type Path = (FetchChoice, Option<u32>);
const ANY_CHUNK: Path = (FetchChoice::Texel, None);
const SMALL_CHUNKS: Path = (FetchChoice::Storage, Some(100));

/// Both memory paths of the device, with chunks of any size and very small ones, give the CPU's bits. False without a device.
#[track_caller]
fn same_on_the_device(scene: &Scene, what: &str) -> bool {
    same_by(scene, &[ANY_CHUNK, SMALL_CHUNKS], what)
}

/// The device gives the CPU's bits by each of `paths`. False without a device.
#[track_caller]
fn same_by(scene: &Scene, paths: &[Path], what: &str) -> bool {
    let data = bake(scene).expect("bakes");
    let reference = render_cpu(scene, &data);
    for &(fetch, chunk) in paths {
        if device::context().is_none() {
            return false;
        }
        let options = VulkanOptions { fetch, chunk, validate: true, ..VulkanOptions::default() };
        let renderer = VulkanRenderer::new(&data, options).unwrap();
        let messages = renderer.messages();
        let mut renderer = device::Validated::new(renderer, messages);
        let film = render(&mut *renderer, scene, &data, 0..scene.settings.samples);
        assert_same(&reference, &film, &format!("{what}, {fetch:?}, chunks of {chunk:?}"));
    }
    true
}

/// A level square of side 20 at height `y`, facing up.
fn level(scene: &mut Scene, y: f32, material: u32) {
    if scene.meshes.is_empty() {
        scene.meshes.push(shape::quad([20.0, 20.0], 1));
    }
    let place = Transform::translate(Vec3::Y * y);
    let level = common::object(Geometry::Mesh(MeshId(0)), place);
    scene.objects.push(Object { name: format!("at {y}"), material: Some(MaterialId(material)), ..level });
}

/// Straight down from `y` onto 16 x 16 pixels, `height` wide.
fn look_down(scene: &mut Scene, y: f32, height: f32) {
    (scene.film.width, scene.film.height) = (16, 16);
    scene.camera = Camera {
        eye: Vec3::Y * y,
        target: Vec3::ZERO,
        up: Vec3::NEG_Z,
        projection: Projection::Orthographic { height },
        lens: None,
        shift: glam::Vec2::ZERO,
        mirrored: false,
    };
}

fn light(kind: LightKind, intensity: f32) -> Light {
    Light {
        name: "light".into(),
        kind,
        intensity: Rgb::splat(intensity),
        unit: IntensityUnit::Radiometric,
        attenuation: Attenuation::InverseSquare,
        flaps: Flaps::NONE,
        casts_shadow: true,
        slide: None,
    }
}

/// Straight down.
fn sun(irradiance: f32) -> Light {
    light(LightKind::Directional { direction: Vec3::NEG_Y }, irradiance)
}

fn matte(color: Rgb) -> Material {
    Material { color, k_d: 1.0, k_s: 0.0, ..Material::grey("matte") }
}

fn pane(color: Rgb, transparency: Transparency) -> Material {
    Material { transparency: Some(transparency), ..matte(color) }
}
