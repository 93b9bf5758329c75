//! `--device` with several devices.

use super::support::{Folder, has_device, line};

/// Stands for a machine without Vulkan.
const NO_LOADER: (&str, &str) = ("GONIO_VULKAN_LOADER", "no-such-folder/libvulkan.so");

fn stats(folder: &Folder) -> serde_json::Value {
    serde_json::from_slice(&folder.bytes("stats.json")).expect("JSON")
}

#[test]
fn several_devices_together_make_the_file_of_the_cpu() {
    if !has_device() {
        return;
    }
    let folder = Folder::new();
    let cpu = folder.cpu(&["render", "scene.toml", "-o", "cpu.png", "--spp", "24"]);
    for devices in ["0,cpu", "cpu, 0"] {
        let args =
            ["render", "scene.toml", "-o", "all.png", "--spp", "24", "--stats", "stats.json", "--device", devices];
        assert_eq!(folder.done(&args), cpu, "{devices}");
        assert_eq!(folder.bytes("all.png"), folder.bytes("cpu.png"), "{devices}");
        let stats = stats(&folder);
        let shares = stats["devices"].as_array().expect("a list");
        assert!(shares.len() >= 2 && stats["device"].as_str().is_some_and(|names| names.contains(" + ")), "{stats}");
        let samples: u64 = shares.iter().map(|share| share["samples"].as_u64().expect("a number")).sum();
        assert_eq!(samples, 24, "{stats}");
        for share in shares {
            assert!(share["error"].is_null() && share["busy_s"].is_f64() && share["device"].is_string(), "{stats}");
        }
    }
}

#[test]
fn all_makes_the_same_file_and_takes_no_software_device_beside_the_cpu_backend() {
    if !has_device() {
        return;
    }
    let folder = Folder::new();
    let cpu = folder.cpu(&["render", "scene.toml", "-o", "cpu.png"]);
    let args = ["render", "scene.toml", "-o", "all.png", "--device", "all", "-v", "--stats", "stats.json"];
    let ended = folder.run(&args);
    assert_eq!((ended.code, ended.text()), (Some(0), cpu));
    assert_eq!(folder.bytes("all.png"), folder.bytes("cpu.png"));
    let list: serde_json::Value = serde_json::from_str(&folder.done(&["devices", "--json"])).expect("JSON");
    let devices = list["vulkan"]["devices"].as_array().expect("a list");
    let names = stats(&folder)["device"].as_str().expect("names").to_owned();
    for device in devices {
        let name = device["name"].as_str().expect("a name");
        let is_software = device["kind"] == "cpu";
        assert_eq!(names.contains(name), !is_software && device["missing"] == serde_json::json!([]), "{names}");
        let told = format!("device {} is left out of \"all\"", device["index"]);
        assert_eq!(ended.stderr.contains(&told), is_software, "{}", ended.stderr);
    }
}

#[test]
fn all_without_vulkan_is_the_cpu_and_says_so() {
    let folder = Folder::new();
    let cpu = folder.cpu(&["render", "scene.toml", "-o", "a.png"]);
    let args = ["render", "scene.toml", "-o", "a.png", "--device", "all"];
    let ended = super::support::ended(folder.command(&args).env(NO_LOADER.0, NO_LOADER.1));
    assert_eq!((ended.code, ended.text()), (Some(0), cpu));
    assert!(
        ended.stderr.contains("no Vulkan loader") && ended.stderr.contains("the CPU backend alone"),
        "{}",
        ended.stderr
    );
}

#[test]
fn cpu_is_the_cpu_backend_as_gonio_devices_lists_it() {
    let folder = Folder::new();
    folder.done(&["render", "scene.toml", "-o", "a.png", "--device", "cpu", "--stats", "stats.json"]);
    assert!(stats(&folder)["device"].as_str().is_some_and(|name| name.starts_with("cpu (")), "{}", stats(&folder));
}

#[test]
fn a_list_with_a_device_that_is_not_there_is_refused_before_rendering() {
    if !has_device() {
        return;
    }
    let folder = Folder::new();
    let message = folder.fails(69, &["render", "scene.toml", "-o", "a.png", "--device", "cpu,97"]);
    assert!(message.starts_with("error: no Vulkan device 97; there are: 0 ("), "{message}");
    assert_eq!(folder.names(), ["scene.toml"]);
}

#[test]
fn a_device_named_twice_is_refused() {
    let folder = Folder::new();
    let message = folder.fails(2, &["render", "scene.toml", "-o", "a.png", "--device", "cpu,cpu"]);
    assert_eq!(message, "error: --device cpu,cpu: \"cpu\" is device cpu, which is named already\n");
    if has_device() {
        let message = folder.fails(2, &["render", "scene.toml", "-o", "a.png", "--device", "0,cpu,0"]);
        assert_eq!(message, "error: --device 0,cpu,0: \"0\" is device 0, which is named already\n");
    }
}

#[test]
fn several_devices_and_the_cpu_backend_alone_exclude_each_other() {
    let folder = Folder::new();
    let message = folder.fails(2, &["render", "scene.toml", "-o", "a.png", "--device", "all", "--backend", "cpu"]);
    assert_eq!(message, "error: --device all cannot be used with --backend cpu\n");
}

#[test]
fn one_bounce_list_takes_one_device() {
    let folder = Folder::new();
    let message = folder.fails(69, &["render", "scene.toml", "--pixel", "1,1", "--device", "all"]);
    assert_eq!(message, "error: --device all: this command takes one device\n");
}

#[test]
fn a_time_limit_ends_all_devices_on_whole_passes() {
    let folder = Folder::new();
    let args = ["render", "scene.toml", "-o", "a.gfilm", "--time", "0.3", "--device"];
    let report = folder.done(&[&args[..], &[if has_device() { "all" } else { "cpu" }]].concat());
    let samples = line(&report, "samples");
    let again = folder.cpu(&["render", "scene.toml", "-o", "b.gfilm", "--samples", samples]);
    assert_eq!(again, report);
}
