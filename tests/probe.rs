//! The strictness probe: what it finds, what it keeps, and what the command line makes of it.

#[path = "common/device.rs"]
mod device;

use gonio::render::vulkan::Context;
use gonio::shading::math::{rcp, sqrt_};
use gonio::verify::inputs::Domain::{Bits, Exponent};
use gonio::verify::probe::{Cache, Exactness, Probed, probe, probe_families};
use gonio::verify::twins::{Family, Mismatch, Twin};
use std::fs;
use std::path::{Path, PathBuf};

/// The reciprocal as it is.
static RIGHT: &[Family] = &[Family {
    kernel: "parity/math",
    twins: &[Twin {
        name: "rcp",
        domains: &[Bits],
        run: |i, o| {
            o.f(rcp(i.f(0)));
        },
    }],
}];

/// The second twin of the second family is wrong by an ulp, above 1.5 only: number 1 of the math kernel is `div`.
static WRONG: &[Family] = &[
    Family { kernel: "parity/math", twins: RIGHT[0].twins },
    Family {
        kernel: "parity/math",
        twins: &[
            Twin {
                name: "rcp",
                domains: &[Bits],
                run: |i, o| {
                    o.f(rcp(i.f(0)));
                },
            },
            Twin {
                name: "div, wrong above 1.5",
                domains: &[Exponent(0, 1), Exponent(3, 4)],
                run: |i, o| {
                    let right = gonio::shading::math::div(i.f(0), i.f(1));
                    o.u(right.to_bits() + u32::from(i.f(0) > 1.5));
                },
            },
            Twin {
                name: "rsqrt, never reached",
                domains: &[Bits],
                run: |i, o| {
                    o.f(sqrt_(i.f(0)));
                },
            },
        ],
    },
];

fn exact(from_cache: bool) -> Probed {
    Probed { exactness: Exactness::Exact, from_cache }
}

fn run(context: &mut Context, families: &[Family], cache: &Cache) -> Probed {
    probe_families(context, families, cache).expect("the device works")
}

/// The only file of a folder.
fn only_file(folder: &Path) -> PathBuf {
    let files: Vec<_> = fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("readable").path()).collect();
    assert_eq!(files.len(), 1, "{files:?}");
    files[0].clone()
}

#[test]
fn the_device_at_hand_is_exact() {
    let Some(mut context) = device::context() else { return };
    assert_eq!(probe(&mut context, &Cache::none()).expect("the device works"), exact(false));
}

#[test]
fn a_twin_that_disagrees_is_reported_with_its_name_and_input() {
    let Some(mut context) = device::context() else { return };
    let folder = tempfile::tempdir().unwrap();
    let cache = Cache::at(folder.path());
    let first = run(&mut context, WRONG, &cache);
    let Exactness::Inexact(mismatch) = &first.exactness else { panic!("a wrong twin passed") };
    assert_eq!(mismatch.twin, "div, wrong above 1.5");
    let [a, b] = mismatch.arguments[..] else { panic!("two arguments: {mismatch:?}") };
    assert!(f32::from_bits(a) > 1.5, "{mismatch}");
    let right = gonio::shading::math::div(f32::from_bits(a), f32::from_bits(b));
    assert_eq!((&mismatch.device[..], &mismatch.cpu[..]), (&[right.to_bits()][..], &[right.to_bits() + 1][..]));
    let text = mismatch.to_string();
    assert!(text.starts_with("div, wrong above 1.5(") && text.contains(&format!("{a:#010x}")), "{text}");
    // And the same again from the cache.
    assert!(!first.from_cache);
    assert_eq!(run(&mut context, WRONG, &cache), Probed { exactness: first.exactness, from_cache: true });
}

#[test]
fn an_answer_is_kept_and_found_again_and_no_other_file_is_left() {
    let Some(mut context) = device::context() else { return };
    let folder = tempfile::tempdir().unwrap();
    let cache = Cache::at(folder.path().join("made/when/needed"));
    assert_eq!(run(&mut context, RIGHT, &cache), exact(false));
    assert_eq!(run(&mut context, RIGHT, &cache), exact(true));
    only_file(&folder.path().join("made/when/needed"));
    assert_eq!(run(&mut context, RIGHT, &Cache::none()), exact(false));
    // Other kernels or twins have an answer of their own.
    assert!(!run(&mut context, WRONG, &cache).from_cache);
}

#[test]
fn a_kept_answer_that_is_corrupt_or_foreign_is_ignored_and_overwritten() {
    let Some(mut context) = device::context() else { return };
    let folder = tempfile::tempdir().unwrap();
    let cache = Cache::at(folder.path());
    run(&mut context, RIGHT, &cache);
    let file = only_file(folder.path());
    let good = fs::read_to_string(&file).unwrap();
    let inexact =
        serde_json::json!({ "inexact": { "twin": "heard of nowhere", "arguments": [], "cpu": [], "device": [] } });
    let mut unheard_of: serde_json::Value = serde_json::from_str(&good).unwrap();
    unheard_of["exactness"] = inexact;
    let mut larger: serde_json::Value = serde_json::from_str(&good).unwrap();
    larger["more"] = serde_json::json!(1);
    let key = file.file_stem().unwrap().to_str().unwrap();
    let bad: [&[u8]; 7] = [
        b"",
        &good.as_bytes()[..good.len() - 1],
        b"\xff\xfe\x00",
        b"{\"exactness\":\"exact\"}",
        good.replace(key, &"0".repeat(64)).leak().as_bytes(),
        unheard_of.to_string().leak().as_bytes(),
        larger.to_string().leak().as_bytes(),
    ];
    for bytes in bad {
        fs::write(&file, bytes).unwrap();
        assert_eq!(run(&mut context, RIGHT, &cache), exact(false), "{:?}", String::from_utf8_lossy(bytes));
        assert_eq!(fs::read_to_string(&file).unwrap(), good, "not overwritten");
    }
}

