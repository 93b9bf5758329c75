//! Pictures that are right at sizes and placements where they could go wrong: a texture of 8192 x 8192 texels, a normal map
//! on a mirrored instance; from the processor, and the same bits from the device.

#[path = "common/device.rs"]
mod device;
#[path = "common/scenes.rs"]
mod scenes;

use glam::Vec3;
use gonio::bake::bake;
use gonio::render::vulkan::{FetchChoice, VulkanOptions, VulkanRenderer};
use gonio::scene::load::{Panels, load};
use gonio::scene::{Projection, Scene};
use std::path::Path;

/// A scene file's text, loaded without a warning.
fn read(folder: &Path, text: &str) -> Scene {
    let file = folder.join("a.toml");
    std::fs::write(&file, text).expect("writable");
    let scene = load(&file, &[]).unwrap_or_else(|error| panic!("{error}"));
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    scene
}

/// A scene's picture, row by row, linear red, green and blue; the device's through these memory paths is bit for bit the
/// same.
fn picture(scene: &Scene, paths: &[FetchChoice]) -> Vec<[f64; 3]> {
    let data = bake(scene).expect("baked");
    let reference = scenes::render_cpu(scene, &data);
    for &fetch in paths {
        if device::context().is_none() {
            break;
        }
        let options = VulkanOptions { validate: true, fetch, ..VulkanOptions::default() };
        let renderer = VulkanRenderer::new(&data, options).expect("a renderer");
        let messages = renderer.messages();
        let mut renderer = device::Validated::new(renderer, messages);
        let film = scenes::render(&mut *renderer, scene, &data, 0..scene.settings.samples);
        scenes::assert_same(&reference, &film, &format!("{fetch:?}"));
    }
    reference.resolve().pixels.iter().map(|pixel| [pixel[0], pixel[1], pixel[2]].map(f64::from)).collect()
}

const SIDE: u32 = 8192;

/// Red and green count the texel's column and row modulo 251 (a prime: no power of two repeats), blue the tiles of 1024.
fn texel(column: u32, row: u32) -> [u8; 3] {
    [(column % 251) as u8, (row % 251) as u8, (8 * (row / 1024) + column / 1024) as u8]
}

#[test]
fn every_part_of_a_texture_of_8192_by_8192_is_found() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let pixels: Vec<u8> = (0..SIDE).flat_map(|row| (0..SIDE).flat_map(move |column| texel(column, row))).collect();
    let file = std::io::BufWriter::new(std::fs::File::create(folder.path().join("large.png")).expect("writable"));
    let encoder = image::codecs::png::PngEncoder::new_with_quality(
        file,
        image::codecs::png::CompressionType::Fast,
        image::codecs::png::FilterType::Up,
    );
    let written = image::ImageEncoder::write_image(encoder, &pixels, SIDE, SIDE, image::ExtendedColorType::Rgb8);
    written.expect("written");
    drop(pixels);
    // The whole texture, one texel of 128 x 128 in each pixel; then 64 x 64 texels around a corner of tiles, one in each.
    let cases: [(f64, f64, f64, &[FetchChoice]); 3] = [
        (0.0, 0.0, 1.0, &[FetchChoice::Texel, FetchChoice::Storage]),
        (0.375, -0.125, 64.0 / 8192.0, &[FetchChoice::Storage]),
        (-0.496_093_75, 0.496_093_75, 64.0 / 8192.0, &[]),
    ];
    let text = "[render]\nintegrator = \"whitted\"\nsamples = 1\nsampler = \"stratified\"\n[film]\nsize = [64, 64]\n\
        filter = { type = \"box\", radius = 1e-3 }\n[camera]\nprojection = \"orthographic\"\neye = [0, 0, 5]\nheight = 1\n\
        [[material]]\nname = \"m\"\nmodel = \"emissive\"\n\
        texture = { file = \"large.png\", filter = \"nearest\", colorspace = \"linear\" }\n[[object]]\nshape = \"quad\"\n\
        size = [1, 1]\nrotate = [1, 0, 0, 90]\nmaterial = \"m\"\n[[light]]\ntype = \"directional\"\ndirection = [0, 0, -1]\n";
    let mut scene = read(folder.path(), text);
    for (x, y, height, paths) in cases {
        scene.camera.eye = Vec3::new(x as f32, y as f32, 5.0);
        scene.camera.target = Vec3::new(x as f32, y as f32, 0.0);
        scene.camera.projection = Projection::Orthographic { height: height as f32 };
        let seen = picture(&scene, paths);
        for row in 0..64u32 {
            for column in 0..64u32 {
                let at = |start: f64, pixel: u32| ((start + height * (f64::from(pixel) + 0.5) / 64.0) * 8192.0) as u32;
                let place = [at(x + 0.5 - height / 2.0, column), at(0.5 - y - height / 2.0, row)];
                let got = seen[(row * 64 + column) as usize];
                // A pixel's middle is a texel's middle, or the corner of four texels in the first picture.
                let corner = u32::from(height == 1.0);
                let found = (0..=corner).any(|i| {
                    (0..=corner).any(|j| {
                        let expected = texel(place[0] - i, place[1] - j).map(|byte| f64::from(byte) / 255.0);
                        (0..3).all(|c| (got[c] - expected[c]).abs() < 1e-5)
                    })
                });
                assert!(found, "{column},{row} of {height}: {got:?}, texel {place:?}");
            }
        }
    }
}

