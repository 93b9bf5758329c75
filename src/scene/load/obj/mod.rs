//! Wavefront OBJ: polygons with texture coordinates, normals, vertex colours and the materials of MTL files.
//!
//! Source: Alias|Wavefront, Advanced Visualizer manual, appendix B "Object files (.obj)", 1995. Free-form curves and
//! surfaces, points and lines are skipped with a warning; groups and objects become one mesh, for one BVH.

mod mtl;
mod statement;

use super::polygon::triangulate;
use super::staging::bare_scene;
use super::text::read_bytes;
use super::texture_files::{TextureFiles, intern};
use crate::scene::shape::{compute_smooth_normals, repair_normals};
use crate::scene::{
    Geometry, Location, Material, MaterialId, Mesh, MeshId, Object, Scene, SceneError, TextureBinding, Transform,
};
use glam::{Vec2, Vec3};
use statement::{Statement, statements};
use std::collections::HashMap;
use std::path::Path;

/// Edges sharper than this stay sharp where a file has no normals, radians (40 degrees).
const CREASE: f64 = 0.698;

/// "None" among indices.
const NONE: u32 = u32::MAX;

/// Statements that do nothing here, and whether a picture misses something without them.
const SKIPPED: &[(&str, bool)] = &[
    ("bevel", false),
    ("c_interp", false),
    ("d_interp", false),
    ("g", false),
    ("lod", false),
    ("mg", false),
    ("o", false),
    ("shadow_obj", false),
    ("trace_obj", false),
    ("bmat", true),
    ("call", true),
    ("con", true),
    ("csh", true),
    ("cstype", true),
    ("ctech", true),
    ("curv", true),
    ("curv2", true),
    ("deg", true),
    ("end", true),
    ("hole", true),
    ("l", true),
    ("maplib", true),
    ("p", true),
    ("parm", true),
    ("scrv", true),
    ("sp", true),
    ("stech", true),
    ("step", true),
    ("surf", true),
    ("trim", true),
    ("usemap", true),
    ("vp", true),
];

/// Loads the file as a scene of one mesh. `load::load` stages it.
pub fn load(path: &Path) -> Result<Scene, SceneError> {
    let mut scene = bare_scene(path);
    let bytes = read_bytes(path)?;
    let text = String::from_utf8_lossy(&bytes);
    let mut reader = Reader::new(path, &mut scene);
    for statement in statements(path, &text) {
        reader.read(&statement)?;
    }
    let (mesh, material) = reader.finish()?;
    scene.objects.push(Object {
        name: mesh.name.clone(),
        geometry: Geometry::Mesh(MeshId(0)),
        transform: Transform::default(),
        material,
        casts_shadow: None,
        shading: None,
    });
    scene.meshes.push(mesh);
    Ok(scene)
}

/// Reads the mesh in the file `path` and no materials; without normals if it has none.
pub fn read_mesh(path: &Path) -> Result<Mesh, SceneError> {
    let mut scene = bare_scene(path);
    let bytes = read_bytes(path)?;
    let text = String::from_utf8_lossy(&bytes);
    let mut reader = Reader::new(path, &mut scene);
    for statement in statements(path, &text) {
        if !matches!(statement.keyword(), "mtllib" | "usemtl") {
            reader.read(&statement)?;
        }
    }
    reader.smooth = false;
    reader.finish().map(|(mesh, _)| mesh)
}

/// What has been read so far.
struct Reader<'s> {
    file: &'s Path,
    scene: &'s mut Scene,
    positions: Vec<Vec3>,
    /// As long as `positions`, or empty while no vertex had a colour.
    colors: Vec<Vec3>,
    uvs: Vec<Vec2>,
    normals: Vec<Vec3>,
    mesh: Mesh,
    /// Vertices of `mesh` by position, texture coordinate and normal.
    vertices: HashMap<[u32; 3], u32>,
    library: HashMap<String, mtl::Entry>,
    files: TextureFiles,
    /// Materials of the scene by the name that `usemtl` said.
    materials: HashMap<String, MaterialId>,
    current: Option<MaterialId>,
    /// Some face asks for smoothing, or did not say that it wants none.
    smooth: bool,
    smoothing: bool,
    skipped: Vec<&'static str>,
    degenerate: usize,
    /// Scratch of `read_face`.
    corners: Vec<u32>,
}

