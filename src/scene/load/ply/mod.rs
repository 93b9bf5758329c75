//! PLY (Turk 1994): triangle and polygon meshes, in text or binary of either byte order.
//!
//! Read are positions, normals, colours and texture coordinates of the element `vertex`, the index lists of `face` and
//! `tristrips`, colours of faces where vertices have none, and what MeshLab adds: texture coordinates of corners
//! (`texcoord`) and pictures (`comment TextureFile`). What else there is is named in a warning. Colours count as
//! sRGB-encoded if integer and as linear if floating.

mod attribute;
mod face;
mod header;
mod numbers;
mod vertex;

use super::image::ColorSpace;
use super::staging::bare_scene;
use super::stream::{Stream, failed};
use super::texture_files::{TextureFiles, beside, intern};
use crate::scene::{
    Geometry, Location, Material, MaterialId, Mesh, MeshId, Object, Rgb, Scene, SceneError, TextureBinding, Transform,
    shape,
};
pub use attribute::Attribute;
use face::Faces;
use header::{Element, Encoding, Header};
use numbers::{Reader, Values};
use std::io;
use std::path::Path;

/// Where in a file something is wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Place {
    Line(u32),
    Byte(u64),
}

/// What is wrong.
#[derive(Debug)]
enum Failure {
    /// In the element that is being read.
    Here(String),
    At(Place, String),
    Read(io::Error),
}

impl Failure {
    fn here(message: impl Into<String>) -> Self {
        Self::Here(message.into())
    }

    fn at(place: Place, message: impl Into<String>) -> Self {
        Self::At(place, message.into())
    }

    /// As the error of the file `name`.
    fn of(self, name: &Path) -> SceneError {
        let mut location = Location::file(name);
        match self {
            Self::Here(message) => SceneError::bad(location, message),
            Self::At(Place::Line(line), message) => {
                location.line = line;
                SceneError::bad(location, message)
            }
            Self::At(Place::Byte(at), message) => SceneError::bad(location, format!("byte {at}: {message}")),
            Self::Read(error) => failed(name, error),
        }
    }
}

impl From<io::Error> for Failure {
    fn from(error: io::Error) -> Self {
        Self::Read(error)
    }
}

/// Edges sharper than this stay sharp where a file has no normals, radians (40 degrees).
const CREASE: f64 = 0.698;

/// Loads the file as a scene: the mesh, smooth where it has no normals of its own, in the house's grey, its own colours or its
/// picture. `load::load` stages it.
pub fn load(path: &Path) -> Result<Scene, SceneError> {
    let read = read(path, &|| Stream::open(path), Wanted { corners: true, attributes: false })?;
    let mut scene = bare_scene(path);
    scene.warnings = read.warnings(path);
    let mut mesh = read.mesh;
    if mesh.normals.is_empty() {
        shape::compute_group_normals(&mut mesh, &read.origins, &[], CREASE);
    }
    add_materials(&read.textures, &read.numbers, path, &mut mesh, &mut scene);
    scene.objects.push(Object {
        name: mesh.name.clone(),
        geometry: Geometry::Mesh(MeshId(0)),
        transform: Transform::default(),
        material: mesh.face_materials.is_empty().then_some(MaterialId(0)),
        casts_shadow: None,
        shading: None,
    });
    scene.meshes.push(mesh);
    Ok(scene)
}

/// One material for each picture, or one in grey; the last of several is for faces that have no picture.
fn add_materials(pictures: &[String], numbers: &[u32], path: &Path, mesh: &mut Mesh, scene: &mut Scene) {
    let grey = Material::grey("ply");
    let white = Material { color: Rgb::ONE, ..grey.clone() };
    let plain = if mesh.colors.is_empty() { grey } else { white.clone() };
    let shown = match (mesh.uvs.is_empty(), numbers.is_empty()) {
        (true, _) => &[],
        (false, true) => &pictures[..pictures.len().min(1)],
        (false, false) => pictures,
    };
    if shown.len() < pictures.len() {
        let message = format!("{}: ignored: TextureFile {}", path.display(), pictures[shown.len()..].join(", "));
        scene.warnings.push(message);
    }
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut files = TextureFiles::default();
    for picture in shown {
        let mut material = plain.clone();
        match files.load(&beside(folder, picture), ColorSpace::Srgb) {
            Ok(texture) => {
                let texture = intern(&mut scene.textures, texture);
                material = Material { textures: vec![TextureBinding::color(texture)], ..white.clone() };
            }
            Err(error) => scene.warnings.push(format!("{}: no texture: {error}", path.display())),
        }
        scene.materials.push(material);
    }
    if !numbers.is_empty() {
        let material = |number: u32| MaterialId(number.min(shown.len() as u32));
        mesh.face_materials = numbers.iter().map(|number| material(*number)).collect();
        mesh.face_materials.resize(mesh.triangles.len(), MaterialId(shown.len() as u32));
    }
    if shown.is_empty() || !numbers.is_empty() {
        scene.materials.push(plain);
    }
}

