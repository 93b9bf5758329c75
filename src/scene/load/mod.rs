//! Scene files: one file or folder per format.

mod bounds;
pub mod builtin;
pub mod confine;
mod directional;
pub mod gltf;
pub mod image;
pub mod measured;
mod merl;
mod meter;
pub mod mitsuba;
pub mod obj;
mod panels;
pub mod ply;
mod polygon;
mod range;
pub mod staging;
pub mod stl;
mod stream;
mod text;
mod texture_files;
pub mod toml;
mod vertices;

pub use self::toml::Override;
pub use panels::Panels;

use crate::scene::{Location, Scene, SceneError};
use std::collections::HashSet;
use std::io::Read;
use std::path::{Path, PathBuf};

/// Bytes of a scene on standard input at most: text of a size that nobody writes, so an endless stream ends.
const STDIN_MAX: u64 = 64 << 20;

/// Loads the scene in `path`, its format told by the extension: `.toml`, `.obj`, `.gltf`, `.glb`, `.ply`, `.stl`, `.xml`
/// (Mitsuba); `-` is TOML on standard input, and `NAME:SIZE` may be a built-in scene (`builtin`). What the scene lacks to be
/// a picture (a mesh has no camera) is staged.
pub fn load(path: &Path, overrides: &[Override]) -> Result<Scene, SceneError> {
    load_with(path, overrides, &[])
}

/// As `load`, with values for the parameters of a Mitsuba scene; other formats have none.
pub fn load_with(path: &Path, overrides: &[Override], defines: &[(String, String)]) -> Result<Scene, SceneError> {
    load_format(path, overrides, defines).map(finished)
}

/// The last step of all formats: images hold what they may, and each warning is told once.
fn finished(mut scene: Scene) -> Scene {
    range::keep_ranges(&mut scene);
    let mut told = HashSet::new();
    scene.warnings.retain(|warning| told.insert(warning.clone()));
    scene
}

fn load_format(path: &Path, overrides: &[Override], defines: &[(String, String)]) -> Result<Scene, SceneError> {
    if extension(path) == "xml" {
        let mut scene = mitsuba::load(path, defines)?;
        toml::override_film(&mut scene, overrides)?;
        if !scene.has_camera {
            staging::stage(&mut scene);
        }
        toml::override_settings(&mut scene, overrides)?;
        return Ok(scene);
    }
    if let Some((name, text)) = toml_text(path, defines)? {
        return toml::scene_from_text(&name, text, overrides);
    }
    if let Some(scene) = builtin::load(path) {
        let mut scene = scene?;
        toml::override_film(&mut scene, overrides)?;
        toml::override_settings(&mut scene, overrides)?;
        return Ok(scene);
    }
    let mut scene = load_file(path)?;
    // The stage is built for the size of the picture.
    toml::override_film(&mut scene, overrides)?;
    staging::stage(&mut scene);
    toml::override_settings(&mut scene, overrides)?;
    Ok(scene)
}

/// The name and the text of a TOML scene, which `-` is, too; None for other formats.
fn toml_text(path: &Path, defines: &[(String, String)]) -> Result<Option<(PathBuf, String)>, SceneError> {
    if extension(path) == "xml" {
        return Ok(None);
    }
    if let Some((name, _)) = defines.first() {
        let message = format!("-D {name}: only Mitsuba scenes (.xml) have parameters; --set changes keys of others");
        return Err(SceneError::bad(Location::file(path), message));
    }
    if path == Path::new("-") {
        let name = Path::new("<stdin>");
        let mut bytes = Vec::new();
        let read = std::io::stdin().lock().take(STDIN_MAX + 1).read_to_end(&mut bytes);
        read.map_err(|source| SceneError::Io { location: Location::file(name), source })?;
        if bytes.len() as u64 > STDIN_MAX {
            let message = format!("a scene on standard input has at most {STDIN_MAX} bytes");
            return Err(SceneError::bad(Location::file(name), message));
        }
        return Ok(Some((name.to_owned(), text::utf8(name, bytes)?)));
    }
    if extension(path) != "toml" {
        return Ok(None);
    }
    Ok(Some((path.to_owned(), text::utf8(path, text::read_bytes(path)?)?)))
}

/// Loads what a file of a format that is not ours holds; what is missing is left to `staging`.
fn load_file(path: &Path) -> Result<Scene, SceneError> {
    match extension(path).as_str() {
        "gltf" | "glb" => gltf::load(path),
        "obj" => obj::load(path),
        "ply" => ply::load(path),
        "stl" => stl::load(path),
        _ if confine::is_dir(path) => {
            let message = "it is a folder; a scene is a file: .toml, .obj, .gltf, .glb, .ply, .stl or .xml";
            let source = std::io::Error::new(std::io::ErrorKind::IsADirectory, message);
            Err(SceneError::Io { location: Location::file(path), source })
        }
        found => {
            let found = if found.is_empty() { "no extension".to_owned() } else { format!(".{found}") };
            let message = format!("scene files are .toml, .obj, .gltf, .glb, .ply, .stl or .xml, found {found}");
            Err(SceneError::bad(Location::file(path), message))
        }
    }
}

fn extension(path: &Path) -> String {
    path.extension().map(|extension| extension.to_string_lossy().to_lowercase()).unwrap_or_default()
}
