//! `gonio bench`: that it measures what it says, never how fast.

use super::support::{Folder, has_device};
use serde_json::Value;

fn json(folder: &Folder, name: &str) -> Value {
    serde_json::from_slice(&folder.bytes(name)).expect("JSON")
}

/// A room with a lamp and a ball: every ray hits something.
const ROOM: &str = "[camera]\neye = [0, 0, 0.9]\n[[object]]\nshape = \"box\"\nsize = 2\n[[object]]\nshape = \"sphere\"\n\
radius = 0.3\n[[light]]\ntype = \"point\"\nposition = [0.5, 0.8, 0.5]\n";

const FEW: [&str; 6] = ["--rays", "600", "--runs", "2", "--warmup", "0"];

#[test]
fn device_and_cpu_find_the_same_hits_and_films() {
    if !has_device() {
        return;
    }
    let folder = Folder::new();
    folder.file("room.toml", ROOM);
    let on = ["--on", "cpu,vulkan::texel,vulkan::storage", "--json", "out.json"];
    let out = folder.done(&[&["bench", "room.toml"], &FEW[..], &on].concat());
    assert!(out.contains("  hits: equal\n") && out.contains("  films: equal\n"), "{out}");
    assert!(out.contains(" Mrays/s (") && out.contains(", n = 2, 0 warm-up)"), "{out}");
    let report = json(&folder, "out.json");
    assert_eq!((&report["schema"], &report["runs"]), (&1.into(), &2.into()));
    let backends = report["backends"].as_array().expect("a list");
    assert_eq!(
        backends.iter().map(|b| b["fetch"].as_str()).collect::<Vec<_>>(),
        [None, Some("texel"), Some("storage")]
    );
    for key in ["driver", "driver_version", "device_uuid", "driver_uuid"] {
        assert!(backends[1]["device"][key].is_string(), "{key} of {backends:?}");
    }
    let scene = &report["scenes"][0];
    let kinds: Vec<_> = scene["rays"].as_array().expect("a list").iter().map(|set| set["kind"].clone()).collect();
    assert_eq!(kinds, ["primary", "diffuse", "second", "occlusion", "shadow"]);
    for results in scene["rays"].as_array().into_iter().chain(scene["images"].as_array()).flatten() {
        let results = results["results"].as_array().expect("a list");
        assert_eq!(results.len(), 3);
        for result in results {
            assert_eq!(
                (&result["differ"], result["wall_s"].as_array().map(Vec::len)),
                (&0.into(), Some(2)),
                "{result}"
            );
            assert_eq!(result["device_s"].is_null(), result["on"] == "cpu", "{result}");
        }
    }
}

#[test]
fn primary_rays_are_as_many_as_the_frame_has_pixels_and_the_others_as_many() {
    let folder = Folder::new();
    folder.done(&[&["bench", "scene.toml", "--on", "cpu", "--json", "out.json"], &FEW[..]].concat());
    let scene = &json(&folder, "out.json")["scenes"][0];
    assert_eq!((&scene["width"], &scene["height"]), (&28.into(), &21.into()), "600 pixels in the shape of 32x24");
    let sets = scene["rays"].as_array().expect("a list");
    assert_eq!(sets.len(), 4, "a ball alone: what leaves it hits nothing, and no second bounce leaves that");
    for set in sets {
        let (rays, hits) = (set["rays"].as_u64().expect("a count"), set["hits"].as_u64().expect("a count"));
        match set["kind"].as_str().expect("a name") {
            "diffuse" | "occlusion" => assert!(rays == 588 && hits == 0, "{set}"),
            "primary" => assert!(rays == 588 && hits > 40 && hits < 400, "{set}"),
            _ => assert!(rays == 588, "{set}"),
        }
    }
    let size = &scene["size"];
    assert_eq!((&size["placed"], &size["triangles"], &size["sah"]), (&1.into(), &0.into(), &2.0.into()));
    assert!(scene["bake"]["whole_s"].as_f64().expect("seconds") > 0.0);
}

