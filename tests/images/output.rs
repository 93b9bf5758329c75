//! Output files are whole or not there.

use crate::{film_of, ramp};
use gonio::film::OutputFile;
use gonio::film::read::read_film;
use gonio::film::write::{Format, Picture};
use std::fs;
use std::io::Write;
use std::path::Path;

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

#[test]
fn a_committed_file_has_its_name_and_leaves_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.gfilm");
    fs::write(&path, "before").unwrap();
    let film = film_of(4, &ramp(4, 2), |_| {});
    let mut file = OutputFile::open(&path).unwrap();
    assert_eq!(names(folder.path()).len(), 2);
    let picture = Picture { format: Format::Gfilm, sixteen_bit: false, backdrop: None, aovs: &[] };
    picture.write(&film, &mut file).unwrap();
    assert_eq!(fs::read(&path).unwrap(), b"before");
    file.commit().unwrap();
    assert_eq!(read_film(&path).unwrap(), film);
    assert_eq!(names(folder.path()), ["a.gfilm"]);
}

#[test]
fn an_uncommitted_file_is_removed_and_what_was_there_stays() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.png");
    fs::write(&path, "before").unwrap();
    let mut file = OutputFile::open(&path).unwrap();
    file.write_all(b"half of it").unwrap();
    drop(file);
    assert_eq!(fs::read(&path).unwrap(), b"before");
    assert_eq!(names(folder.path()), ["a.png"]);
}

#[test]
fn a_commit_that_fails_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.png");
    let mut file = OutputFile::open(&path).unwrap();
    file.write_all(b"all of it").unwrap();
    // Someone makes a folder of that name while we render.
    fs::create_dir(&path).unwrap();
    assert_eq!(file.commit().unwrap_err().exit_code(), 74);
    assert_eq!(names(folder.path()), ["a.png"]);
}

#[cfg(unix)]
#[test]
fn what_appeared_under_the_name_meanwhile_is_not_replaced_unless_it_is_a_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("pipe.gfilm");
    let mut file = OutputFile::open(&path).unwrap();
    file.write_all(b"all of it").unwrap();
    named_pipe(folder.path());
    assert_eq!(file.commit().unwrap_err().exit_code(), 74);
    assert!(is_pipe(&path));
    assert_eq!(names(folder.path()), ["pipe.gfilm"]);
}

#[test]
fn two_runs_to_one_name_do_not_mix() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.png");
    let (mut a, mut b) = (OutputFile::open(&path).unwrap(), OutputFile::open(&path).unwrap());
    a.write_all(b"aaaa").unwrap();
    b.write_all(b"b").unwrap();
    b.commit().unwrap();
    a.commit().unwrap();
    assert_eq!(fs::read(&path).unwrap(), b"aaaa");
    assert_eq!(names(folder.path()), ["a.png"]);
}

/// Makes a file that was last written ten minutes ago.
fn old_file(path: &Path) -> fs::File {
    let file = fs::File::create(path).unwrap();
    file.set_modified(std::time::SystemTime::now() - std::time::Duration::from_secs(600)).unwrap();
    file
}

#[test]
fn what_killed_processes_left_is_swept_and_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    for dead in [".a.png.123-0.part", ".other name.exr.7-1764571132000000000.part"] {
        drop(old_file(&at(dead)));
    }
    let kept = [".a.png.part", ".a.png.12-x.part", ".b.12-3.part.png", "a.png.12-3.part", "notes"];
    for other in kept {
        drop(old_file(&at(other)));
    }
    // Of a process that is at work, and one that was made a moment ago.
    let held = old_file(&at(".a.png.124-0.part"));
    held.lock().unwrap();
    fs::write(at(".a.png.125-0.part"), "new").unwrap();
    let mut file = OutputFile::open(&at("a.png")).unwrap();
    file.write_all(b"all of it").unwrap();
    file.commit().unwrap();
    let mut expected: Vec<&str> = kept.to_vec();
    expected.extend([".a.png.124-0.part", ".a.png.125-0.part", "a.png"]);
    expected.sort_unstable();
    assert_eq!(names(folder.path()), expected);
}

#[test]
fn a_file_at_work_is_not_swept_however_long_it_takes() {
    let folder = tempfile::tempdir().unwrap();
    let (a, b) = (folder.path().join("a.png"), folder.path().join("b.png"));
    let mut slow = OutputFile::open(&a).unwrap();
    let unfinished = fs::OpenOptions::new().write(true).open(slow.temporary().unwrap()).unwrap();
    unfinished.set_modified(std::time::SystemTime::now() - std::time::Duration::from_secs(86_400)).unwrap();
    OutputFile::open(&b).unwrap().commit().unwrap();
    slow.write_all(b"all of it").unwrap();
    slow.commit().unwrap();
    assert_eq!(names(folder.path()), ["a.png", "b.png"]);
}

#[test]
fn a_thousand_unfinished_files_of_this_very_number_do_not_stop_the_next() {
    let folder = tempfile::tempdir().unwrap();
    for attempt in 0..1000 {
        fs::write(folder.path().join(format!(".a.png.{}-{attempt}.part", std::process::id())), "").unwrap();
    }
    let path = folder.path().join("a.png");
    OutputFile::open(&path).unwrap().commit().unwrap();
    assert!(path.exists());
}