#[test]
fn a_normal_map_leans_with_its_coordinates_on_a_mirrored_instance() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    // Every normal leans towards growing u: tan = 1/2.
    let root = 5f64.sqrt();
    let lean = ((0.5 + 0.5 / root) as f32, 0.5f32, (0.5 + 1.0 / root) as f32);
    exr::prelude::write_rgb_file(folder.path().join("lean.exr"), 4, 4, |_, _| lean).expect("written");
    let text = "[render]\nintegrator = \"whitted\"\nintensity = \"lecture\"\nsamples = 4\n[film]\nsize = [64, 32]\n\
        filter = \"box\"\n[camera]\nprojection = \"orthographic\"\neye = [0, 0, 5]\nheight = 1\n[[material]]\nname = \"m\"\n\
        color = 1\nk_a = 0\nnormal_map = \"lean.exr\"\n[[object]]\nshape = \"quad\"\nsize = [1, 1]\nmaterial = \"m\"\n\
        instances = [\n{ rotate = [1, 0, 0, 90], translate = [-0.5, 0, 0] },\n\
        { scale = [-1, 1, 1], rotate = [1, 0, 0, 90], translate = [0.5, 0, 0] },\n]\n[[light]]\ntype = \"directional\"\n\
        direction = [-0.8, 0, -0.6]\nintensity = 1\n";
    let seen = picture(&read(folder.path(), text), &[FetchChoice::Texel, FetchChoice::Storage]);
    // L = (.8, 0, .6); u grows to the right on the left instance, to the left on the mirrored one.
    for (column, leaning) in [(16, 1.0), (48, -1.0)] {
        let expected = (leaning * 0.8 + 2.0 * 0.6) / root;
        let got = seen[16 * 64 + column][1];
        assert!((got - expected).abs() < 1e-5, "column {column}: {got} for {expected}");
    }
}

#[test]
fn every_map_and_every_source_is_the_same_on_the_device() {
    let lecture = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/lecture");
    // All balls at once, with a map each; an image, wrapped; mip levels; layers by their weights.
    for (name, panel) in [("27-maps", None), ("27-sources", Some(3)), ("27-horizon", None), ("19-layers", Some(2))] {
        let panels = Panels::open(&lecture.join(name).with_extension("toml"), &[], &[]);
        let scene = panels.and_then(|panels| panels.scene(panel));
        let mut scene = scene.unwrap_or_else(|error| panic!("{error}"));
        (scene.film.width, scene.film.height, scene.settings.samples) = (72, 48, 4);
        picture(&scene, &[FetchChoice::Texel]);
    }
}