#[test]
fn baking_takes_no_more_memory_than_two_and_a_half_times_what_it_makes() {
    let folder = Folder::new();
    let args = ["bench", "terrain:1M", "--on", "cpu", "--only", "primary", "--json", "out.json"];
    folder.done(&[&args, &FEW[..]].concat());
    let scene = &json(&folder, "out.json")["scenes"][0];
    let Some(taken) = scene["bake_bytes"].as_u64() else {
        eprintln!("SKIPPED: the system does not tell how much memory a program has");
        return;
    };
    let size = &scene["size"];
    let made: u64 = ["node_bytes", "triangle_bytes", "data_bytes"].iter().filter_map(|key| size[key].as_u64()).sum();
    assert!(made > 80_000_000 && taken > made, "{made} bytes made, {taken} taken");
    assert!(2 * taken <= 5 * made, "{made} bytes made, {taken} taken");
}

#[test]
fn json_of_one_run_is_the_baseline_of_the_next() {
    let folder = Folder::new();
    let args = [&["bench", "scene.toml", "--on", "cpu", "--only", "primary,images"], &FEW[..]].concat();
    let out = folder.done(&[&args[..], &["--json", "-"]].concat());
    let report: Value = serde_json::from_str(&out).expect("nothing but JSON");
    assert_eq!(report["scenes"][0]["rays"].as_array().map(Vec::len), Some(1), "--only");
    folder.file("before.json", &out);
    let out = folder.done(&[&args[..], &["--baseline", "before.json"]].concat());
    let rows = out.lines().filter(|line| line.contains("median ")).count();
    assert!(rows >= 3 && out.matches(" of the baseline").count() == rows, "{out}");
    folder.file("other.json", "{\"schema\": 0}");
    let message = folder.fails(65, &[&args[..], &["--baseline", "other.json"]].concat());
    assert!(message.contains("other.json: schema 0; this program reads schema 1"), "{message}");
    folder.fails(74, &[&args[..], &["--baseline", "none.json"]].concat());
    folder.fails(74, &[&args[..], &["--json", "no/such/folder.json"]].concat());
}

fn floats(folder: &Folder, name: &str) -> Vec<f32> {
    bytemuck::pod_collect_to_vec(&folder.bytes(name))
}

fn words(folder: &Folder, name: &str) -> Vec<u32> {
    bytemuck::pod_collect_to_vec(&folder.bytes(name))
}

/// A box twice as large as itself, moved, seen by few rays.
const BOX: &str = "[camera]\neye = [9, 0, 0]\ntarget = [0, 0, 0]\n[[object]]\nshape = \"box\"\nscale = 2\ntranslate = [1, 0, 0]\n\
[[object]]\nshape = \"sphere\"\nradius = 0.5\ntranslate = [4, 3, 0]\ncasts_shadow = false\n";