#[test]
fn bad_paths_are_refused_before_the_work_starts() {
    let folder = tempfile::tempdir().unwrap();
    let read_only = folder.path().join("kept.png");
    fs::write(&read_only, "kept").unwrap();
    let mut permissions = fs::metadata(&read_only).unwrap().permissions();
    permissions.set_readonly(true);
    fs::set_permissions(&read_only, permissions).unwrap();
    let cases = [
        (folder.path().to_path_buf(), "it is a folder"),
        (folder.path().join("new.png/"), "the name is a folder's"),
        (folder.path().join("missing/a.png"), "no folder "),
        (folder.path().join("kept.png/a.png"), "Not a directory"),
        (read_only.clone(), "it is read-only"),
    ];
    for (path, reason) in cases {
        let error = OutputFile::open(&path).unwrap_err();
        assert_eq!(error.exit_code(), 74);
        let message = error.to_string();
        assert!(message.starts_with(&format!("cannot write {}: ", path.display())), "{message}");
        assert!(message.contains(reason), "{message}");
    }
    assert_eq!(fs::read(&read_only).unwrap(), b"kept");
    assert_eq!(names(folder.path()), ["kept.png"]);
}

#[cfg(unix)]
#[test]
fn a_link_stays_a_link_and_permissions_stay() {
    use std::os::unix::fs::{PermissionsExt, symlink};
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("real")).unwrap();
    let (target, link) = (folder.path().join("real/a.png"), folder.path().join("link.png"));
    fs::write(&target, "before").unwrap();
    fs::set_permissions(&target, fs::Permissions::from_mode(0o640)).unwrap();
    symlink("real/a.png", &link).unwrap();
    let write = |path: &Path, text: &str| {
        let mut file = OutputFile::open(path).unwrap();
        file.write_all(text.as_bytes()).unwrap();
        file.commit().unwrap();
    };
    write(&link, "after");
    assert_eq!(fs::read(&target).unwrap(), b"after");
    assert_eq!(fs::metadata(&target).unwrap().permissions().mode() & 0o777, 0o640);
    // A link to what is not there yet makes it.
    let dangling = folder.path().join("dangling.png");
    symlink("real/b.png", &dangling).unwrap();
    write(&dangling, "new");
    assert_eq!(fs::read(folder.path().join("real/b.png")).unwrap(), b"new");
    assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    assert!(fs::symlink_metadata(&dangling).unwrap().is_symlink());
    assert_eq!(names(folder.path()), ["dangling.png", "link.png", "real"]);
    assert_eq!(names(&folder.path().join("real")), ["a.png", "b.png"]);
}

/// A pipe with a name. These tests never name a device: run as root against a broken `OutputFile`, they would replace it.
#[cfg(unix)]
fn named_pipe(folder: &Path) -> std::path::PathBuf {
    let path = folder.join("pipe.gfilm");
    assert!(std::process::Command::new("mkfifo").arg(&path).status().unwrap().success());
    path
}

#[cfg(unix)]
fn is_pipe(path: &Path) -> bool {
    use std::os::unix::fs::FileTypeExt;
    fs::symlink_metadata(path).unwrap().file_type().is_fifo()
}

#[cfg(unix)]
#[test]
fn what_is_no_regular_file_is_written_to_and_stays() {
    let folder = tempfile::tempdir().unwrap();
    let path = named_pipe(folder.path());
    let (sender, receiver) = std::sync::mpsc::channel();
    let reader = path.clone();
    std::thread::spawn(move || sender.send(fs::read(reader).unwrap()));
    let film = film_of(64, &ramp(64, 64), |_| {});
    let mut file = OutputFile::open(&path).unwrap();
    let picture = Picture { format: Format::Gfilm, sixteen_bit: false, backdrop: None, aovs: &[] };
    picture.write(&film, &mut file).unwrap();
    file.commit().unwrap();
    // A time limit: what was renamed away never ends the reader's wait.
    let bytes = receiver.recv_timeout(std::time::Duration::from_secs(10)).unwrap();
    assert_eq!(bytes, crate::encode(&film, Format::Gfilm, false));
    assert!(is_pipe(&path));
    assert_eq!(names(folder.path()), ["pipe.gfilm"]);
}

#[cfg(unix)]
#[test]
fn an_error_that_shows_only_when_the_buffer_is_emptied_is_reported() {
    let folder = tempfile::tempdir().unwrap();
    let path = named_pipe(folder.path());
    let (sender, receiver) = std::sync::mpsc::channel();
    let reader = path.clone();
    std::thread::spawn(move || {
        drop(fs::File::open(reader).unwrap());
        sender.send(())
    });
    let mut file = OutputFile::open(&path).unwrap();
    receiver.recv_timeout(std::time::Duration::from_secs(10)).unwrap();
    // Nobody reads any more, but so little stays in the buffer until the end.
    file.write_all(b"few bytes").unwrap();
    let error = file.commit().unwrap_err();
    assert_eq!(error.exit_code(), 74);
    assert!(error.to_string().starts_with(&format!("cannot write {}: ", path.display())), "{error}");
}
