//! `gonio parity`.

use super::support::{Folder, ended, has_device};

#[test]
fn device_agrees_with_the_cpu_through_both_fetch_paths() {
    if !has_device() {
        return;
    }
    let folder = Folder::new();
    let out = folder.done(&["parity", "scene.toml", "--size", "16x12", "--spp", "1"]);
    let lines: Vec<&str> = out.lines().collect();
    assert_eq!(lines.len(), 2, "{out}");
    for (line, path) in lines.iter().zip(["vulkan texel", "vulkan storage"]) {
        assert!(line.starts_with("scene.toml: 0 of 192 pixels differ (16x12, 1 sample, seed 0; cpu and "), "{line}");
        assert!(line.contains(path), "{line}");
    }
}

#[test]
fn contenders_can_be_named() {
    let folder = Folder::new();
    let out = folder.done(&["parity", "scene.toml", "--between", "cpu,cpu"]);
    assert!(out.starts_with("scene.toml: 0 of 768 pixels differ (32x24, 2 samples, seed 0; cpu and cpu"), "{out}");
    folder.fails(2, &["parity", "scene.toml", "--between", "cpu"]);
    folder.fails(2, &["parity", "scene.toml", "--between", "cpu,abacus"]);
    folder.fails(2, &["parity", "scene.toml", "--between", "cpu,vulkan:0:magic"]);
}

/// Records the hash of the scene on the CPU in `expect.json`.
fn record(folder: &Folder) -> serde_json::Value {
    let json = folder.done(&["parity", "scene.toml", "--between", "cpu,cpu", "--json"]);
    folder.file("expect.json", &json);
    serde_json::from_str(&json).expect("JSON")
}

#[test]
fn recorded_hashes_are_met_again() {
    let folder = Folder::new();
    let document = record(&folder);
    let scene = &document["scenes"][0];
    assert_eq!((&scene["scene"], &scene["comparisons"][0]["differ"]), (&"scene.toml".into(), &0.into()), "{document}");
    let out = folder.done(&["parity", "scene.toml", "--between", "cpu,cpu", "--expect", "expect.json"]);
    assert!(out.contains("scene.toml at 32x24, 2 samples, seed 0: the recorded hash"), "{out}");
    // One backend is enough where there is something to compare it with.
    folder.done(&["parity", "scene.toml", "--between", "cpu", "--expect", "expect.json"]);
}

#[test]
fn what_was_recorded_is_rendered_as_it_was() {
    let folder = Folder::new();
    let recorded =
        ["parity", "scene.toml", "--between", "cpu,cpu", "--json", "--size", "8x6", "--spp", "3", "--seed", "7"];
    folder.file("expect.json", folder.done(&recorded));
    let out = folder.done(&["parity", "scene.toml", "--between", "cpu", "--expect", "expect.json"]);
    assert_eq!(out, "scene.toml at 8x6, 3 samples, seed 7: the recorded hash\n");
    // What is given counts.
    let args = ["parity", "scene.toml", "--between", "cpu", "--expect", "expect.json", "--spp", "2"];
    let ended = folder.run(&args);
    assert_eq!(
        (ended.code, ended.text()),
        (Some(1), "scene.toml at 32x24, 2 samples, seed 0: no hash recorded\n".into())
    );
    // Every way in which it was recorded.
    let mut twice: serde_json::Value = serde_json::from_slice(&folder.bytes("expect.json")).expect("JSON");
    let other: serde_json::Value =
        serde_json::from_str(&folder.done(&["parity", "scene.toml", "--between", "cpu,cpu", "--json"])).expect("JSON");
    twice["scenes"].as_array_mut().expect("a list").push(other["scenes"][0].clone());
    folder.file("expect.json", twice.to_string());
    let out = folder.done(&["parity", "scene.toml", "--between", "cpu", "--expect", "expect.json"]);
    assert_eq!(out.lines().count(), 2, "{out}");
    assert!(out.contains("8x6") && out.contains("32x24"), "{out}");
}

#[test]
fn film_hash_of_parity_is_that_of_render() {
    let folder = Folder::new();
    let document = record(&folder);
    let report = folder.cpu(&["render", "scene.toml", "-o", "a.gfilm"]);
    assert_eq!(document["scenes"][0]["film_hash"], super::support::line(&report, "film"));
}

