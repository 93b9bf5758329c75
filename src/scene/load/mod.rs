//! Scene files: one file or folder per format.

mod bounds;
pub mod builtin;
pub mod confine;
pub mod controls;
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
mod reflectance;
pub mod staging;
pub mod stl;
mod stream;
pub mod surroundings;
mod text;
mod texture_files;
pub mod toml;
mod vertices;

pub use self::toml::Override;
pub use controls::Controls;
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
    load_format(path, overrides, defines, &Controls::default()).map(finished)
}

/// The last step of all formats: images hold what they may, and each warning is told once.
fn finished(mut scene: Scene) -> Scene {
    range::keep_ranges(&mut scene);
    let mut told = HashSet::new();
    scene.warnings.retain(|warning| told.insert(warning.clone()));
    scene
}

/// `defines`: values for the parameters of a Mitsuba scene; other formats have none.
fn load_format(
    path: &Path,
    overrides: &[Override],
    defines: &[(String, String)],
    controls: &Controls,
) -> Result<Scene, SceneError> {
    if let Some((name, text)) = toml_text(path, defines)? {
        let (text, overrides) = controls.written_into(text, overrides);
        let mut scene = toml::scene_from_text(&name, text, &overrides)?;
        controls.adjust(&mut scene)?;
        return Ok(scene);
    }
    let built_in = if extension(path) == "xml" { Some(mitsuba::load(path, defines)) } else { builtin::load(path) };
    let Some(scene) = built_in else { return load_staged(path, overrides, controls) };
    controls.refuse_tables(path)?;
    let mut scene = scene?;
    toml::override_film(&mut scene, overrides)?;
    if !scene.has_camera {
        let integrator = Some(scene.settings.integrator);
        staging::stage(&mut scene, &Controls { integrator, ..Controls::default() })?;
    }
    controls.adjust(&mut scene)?;
    toml::override_settings(&mut scene, overrides)?;
    Ok(scene)
}

/// A scene of a format that says little of pictures.
fn load_staged(path: &Path, overrides: &[Override], controls: &Controls) -> Result<Scene, SceneError> {
    let scene = staged(path, overrides, controls)?;
    let has_tables = !controls.lights.is_empty() || !controls.materials.is_empty();
    if !has_tables && !overrides.iter().any(toml::concerns_tables) {
        return Ok(scene);
    }
    // What the stage made is changed as what a file says: the file is read once more, around its model.
    let file = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let text = staged_text(&scene, &file, overrides, controls);
    let Scene { metered, notes, .. } = scene;
    Ok(Scene { metered, notes, ..toml::scene_from_text(path, text, overrides)? })
}

/// What `path` holds with the stage that `controls` ask for, without the other changes.
fn staged(path: &Path, overrides: &[Override], controls: &Controls) -> Result<Scene, SceneError> {
    let overrides: Vec<Override> = overrides.iter().filter(|change| !toml::concerns_tables(change)).cloned().collect();
    let mut scene = load_file(path)?;
    staging::prepare(&mut scene);
    controls.check_materials(&scene)?;
    controls.raise(&mut scene);
    controls.choose_camera(&mut scene)?;
    if let (None, [first, _, ..]) = (&controls.camera, &scene.cameras[..]) {
        let (count, name) = (scene.cameras.len(), &first.name);
        let note = format!("{}: the first of {count} cameras ({name:?}) is used; --camera takes another", scene.name);
        scene.notes.push(note);
    }
    // The stage is built for the size of the picture and for the integrator.
    toml::override_film(&mut scene, &overrides)?;
    scene.metered &= !toml::are_set(&overrides, "film", "exposure");
    let integrator = controls.integrator.or(toml::asked_integrator(&scene, &overrides)?);
    staging::stage(&mut scene, &Controls { integrator, ..controls.clone() })?;
    toml::override_settings(&mut scene, &overrides)?;
    Ok(scene)
}

/// The stage as a scene file around `file`.
fn staged_text(scene: &Scene, file: &str, overrides: &[Override], controls: &Controls) -> String {
    let additions = toml::Additions {
        file,
        z_up: controls.z_up,
        lights: &controls.lights,
        materials: &controls.materials,
        without_background: overrides.iter().any(toml::replaces_background),
    };
    toml::staged_text(scene, &additions)
}

/// A scene file that shows the picture of the model in `path`, which it names `file`, and the scene itself; `exposed` measures the
/// film's exposure. The format of `path` is one that is staged.
pub fn convert<E: From<SceneError>>(
    path: &Path,
    file: &str,
    overrides: &[Override],
    controls: &Controls,
    exposed: impl FnOnce(&mut Scene) -> Result<(), E>,
) -> Result<(String, Scene), E> {
    if extension(path) == "xml" || extension(path) == "toml" || builtin::load(path).is_some() {
        let message = "only OBJ, PLY, STL, glTF and GLB are converted";
        return Err(SceneError::bad(Location::file(path), message).into());
    }
    if let Some(change) = overrides.iter().find(|change| toml::concerns_tables(change)) {
        let message = format!("--set {change}: change the scene file that is written");
        return Err(SceneError::bad(Location::file(path), message).into());
    }
    let mut scene = staged(path, overrides, controls)?;
    exposed(&mut scene)?;
    Ok((staged_text(&scene, file, overrides, controls), scene))
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
