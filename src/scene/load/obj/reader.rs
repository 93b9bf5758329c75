//! The statements of an OBJ file, gathered into one mesh.

use super::material::Maker;
use super::mtl::{Library, read_library};
use super::statement::{Statement, decode, unquoted};
use crate::scene::load::image::srgb_to_linear;
use crate::scene::load::polygon::Triangulator;
use crate::scene::load::texture_files::{beside, words_or_whole};
use crate::scene::load::vertices::{NONE, Vertices, are_in_order, gather};
use crate::scene::shape::{BY_CREASE, compute_group_normals, repair_normals};
use crate::scene::{Location, Material, MaterialId, Mesh, Rgb, Scene, SceneError};
use glam::{Vec2, Vec3};
use std::collections::HashMap;
use std::path::Path;

/// Edges sharper than this stay sharp where a file has neither normals nor smoothing groups, radians (40 degrees).
const CREASE: f64 = 0.698;

/// Statements that change nothing here.
const WITHOUT_EFFECT: &[&str] = &["bevel", "c_interp", "d_interp", "g", "lod", "mg", "o", "shadow_obj", "trace_obj"];

/// Statements without which a picture misses something.
const UNSUPPORTED: &[&str] = &[
    "bmat", "call", "con", "csh", "cstype", "ctech", "curv", "curv2", "deg", "end", "hole", "l", "maplib", "p", "parm",
    "scrv", "sp", "stech", "step", "surf", "trim", "usemap", "vp",
];

/// Unknown or unsupported statements that a warning names; a file that is no OBJ has more than anyone reads.
const IGNORED_MAX: usize = 8;

/// What has been read so far.
pub struct Reader<'s> {
    file: &'s Path,
    scene: &'s mut Scene,
    positions: Vec<Vec3>,
    /// As written; as long as `positions`, or empty while no vertex had a colour.
    colors: Vec<Vec3>,
    uvs: Vec<Vec2>,
    normals: Vec<Vec3>,
    /// Vertices of the mesh by position, texture coordinate and normal.
    vertices: Vertices<3>,
    triangles: Vec<[u32; 3]>,
    /// Empty before the first `usemtl`.
    face_materials: Vec<MaterialId>,
    /// Smoothing groups by triangle; empty before the first `s`.
    groups: Vec<u32>,
    group: u32,
    library: Library,
    /// Materials in the order of their use, and where; without a name: those of faces that name none.
    used: Vec<(Option<String>, Location)>,
    materials: HashMap<Option<String>, MaterialId>,
    current: Option<MaterialId>,
    ignored: Vec<String>,
    /// The first statement that no OBJ file has.
    unknown: Option<(Location, String)>,
    degenerate: usize,
    triangulator: Triangulator,
    /// Scratch of `read_face`.
    corners: Vec<u32>,
}

impl<'s> Reader<'s> {
    pub fn new(file: &'s Path, scene: &'s mut Scene) -> Self {
        Self {
            file,
            scene,
            positions: Vec::new(),
            colors: Vec::new(),
            uvs: Vec::new(),
            normals: Vec::new(),
            vertices: Vertices::new(),
            triangles: Vec::new(),
            face_materials: Vec::new(),
            groups: Vec::new(),
            group: BY_CREASE,
            library: Library::new(),
            used: Vec::new(),
            materials: HashMap::new(),
            current: None,
            ignored: Vec::new(),
            unknown: None,
            degenerate: 0,
            triangulator: Triangulator::new(),
            corners: Vec::new(),
        }
    }

    pub fn read(&mut self, statement: &Statement) -> Result<(), SceneError> {
        match statement.keyword() {
            b"v" => self.read_vertex(statement),
            b"vt" => self.read_uv(statement),
            b"vn" => {
                self.normals.push(Vec3::from_array(statement.numbers()?));
                self.check_count(statement, self.normals.len())
            }
            b"f" => self.read_face(statement),
            keyword => self.read_seldom(statement, &decode(keyword).to_ascii_lowercase()),
        }
    }

