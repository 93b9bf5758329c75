//! glTF 2.0 (ISO/IEC 12113:2022), as .gltf with files or data URIs beside it, or as .glb.
//!
//! Read are the node hierarchy of the default scene, meshes (nodes that share one share it here), materials, textures,
//! cameras, KHR_lights_punctual, and the extensions in `KNOWN`. Nothing in the file is believed before it is checked
//! against the bytes that are there. Animations and skins are ignored; morph targets have their default weights.

mod accessor;
mod glossy;
mod material;
mod mesh;
mod node;
mod source;
mod texture;

use super::staging;
use super::text::read_bytes;
use crate::memory::Shortage;
use crate::scene::{Location, Material, MaterialId, MeshId, Scene, SceneError};
use accessor::Accessors;
use gltf::json::Root;
use source::Buffers;
use std::collections::{BTreeSet, HashMap};
use std::path::Path;
use texture::Textures;

/// Extensions that are read.
const KNOWN: [&str; 11] = [
    "EXT_mesh_gpu_instancing",
    "EXT_texture_webp",
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_volume",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
];

/// Extensions without which a file still shows what it should, if not as well: ignored even where required.
const DISPENSABLE: [&str; 9] = [
    "KHR_animation_pointer",
    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",
    "KHR_materials_dispersion",
    "KHR_materials_iridescence",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_variants",
    "KHR_xmp_json_ld",
];

/// Of those, what no picture shows: not worth a word.
const UNSEEN: [&str; 4] = ["KHR_animation_pointer", "KHR_materials_variants", "KHR_xmp", "KHR_xmp_json_ld"];

/// Vertices of all meshes together: a file may name one array many times.
const VERTICES_MAX: usize = 1 << 27;

/// Nodes that fail, at most, before reading ends.
const FAILURES_MAX: usize = 32;

/// Loads the file as a scene. `load::load` stages what it has no camera or light for.
pub fn load(path: &Path) -> Result<Scene, SceneError> {
    let bytes = read_bytes(path)?;
    scene_from_bytes(&bytes, path)
}

/// Loads a scene from the bytes of a .gltf or .glb file; `path` is that file, whose neighbours it may refer to.
pub fn scene_from_bytes(bytes: &[u8], path: &Path) -> Result<Scene, SceneError> {
    read(bytes, path).map_err(|failure| failure.at(path))
}

/// What is wrong, and where in the document.
#[derive(Debug)]
enum Failure {
    Bad {
        place: String,
        message: String,
    },
    /// Broken text.
    Json(serde_json::Error),
    /// A file it refers to.
    File {
        place: String,
        error: SceneError,
    },
    /// Of another format.
    Other(Box<SceneError>),
    /// At least one.
    Several(Vec<Failure>),
}

impl Failure {
    fn new(place: impl Into<String>, message: impl Into<String>) -> Self {
        Self::Bad { place: place.into(), message: message.into() }
    }

    fn at(self, path: &Path) -> SceneError {
        match self {
            Self::Bad { place, message } => SceneError::bad(Location::file(path), format!("{place}: {message}")),
            Self::Json(error) => {
                let location =
                    Location { file: path.to_owned(), line: error.line() as u32, column: error.column() as u32 };
                // Its own "at line 1 column 2" would say it twice.
                let message = error.to_string();
                SceneError::bad(location, message.split(" at line ").next().unwrap_or(&message))
            }
            // The file's own error, with where it is named before it.
            Self::File { place, error: SceneError::Io { location, source } } => {
                let source = std::io::Error::new(source.kind(), format!("{place}: {location}: {source}"));
                SceneError::Io { location: Location::file(path), source }
            }
            Self::File { place, error: SceneError::Memory { location, short } } => {
                let what = format!("{place}: {location}: {}", short.what);
                SceneError::Memory { location: Location::file(path), short: Shortage { what, ..short } }
            }
            Self::File { place, error } => SceneError::bad(Location::file(path), format!("{place}: {error}")),
            Self::Other(error) => *error,
            Self::Several(failures) => SceneError::all(failures.into_iter().map(|failure| failure.at(path)).collect()),
        }
    }
}