impl<'s> Reader<'s> {
    fn new(file: &'s Path, scene: &'s mut Scene) -> Self {
        let name = file.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
        Self {
            file,
            scene,
            positions: Vec::new(),
            colors: Vec::new(),
            uvs: Vec::new(),
            normals: Vec::new(),
            mesh: Mesh { name, ..Mesh::default() },
            vertices: HashMap::new(),
            library: HashMap::new(),
            files: TextureFiles::default(),
            materials: HashMap::new(),
            current: None,
            smooth: false,
            smoothing: true,
            skipped: Vec::new(),
            degenerate: 0,
            corners: Vec::new(),
        }
    }

    fn read(&mut self, statement: &Statement) -> Result<(), SceneError> {
        match statement.keyword() {
            "v" => self.read_vertex(statement)?,
            "vt" => {
                let u = statement.numbers::<1>()?[0];
                let v = statement.words().nth(1).map(|word| statement.number(word)).transpose()?;
                self.uvs.push(Vec2::new(u, v.unwrap_or(0.0)));
            }
            "vn" => self.normals.push(Vec3::from_array(statement.numbers()?)),
            "f" | "fo" => self.read_face(statement)?,
            "s" => self.smoothing = !matches!(statement.rest(), "off" | "0"),
            "usemtl" => self.current = Some(self.use_material(statement)?),
            "mtllib" => self.read_libraries(statement)?,
            keyword => match SKIPPED.iter().find(|(name, _)| *name == keyword) {
                Some((name, true)) if !self.skipped.contains(name) => self.skipped.push(name),
                Some(_) => {}
                None => return Err(statement.bad(format!("unknown statement {keyword:?}"))),
            },
        }
        Ok(())
    }

    /// `v x y z [w]` or `v x y z r g b [a]`; the colour is linear.
    fn read_vertex(&mut self, statement: &Statement) -> Result<(), SceneError> {
        self.positions.push(Vec3::from_array(statement.numbers()?));
        if self.positions.len() >= NONE as usize {
            return Err(statement.bad("more vertices than 32 bits can count"));
        }
        let colored = statement.words().nth(5).is_some();
        if colored || !self.colors.is_empty() {
            // Vertices before the first colour are white.
            self.colors.resize(self.positions.len(), Vec3::ONE);
        }
        if colored && let Some(color) = self.colors.last_mut() {
            let [_, _, _, r, g, b] = statement.numbers()?;
            *color = Vec3::new(r, g, b).clamp(Vec3::ZERO, Vec3::ONE);
        }
        Ok(())
    }

    /// `f v v v ...`, each corner `v`, `v/vt`, `v//vn` or `v/vt/vn`.
    fn read_face(&mut self, statement: &Statement) -> Result<(), SceneError> {
        let mut corners = std::mem::take(&mut self.corners);
        corners.clear();
        for word in statement.words() {
            corners.push(self.read_corner(statement, word)?);
        }
        if corners.len() < 3 {
            return Err(statement.bad(format!("a face needs 3 corners, found {}", corners.len())));
        }
        let before = self.mesh.triangles.len();
        triangulate(&corners, &self.mesh.positions, &mut self.mesh.triangles);
        let mut kept = before;
        for index in before..self.mesh.triangles.len() {
            let [a, b, c] = self.mesh.triangles[index];
            if a != b && b != c && c != a {
                self.mesh.triangles[kept] = [a, b, c];
                kept += 1;
            }
        }
        self.degenerate += self.mesh.triangles.len() - kept;
        self.mesh.triangles.truncate(kept);
        if let Some(material) = self.current {
            if self.mesh.face_materials.len() < before {
                // Faces before the first `usemtl` have the house's grey.
                let grey = self.add_material(Material::grey("grey"));
                self.mesh.face_materials.resize(before, grey);
            }
            self.mesh.face_materials.resize(kept, material);
        }
        self.smooth |= self.smoothing;
        self.corners = corners;
        Ok(())
    }

