//! The house's own scene format: TOML (scenes/README.md).
//!
//! `document` holds what was written, `format` lists every key, `reader` reads one; the other files give the values
//! their meaning.

mod color;
mod document;
mod format;
mod keys;
mod light;
mod material;
mod material_format;
mod metal;
mod names;
mod object;
mod overrides;
mod panel;
mod place;
mod reader;
mod settings;
mod shapes;
mod table;
mod texture;
mod write;

pub use color::color_from_text;
pub(super) use keys::LARGEST;
pub use metal::{METALS, Metal};
pub use overrides::Override;
pub(super) use panel::{Layout, panel_from_text};
pub use reader::nearest;
pub use write::{Additions, quoted, staged_text};

use super::staging::bare_scene;
use crate::scene::{Integrator, IntensityUnit, Rgb, Scene, SceneError};
use document::Document;
use format::SCENE;
use reader::Reader;
use settings::{LightSettings, read_background, read_camera, read_film, read_render};
use std::path::Path;

/// The scene that `text` describes; `file` is its name in messages, and its folder is where its paths begin.
pub fn scene_from_text(file: &Path, text: String, overrides: &[Override]) -> Result<Scene, SceneError> {
    let mut document = Document::parse(file, text)?;
    document.apply(overrides)?;
    scene_from_document(&document)
}

fn scene_from_document(document: &Document) -> Result<Scene, SceneError> {
    document.judge(|| read_scene(document))
}

/// The scene with whatever stands where a fault was noted: only for `Document::judge`.
fn read_scene(document: &Document) -> Result<Scene, SceneError> {
    let root = Reader::open(document, &document.root, &SCENE)?;
    let mut scene = bare_scene(&document.file);
    let mut lights = LightSettings { unit: IntensityUnit::Radiometric, ambient: Rgb::ZERO };
    document.attempt(|| read_render(&root, &mut scene.settings, &mut lights));
    document.attempt(|| read_film(&root, &mut scene.film));
    let camera = root.attempt(|| root.required("camera", read_camera(&root, &scene.film, None)?));
    scene.camera = camera.unwrap_or(scene.camera);
    scene.has_camera = true;
    scene.ambient = lights.ambient;
    let mut textures = texture::Textures::default();
    let background = document.attempt(|| read_background(&root, &mut textures));
    scene.background = background.unwrap_or(scene.background);
    let mut tables = table::Tables::default();
    let (materials, names) = material::read_materials(&root, &mut textures, &mut tables, &mut scene.warnings)?;
    (scene.materials, scene.textures, scene.tables) = (materials, textures.list, tables.list);
    scene.warnings.extend(textures.warnings);
    root.attempt(|| object::read_objects(&root, &names, &mut scene));
    scene.lights = light::read_lights(&root, &lights, &mut scene.warnings)?;
    warn_dark(&mut scene);
    Ok(scene)
}

/// Changes what `[film]` says of a scene that came from another format.
pub fn override_film(scene: &mut Scene, overrides: &[Override]) -> Result<(), SceneError> {
    let mut document = Document::empty(Path::new(&scene.name));
    document.apply(overrides)?;
    document.judge(|| read_film(&Reader::open(&document, &document.root, &SCENE)?, &mut scene.film))
}

/// The integrator that the changes ask for.
pub fn asked_integrator(scene: &Scene, overrides: &[Override]) -> Result<Option<Integrator>, SceneError> {
    if !are_set(overrides, "render", "integrator") {
        return Ok(None);
    }
    let mut asked = Scene { objects: Vec::new(), lights: Vec::new(), ..bare_scene(Path::new(&scene.name)) };
    override_settings(&mut asked, overrides)?;
    Ok(Some(asked.settings.integrator))
}

/// Whether a change is of something that only a scene file has tables for.
pub fn concerns_tables(change: &Override) -> bool {
    let first = change.path.first().map_or("", String::as_str);
    ["background", "material", "object", "light"].contains(&first)
}

/// Whether a change gives the scene another background, and does not only turn or scale it.
pub fn replaces_background(change: &Override) -> bool {
    let [first, rest @ ..] = &change.path[..] else { return false };
    first == "background" && !matches!(rest, [key] if key == "scale" || key == "rotate")
}

/// Whether a change sets `key` of the table `section`.
pub fn are_set(overrides: &[Override], section: &str, key: &str) -> bool {
    let sets = |change: &Override| change.path.iter().map(String::as_str).eq([section, key]);
    overrides.iter().any(sets)
}

/// Changes what `[render]`, `[film]` and `[camera]` say of a scene that came from another format.
pub fn override_settings(scene: &mut Scene, overrides: &[Override]) -> Result<(), SceneError> {
    let mut document = Document::empty(Path::new(&scene.name));
    document.apply(overrides)?;
    document.judge(|| override_from_document(&document, scene))
}

fn override_from_document(document: &Document, scene: &mut Scene) -> Result<(), SceneError> {
    let root = Reader::open(document, &document.root, &SCENE)?;
    for key in ["background", "material", "object", "light", "panel"] {
        if root.has(key) {
            let message = format!("{key:?} can only be set in a TOML scene; here render, film and camera can");
            return Err(root.bad(key, message));
        }
    }
    let mut lights = LightSettings { unit: IntensityUnit::Radiometric, ambient: scene.ambient };
    if let Some(unit) = scene.lights.first().map(|light| light.unit) {
        lights.unit = unit;
    }
    read_render(&root, &mut scene.settings, &mut lights)?;
    read_film(&root, &mut scene.film)?;
    if let Some(camera) = read_camera(&root, &scene.film, Some(scene.camera))? {
        scene.camera = camera;
    }
    scene.ambient = lights.ambient;
    for light in &mut scene.lights {
        light.unit = lights.unit;
    }
    Ok(())
}

/// The tables of the format as scenes/README.md prints them: (heading, rows).
pub fn key_tables() -> Vec<(&'static str, String)> {
    format::SECTIONS.iter().map(|section| (section.name, section.markdown())).collect()
}

/// A picture that can only be black deserves a word.
fn warn_dark(scene: &mut Scene) {
    let glows = scene
        .materials
        .iter()
        .any(|material| material.emission != Rgb::ZERO || matches!(material.model, crate::scene::Model::Emissive));
    if scene.lights.is_empty() && scene.ambient == Rgb::ZERO && !glows && !scene.background.shines() {
        scene.warnings.push(format!("{}: the scene has no light: the picture will be black", scene.name));
    }
}