#[test]
fn exported_arrays_are_the_world_and_its_rays() {
    let folder = Folder::new();
    folder.file("box.toml", BOX);
    folder.done(&[&["bench", "box.toml", "--on", "cpu", "--export-rays", "work"], &FEW[..]].concat());
    let corners = floats(&folder, "work/box/triangles.f32");
    assert_eq!(corners.len(), 12 * 9);
    let xs: Vec<f32> = corners.iter().step_by(3).copied().collect();
    assert!(xs.iter().all(|x| [0.0, 2.0].contains(x)), "a box from 0 to 2: {xs:?}");
    let ids = words(&folder, "work/box/triangles.u32");
    assert!(ids.chunks(3).enumerate().all(|(at, id)| id == [0, at as u32, 1]), "{ids:?}");
    let sphere = floats(&folder, "work/box/spheres.f32");
    assert_eq!(sphere, [0.5, 0.0, 0.0, 4.0, 0.0, 0.5, 0.0, 3.0, 0.0, 0.0, 0.5, 0.0]);
    assert_eq!(words(&folder, "work/box/spheres.u32"), [1, 0], "no shadow");

    let document = json(&folder, "work/box/scene.json");
    assert_eq!((&document["triangles"], &document["spheres"]), (&12.into(), &1.into()));
    for set in document["sets"].as_array().expect("a list") {
        let (kind, count) = (set["kind"].as_str().expect("a name"), set["rays"].as_u64().expect("a count") as usize);
        let rays = floats(&folder, &format!("work/box/{kind}.rays.f32"));
        assert_eq!(rays.len(), count * 8);
        let skip = words(&folder, &format!("work/box/{kind}.skip.u32"));
        assert_eq!(skip.len(), count * 2);
        for (ray, skip) in rays.chunks(8).zip(skip.chunks(2)) {
            assert_eq!(ray[3] == 0.0, skip[0] == u32::MAX, "{kind}: only rays that leave a surface begin later");
            let length = ray[4] * ray[4] + ray[5] * ray[5] + ray[6] * ray[6];
            assert!((length - 1.0).abs() < 1e-5 && ray[7] > ray[3], "{kind}: {ray:?}");
        }
        let hits = words(&folder, &format!("work/box/{kind}.hits.u32"));
        assert_eq!(hits.len(), if set["any"] == true { count } else { count * 2 });
    }

    // A hit lies where its ray is at t, and in the plane of its triangle's corners weighted.
    let (rays, hits) = (floats(&folder, "work/box/primary.rays.f32"), floats(&folder, "work/box/primary.hits.f32"));
    let ids = words(&folder, "work/box/primary.hits.u32");
    let mut seen = 0;
    for ((ray, hit), id) in rays.chunks(8).zip(hits.chunks(3)).zip(ids.chunks(2)).filter(|(_, id)| id[0] == 0) {
        let triangle = &corners[id[1] as usize * 9..][..9];
        for axis in 0..3 {
            let corner = |k: usize| triangle[3 * k + axis];
            let point = corner(0) * (1.0 - hit[1] - hit[2]) + corner(1) * hit[1] + corner(2) * hit[2];
            let along = ray[axis] + ray[4 + axis] * hit[0];
            assert!((point - along).abs() < 1e-4, "{point} and {along}");
        }
        seen += 1;
    }
    assert!(seen > 20, "{seen}");
}

#[test]
fn a_scene_that_is_not_seen_is_measured_with_primary_rays_alone() {
    let folder = Folder::new();
    let away = ["bench", "scene.toml", "--on", "cpu", "--set", "camera.target=[0,9,9]", "--json", "out.json"];
    folder.done(&[&away[..], &FEW[..]].concat());
    let scene = &json(&folder, "out.json")["scenes"][0];
    assert_eq!(scene["rays"].as_array().map(Vec::len), Some(1), "{scene}");
}

#[test]
fn built_in_scenes_are_measured_and_rendered_by_name() {
    let folder = Folder::new();
    let scenes = ["sphereflake:1", "terrain:200", "hairball:200", "teapots:4000"];
    let few = ["--on", "cpu", "--only", "primary", "--rays", "300", "--runs", "1", "--json", "out.json"];
    let out = folder.done(&[&["bench"], &scenes[..], &few].concat());
    assert_eq!(out.matches("  hits: equal\n").count(), 4, "{out}");
    let report = json(&folder, "out.json");
    let placed = |at: usize| report["scenes"][at]["size"]["placed"].as_u64().expect("a count");
    // With the two triangles of the ground, which a terrain does not have.
    assert_eq!([placed(0), placed(1), placed(2)], [10 + 2, 200, 192 + 2]);
    folder.cpu(&["render", "teapots:4000", "--size", "16x9", "--spp", "1", "-o", "a.png"]);
    assert!(folder.fails(65, &["render", "terrain:1", "-o", "b.png"]).contains("found \"1\""));
}