#[test]
fn hash_that_was_tampered_with_is_told() {
    let folder = Folder::new();
    let hash = record(&folder)["scenes"][0]["film_hash"].as_str().expect("a hash").to_owned();
    let other = format!("{}{}", if hash.starts_with('0') { '1' } else { '0' }, &hash[1..]);
    let text = String::from_utf8(folder.bytes("expect.json")).expect("text");
    folder.file("tampered.json", text.replace(&hash, &other));
    let args = ["parity", "scene.toml", "--between", "cpu,cpu", "--expect", "tampered.json"];
    let ended = folder.run(&args);
    assert_eq!(ended.code, Some(1), "{}", ended.stderr);
    let told = format!("hash {hash} differs from the recorded {other}");
    assert!(ended.text().contains(&told), "{}", ended.text());
    let json = folder.run(&[&args[..], &["--json"]].concat());
    assert_eq!(json.code, Some(1));
    assert!(serde_json::from_slice::<serde_json::Value>(&json.out).is_ok(), "{}", json.text());
    assert!(json.stderr.contains(&told), "with --json the line goes to standard error: {}", json.stderr);
}

#[test]
fn scene_that_was_never_recorded_is_a_difference() {
    let folder = Folder::new();
    record(&folder);
    let ended = folder.run(&["parity", "scene.toml", "--seed", "9", "--between", "cpu", "--expect", "expect.json"]);
    assert_eq!(ended.code, Some(1));
    assert!(ended.text().contains("seed 9: no hash recorded"), "{}", ended.text());
}

#[test]
fn expect_file_that_is_missing_or_no_record_is_refused() {
    let folder = Folder::new();
    let args = ["parity", "scene.toml", "--between", "cpu,cpu", "--expect", "expect.json"];
    assert!(folder.fails(74, &args).starts_with("error: cannot read expect.json: "));
    for bad in
        ["", "{", "[]", "{\"scenes\": 3}", "{\"scenes\": [{}]}", "{\"scenes\": [{\"scene\": \"a\", \"width\": -1}]}"]
    {
        folder.file("expect.json", bad);
        let message = folder.fails(65, &args);
        assert!(message.starts_with("error: expect.json: ") && message.lines().count() == 1, "{message}");
    }
}

/// A box with a lamp, a glass ball and a blend: long paths of many kinds.
const BOX: &str = r#"
[render]
integrator = "path"
max_depth = 64
rr_depth = 5
samples = 4
[film]
size = [16, 12]
[camera]
eye = [0, 1, 3.4]
target = [0, 1, 0]
[background]
color = 0.1
[[material]]
name = "white"
color = 0.7
[[material]]
name = "lamp"
color = 0
emission = 6
[[material]]
name = "glass"
model = "dielectric"
[[material]]
name = "metal"
model = "rough-conductor"
metal = "Au"
alpha = 0.3
[[material]]
name = "mixed"
model = "blend"
materials = ["white", "metal"]
[[object]]
name = "room"
shape = "box"
scale = [4, 4, 8]
material = "white"
[[object]]
name = "lamp"
shape = "sphere"
scale = 0.3
translate = [0, 1.8, 0]
material = "lamp"
[[object]]
name = "glass"
shape = "sphere"
scale = 0.5
translate = [0.6, 0.6, 0.4]
material = "glass"
[[object]]
name = "mixed"
shape = "sphere"
scale = 0.5
translate = [-0.6, 0.6, 0]
material = "mixed"
"#;

#[test]
fn long_paths_agree_whatever_the_width_of_a_software_device_s_vectors() {
    if !has_device() {
        return;
    }
    let folder = Folder::new();
    folder.file("box.toml", BOX);
    // Mesa's software driver takes its subgroups' size from this; other drivers do not look at it.
    for bits in ["128", "256", "512"] {
        let mut command = folder.command(&["parity", "box.toml"]);
        // That driver's cache on disk does not tell the widths apart (Mesa 25): what is kept here would poison it.
        command.env("MESA_SHADER_CACHE_DISABLE", "true");
        let ended = ended(command.env("LP_NATIVE_VECTOR_WIDTH", bits));
        assert_eq!(ended.code, Some(0), "{bits}: {}{}", ended.text(), ended.stderr);
        let out = ended.text();
        assert_eq!(out.lines().filter(|line| line.starts_with("box.toml: 0 of 192 pixels differ")).count(), 2, "{out}");
    }
}
