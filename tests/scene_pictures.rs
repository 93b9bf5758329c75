//! Every scene has its picture in scenes/README.md, and the pictures are small.

use std::path::{Path, PathBuf};

const PICTURES_MAX: u64 = 6_000_000;

fn files(folder: &Path, extensions: &[&str]) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let mut found: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    found.retain(|path| path.extension().is_some_and(|e| extensions.iter().any(|known| e == *known)));
    found.sort();
    found
}

fn stem(path: &Path) -> String {
    path.file_stem().unwrap().to_string_lossy().into_owned()
}

#[test]
fn every_scene_has_a_picture_and_every_picture_a_scene() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let readme = std::fs::read_to_string(root.join("README.md")).unwrap();
    let scenes = ["", "lecture/", "others/"].map(|folder| (folder, files(&root.join(folder), &["toml"])));
    let mut names = Vec::new();
    for (folder, paths) in &scenes {
        for name in paths.iter().map(|path| stem(path)) {
            let link = format!("]({folder}{name}.toml)");
            assert!(readme.contains(&link), "scenes/README.md has no {link}");
            names.push(name);
        }
    }
    let pictures = files(&root.join("images"), &["png", "jpg"]);
    for picture in &pictures {
        let file = picture.file_name().unwrap().to_string_lossy();
        assert!(readme.contains(&format!("](images/{file})")), "scenes/README.md does not show {file}");
        assert!(names.contains(&stem(picture)), "{file} is of no scene");
    }
    assert_eq!(pictures.len(), names.len());
    let bytes: u64 = pictures.iter().map(|picture| picture.metadata().unwrap().len()).sum();
    assert!(bytes < PICTURES_MAX, "{bytes} bytes of pictures");
}
