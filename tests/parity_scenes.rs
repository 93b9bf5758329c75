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
use scenes::{Take, assert_same, prepare, render, render_cpu, taken};
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
    for fetch in [FetchChoice::Texel, FetchChoice::Storage] {
        let mut renderer = vulkan(&data, VulkanOptions { fetch, ..VulkanOptions::default() })?;
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
    for file in files {
        let Some(path) = scenes::asset(file) else { continue };
        if assert_parity(&path, Take { width: 80, height: 60, samples: 1, seed: 0 }).is_none() {
            return;
        }
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

#[test]
fn paths_of_any_length_are_the_same_on_cpu_and_device() {
    let cornell = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/cornell.toml");
    let evening = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/evening.toml");
    for (path, samples, max_depth, rr_depth) in
        [(&cornell, 1, 64, 65), (&cornell, 4, 64, 5), (&cornell, 16, 2, 0), (&evening, 4, 64, 65), (&evening, 16, 1, 5)]
    {
        let mut scene = gonio::scene::load::load(path, &[]).unwrap();
        (scene.film.width, scene.film.height) = (29, 23);
        let settings = &mut scene.settings;
        (settings.samples, settings.max_depth, settings.rr_depth) = (samples, max_depth, rr_depth);
        settings.clamp = Some(20.0);
        let data = gonio::bake::bake(&scene).unwrap();
        let reference = render_cpu(&scene, &data);
        for fetch in [FetchChoice::Texel, FetchChoice::Storage] {
            // Chunks smaller than the picture put rays of all depths into one queue.
            let options = VulkanOptions { fetch, chunk: Some(200), ..VulkanOptions::default() };
            let Some(mut renderer) = vulkan(&data, options) else { return };
            let film = render(&mut *renderer, &scene, &data, 0..samples);
            assert_same(&reference, &film, &format!("{} {samples} {max_depth} {fetch:?}", path.display()));
        }
    }
}