    /// The vertex of the mesh that a corner such as `3/1/-2` stands for.
    fn read_corner(&mut self, statement: &Statement, word: &str) -> Result<u32, SceneError> {
        let bad = |message: String| SceneError::bad(statement.location_of(word), message);
        let mut key = [NONE; 3];
        let counts = [self.positions.len(), self.uvs.len(), self.normals.len()];
        for (part, text) in word.split('/').enumerate() {
            if part > 2 {
                return Err(bad(format!("a corner is v, v/vt, v//vn or v/vt/vn, found {word:?}")));
            }
            if text.is_empty() && part > 0 {
                continue;
            }
            let kind = ["vertex", "texture coordinate", "normal"][part];
            let index: i64 =
                text.parse().map_err(|_| bad(format!("expected the index of a {kind}, found {text:?}")))?;
            let count = counts[part] as i64;
            key[part] = match index {
                1.. if index <= count => (index - 1) as u32,
                // -1 is the latest one.
                ..=-1 if index >= -count => (count + index) as u32,
                0 => return Err(bad(format!("indices count from 1, found {kind} 0"))),
                _ => return Err(bad(format!("there is no {kind} {index}: the file has {count} so far"))),
            };
        }
        if let Some(vertex) = self.vertices.get(&key) {
            return Ok(*vertex);
        }
        let vertex = self.mesh.positions.len() as u32;
        if vertex == NONE {
            return Err(statement.bad("more vertices than 32 bits can count"));
        }
        self.mesh.positions.push(self.positions[key[0] as usize]);
        self.vertices.insert(key, vertex);
        add(&mut self.mesh.uvs, vertex, key[1], &self.uvs, Vec2::ZERO);
        // A zero normal is repaired at the end.
        add(&mut self.mesh.normals, vertex, key[2], &self.normals, Vec3::ZERO);
        let color = if self.colors.is_empty() { NONE } else { key[0] };
        add(&mut self.mesh.colors, vertex, color, &self.colors, Vec3::ONE);
        Ok(vertex)
    }

    fn read_libraries(&mut self, statement: &Statement) -> Result<(), SceneError> {
        let folder = statement.folder();
        let whole = statement.rest();
        // Several files, or one whose name has spaces.
        let names = if folder.join(whole).is_file() { vec![whole] } else { statement.words().collect() };
        for name in names {
            let path = folder.join(name.replace('\\', "/"));
            match mtl::read_library(&path, &mut self.library, &mut self.scene.warnings) {
                Err(SceneError::Io { source, .. }) => {
                    let message = format!("{}: no materials from {}: {source}", statement.location(), path.display());
                    self.scene.warnings.push(message);
                }
                outcome => outcome?,
            }
        }
        Ok(())
    }

    fn use_material(&mut self, statement: &Statement) -> Result<MaterialId, SceneError> {
        let name = statement.rest();
        if name.is_empty() {
            return Err(statement.bad("\"usemtl\" needs a name"));
        }
        if let Some(id) = self.materials.get(name) {
            return Ok(*id);
        }
        let (mut material, texture) = match self.library.get(name) {
            Some(entry) => entry.material(name, &mut self.files, &mut self.scene.warnings),
            None => {
                let message = format!("{}: there is no material {name:?}: it is grey", statement.location());
                self.scene.warnings.push(message);
                (Material::grey(name), None)
            }
        };
        material.textures = texture
            .map(|texture| TextureBinding::color(intern(&mut self.scene.textures, texture)))
            .into_iter()
            .collect();
        let id = self.add_material(material);
        self.materials.insert(name.to_owned(), id);
        Ok(id)
    }

    fn add_material(&mut self, material: Material) -> MaterialId {
        self.scene.materials.push(material);
        MaterialId(self.scene.materials.len() as u32 - 1)
    }

    /// The mesh, complete and with usable normals, and its material where the file gave it none.
    fn finish(mut self) -> Result<(Mesh, Option<MaterialId>), SceneError> {
        if self.mesh.triangles.is_empty() {
            return Err(SceneError::bad(Location::file(self.file), "the file has no triangles"));
        }
        let count = self.mesh.positions.len();
        pad(&mut self.mesh.uvs, count, Vec2::ZERO);
        pad(&mut self.mesh.normals, count, Vec3::ZERO);
        pad(&mut self.mesh.colors, count, Vec3::ONE);
        let bare = self.mesh.face_materials.is_empty();
        let material = bare.then(|| self.add_material(Material::grey("grey")));
        if !self.mesh.normals.is_empty() {
            repair_normals(&mut self.mesh);
        } else if self.smooth {
            compute_smooth_normals(&mut self.mesh, CREASE);
        }
        let file = self.file.display();
        if !self.skipped.is_empty() {
            self.scene.warnings.push(format!("{file}: ignored: {}", self.skipped.join(", ")));
        }
        if self.degenerate > 0 {
            let message = format!("{file}: triangles with a repeated corner left out: {}", self.degenerate);
            self.scene.warnings.push(message);
        }
        Ok((self.mesh, material))
    }
}

/// Gives `vertex`, the newest, its attribute; `list` stays empty until a vertex has one.
fn add<T: Copy>(list: &mut Vec<T>, vertex: u32, index: u32, source: &[T], default: T) {
    if index != NONE {
        list.resize(vertex as usize, default);
        list.push(source[index as usize]);
    }
}

/// Fills up an attribute that the latest vertices lack; one that no vertex has stays empty.
fn pad<T: Copy>(list: &mut Vec<T>, count: usize, default: T) {
    if !list.is_empty() {
        list.resize(count, default);
    }
}
