//! PLY (Turk 1994): triangle and polygon meshes, in text or binary of either byte order.
//!
//! Read are positions, normals, colours and texture coordinates of the element `vertex`, the index lists of `face` and
//! `tristrips`; everything else is skipped. Colours count as sRGB-encoded if integer and as linear if floating.

mod attribute;
mod header;
mod numbers;

use super::image::srgb_to_linear;
use super::{polygon, staging};
use crate::scene::{Geometry, Location, Material, MaterialId, Mesh, MeshId, Object, Scene, SceneError, Transform};
pub use attribute::Attribute;
use glam::{Vec2, Vec3};
use header::{Element, Header};
use numbers::{Reader, Values};
use std::path::Path;

/// Where in a file something is wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Place {
    Line(u32),
    Byte(usize),
}

/// Edges sharper than this stay sharp where a file has no normals, radians (40 degrees).
const CREASE: f64 = 0.698;

/// Loads the file as a scene: the mesh, smooth where it has no normals of its own, in the house's grey. `load::load` stages it.
pub fn load(path: &Path) -> Result<Scene, SceneError> {
    let mut mesh = read_mesh(path)?;
    if mesh.normals.is_empty() {
        crate::scene::shape::compute_smooth_normals(&mut mesh, CREASE);
    }
    let mut scene = staging::bare_scene(path);
    scene.materials.push(Material::grey("ply"));
    scene.objects.push(Object {
        name: mesh.name.clone(),
        geometry: Geometry::Mesh(MeshId(0)),
        transform: Transform::default(),
        material: Some(MaterialId(0)),
        casts_shadow: None,
        shading: None,
    });
    scene.meshes.push(mesh);
    Ok(scene)
}

/// Reads the mesh in the file `path`, without normals if it has none.
pub fn read_mesh(path: &Path) -> Result<Mesh, SceneError> {
    mesh_from_bytes(&read_bytes(path)?, path)
}

/// Reads the mesh in the file `path` with the attributes of its vertices and triangles.
pub fn read_mesh_with_attributes(path: &Path) -> Result<(Mesh, Vec<Attribute>), SceneError> {
    let mut attributes = Vec::new();
    let mesh = read(&read_bytes(path)?, path, Some(&mut attributes))?;
    Ok((mesh, attributes))
}

fn read_bytes(path: &Path) -> Result<Vec<u8>, SceneError> {
    std::fs::read(path).map_err(|source| SceneError::Io { location: Location::file(path), source })
}

/// Reads a mesh from the bytes of a PLY file; `name` is that file, for messages.
pub fn mesh_from_bytes(bytes: &[u8], name: &Path) -> Result<Mesh, SceneError> {
    read(bytes, name, None)
}

fn read(bytes: &[u8], name: &Path, attributes: Option<&mut Vec<Attribute>>) -> Result<Mesh, SceneError> {
    let mut mesh = parse(bytes, attributes).map_err(|(place, message)| {
        let mut location = Location::file(name);
        match place {
            Place::Line(line) => {
                location.line = line;
                SceneError::bad(location, message)
            }
            Place::Byte(at) => SceneError::bad(location, format!("byte {at}: {message}")),
        }
    })?;
    mesh.name = name.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
    crate::scene::shape::repair_normals(&mut mesh);
    Ok(mesh)
}

type Failure = (Place, String);

/// `attributes`: where those of vertices and faces are put, if they are wanted.
fn parse(bytes: &[u8], mut attributes: Option<&mut Vec<Attribute>>) -> Result<Mesh, Failure> {
    let header = header::parse(bytes)?;
    let end_of_header = Place::Line(header.lines);
    let mut reader = Reader::new(bytes, &header);
    let mut mesh = Mesh::default();
    for element in &header.elements {
        check_count(element, &header, &reader)?;
        let mut further = match attributes {
            Some(_) if matches!(element.name.as_str(), "vertex" | "face") => attribute::Columns::find(element),
            _ => Vec::new(),
        };
        match element.name.as_str() {
            "vertex" if mesh.positions.is_empty() => {
                let columns = Columns::find(element).map_err(|message| (end_of_header, message))?;
                each(&mut reader, element, |values| {
                    further.iter_mut().for_each(|further| further.push(values, 1));
                    columns.push(values, &mut mesh)
                })?;
            }
            "face" => match element.find_list(&["vertex_indices", "vertex_index"]) {
                Some(list) => each(&mut reader, element, |values| {
                    let before = mesh.triangles.len();
                    push_face(values.list(list), &mut mesh)?;
                    further.iter_mut().for_each(|further| further.push(values, mesh.triangles.len() - before));
                    Ok(())
                })?,
                None => {
                    return Err((end_of_header, "element face has no list vertex_indices".to_owned()));
                }
            },
            "tristrips" => match element.find_list(&["vertex_indices", "vertex_index"]) {
                Some(list) => each(&mut reader, element, |values| push_strip(values.list(list), &mut mesh))?,
                None => each(&mut reader, element, |_| Ok(()))?,
            },
            _ => each(&mut reader, element, |_| Ok(()))?,
        }
        if let Some(attributes) = attributes.as_deref_mut() {
            attributes.extend(further.into_iter().map(|further| further.attribute));
        }
    }
    if mesh.triangles.is_empty() {
        return Err((end_of_header, "the file has no faces to draw".to_owned()));
    }
    check_indices(&mesh).map_err(|message| (end_of_header, message))?;
    Ok(mesh)
}