/// A primitive of a mesh as ours, and its material.
type Part = (MeshId, MaterialId);

/// What is under way.
struct Loader<'a> {
    root: &'a Root,
    buffers: &'a Buffers<'a>,
    textures: Textures<'a>,
    scene: Scene,
    /// Warnings, each once.
    notes: BTreeSet<String>,
    /// Materials by index, and the set of texture coordinates each wants.
    materials: HashMap<Option<usize>, (MaterialId, Option<u32>)>,
    /// Meshes by index and morph weights.
    parts: HashMap<(usize, Vec<u32>), Vec<Part>>,
    /// `Mesh::unit` of the meshes placed so far.
    units: HashMap<MeshId, f64>,
    vertices: usize,
}

fn read(bytes: &[u8], path: &Path) -> Result<Scene, Failure> {
    let (json, binary) = source::split(bytes)?;
    let root = parse(json)?;
    let mut notes = BTreeSet::new();
    check_version(&root.asset.version, root.asset.min_version.as_deref())?;
    check_extensions(&root, &mut notes)?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let buffers = Buffers::read(&root, binary, folder)?;
    let mut loader = Loader {
        root: &root,
        buffers: &buffers,
        textures: Textures::new(&root, &buffers, folder, path),
        scene: staging::bare_scene(path),
        notes,
        materials: HashMap::new(),
        parts: HashMap::new(),
        units: HashMap::new(),
        vertices: 0,
    };
    let nodes = node::flatten(&root)?;
    // All that is wrong is told at once, as far as anybody reads it.
    let failures = nodes.into_iter().filter_map(|(index, world)| loader.add_node(index, world).err());
    let failures: Vec<Failure> = failures.take(FAILURES_MAX).collect();
    if !failures.is_empty() {
        return Err(Failure::Several(failures));
    }
    loader.add_loose_meshes()?;
    if !root.animations.is_empty() {
        loader.notes.insert("animations are ignored".to_owned());
    }
    if loader.scene.objects.is_empty() {
        loader.notes.insert("there is nothing to draw".to_owned());
    }
    Ok(loader.finish())
}

/// The document. What is ignored anyway may be of a form the `gltf` crate does not know (KHR_animation_pointer has channels
/// without nodes): then it is left out.
fn parse(json: &[u8]) -> Result<Root, Failure> {
    let first = match gltf::json::deserialize::from_slice(json) {
        Ok(root) => return Ok(root),
        Err(error) => error,
    };
    let mut document: serde_json::Value = serde_json::from_slice(json).map_err(Failure::Json)?;
    // Version 1 was another format: what the `gltf` crate misses in it says nothing.
    if let Some(version) = document.pointer("/asset/version").and_then(|version| version.as_str()) {
        check_version(version, None)?;
    }
    if let Some(animations) = document.get_mut("animations").and_then(|a| a.as_array_mut()) {
        animations.clear();
    }
    serde_json::from_value(document).map_err(|_| Failure::Json(first))
}

fn check_version(version: &str, least: Option<&str>) -> Result<(), Failure> {
    let is_known = least.map_or(version.starts_with("2."), |least| least == "2.0");
    let version = least.unwrap_or(version);
    if is_known {
        return Ok(());
    }
    Err(Failure::new("asset", format!("version {}; only 2.0 is known", version.escape_debug())))
}

