//! Drivers that crash, hang or fail while they are asked about, beside one that does not; and a disk that is full.

use super::{Folder, done, has_device, library, program, stderr};
use std::path::{Path, PathBuf};
use std::process::Command;

/// The manifest of a driver that is broken in the way `mode` (`driver.cpp`).
fn manifest(folder: &Folder, mode: u32) -> PathBuf {
    let driver = library(folder, "driver.cpp", &[&format!("-DMODE={mode}")]);
    let text = format!(
        r#"{{ "file_format_version": "1.0.0", "ICD": {{ "library_path": "{}", "api_version": "1.2.0" }} }}"#,
        driver.display()
    );
    let path = folder.path(&format!("{mode}.json"));
    std::fs::write(&path, text).expect("writable");
    path
}

/// The command with a driver beside those of this machine. Nobody waits long for it.
fn beside<'a>(command: &'a mut Command, manifest: &Path) -> &'a mut Command {
    command.env("VK_ADD_DRIVER_FILES", manifest).env("GONIO_DRIVER_SECONDS", "3")
}

/// What `gonio devices` lists, by index.
fn devices(command: &mut Command) -> (String, String) {
    let output = done(command.args(["devices"]));
    (String::from_utf8_lossy(&output.stdout).into_owned(), stderr(&output))
}

fn a_broken_driver_costs_only_itself(mode: u32) {
    if !has_device() {
        return;
    }
    let folder = Folder::new();
    let broken = manifest(&folder, mode);
    let (well, _) = devices(&mut Command::new(program()));
    let (there, said) = devices(beside(&mut Command::new(program()), &broken));
    assert_eq!(there, well);
    assert!(said.contains(&format!("warn: the Vulkan driver {} is passed over: ", broken.display())), "{said}");
    let expected = folder.expected();
    for args in [&["--backend", "vulkan"][..], &[], &["--device", "all"]] {
        let output = done(beside(&mut folder.render(args), &broken));
        assert_eq!(folder.take_picture().as_ref(), Some(&expected), "{args:?}: {}", stderr(&output));
    }
    // Alone it leaves the CPU backend.
    let mut alone = folder.render(&[]);
    done(beside(&mut alone, &broken).env("VK_DRIVER_FILES", &broken));
    assert_eq!(folder.take_picture(), Some(expected));
}

#[test]
fn a_driver_that_crashes_costs_only_itself() {
    a_broken_driver_costs_only_itself(0);
}

#[test]
fn a_driver_that_hangs_costs_only_itself() {
    a_broken_driver_costs_only_itself(1);
}

#[test]
fn a_driver_that_cannot_list_its_devices_costs_only_itself() {
    a_broken_driver_costs_only_itself(2);
}

#[test]
fn a_full_disk_costs_the_drivers_cache_and_nothing_else() {
    if !has_device() {
        return;
    }
    let folder = Folder::new();
    std::fs::create_dir(folder.path("full")).expect("writable");
    let expected = folder.expected();
    // A disk of its own for one process; only root may have one.
    let disk = "mount -t tmpfs -o size=64k tmpfs full && { head -c 100000 /dev/zero > full/filler 2> /dev/null; exec \"$@\"; }";
    let on_full_disk = |program: &Path, args: &[&str]| {
        let mut command = Command::new("unshare");
        command.args(["-m", "sh", "-c", disk, "sh"]).arg(program).args(args).current_dir(folder.path(""));
        command.env("XDG_CACHE_HOME", folder.path("full")).env_remove("MESA_SHADER_CACHE_DIR");
        command
    };
    if !on_full_disk(Path::new("true"), &[]).output().is_ok_and(|output| output.status.success()) {
        return println!("SKIPPED: this user cannot make a disk");
    }
    done(&mut on_full_disk(program(), &["render", "scene.toml", "--backend", "vulkan", "-o", "a.png"]));
    assert_eq!(folder.take_picture(), Some(expected));
}