#[test]
fn a_cache_that_cannot_be_written_is_no_error() {
    let Some(mut context) = device::context() else { return };
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("a file, no folder");
    fs::write(&file, "").unwrap();
    for _ in 0..2 {
        assert_eq!(run(&mut context, RIGHT, &Cache::at(&file)), exact(false));
    }
}

const SCENE: &str = "\
[render]
samples = 1

[film]
size = [4, 4]

[camera]
eye = [0, 0, 4]
target = [0, 0, 0]

[[material]]
name = \"grey\"
model = \"lambert\"

[[object]]
name = \"ball\"
shape = \"sphere\"
material = \"grey\"

[[light]]
type = \"point\"
position = [2, 3, 4]
intensity = 20
";

/// The program with its cache in a folder.
fn gonio(cache: &Path) -> assert_cmd::Command {
    let mut command = assert_cmd::Command::cargo_bin("gonio").expect("built");
    command.env("XDG_CACHE_HOME", cache).timeout(std::time::Duration::from_secs(120));
    command
}

/// A cache in which the device at hand is said to be inexact.
fn denied(context: &mut Context) -> tempfile::TempDir {
    let cache = tempfile::tempdir().unwrap();
    let folder = cache.path().join("gonio/exact");
    probe(context, &Cache::at(&folder)).expect("the device works");
    let file = only_file(&folder);
    let mut answer: serde_json::Value = serde_json::from_str(&fs::read_to_string(&file).unwrap()).unwrap();
    let mismatch = Mismatch {
        twin: "div".into(),
        arguments: vec![0x3f80_0000, 0x4000_0000],
        cpu: vec![0x3f00_0000],
        device: vec![7],
    };
    answer["exactness"] = serde_json::to_value(Exactness::Inexact(mismatch)).unwrap();
    fs::write(&file, answer.to_string()).unwrap();
    cache
}

#[test]
fn the_command_line_warns_of_an_inexact_device_and_refuses_it_if_asked() {
    let Some(mut context) = device::context() else { return };
    let cache = denied(&mut context);
    let name = context.info().name.clone();
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("scene.toml");
    fs::write(&scene, SCENE).unwrap();
    let picture = folder.path().join("a.png");
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();

    let render = |flags: &[&str]| {
        let mut command = gonio(cache.path());
        command.arg("render").arg(&scene).arg("-o").arg(&picture).args(flags).output().unwrap()
    };
    let warned = render(&["--backend", "vulkan"]);
    let said = text(&warned.stderr);
    assert_eq!(warned.status.code(), Some(0), "{said}");
    assert_eq!(said.matches("is not exact: div(1.0 (0x3f800000), 2.0 (0x40000000))").count(), 1, "{said}");
    let is_warning = |line: &str| line.starts_with("warn: ") && line.contains("is not exact");
    assert!(said.lines().any(is_warning), "{said}");
    let refused = render(&["--require-exact", "--backend", "vulkan"]);
    let said = text(&refused.stderr);
    assert_eq!(refused.status.code(), Some(69), "{said}");
    assert!(said.contains(&name) && said.contains("is not exact: div(1.0"), "{said}");
    // The CPU backend is exact, and is what `auto` goes on with.
    for backend in ["cpu", "auto"] {
        assert_eq!(render(&["--require-exact", "--backend", backend]).status.code(), Some(0), "{backend}");
    }

    let parity = |flags: &[&str]| gonio(cache.path()).arg("parity").arg(&scene).args(flags).output().unwrap();
    let warned = parity(&[]);
    assert_eq!(warned.status.code(), Some(0), "{}", text(&warned.stderr));
    assert_eq!(text(&warned.stderr).matches("is not exact").count(), 1, "once, though the device is opened twice");
    assert_eq!(parity(&["--require-exact"]).status.code(), Some(69));

    let listed = gonio(cache.path()).arg("devices").output().unwrap();
    let table = text(&listed.stdout);
    assert!(table.contains("  no (div, 1.0 2.0)\n"), "{table}");
    let json: serde_json::Value =
        serde_json::from_slice(&gonio(cache.path()).args(["devices", "--json"]).output().unwrap().stdout).unwrap();
    let devices = json["vulkan"]["devices"].as_array().unwrap();
    let inexact: Vec<_> = devices.iter().filter(|device| device["exact"] == false).collect();
    assert_eq!(inexact.len(), 1, "{json}");
    assert_eq!(inexact[0]["inexact"]["twin"], "div");
}

#[test]
fn the_command_line_proves_a_device_once_and_then_lists_it_as_exact() {
    let Some(context) = device::context() else { return };
    let index = context.info().index;
    let cache = tempfile::tempdir().unwrap();
    for _ in 0..2 {
        let output = gonio(cache.path()).args(["devices", "--json"]).output().unwrap();
        let json: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!(json["vulkan"]["devices"][index]["exact"], true, "{json}");
    }
    assert!(fs::read_dir(cache.path().join("gonio/exact")).unwrap().count() >= 1, "nothing was kept");
}