fn check_extensions(root: &Root, notes: &mut BTreeSet<String>) -> Result<(), Failure> {
    let known = |name: &&String| KNOWN.contains(&name.as_str());
    let dispensable = |name: &&String| DISPENSABLE.contains(&name.as_str());
    let missing: Vec<String> = root
        .extensions_required
        .iter()
        .filter(|name| !known(name) && !dispensable(name))
        .map(|name| name.escape_debug().to_string())
        .collect();
    if !missing.is_empty() {
        return Err(Failure::new("extensionsRequired", format!("not supported: {}", missing.join(", "))));
    }
    let unseen = |name: &&String| UNSEEN.contains(&name.as_str());
    let ignored = root.extensions_used.iter().filter(|name| !known(name) && !unseen(name));
    let ignored: Vec<String> = ignored.map(|name| name.escape_debug().to_string()).collect();
    if !ignored.is_empty() {
        notes.insert(format!("extensions that are ignored: {}", ignored.join(", ")));
    }
    Ok(())
}

impl Loader<'_> {
    /// The parts of mesh `index`, read on first use; `weights` override the mesh's own. `user` refers to it.
    fn mesh_parts(&mut self, index: usize, weights: Option<&[f32]>, user: &str) -> Result<Vec<Part>, Failure> {
        let root = self.root;
        let Some(mesh) = root.meshes.get(index) else {
            let message = format!("refers to mesh {index}; there are {}", root.meshes.len());
            return Err(Failure::new(user, message));
        };
        let weights = weights.or(mesh.weights.as_deref()).unwrap_or(&[]);
        let key = (index, weights.iter().map(|w| w.to_bits()).collect::<Vec<u32>>());
        if let Some(parts) = self.parts.get(&key) {
            return Ok(parts.clone());
        }
        let mut parts = Vec::new();
        for (i, primitive) in mesh.primitives.iter().enumerate() {
            let place = format!("meshes[{index}].primitives[{i}]");
            let (material, set) = self.material(primitive.material.map(|m| m.value()), &place)?;
            let accessors = Accessors { root, buffers: self.buffers };
            let read = mesh::read(&accessors, primitive, &place, weights, set, &mut self.notes)?;
            let Some(mut read) = read else { continue };
            self.vertices += read.positions.len() + read.triangles.len();
            if self.vertices > VERTICES_MAX {
                return Err(Failure::new(place, format!("more than {VERTICES_MAX} vertices and triangles in all")));
            }
            read.name = mesh.name.clone().unwrap_or_else(|| format!("meshes[{index}]"));
            self.scene.meshes.push(read);
            parts.push((MeshId(self.scene.meshes.len() as u32 - 1), material));
        }
        self.parts.insert(key, parts.clone());
        Ok(parts)
    }

    /// Material `index`, or the default one.
    fn material(&mut self, index: Option<usize>, user: &str) -> Result<(MaterialId, Option<u32>), Failure> {
        if let Some(made) = self.materials.get(&index) {
            return Ok(*made);
        }
        let (material, set) = match index {
            None => (Material::grey("default"), None),
            Some(i) => {
                let Some(source) = self.root.materials.get(i) else {
                    let message = format!("refers to material {i}; there are {}", self.root.materials.len());
                    return Err(Failure::new(user, message));
                };
                let converted = material::convert(source, i, &mut self.textures, &mut self.scene, &mut self.notes)?;
                (converted.material, converted.set)
            }
        };
        self.scene.materials.push(material);
        let made = (MaterialId(self.scene.materials.len() as u32 - 1), set);
        self.materials.insert(index, made);
        Ok(made)
    }

    /// A file without scenes and nodes is a library; its meshes are shown as they are.
    fn add_loose_meshes(&mut self) -> Result<(), Failure> {
        if !self.root.scenes.is_empty() || !self.root.nodes.is_empty() || self.root.meshes.is_empty() {
            return Ok(());
        }
        self.notes.insert("there is no scene: all meshes are drawn as they are".to_owned());
        for index in 0..self.root.meshes.len() {
            let parts = self.mesh_parts(index, None, "meshes")?;
            let place = format!("meshes[{index}]");
            self.add_objects(&parts, &place, &place, glam::DAffine3::IDENTITY)?;
        }
        Ok(())
    }

    fn finish(self) -> Scene {
        let mut scene = self.scene;
        scene.warnings.extend(self.textures.warnings);
        scene.warnings.extend(self.notes);
        scene
    }
}
