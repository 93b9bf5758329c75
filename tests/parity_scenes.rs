//! Whole pictures, bit for bit: CPU against Vulkan through both memory paths, and against recorded hashes.

#[path = "common/device.rs"]
mod device;
#[path = "common/scenes.rs"]
mod scenes;

use gonio::bake::{SceneData, bake};
use gonio::render::cpu::CpuRenderer;
use gonio::render::vulkan::{FetchChoice, VulkanOptions, VulkanRenderer};
use gonio::scene::Scene;
use gonio::scene::load::{self, Panels};
use scenes::{Take, accumulate, assert_same, prepare, render, render_cpu, taken};
use std::collections::BTreeMap;
use std::path::Path;

fn vulkan(data: &SceneData, options: VulkanOptions) -> Option<device::Validated<VulkanRenderer>> {
    device::context()?;
    let renderer = VulkanRenderer::new(data, VulkanOptions { validate: true, ..options }).unwrap();
    let messages = renderer.messages();
    Some(device::Validated::new(renderer, messages))
}

fn assert_parity(path: &Path, take: Take) -> Option<()> {
    assert_scene_parity(load::load(path, &[]).unwrap_or_else(|error| panic!("{error}")), take)
}

fn assert_scene_parity(scene: Scene, take: Take) -> Option<()> {
    let scene = taken(scene, take);
    let data = bake(&scene).unwrap_or_else(|error| panic!("{}: {error}", scene.name));
    let reference = render_cpu(&scene, &data);
    // Shaded in groups, as large pictures are, and all at once.
    for (fetch, group_from) in [(FetchChoice::Texel, Some(0)), (FetchChoice::Storage, None)] {
        let mut renderer = vulkan(&data, VulkanOptions { fetch, group_from, ..VulkanOptions::default() })?;
        let film = render(&mut *renderer, &scene, &data, 0..take.samples);
        assert_same(&reference, &film, &format!("{} {take:?} {fetch:?}", scene.name));
    }
    Some(())
}

/// Film hashes of every scene and of each of its panels, recorded once. GONIO_BLESS=1 writes what the CPU backend renders now.
#[test]
fn every_scene_has_its_recorded_hash_on_the_cpu() {
    let take = Take { width: 96, height: 64, samples: 4, seed: 0 };
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/goldens/film-hashes.json");
    let hash = |scene: &Scene| {
        let scene = taken(scene.clone(), take);
        render_cpu(&scene, &bake(&scene).unwrap()).hash().to_string()
    };
    let mut found = BTreeMap::new();
    for path in scenes::all() {
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        let panels = Panels::open(&path, &[], &[]).unwrap_or_else(|error| panic!("{error}"));
        for (index, label) in panels.labels().iter().enumerate() {
            let scene = panels.scene(Some(index)).unwrap_or_else(|error| panic!("{label}: {error}"));
            assert!(scene.warnings.is_empty(), "{label}: {:?}", scene.warnings);
            found.insert(format!("{name}, {label}"), hash(&scene));
        }
        found.insert(name, hash(&panels.scene(None).unwrap_or_else(|error| panic!("{error}"))));
    }
    if std::env::var_os("GONIO_BLESS").is_some_and(|value| value == "1") {
        std::fs::create_dir_all(file.parent().unwrap()).unwrap();
        std::fs::write(&file, serde_json::to_string_pretty(&found).unwrap() + "\n").unwrap();
    }
    let text =
        std::fs::read_to_string(&file).expect("tests/goldens/film-hashes.json is missing; GONIO_BLESS=1 writes it");
    let recorded: BTreeMap<String, String> = serde_json::from_str(&text).unwrap();
    let wrong: Vec<_> = found.iter().filter(|(scene, hash)| recorded.get(*scene) != Some(hash)).collect();
    assert!(wrong.is_empty(), "other hashes than recorded: {wrong:#?}");
    assert_eq!(found.len(), recorded.len(), "hashes of scenes that are gone");
}

#[test]
fn every_scene_is_the_same_on_cpu_and_device() {
    // Odd sizes leave partial workgroups and tiles; one in three scenes takes each count and seed.
    let takes = [
        Take { width: 96, height: 64, samples: 4, seed: 0 },
        Take { width: 33, height: 17, samples: 7, seed: 1 },
        Take { width: 64, height: 48, samples: 16, seed: 2 },
    ];
    for (index, path) in scenes::all().iter().enumerate() {
        let panels = Panels::open(path, &[], &[]).unwrap_or_else(|error| panic!("{error}"));
        // Of a scene with panels one: which, goes round from scene to scene.
        let panel = index.checked_rem(panels.labels().len());
        let scene = panels.scene(panel).unwrap_or_else(|error| panic!("{error}"));
        if assert_scene_parity(scene, takes[index % takes.len()]).is_none() {
            return;
        }
    }
}