    /// Keywords in any case, of which there are few in a file.
    fn read_seldom(&mut self, statement: &Statement, keyword: &str) -> Result<(), SceneError> {
        match keyword {
            "v" => self.read_vertex(statement)?,
            "vt" => self.read_uv(statement)?,
            "vn" => self.normals.push(Vec3::from_array(statement.numbers()?)),
            "f" | "fo" => self.read_face(statement)?,
            "s" => self.group = smoothing_group(&statement.rest()),
            "usemtl" => self.use_material(statement),
            "mtllib" => self.read_libraries(statement)?,
            _ if WITHOUT_EFFECT.contains(&keyword) => {}
            _ => {
                let name: String = keyword.chars().take(32).flat_map(char::escape_debug).collect();
                if self.unknown.is_none() && !UNSUPPORTED.contains(&keyword) {
                    self.unknown = Some((statement.location_of(statement.keyword()), name.clone()));
                }
                if self.ignored.len() <= IGNORED_MAX && !self.ignored.contains(&name) {
                    self.ignored.push(name);
                }
            }
        }
        Ok(())
    }

    fn check_count(&self, statement: &Statement, count: usize) -> Result<(), SceneError> {
        if count >= NONE as usize {
            return Err(statement.bad("more of these than 32 bits can count"));
        }
        Ok(())
    }

    /// `v x y z [w]` or `v x y z r g b [a]`.
    fn read_vertex(&mut self, statement: &Statement) -> Result<(), SceneError> {
        let mut words = statement.words();
        self.positions.push(Vec3::from_array(statement.take_numbers(&mut words)?));
        let mut is_colored = words;
        let is_colored = is_colored.nth(2).is_some();
        if is_colored || !self.colors.is_empty() {
            // Vertices before the first colour are white.
            self.colors.resize(self.positions.len(), Vec3::ONE);
        }
        if is_colored && let Some(color) = self.colors.last_mut() {
            *color = Vec3::from_array(statement.take_numbers(&mut words)?);
        }
        self.check_count(statement, self.positions.len())
    }

    fn read_uv(&mut self, statement: &Statement) -> Result<(), SceneError> {
        let mut words = statement.words();
        let [u] = statement.take_numbers(&mut words)?;
        let v = words.next().map(|word| statement.number(word)).transpose()?;
        self.uvs.push(Vec2::new(u, v.unwrap_or(0.0)));
        self.check_count(statement, self.uvs.len())
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
        let before = self.triangles.len();
        let position = |vertex| self.positions[self.vertices.position(vertex)];
        self.degenerate += self.triangulator.triangulate(&corners, position, &mut self.triangles);
        self.corners = corners;
        let after = self.triangles.len();
        if let Some(material) = self.current {
            if self.face_materials.len() < before {
                let grey = self.material(None, statement);
                self.face_materials.resize(before, grey);
            }
            self.face_materials.resize(after, material);
        }
        if self.group != BY_CREASE || !self.groups.is_empty() {
            self.groups.resize(before, BY_CREASE);
            self.groups.resize(after, self.group);
        }
        Ok(())
    }

    /// The vertex of the mesh that a corner such as `3/1/-2` stands for.
    #[inline]
    fn read_corner(&mut self, statement: &Statement, word: &[u8]) -> Result<u32, SceneError> {
        let counts = [self.positions.len(), self.uvs.len(), self.normals.len()];
        let mut key = [NONE; 3];
        let mut rest = word;
        for (part, count) in counts.into_iter().enumerate() {
            let text = rest;
            let (index, length) = leading_integer(text);
            key[part] = match index {
                Some(index @ 1..) if index <= count as i64 => (index - 1) as u32,
                // -1 is the latest one.
                Some(index @ ..=-1) if -index <= count as i64 => (count as i64 + index) as u32,
                None if length == 0 && part > 0 => NONE,
                _ => return Err(bad_index(statement, word, text, part, index, count)),
            };
            rest = &rest[length..];
            if rest.is_empty() {
                break;
            }
            if rest[0] != b'/' || part == 2 {
                return Err(bad_index(statement, word, text, part, None, count));
            }
            rest = &rest[1..];
        }
        match self.vertices.find_or_add(key, self.positions.len()) {
            Some(vertex) => Ok(vertex),
            None => Err(statement.bad("more vertices than 32 bits can count")),
        }
    }

