//! Mitsuba 3's XML scenes.
//!
//! `document` reads the files, `plugin` lists what is known of every plug-in, `object` reads one; the other files give
//! them their meaning. What Mitsuba's documentation says, down to its defaults, is what is meant; where gonio cannot do
//! that, it is an error with a place, or a warning.

mod attribute;
mod bsdf;
mod color;
mod document;
mod emitter;
mod integrator;
mod object;
mod plugin;
mod sensor;
mod serialized;
mod shape;
mod spectrum;
mod texture;
mod transform;
mod upgrade;

use super::staging::bare_scene;
use crate::scene::{MaterialId, MeshId, Rgb, Scene, SceneError};
use document::{Document, Node, hint};
use object::CLASSES;
use std::collections::HashMap;
use std::path::Path;

/// Part of the message about scenes with participating media.
pub const NO_MEDIA: &str = "gonio reads surfaces, not media";

/// What makes one mesh differ from another.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
struct MeshKey {
    /// Or the name of a shape.
    file: String,
    index: u32,
    /// Without vertex normals.
    flat: bool,
    /// Inside out.
    flip: bool,
    /// v counts from the bottom in the file.
    turned: bool,
    /// Its attributes are shown.
    shown: attribute::Shown,
    /// Placed by a transform that mirrors it.
    mirrored: bool,
}

/// A scene on its way.
struct Loader<'a> {
    document: &'a Document,
    scene: Scene,
    textures: texture::Textures,
    /// By element, whether a `twosided` is around it, and the mesh whose attributes it shows.
    materials: HashMap<(Node, bool, Option<MeshId>), MaterialId>,
    meshes: HashMap<MeshKey, MeshId>,
    /// `Mesh::unit` of the meshes placed so far.
    units: HashMap<MeshId, f64>,
    /// Meshes with attributes that materials show as pictures.
    pictured: HashMap<MeshId, attribute::Pictured>,
    /// The one of them whose material is being made.
    showing: Option<MeshId>,
    /// The emitter around the scene.
    environment: Option<Node>,
    integrator: Option<Node>,
}

/// Loads the scene in `path`. `defines`: values of its parameters (`-D name=value`).
pub fn load(path: &Path, defines: &[(String, String)]) -> Result<Scene, SceneError> {
    let document = Document::read(path, defines)?;
    let mut loader = Loader {
        document: &document,
        scene: bare_scene(path),
        textures: texture::Textures::default(),
        materials: HashMap::new(),
        meshes: HashMap::new(),
        units: HashMap::new(),
        pictured: HashMap::new(),
        showing: None,
        environment: None,
        integrator: None,
    };
    // All that is wrong is told at once; what one element lacks no other needs to know.
    let read = |node: &Node| loader.read(*node).err();
    let errors: Vec<SceneError> = document.children(document.root).iter().filter_map(read).collect();
    if !errors.is_empty() {
        return Err(SceneError::all(errors));
    }
    loader.finish()
}

/// The tables of what is read, as scenes/README.md prints them: (element, rows).
pub fn plugin_tables() -> Vec<(&'static str, String)> {
    plugin::tables()
}

impl Loader<'_> {
    /// One element of the scene itself.
    fn read(&mut self, written: Node) -> Result<(), SceneError> {
        let node = self.document.resolve(written)?;
        match self.document.tag(node) {
            "shape" => self.add_shape(node),
            "emitter" => self.add_emitter(node),
            "sensor" if !self.scene.has_camera => sensor::read_sensor(self.document, node, &mut self.scene),
            "sensor" => {
                let location = self.document.location_of(node);
                self.scene.warnings.push(format!("{location}: the first sensor is used, this one is not"));
                Ok(())
            }
            "integrator" => match self.integrator.replace(node) {
                None => integrator::read_integrator(self.document, node, &mut self.scene),
                Some(first) => {
                    let message = format!("a second integrator; the first is at {}", self.document.location_of(first));
                    Err(self.document.bad(node, message))
                }
            },
            // Others refer to them; what nobody refers to is still checked.
            "bsdf" => self.material(node).map(|_| ()),
            "texture" | "spectrum" | "sampler" | "film" | "rfilter" => {
                object::Object::open(self.document, node).map(|_| ())
            }
            tag if CLASSES.contains(&tag) => {
                Err(self.document.bad(node, format!("<{tag}> is not supported: {NO_MEDIA}")))
            }
            tag => {
                let hint = hint(tag, CLASSES.iter().copied());
                let message = format!("<{tag}> has no meaning in a scene, which holds {}{hint}", CLASSES.join(", "));
                Err(self.document.bad(node, message))
            }
        }
    }

    fn finish(self) -> Result<Scene, SceneError> {
        let mut scene = self.scene;
        let glows = scene.materials.iter().any(|material| material.emission != Rgb::ZERO);
        if scene.lights.is_empty() && !glows && !scene.background.shines() {
            scene.warnings.push(format!("{}: the scene has no light: the picture will be black", scene.name));
        }
        Ok(scene)
    }
}
