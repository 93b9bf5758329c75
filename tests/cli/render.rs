//! `gonio render`: what its flags change, and what it prints.

use super::support::{Folder, has_device, line};
use std::time::{Duration, Instant};

#[test]
fn set_changes_keys_of_the_scene_and_later_ones_win() {
    let folder = Folder::new();
    let plain = folder.cpu(&["render", "scene.toml", "-o", "a.gfilm"]);
    let blue = folder.cpu(&["render", "scene.toml", "-o", "a.gfilm", "--set", "material.red.color=[0,0,1]"]);
    assert_ne!(line(&blue, "film"), line(&plain, "film"));
    let back = ["--set", "material.red.color=[0,0,1]", "--set", "material.red.color=[0.8,0.1,0.1]"];
    let again = folder.cpu(&[&["render", "scene.toml", "-o", "a.gfilm"], &back[..]].concat());
    assert_eq!(again, plain);
}

#[test]
fn set_of_an_unknown_key_is_refused_with_the_nearest_one() {
    let folder = Folder::new();
    let message = folder.fails(65, &["render", "scene.toml", "-o", "a.png", "--set", "render.smaples=3"]);
    assert!(message.contains("smaples") && message.contains("did you mean \"samples\"?"), "{message}");
}

#[test]
fn seed_changes_the_film_and_comes_back() {
    let folder = Folder::new();
    let hash = |seed: &str| folder.cpu(&["render", "scene.toml", "-o", "a.gfilm", "--seed", seed]);
    let (zero, one) = (hash("0"), hash("1"));
    assert_ne!(zero, one);
    assert_eq!(folder.film("a.gfilm").spec().seed, 1);
    assert_eq!(hash("0"), zero);
}

#[test]
fn number_of_threads_changes_nothing() {
    let folder = Folder::new();
    let hash = |threads: &str| folder.cpu(&["render", "scene.toml", "-o", "a.gfilm", "--threads", threads]);
    assert_eq!(hash("1"), hash("3"));
}

#[test]
fn size_and_spp_of_the_command_line_win_over_the_scenes() {
    let folder = Folder::new();
    let report = folder.cpu(&["render", "scene.toml", "-o", "a.gfilm", "--size", "16x8", "--spp", "3"]);
    assert_eq!(line(&report, "samples"), "0..3");
    let film = folder.film("a.gfilm");
    assert_eq!((film.spec().width, film.spec().height), (16, 8));
}

#[test]
fn time_limit_ends_soon_on_a_whole_pass() {
    let folder = Folder::new();
    let start = Instant::now();
    let report = folder.cpu(&["render", "scene.toml", "-o", "a.gfilm", "--time", "0.2", "--stats", "s.json"]);
    assert!(start.elapsed() < Duration::from_secs(10), "{:?}", start.elapsed());
    let film = folder.film("a.gfilm");
    assert!(film.samples().total() > 1, "{report}");
    assert_eq!(film.samples().as_slice().len(), 1, "from 0 without a gap: {report}");
    // Whole passes: the same number of samples on purpose is the same film.
    let samples = line(&report, "samples");
    let again = folder.cpu(&["render", "scene.toml", "-o", "b.gfilm", "--samples", samples]);
    assert_eq!(again, report);
}

#[test]
fn pixel_prints_every_bounce_and_the_device_prints_the_same() {
    let folder = Folder::new();
    folder.file(
        "mirror.toml",
        super::support::SCENE.replace("name = \"red\"", "name = \"red\"\nk_r = 0.5").replace(
            "[[light]]",
            "[[object]]\nshape = \"quad\"\nsize = [20, 20]\ntranslate = [0, -1, 0]\nmaterial = \"red\"\n[[light]]",
        ),
    );
    let args = ["render", "mirror.toml", "--pixel", "16,14", "--samples", "1..2"];
    let cpu = folder.cpu(&args);
    let (first, bounces) = cpu.split_once('\n').expect("lines");
    assert!(first.starts_with("pixel 16,14 sample 1 on cpu"), "{first}");
    assert!(bounces.starts_with("depth 0 path ") && bounces.contains("\ndepth 1 path "), "{bounces}");
    assert_eq!(folder.names(), ["mirror.toml", "scene.toml"], "no picture is made");
    if !has_device() {
        return;
    }
    let device = folder.done(&[&args[..], &["--backend", "vulkan"]].concat());
    let (first, same) = device.split_once('\n').expect("lines");
    assert!(!first.contains(" on cpu "), "{first}");
    assert_eq!(same, bounces);
}

#[test]
fn pixel_outside_the_frame_is_refused() {
    let folder = Folder::new();
    let message = folder.fails(2, &["render", "scene.toml", "--pixel", "32,0", "--backend", "cpu"]);
    assert_eq!(message, "error: --pixel 32,0 is not inside the frame 32x24+0+0\n");
}

#[test]
fn device_and_cpu_make_the_same_file() {
    if !has_device() {
        return;
    }
    let folder = Folder::new();
    let cpu = folder.cpu(&["render", "scene.toml", "-o", "cpu.png"]);
    let vulkan = folder.done(&["render", "scene.toml", "-o", "vulkan.png", "--backend", "vulkan"]);
    assert_eq!(cpu, vulkan);
    assert_eq!(folder.bytes("cpu.png"), folder.bytes("vulkan.png"));
}

#[test]
fn stats_say_what_was_done() {
    let folder = Folder::new();
    let report = folder.cpu(&["render", "scene.toml", "-o", "a.png", "--crop", "1,2,31,22", "--stats", "stats.json"]);
    let stats: serde_json::Value = serde_json::from_slice(&folder.bytes("stats.json")).expect("JSON");
    assert_eq!(stats["film_hash"], line(&report, "film"));
    assert_eq!(stats["samples"], "0..2");
    assert_eq!(stats["scene"], "scene.toml");
    assert_eq!((&stats["width"], &stats["height"], &stats["seed"]), (&32.into(), &24.into(), &0.into()));
    assert_eq!(stats["crop"], serde_json::json!({ "x": 1, "y": 2, "width": 30, "height": 20 }));
    assert_eq!(stats["interrupted"], false);
    assert!(stats["device"].as_str().is_some_and(|device| device.starts_with("cpu")), "{stats}");
    assert!(stats["counters"]["closest_rays"].as_u64().is_some_and(|rays| rays >= 2 * 30 * 20), "{stats}");
    for number in ["schema", "passes", "nan_count", "clamped_count", "triangles", "instances", "nodes", "lights"] {
        assert!(stats[number].is_u64(), "{number} in {stats}");
    }
    for seconds in ["render_s", "bake_s", "rays_per_s"] {
        assert!(stats[seconds].as_f64().is_some_and(|value| value >= 0.0), "{seconds} in {stats}");
    }
}

#[test]
fn quiet_says_nothing_on_standard_error_and_still_prints_the_hash() {
    let folder = Folder::new();
    let mut command = folder.command(&["render", "scene.toml", "-o", "a.png", "--quiet"]);
    let ended = super::support::ended(command.env("VK_DRIVER_FILES", "/nonexistent"));
    assert_eq!((ended.code, ended.stderr.as_str()), (Some(0), ""));
    assert_eq!(line(&ended.text(), "film").len(), 64);
}
