//! Devices as a user meets them: the list, and what happens on a machine without Vulkan.

use assert_cmd::Command;
use serde_json::Value;

/// Stands for a machine without Vulkan.
const NO_LOADER: (&str, &str) = ("GONIO_VULKAN_LOADER", "no-such-folder/libvulkan.so");

fn gonio(args: &[&str]) -> Command {
    let mut command = Command::cargo_bin("gonio").unwrap();
    command.args(args);
    command
}

fn stdout(command: &mut Command) -> String {
    String::from_utf8(command.assert().success().get_output().stdout.clone()).unwrap()
}

#[test]
fn a_machine_without_a_loader_lists_the_cpu_backend_and_says_why_in_one_line() {
    let text = stdout(gonio(&["devices"]).env(NO_LOADER.0, NO_LOADER.1));
    let lines: Vec<_> = text.lines().collect();
    assert_eq!(lines.len(), 3, "{text}");
    assert!(lines[0].starts_with("DEVICE  NAME") && lines[0].ends_with("USABLE  EXACT"), "{text}");
    assert!(lines[1].contains("the CPU backend (") && lines[1].ends_with("yes     yes"), "{text}");
    assert!(lines[2].starts_with("no Vulkan loader on this machine (no-such-folder/libvulkan.so: "), "{text}");
}

#[test]
fn the_json_has_what_the_table_has() {
    let report: Value = serde_json::from_str(&stdout(&mut gonio(&["devices", "--json"]))).unwrap();
    let table = stdout(&mut gonio(&["devices"]));
    assert_eq!(report["cpu"]["usable"], true);
    assert!(report["cpu"]["threads"].as_u64().unwrap() >= 1);
    let listed = report["vulkan"]["devices"].as_array().unwrap();
    let rows: Vec<_> = table.lines().skip(1).take(listed.len()).collect();
    for (device, row) in listed.iter().zip(rows) {
        assert!(row.starts_with(&format!("{} ", device["index"])), "{row}");
        assert!(row.contains(device["name"].as_str().unwrap()), "{row}");
        assert_eq!(device["usable"], device["missing"].as_array().unwrap().is_empty());
    }
    if let Some(problem) = report["vulkan"]["problem"].as_str() {
        assert!(table.ends_with(&format!("{problem}\n")), "{table}");
    }
}

#[test]
fn without_a_loader_auto_uses_the_cpu_and_vulkan_is_an_error() {
    let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/lecture/01-lambert.toml");
    let render = |backend: &str| {
        let args = ["render", scene, "--size", "16x12", "--spp", "1", "-o", "-", "--backend", backend];
        gonio(&args).env(NO_LOADER.0, NO_LOADER.1).assert()
    };
    let automatic = render("auto").success();
    let stderr = String::from_utf8_lossy(&automatic.get_output().stderr).into_owned();
    assert!(automatic.get_output().stdout.starts_with(b"\x89PNG"));
    assert!(!stderr.contains("warn"), "{stderr}");
    render("vulkan").code(69);
}