/// Reads the mesh in the file `path`, without normals if it has none.
pub fn read_mesh(path: &Path) -> Result<Mesh, SceneError> {
    Ok(read(path, &|| Stream::open(path), Wanted::default())?.mesh)
}

/// Reads the mesh in the file `path` with the attributes of its vertices and triangles.
pub fn read_mesh_with_attributes(path: &Path) -> Result<(Mesh, Vec<Attribute>), SceneError> {
    let read = read(path, &|| Stream::open(path), Wanted { attributes: true, corners: false })?;
    Ok((read.mesh, read.attributes))
}

/// Reads a mesh from the bytes of a PLY file; `name` is that file, for messages.
pub fn mesh_from_bytes(bytes: &[u8], name: &Path) -> Result<Mesh, SceneError> {
    Ok(read(name, &|| Ok(Stream::of(bytes)), Wanted { corners: true, attributes: false })?.mesh)
}

/// What is wanted of a file beside its triangles.
#[derive(Clone, Copy, Debug, Default)]
struct Wanted {
    /// What belongs to corners and faces, for which vertices are doubled.
    corners: bool,
    /// Properties under names.
    attributes: bool,
}

/// All there is in a file.
#[derive(Debug, Default)]
struct Read {
    mesh: Mesh,
    attributes: Vec<Attribute>,
    /// The vertex of the file that each vertex was; empty where they are those of the file.
    origins: Vec<u32>,
    /// Vertices of the file.
    vertices: usize,
    textures: Vec<String>,
    /// The picture of each triangle, by its number.
    numbers: Vec<u32>,
    degenerate: usize,
    unused: Vec<String>,
    has_wedges: bool,
}

impl Read {
    fn warnings(&self, path: &Path) -> Vec<String> {
        let mut found = Vec::new();
        let mut say = |message: String| found.push(format!("{}: {message}", path.display()));
        if !self.unused.is_empty() {
            say(format!("ignored: {}", self.unused.join(", ")));
        }
        if self.has_wedges {
            let more = self.origins.len().saturating_sub(self.vertices);
            say(format!("texture coordinates are those of corners (texcoord): vertices doubled for them: {more}"));
        }
        if self.degenerate > 0 {
            say(format!("faces with fewer than three different corners left out: {}", self.degenerate));
        }
        found
    }
}

/// Elements that a pass over the file takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Pass {
    All,
    Vertices,
    Faces,
}

/// Reads the file `name` that `open` opens.
fn read<'a>(
    name: &Path,
    open: &dyn Fn() -> Result<Stream<'a>, SceneError>,
    wanted: Wanted,
) -> Result<Read, SceneError> {
    let mut stream = open()?;
    let mut header = header::parse(&mut stream).map_err(|failure| failure.of(name))?;
    let end_of_header = Place::Line(header.lines);
    let fail = |message: &str| Failure::at(end_of_header, message).of(name);
    let mut found = Read { textures: std::mem::take(&mut header.textures), ..Read::default() };
    header.textures = found.textures.clone();
    let mut faces = Faces::new();
    if header.faces_come_first() {
        // Polygons are cut when their corners are known.
        if stream.remaining().is_none() {
            return Err(fail("faces before vertices are read from a file only, not from a pipe"));
        }
        read_pass(Pass::Vertices, &header, stream, wanted, &mut faces, &mut found).map_err(|f| f.of(name))?;
        let mut again = open()?;
        header::parse(&mut again).map_err(|failure| failure.of(name))?;
        read_pass(Pass::Faces, &header, again, wanted, &mut faces, &mut found).map_err(|f| f.of(name))?;
    } else {
        read_pass(Pass::All, &header, stream, wanted, &mut faces, &mut found).map_err(|f| f.of(name))?;
    }
    found.degenerate = faces.degenerate;
    if found.mesh.triangles.is_empty() {
        return Err(match found.degenerate {
            0 => fail("the file has no faces to draw"),
            count => fail(&format!("the file has no faces to draw, only {count} without three different corners")),
        });
    }
    found.vertices = found.mesh.positions.len();
    found.numbers = std::mem::take(&mut faces.numbers);
    found.origins = faces.finish(&mut found.mesh);
    found.has_wedges = wanted.corners && header.has_wedges();
    found.unused = vertex::unused(&header);
    found.mesh.name = name.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
    shape::repair_normals(&mut found.mesh);
    Ok(found)
}

