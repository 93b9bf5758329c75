//! Ctrl-C and SIGTERM: what was finished is saved, soon.
#![cfg(unix)]

use super::support::{Folder, has_device, program};
use std::io::{BufRead, BufReader};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

/// Ends the child if the test ends first.
struct Running(Child);

impl Drop for Running {
    fn drop(&mut self) {
        // An error means that it has ended, as it should.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

impl Running {
    /// A render that would take days, once it has begun.
    fn render(folder: &Folder, output: &str, device: &str) -> Self {
        let running = Self::until(folder, "rendering on cpu", &["scene.toml", "--device", device, "-o", output]);
        std::thread::sleep(Duration::from_millis(300));
        running
    }

    /// Once it has said what begins like `word`.
    fn until(folder: &Folder, word: &str, args: &[&str]) -> Self {
        let mut command = Command::new(program());
        command.args(["render", "--spp", "16777216", "--verbose"]).args(args);
        let child = command.current_dir(folder.path("")).stdout(Stdio::null()).stderr(Stdio::piped()).spawn();
        let mut running = Self(child.expect("the program starts"));
        let stderr = running.0.stderr.take().expect("piped");
        let mut lines = BufReader::new(stderr).lines();
        assert!(lines.any(|line| line.is_ok_and(|line| line.starts_with(word))), "it never began");
        // Keeps the pipe open and empty, or the next message would meet a closed one.
        std::thread::spawn(move || lines.for_each(drop));
        running
    }

    fn signal(&self, name: &str) {
        // The shell's own kill: a bare machine has no other.
        let sent = Command::new("sh").args(["-c", &format!("kill {name} {}", self.0.id())]).status();
        assert!(sent.expect("sh starts").success());
    }

    fn ends(&mut self) -> ExitStatus {
        let start = Instant::now();
        loop {
            if let Some(status) = self.0.try_wait().expect("a child") {
                return status;
            }
            assert!(start.elapsed() < Duration::from_secs(20), "it did not end");
            std::thread::sleep(Duration::from_millis(20));
        }
    }
}

#[test]
fn ctrl_c_before_there_is_anything_to_save_ends_at_once_and_leaves_nothing() {
    let folder = Folder::new();
    let mut command = Command::new(program());
    // The largest terrain there is: it takes far longer to make than this test waits.
    command.args(["render", "terrain:33554432", "--device", "cpu", "-o", "a.png"]).current_dir(folder.path(""));
    let mut render = Running(command.stderr(Stdio::null()).spawn().expect("the program starts"));
    let start = Instant::now();
    while folder.names().len() < 2 {
        assert!(start.elapsed() < Duration::from_secs(20), "it never began");
        std::thread::sleep(Duration::from_millis(5));
    }
    assert!(folder.names()[0].ends_with(".part"), "{:?}", folder.names());
    render.signal("-INT");
    assert_eq!(render.ends().code(), Some(130));
    assert_eq!(folder.names(), ["scene.toml"]);
}

/// Interrupts a render on `device`.
fn ctrl_c_saves_what_was_finished(device: &str) {
    let folder = Folder::new();
    let mut render = Running::render(&folder, "a.gfilm", device);
    render.signal("-INT");
    assert_eq!(render.ends().code(), Some(130));
    let film = folder.film("a.gfilm");
    let samples = film.samples().to_string();
    assert!(film.samples().total() > 0 && samples.starts_with("0.."), "{samples}");
    // A whole number of samples of every pixel: the same number on purpose is the same film.
    let again = folder.cpu(&["render", "scene.toml", "-o", "b.gfilm", "--samples", &samples]);
    assert_eq!(super::support::line(&again, "film"), film.hash().to_string());
}

#[test]
fn ctrl_c_saves_the_film_so_far_and_exits_with_130() {
    ctrl_c_saves_what_was_finished("cpu");
}

#[test]
fn ctrl_c_ends_all_devices_on_whole_passes() {
    if has_device() {
        ctrl_c_saves_what_was_finished("all");
    }
}

#[test]
fn ctrl_c_while_a_large_scene_is_baked_ends_it_and_leaves_nothing() {
    let folder = Folder::new();
    let mut render = Running::until(&folder, "terrain:2M: baking", &["terrain:2M", "-o", "a.png"]);
    let sent = Instant::now();
    render.signal("-INT");
    assert_eq!(render.ends().code(), Some(130));
    assert!(sent.elapsed() < Duration::from_secs(5), "{:?}", sent.elapsed());
    assert_eq!(folder.names(), ["scene.toml"]);
}

#[test]
fn sigterm_saves_the_picture_so_far_and_exits_with_143() {
    let folder = Folder::new();
    let mut render = Running::render(&folder, "a.png", "cpu");
    render.signal("-TERM");
    assert_eq!(render.ends().code(), Some(143));
    let picture = folder.picture("a.png");
    assert_eq!((picture.image.width, picture.image.height), (32, 24));
    assert!(picture.image.pixels.iter().any(|pixel| pixel[0] > 0.0));
    assert_eq!(folder.names(), ["a.png", "scene.toml"]);
}

/// Interrupts a render of 16 million pixels in the middle of its first samples.
fn ctrl_c_does_not_wait_for_the_first_samples(device: &str) {
    let folder = Folder::new();
    let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/cornell.toml");
    for fetch in ["texel", "storage"] {
        let args = [scene, "--size", "4096x4096", "--device", device, "--fetch", fetch, "-o", "a.png"];
        let mut render = Running::until(&folder, "rendering on ", &args);
        // Also while a device still compiles.
        std::thread::sleep(Duration::from_millis(if fetch == "texel" { 200 } else { 3000 }));
        let sent = Instant::now();
        render.signal("-INT");
        assert_eq!(render.ends().code(), Some(130));
        // Two seconds on a machine that does nothing else, as tests do not have it.
        assert!(sent.elapsed() < Duration::from_secs(5), "{device}, {fetch}: {:?}", sent.elapsed());
        assert_eq!(folder.names(), ["scene.toml"]);
    }
}

#[test]
fn ctrl_c_does_not_wait_for_the_cpu() {
    ctrl_c_does_not_wait_for_the_first_samples("cpu");
}

#[test]
fn ctrl_c_does_not_wait_for_a_software_device() {
    let is_there =
        |choice: &str| super::support::ended(Folder::new().command(&["devices"]).arg("--json")).text().contains(choice);
    if is_there("\"kind\": \"cpu\"") {
        ctrl_c_does_not_wait_for_the_first_samples("software");
    } else {
        println!("SKIPPED: no software device");
    }
}

#[test]
fn an_interrupted_gallery_has_its_page_with_what_there_is_and_says_what_is_to_come() {
    let folder = Folder::new();
    std::fs::create_dir(folder.path("scenes")).expect("a folder");
    folder.file("scenes/a.toml", super::support::SCENE);
    folder.file("scenes/b.toml", super::support::SCENE.replace("samples = 2", "samples = 16777216"));
    let mut command = Command::new(program());
    command.args(["render", "--gallery", "scenes", "-o", "out", "--backend", "cpu"]).current_dir(folder.path(""));
    let mut gallery = Running(command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().expect("the program starts"));
    let start = Instant::now();
    while !folder.path("out/a.png").is_file() {
        assert!(start.elapsed() < Duration::from_secs(60), "it never rendered the first");
        std::thread::sleep(Duration::from_millis(5));
    }
    std::thread::sleep(Duration::from_millis(300));
    gallery.signal("-INT");
    assert_eq!(gallery.ends().code(), Some(130));
    let page = String::from_utf8(folder.bytes("out/index.html")).expect("text");
    assert!(page.contains("id=\"a\"") && page.contains("To come: b.") && !page.contains("id=\"b\""), "{page}");
}