/// Refuses a count that the rest of the file cannot hold, before memory is taken for it.
fn check_count(element: &Element, header: &Header, reader: &Reader) -> Result<(), Failure> {
    // The last number of a text file needs no separator.
    let room = reader.remaining() as u64 + u64::from(header.encoding == header::Encoding::Ascii);
    let needed = element.count.saturating_mul(element.size_min(header.encoding) as u64);
    if needed > room {
        let message = format!(
            "element {} claims {} items of at least {} bytes, but only {} bytes follow",
            element.name,
            element.count,
            element.size_min(header.encoding),
            reader.remaining()
        );
        return Err((reader.place(), message));
    }
    if element.count > u64::from(u32::MAX) && !element.properties.is_empty() {
        return Err((reader.place(), format!("element {} claims {} items", element.name, element.count)));
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
        let read = reader.read(element, &mut values).and_then(|()| use_values(&values));
        if let Err(message) = read {
            let place = if matches!(before, Place::Line(_)) { reader.place() } else { before };
            return Err((place, format!("{} {index} of {}: {message}", element.name, element.count)));
        }
    }
    Ok(())
}

/// Which properties of a vertex mean what.
struct Columns {
    position: [usize; 3],
    normal: Option<[usize; 3]>,
    uv: Option<[usize; 2]>,
    /// And whether they are codes to be decoded, and their full scale.
    color: Option<([usize; 3], bool, f64)>,
}

impl Columns {
    fn find(element: &Element) -> Result<Self, String> {
        let three =
            |names: [&[&str]; 3]| Some([element.find(names[0])?, element.find(names[1])?, element.find(names[2])?]);
        let Some(position) = three([&["x"], &["y"], &["z"]]) else {
            return Err("element vertex has no properties x, y, z".to_owned());
        };
        let uv = [("s", "t"), ("u", "v"), ("texture_u", "texture_v"), ("texture_s", "texture_t")]
            .iter()
            .find_map(|(u, v)| Some([element.find(&[u])?, element.find(&[v])?]));
        let red: [&[&str]; 3] =
            [&["red", "r", "diffuse_red"], &["green", "g", "diffuse_green"], &["blue", "b", "diffuse_blue"]];
        let color = three(red).map(|columns| {
            let item = element.properties[columns[0]].item;
            (columns, !item.is_float(), item.full_scale())
        });
        Ok(Self { position, normal: three([&["nx"], &["ny"], &["nz"]]), uv, color })
    }

    fn push(&self, values: &Values, mesh: &mut Mesh) -> Result<(), String> {
        let vector = |columns: [usize; 3]| Vec3::from_array(columns.map(|c| values.scalars[c] as f32));
        let position = vector(self.position);
        if !position.is_finite() {
            return Err(format!("the position {position} is not finite"));
        }
        mesh.positions.push(position);
        if let Some(columns) = self.normal {
            mesh.normals.push(vector(columns));
        }
        if let Some(columns) = self.uv {
            let uv = Vec2::from_array(columns.map(|c| values.scalars[c] as f32));
            mesh.uvs.push(if uv.is_finite() { uv } else { Vec2::ZERO });
        }
        if let Some((columns, encoded, full_scale)) = self.color {
            let channel = |c: usize| {
                let v = values.scalars[c] / full_scale;
                let v = if encoded { srgb_to_linear(v) } else { v };
                // NaN becomes 0.
                if v > 0.0 { v.min(1e6) as f32 } else { 0.0 }
            };
            mesh.colors.push(Vec3::from_array(columns.map(channel)));
        }
        Ok(())
    }
}

fn index(value: f64) -> Result<u32, String> {
    if (0.0..=4_294_967_294.0).contains(&value) && value == libm::floor(value) {
        return Ok(value as u32);
    }
    Err(format!("{value} is not the index of a vertex"))
}

fn push_face(items: &[f64], mesh: &mut Mesh) -> Result<(), String> {
    if items.len() < 3 {
        return Err(format!("a face of {} corners", items.len()));
    }
    let corners = items.iter().map(|v| index(*v)).collect::<Result<Vec<u32>, String>>()?;
    // Faces may come before vertices; then their range is known at the end only.
    if let Some(outside) = corners.iter().find(|c| !mesh.positions.is_empty() && **c as usize >= mesh.positions.len()) {
        return Err(format!("vertex {outside} of {}", mesh.positions.len()));
    }
    polygon::triangulate(&corners, &mesh.positions, &mut mesh.triangles);
    Ok(())
}

/// Triangle strips; -1 starts a new one.
fn push_strip(items: &[f64], mesh: &mut Mesh) -> Result<(), String> {
    for strip in items.split(|v| *v == -1.0) {
        let corners = strip.iter().map(|v| index(*v)).collect::<Result<Vec<u32>, String>>()?;
        polygon::unroll_strip(&corners, &mut mesh.triangles);
    }
    Ok(())
}

fn check_indices(mesh: &Mesh) -> Result<(), String> {
    let outside = |i: &&u32| **i as usize >= mesh.positions.len();
    match mesh.triangles.iter().flatten().find(outside) {
        Some(i) => Err(format!("a face refers to vertex {i} of {}", mesh.positions.len())),
        None => Ok(()),
    }
}