#[test]
fn third_party_scenes_are_the_same_on_cpu_and_device() {
    let files = [
        "kitchen/kitchen.obj",
        "sponza-dabrovic/obj/sponza.obj",
        "cornell/obj-mtl/cornell_box.obj",
        "gltf/Duck.glb",
        "gltf/Box.glb",
        "gltf/BoxTextured/BoxTextured.gltf",
        "gltf/02_suzanne/02_suzanne.gltf",
    ];
    let take = Take { width: 80, height: 60, samples: 1, seed: 0 };
    for file in files {
        let Some(path) = scenes::asset(file) else { continue };
        if assert_parity(&path, take).is_none() {
            return;
        }
    }
    // Its mesh is not beside it.
    if let Some(mesh) = scenes::asset("kitchen/kitchen.obj") {
        let mesh = format!("object.kitchen.file={mesh:?}").parse().unwrap();
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/others/kitchen.toml");
        let scene = load::load(&path, &[mesh]).unwrap_or_else(|error| panic!("{error}"));
        assert_scene_parity(scene, take);
    }
}

fn first_light(take: Take) -> (gonio::scene::Scene, SceneData) {
    prepare(&Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/first-light.toml"), take)
}

#[test]
fn threads_and_tiles_do_not_change_a_bit() {
    let take = Take { width: 61, height: 35, samples: 3, seed: 5 };
    let (scene, data) = first_light(take);
    let reference = render_cpu(&scene, &data);
    for (threads, tile) in [(1, 256), (2, 1), (3, 7), (8, 100_000)] {
        let mut renderer = CpuRenderer::new(&data, Some(threads)).unwrap().with_tile_pixels(tile);
        let film = render(&mut renderer, &scene, &data, 0..take.samples);
        assert_same(&reference, &film, &format!("{threads} threads, tiles of {tile}"));
    }
}

#[test]
fn chunks_and_pages_do_not_change_a_bit() {
    let take = Take { width: 61, height: 35, samples: 3, seed: 5 };
    let (scene, data) = first_light(take);
    let reference = render_cpu(&scene, &data);
    for fetch in [FetchChoice::Texel, FetchChoice::Storage] {
        for (chunk, page_limit) in [(Some(100), None), (Some(1537), None), (None, Some(1 << 20))] {
            let options = VulkanOptions { fetch, chunk, page_limit, ..VulkanOptions::default() };
            let Some(mut renderer) = vulkan(&data, options) else { return };
            let film = render(&mut *renderer, &scene, &data, 0..take.samples);
            assert_same(&reference, &film, &format!("chunk {chunk:?}, pages of {page_limit:?} bytes, {fetch:?}"));
            if page_limit.is_some() {
                let pages = renderer.page_counts();
                assert!(pages.iter().any(|&count| count > 1), "one page each proves nothing: {pages:?}");
            }
        }
    }
}

#[test]
fn halves_from_two_backends_merge_into_the_whole() {
    let take = Take { width: 61, height: 35, samples: 6, seed: 5 };
    let (scene, data) = first_light(take);
    let whole = render_cpu(&scene, &data);
    let mut first = render(&mut CpuRenderer::new(&data, None).unwrap(), &scene, &data, 0..2);
    let Some(mut renderer) = vulkan(&data, VulkanOptions::default()) else { return };
    first.merge(&render(&mut *renderer, &scene, &data, 2..6)).unwrap();
    assert_same(&whole, &first, "two samples of the CPU and four of the device");
}

/// A comparison that cannot fail proves nothing.
#[test]
#[should_panic(expected = "pixels differ")]
fn another_seed_is_another_picture() {
    let take = Take { width: 16, height: 16, samples: 1, seed: 0 };
    let (scene, data) = first_light(take);
    let (other_scene, other_data) = first_light(Take { seed: 1, ..take });
    assert_same(&render_cpu(&scene, &data), &render_cpu(&other_scene, &other_data), "two seeds");
}

/// Compares the scene after 1, 4 and 16 samples, through both fetch paths; false without a device.
fn assert_path_parity(scene: &Scene, what: &str) -> bool {
    const PARTS: [std::ops::Range<u32>; 3] = [0..1, 1..4, 4..16];
    let data = gonio::bake::bake(scene).unwrap();
    let mut film = scenes::film(scene, &data);
    let mut cpu = CpuRenderer::new(&data, None).unwrap();
    let references = PARTS.map(|part| {
        accumulate(&mut cpu, &mut film, part);
        film.clone()
    });
    for fetch in [FetchChoice::Texel, FetchChoice::Storage] {
        // Chunks smaller than the picture put rays of all depths into one queue.
        let options = VulkanOptions { fetch, chunk: Some(200), ..VulkanOptions::default() };
        let Some(mut renderer) = vulkan(&data, options) else { return false };
        let mut film = scenes::film(scene, &data);
        for (part, reference) in PARTS.into_iter().zip(&references) {
            let what = format!("{what}, {} samples, {fetch:?}", part.end);
            accumulate(&mut *renderer, &mut film, part);
            assert_same(reference, &film, &what);
            assert_eq!(film.limited_count(), reference.limited_count(), "{what}");
        }
    }
    true
}

#[test]
fn paths_of_any_length_are_the_same_on_cpu_and_device() {
    for (name, rr_depth) in [("cornell", 5), ("evening", 65)] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("scenes/{name}.toml"));
        let mut scene = gonio::scene::load::load(&path, &[]).unwrap();
        (scene.film.width, scene.film.height) = (29, 23);
        (scene.settings.max_depth, scene.settings.rr_depth, scene.settings.clamp) = (64, rr_depth, Some(2.0));
        if !assert_path_parity(&scene, name) {
            return;
        }
    }
}

