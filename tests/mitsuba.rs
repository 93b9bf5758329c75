//! Mitsuba's XML scenes: what is read, what it means, and what is refused.

#[path = "mitsuba/attributes.rs"]
mod attributes;
#[path = "mitsuba/lamps.rs"]
mod lamps;
#[path = "mitsuba/meaning.rs"]
mod meaning;
#[path = "mitsuba/published.rs"]
mod published;
#[path = "mitsuba/references.rs"]
mod references;
#[path = "mitsuba/refused.rs"]
mod refused;
#[path = "common/scenes.rs"]
mod scenes;

use gonio::scene::load::load_with;
use gonio::scene::*;
use std::fs;
use std::path::{Path, PathBuf};

/// A camera and a ball: the least that a scene needs, to be added to.
const LEAST: &str = "<sensor type=\"perspective\"/><shape type=\"sphere\"/>";

/// Writes files into a fresh folder and loads the first.
fn try_files(files: &[(&str, &str)], defines: &[(&str, &str)]) -> Result<Scene, SceneError> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for (name, text) in files {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        fs::write(path, text).expect("writable");
    }
    let defines: Vec<_> = defines.iter().map(|(name, value)| ((*name).to_owned(), (*value).to_owned())).collect();
    load_with(&folder.path().join(files[0].0), &[], &defines)
}

/// A scene of these elements.
fn scene_text(elements: &str) -> String {
    format!("<scene version=\"3.0.0\">\n{elements}\n</scene>\n")
}

fn try_read(elements: &str) -> Result<Scene, SceneError> {
    try_files(&[("a.xml", &scene_text(elements))], &[])
}

#[track_caller]
fn read(elements: &str) -> Scene {
    try_read(elements).unwrap_or_else(|error| panic!("{error}"))
}

/// The material of the only shape, a ball with this BSDF.
#[track_caller]
fn material(bsdf: &str) -> Material {
    let scene = read(&format!("<sensor type=\"perspective\"/><shape type=\"sphere\">{bsdf}</shape>"));
    let id = scene.objects[0].material.expect("a material");
    scene.materials[id.0 as usize].clone()
}

/// The folder of third-party scenes, if it is there.
fn assets() -> Option<PathBuf> {
    let folder = std::env::var_os("GONIO_ASSETS").map_or_else(|| PathBuf::from("../shared/assets"), PathBuf::from);
    let found = folder.is_dir();
    if !found {
        println!("SKIPPED: no assets in {}", folder.display());
    }
    found.then_some(folder)
}

#[test]
fn the_readme_lists_exactly_the_plugins_that_are_read() {
    const HEAD: &str = "\n## Mitsuba's plug-ins\n";
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/README.md");
    let written = fs::read_to_string(&path).expect("scenes/README.md");
    let (before, after) = written.split_once(HEAD).expect("a chapter \"Mitsuba's plug-ins\"");
    let (introduction, rest) = after.split_once("\n### ").expect("tables");
    // The chapter ends with the next heading of the first or second level.
    let end = ["\n## ", "\n# "].iter().filter_map(|next| rest.find(next)).min().unwrap_or(rest.len());
    let tables: Vec<String> = gonio::scene::load::mitsuba::plugin_tables()
        .iter()
        .map(|(class, rows)| format!("\n### `{class}`\n\n{rows}"))
        .collect();
    let expected = format!("{before}{HEAD}{introduction}{}{}", tables.concat(), &rest[end..]);
    if std::env::var_os("GONIO_UPDATE").is_some() {
        fs::write(&path, &expected).expect("writable");
        return;
    }
    for (written, expected) in written.lines().zip(expected.lines()) {
        assert_eq!(written, expected, "GONIO_UPDATE=1 cargo test --test mitsuba rewrites the tables");
    }
    assert_eq!(written.lines().count(), expected.lines().count(), "GONIO_UPDATE=1 rewrites the tables");
}