    fn read_libraries(&mut self, statement: &Statement) -> Result<(), SceneError> {
        for name in words_or_whole(statement.folder(), &statement.rest()) {
            let path = beside(statement.folder(), unquoted(&name));
            match read_library(&path, &mut self.library, &mut self.scene.warnings) {
                Err(SceneError::Io { source, .. }) => {
                    let message = format!("{}: no materials from {}: {source}", statement.location(), path.display());
                    self.scene.warnings.push(message);
                }
                outcome => outcome?,
            }
        }
        Ok(())
    }

    /// Faces that follow have the material of this name. Without a name the faces have none: Blender and Rhino say so.
    fn use_material(&mut self, statement: &Statement) {
        let name = statement.name();
        let is_named = !name.is_empty() || self.library.contains_key("");
        self.current = Some(self.material(is_named.then_some(name), statement));
    }

    fn material(&mut self, name: Option<String>, statement: &Statement) -> MaterialId {
        if let Some(id) = self.materials.get(&name) {
            return *id;
        }
        let id = MaterialId(self.used.len() as u32);
        self.used.push((name.clone(), statement.location()));
        self.materials.insert(name, id);
        id
    }

    /// The mesh, complete and with usable normals, and its material where the file gave it none. `smooth`: a mesh without
    /// normals gets some.
    pub fn finish(self, smooth: bool) -> Result<(Mesh, Option<MaterialId>), SceneError> {
        if self.triangles.is_empty() {
            // It may be no OBJ file at all.
            return Err(match self.unknown {
                Some((place, name)) => SceneError::bad(place, format!("unknown statement \"{name}\"")),
                None => SceneError::bad(Location::file(self.file), "the file has no triangles"),
            });
        }
        let name = self.file.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
        // Each list goes when what is made of it is there.
        let [at, uv, normal] = self.vertices.into_words();
        let mut mesh = Mesh {
            name,
            colors: if self.colors.is_empty() { Vec::new() } else { gather(&at, self.colors, Vec3::ONE) },
            positions: gather(&at, self.positions, Vec3::ZERO),
            triangles: self.triangles,
            face_materials: self.face_materials,
            ..Mesh::default()
        };
        mesh.uvs = gather(&uv, self.uvs, Vec2::ZERO);
        drop(uv);
        // A zero normal is repaired.
        mesh.normals = gather(&normal, self.normals, Vec3::ZERO);
        drop(normal);
        decode_colors(&mut mesh.colors);
        if !mesh.normals.is_empty() {
            repair_normals(&mut mesh);
        } else if smooth && (self.groups.len() < mesh.triangles.len() || self.groups.iter().any(|group| *group != 0)) {
            // Vertices of different points need no telling which.
            let points = if are_in_order(&at) { Vec::new() } else { at };
            compute_group_normals(&mut mesh, &points, &self.groups, CREASE);
        }
        // Colours of vertices are colours of the surface where no material says another.
        let plain = |name: &str| {
            let grey = Material::grey(name);
            if mesh.colors.is_empty() { grey } else { Material { color: Rgb::ONE, ..grey } }
        };
        let mut maker = Maker::new(self.scene, &mesh);
        for (id, (name, place)) in self.used.into_iter().enumerate() {
            let material = match name {
                None => plain("grey"),
                Some(name) => match self.library.get(&name) {
                    Some(entry) => maker.make(entry, &name, MaterialId(id as u32)),
                    None => {
                        maker.scene.warnings.push(format!("{place}: there is no material {name:?}: it is grey"));
                        plain(&name)
                    }
                },
            };
            maker.scene.materials.push(material);
        }
        let scene = maker.scene;
        let bare = mesh.face_materials.is_empty().then(|| {
            scene.materials.push(plain("grey"));
            MaterialId(scene.materials.len() as u32 - 1)
        });
        let file = self.file.display();
        if let Some(more) = self.ignored.get(..IGNORED_MAX + 1) {
            scene.warnings.push(format!("{file}: ignored: {} and more", more[..IGNORED_MAX].join(", ")));
        } else if !self.ignored.is_empty() {
            scene.warnings.push(format!("{file}: ignored: {}", self.ignored.join(", ")));
        }
        if self.degenerate > 0 {
            let message = format!("{file}: triangles with a repeated corner left out: {}", self.degenerate);
            scene.warnings.push(message);
        }
        Ok((mesh, bare))
    }
}

