//! What a broken driver costs: itself. `loader.cpp` fails single calls, `driver.cpp` is broken as a whole.
#![cfg(target_os = "linux")]

mod calls;
mod drivers;

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A ball under a lamp, 16x16, one sample a pixel.
const SCENE: &str = r#"
[render]
samples = 1
[film]
size = [16, 16]
filter = "box"
[camera]
eye = [0, 1, 5]
target = [0, 0.5, 0]
[background]
color = 0.25
[[material]]
name = "red"
color = [0.8, 0.1, 0.1]
[[object]]
shape = "sphere"
material = "red"
[[light]]
type = "point"
position = [3, 5, 4]
intensity = 200
"#;

/// A folder with the scene in it.
struct Folder(tempfile::TempDir);

impl Folder {
    fn new() -> Self {
        let folder = Self(tempfile::tempdir().expect("a temporary folder"));
        std::fs::write(folder.path("scene.toml"), SCENE).expect("writable");
        folder
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// The names of all files but the scene, sorted.
    fn names(&self) -> Vec<String> {
        let entries = std::fs::read_dir(self.0.path()).expect("readable");
        let mut names: Vec<String> =
            entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
        names.retain(|name| name != "scene.toml");
        names.sort();
        names
    }

    /// `gonio render` of the scene into `a.png`.
    fn render(&self, args: &[&str]) -> Command {
        let mut command = Command::new(program());
        command.args(["render", "scene.toml", "-o", "a.png"]).args(args).current_dir(self.0.path());
        command.env_remove("GONIO_VALIDATION");
        command
    }

    /// The picture, which is taken away.
    fn take_picture(&self) -> Option<Vec<u8>> {
        let bytes = std::fs::read(self.path("a.png")).ok()?;
        std::fs::remove_file(self.path("a.png")).expect("it was there");
        Some(bytes)
    }

    /// The picture of the CPU backend, which is everybody's.
    fn expected(&self) -> Vec<u8> {
        done(&mut self.render(&["--backend", "cpu"]));
        self.take_picture().expect("a picture")
    }
}

fn program() -> &'static Path {
    Path::new(env!("CARGO_BIN_EXE_gonio"))
}

/// Must succeed.
#[track_caller]
fn done(command: &mut Command) -> Output {
    let output = command.output().expect("the program starts");
    assert_eq!(output.status.code(), Some(0), "{command:?}: {}", stderr(&output));
    output
}

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// A library from a source of this folder, compiled by what compiles the program's own C++.
fn library(folder: &Folder, source: &str, flags: &[&str]) -> PathBuf {
    let compiler = std::env::var_os("CXX").unwrap_or_else(|| "c++".into());
    let from = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/vulkan_faults").join(source);
    let library = folder.path(&format!("{source}{}.so", flags.concat()));
    // Not to be unloaded: it counts over all instances of a process.
    let always = ["-std=c++17", "-O1", "-fPIC", "-shared", "-Wl,-z,nodelete", "-o"];
    done(Command::new(compiler).args(flags).args(always).arg(&library).arg(from).arg("-ldl"));
    library
}

/// Whether this machine has a device; says so where it has none, and fails if `GONIO_REQUIRE_DEVICE=1`.
fn has_device() -> bool {
    use gonio::render::vulkan::{Context, DeviceChoice};
    let opened = Context::new(&DeviceChoice::Auto, false);
    if let Err(error) = &opened {
        let required = std::env::var_os("GONIO_REQUIRE_DEVICE").is_some_and(|value| value == "1");
        assert!(!required, "GONIO_REQUIRE_DEVICE=1, but: {error}");
        println!("SKIPPED: no Vulkan device ({error})");
    }
    opened.is_ok()
}