fn read_pass(
    pass: Pass,
    header: &Header,
    stream: Stream,
    wanted: Wanted,
    faces: &mut Faces,
    found: &mut Read,
) -> Result<(), Failure> {
    let end_of_header = Place::Line(header.lines);
    let mut reader = Reader::new(stream, header);
    let mesh = &mut found.mesh;
    for element in &header.elements {
        check_count(element, header, &reader)?;
        let takes = |name: &str, other: Pass| element.name == name && pass != other;
        let takes_vertices = takes("vertex", Pass::Faces) && mesh.positions.is_empty();
        let takes_faces = takes("face", Pass::Vertices);
        let mut further = match wanted.attributes && (takes_vertices || takes_faces) {
            true => attribute::Columns::find(element),
            false => Vec::new(),
        };
        if takes_vertices {
            let columns = vertex::Columns::find(element).map_err(|message| Failure::at(end_of_header, message))?;
            each(&mut reader, element, |values| {
                further.iter_mut().for_each(|further| further.push(values, 1));
                columns.push(values, mesh)
            })?;
        } else if takes_faces {
            let Some(columns) = face::Columns::find(element, header, wanted.corners) else {
                return Err(Failure::at(end_of_header, "element face has no list vertex_indices"));
            };
            each(&mut reader, element, |values| {
                let before = mesh.triangles.len();
                faces.push(values, &columns, mesh)?;
                further.iter_mut().for_each(|further| further.push(values, mesh.triangles.len() - before));
                Ok(())
            })?;
        } else if takes("tristrips", Pass::Vertices)
            && let Some(columns) = face::Columns::find(element, header, false)
        {
            each(&mut reader, element, |values| faces.push_strip(values, &columns, mesh))?;
        } else {
            each(&mut reader, element, |_| Ok(()))?;
        }
        found.attributes.extend(further.into_iter().map(|further| further.attribute));
    }
    Ok(())
}

/// Refuses a count that the rest of the file cannot hold, before memory is taken for it.
fn check_count(element: &Element, header: &Header, reader: &Reader) -> Result<(), Failure> {
    if element.count > u64::from(u32::MAX) && !element.properties.is_empty() {
        return Err(Failure::at(reader.place(), format!("element {} claims {} items", element.name, element.count)));
    }
    let Some(rest) = reader.remaining() else { return Ok(()) };
    // The last number of a text file needs no separator.
    let room = rest + u64::from(header.encoding == Encoding::Ascii);
    let least = element.size_min(header.encoding);
    if element.count.saturating_mul(least as u64) > room {
        let (name, count) = (&element.name, element.count);
        let message =
            format!("element {name} claims {count} items of at least {least} bytes, but only {rest} bytes follow");
        return Err(Failure::at(reader.place(), message));
    }
    Ok(())
}

fn each(
    reader: &mut Reader,
    element: &Element,
    mut use_values: impl FnMut(&Values) -> Result<(), String>,
) -> Result<(), Failure> {
    // Elements without properties take no room: nothing to read, whatever their count.
    if element.properties.is_empty() {
        return Ok(());
    }
    let mut values = Values::default();
    for index in 0..element.count {
        let before = reader.place();
        let read = reader.read(element, &mut values).and_then(|()| use_values(&values).map_err(Failure::Here));
        match read {
            Err(Failure::Here(message)) => {
                let place = if matches!(before, Place::Line(_)) { reader.place() } else { before };
                let message = format!("{} {index} of {}: {message}", element.name, element.count);
                return Err(Failure::at(place, message));
            }
            outcome => outcome?,
        }
    }
    Ok(())
}