/// `off` and 0 are no group.
fn smoothing_group(text: &str) -> u32 {
    match text {
        "" | "0" => 0,
        _ if text.eq_ignore_ascii_case("off") => 0,
        _ => text.parse().ok().filter(|group| *group != BY_CREASE).unwrap_or(1),
    }
}

/// The integer that `text` begins with, None if there is none or it is beyond reach; and the length of its sign and digits.
#[inline]
fn leading_integer(text: &[u8]) -> (Option<i64>, usize) {
    let is_negative = text.first() == Some(&b'-');
    let start = usize::from(is_negative || text.first() == Some(&b'+'));
    let (mut value, mut end) = (0i64, start);
    while let Some(digit) = text.get(end).map(|byte| byte.wrapping_sub(b'0')).filter(|digit| *digit < 10) {
        // Large enough to be refused, whatever follows.
        value = (value * 10 + i64::from(digit)).min(1 << 40);
        end += 1;
    }
    let found = end > start;
    (found.then_some(if is_negative { -value } else { value }), end)
}

/// What is wrong with the part of the corner `word` that begins `text`.
#[cold]
fn bad_index(
    statement: &Statement,
    word: &[u8],
    text: &[u8],
    part: usize,
    index: Option<i64>,
    count: usize,
) -> SceneError {
    let kind = ["vertex", "texture coordinate", "normal"][part];
    let written = text.split(|byte| *byte == b'/').next().unwrap_or_default();
    let shown = decode(written);
    let message = match index {
        Some(0) => format!("indices count from 1, found {kind} 0"),
        Some(_) if shown.parse::<i64>().is_ok() => format!("there is no {kind} {shown}: the file has {count} so far"),
        None if text.contains(&b'/') && part == 2 => {
            format!("a corner is v, v/vt, v//vn or v/vt/vn, found {:?}", decode(word))
        }
        _ => format!("expected the index of a {kind}, found {shown:?}"),
    };
    SceneError::bad(statement.location_of(word), message)
}

/// Colours as written become linear. Some programs write 0 to 255.
fn decode_colors(colors: &mut [Vec3]) {
    /// What an encoder may round up.
    const MOST: f32 = 1.5;
    let full = if colors.iter().any(|color| color.max_element() > MOST) { 255.0 } else { 1.0 };
    // Most are the 256 codes of a byte.
    let mut known: HashMap<u32, f32> = HashMap::new();
    let mut linear = |code: f32| {
        let decode = || srgb_to_linear((f64::from(code) / full).clamp(0.0, 1.0)) as f32;
        if known.len() >= 1 << 16 && !known.contains_key(&code.to_bits()) {
            return decode();
        }
        *known.entry(code.to_bits()).or_insert_with(decode)
    };
    for color in colors {
        *color = Vec3::from_array(color.to_array().map(&mut linear));
    }
}