/// Slides in spots, a blend that glows, holes in a blend, sides, a mirrored and shifted camera.
const MITSUBA: &str = r#"<scene version="3.0.0">
<integrator type="path"><integer name="max_depth" value="7"/></integrator>
<sensor type="perspective">
  <float name="principal_point_offset_x" value="0.05"/>
  <transform name="to_world"><scale x="-1"/><lookat origin="0, 2, 5" target="0, 0.5, 0" up="0, 1, 0"/></transform>
  <film type="hdrfilm"><integer name="width" value="29"/><integer name="height" value="23"/></film>
</sensor>
<shape type="rectangle"><transform name="to_world"><scale value="4"/><rotate x="1" angle="-90"/></transform>
  <bsdf type="twosided"><bsdf type="diffuse"/><bsdf type="conductor"/></bsdf></shape>
<shape type="sphere"><point name="center" value="-1, 0.7, 0"/><float name="radius" value="0.7"/>
  <bsdf type="mask"><float name="opacity" value="0.6"/><bsdf type="blendbsdf">
    <texture name="weight" type="checkerboard"><transform name="to_uv"><scale value="4"/></transform></texture>
    <bsdf type="roughplastic"/><bsdf type="roughconductor"/></bsdf></bsdf></shape>
<shape type="cube"><transform name="to_world"><scale value="0.4"/><translate x="1" y="0.5"/></transform>
  <bsdf type="blendbsdf"><float name="weight" value="0.3"/><bsdf type="diffuse"/><bsdf type="dielectric"/></bsdf>
  <emitter type="area"><texture type="checkerboard" name="radiance"><rgb name="color0" value="1"/></texture></emitter></shape>
<emitter type="spot"><transform name="to_world"><lookat origin="0, 4, 1" target="0, 0, 0" up="0, 0, 1"/></transform>
  <rgb name="intensity" value="9, 8, 7"/><float name="cutoff_angle" value="30"/>
  <texture name="texture" type="checkerboard"><rgb name="color0" value="0.9, 0.1, 0.2"/></texture></emitter>
<emitter type="projector"><transform name="to_world"><lookat origin="3, 4, 1" target="0, 0, 0" up="0, 0, 1"/></transform>
  <float name="fov" value="50"/><float name="scale" value="4"/>
  <texture name="irradiance" type="checkerboard"><transform name="to_uv"><scale value="3"/></transform></texture></emitter>
</scene>"#;

#[test]
fn what_mitsuba_scenes_bring_is_the_same_on_cpu_and_device() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.xml");
    std::fs::write(&path, MITSUBA).unwrap();
    let mut scene = gonio::scene::load::load(&path, &[]).unwrap();
    scene.settings.clamp = Some(3.0);
    assert_path_parity(&scene, "mitsuba");
    // The lights of no size through the other integrators' loop.
    (scene.settings.integrator, scene.settings.samples) = (gonio::scene::Integrator::Whitted, 2);
    let data = gonio::bake::bake(&scene).unwrap();
    let Some(mut renderer) = vulkan(&data, VulkanOptions::default()) else { return };
    let film = render(&mut *renderer, &scene, &data, 0..2);
    assert_same(&render_cpu(&scene, &data), &film, "mitsuba, whitted");
}
