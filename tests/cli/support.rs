//! A folder with a scene in it, and the program.

#[path = "../common/assets.rs"]
mod assets;

use assert_cmd::Command;
pub use assets::asset;
use gonio::film::read::{Picture, read_film, read_picture};
use gonio::film::{Film, Rect};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// A red ball before a grey background, 32x24, two samples a pixel: too few for a filter with negative lobes.
pub const SCENE: &str = r#"
[render]
samples = 2
[film]
size = [32, 24]
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
name = "ball"
shape = "sphere"
material = "red"
[[light]]
type = "point"
position = [3, 5, 4]
intensity = 200
"#;

pub const TRIANGLE_OBJ: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
pub const TRIANGLE_PLY: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n\
property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

/// No command of these tests may take longer, by far.
const PATIENCE: Duration = Duration::from_secs(120);

/// A temporary folder in which commands run.
pub struct Folder {
    folder: tempfile::TempDir,
}

/// How a command ended.
#[derive(Debug)]
pub struct Ended {
    /// None if a signal ended it.
    pub code: Option<i32>,
    pub out: Vec<u8>,
    pub stderr: String,
}

impl Folder {
    /// With `scene.toml` in it.
    pub fn new() -> Self {
        let folder = Self { folder: tempfile::tempdir().expect("a temporary folder") };
        folder.file("scene.toml", SCENE);
        folder
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub fn file(&self, name: &str, content: impl AsRef<[u8]>) {
        std::fs::write(self.path(name), content).expect("a file in a temporary folder can be written");
    }

    pub fn bytes(&self, name: &str) -> Vec<u8> {
        std::fs::read(self.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    pub fn film(&self, name: &str) -> Film {
        read_film(&self.path(name)).expect("a film")
    }

    pub fn picture(&self, name: &str) -> Picture {
        read_picture(&self.path(name)).expect("a picture")
    }

    /// The names of all files, sorted: what is left over shows here.
    pub fn names(&self) -> Vec<String> {
        let entries = std::fs::read_dir(self.folder.path()).expect("readable");
        let mut names: Vec<String> =
            entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }

    /// The program, in this folder, with a limit on its time.
    pub fn command(&self, args: &[&str]) -> Command {
        let mut command = Command::new(program());
        command.args(args).current_dir(self.folder.path()).timeout(PATIENCE).env_remove("RUST_LOG");
        command
    }

    pub fn run(&self, args: &[&str]) -> Ended {
        ended(&mut self.command(args))
    }

    /// Runs on the CPU and must succeed; gives its standard output.
    #[track_caller]
    pub fn cpu(&self, args: &[&str]) -> String {
        let mut all = args.to_vec();
        all.extend(["--backend", "cpu"]);
        self.done(&all)
    }

    /// Must succeed; gives its standard output.
    #[track_caller]
    pub fn done(&self, args: &[&str]) -> String {
        let ended = self.run(args);
        assert_eq!(ended.code, Some(0), "{args:?}: {}", ended.stderr);
        ended.text()
    }

    /// Must fail with `code`, without a panic; gives its standard error.
    #[track_caller]
    pub fn fails(&self, code: i32, args: &[&str]) -> String {
        let ended = self.run(args);
        assert_eq!(ended.code, Some(code), "{args:?}: {}{}", ended.text(), ended.stderr);
        assert!(!ended.stderr.contains("panicked"), "{args:?}: {}", ended.stderr);
        ended.stderr
    }
}

impl Ended {
    pub fn text(&self) -> String {
        String::from_utf8_lossy(&self.out).into_owned()
    }
}

pub fn program() -> &'static Path {
    Path::new(env!("CARGO_BIN_EXE_gonio"))
}

pub fn ended(command: &mut Command) -> Ended {
    let output = command.output().expect("the program starts");
    Ended {
        code: output.status.code(),
        out: output.stdout,
        stderr: String::from_utf8(output.stderr).expect("messages are UTF-8"),
    }
}

/// The line of a report that begins with `word`, without it.
#[track_caller]
pub fn line<'a>(report: &'a str, word: &str) -> &'a str {
    let found = report.lines().find_map(|line| line.strip_prefix(word)?.strip_prefix(' '));
    found.unwrap_or_else(|| panic!("no line {word:?} in {report:?}"))
}

/// The pixels of `rect` in a picture of the whole frame.
pub fn region(picture: &Picture, rect: Rect) -> Vec<[f32; 4]> {
    let width = picture.image.width as usize;
    let (x, y) = (rect.x as usize, rect.y as usize);
    let rows = picture.image.pixels.chunks(width).skip(y).take(rect.height as usize);
    rows.flat_map(|row| row[x..x + rect.width as usize].iter().copied()).collect()
}

/// Whether this machine has a Vulkan device that the program can use; says so where it has none, and fails if
/// `GONIO_REQUIRE_DEVICE=1`.
pub fn has_device() -> bool {
    use gonio::render::vulkan::{Context, DeviceChoice};
    match Context::new(&DeviceChoice::Auto, false) {
        Ok(_) => true,
        Err(error) => {
            let required = std::env::var_os("GONIO_REQUIRE_DEVICE").is_some_and(|value| value == "1");
            assert!(!required, "GONIO_REQUIRE_DEVICE=1, but: {error}");
            println!("SKIPPED: no Vulkan device ({error})");
            false
        }
    }
}
