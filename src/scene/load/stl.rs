//! STL: bare triangles, in text or binary.
//!
//! Corners in the same place are one vertex, and edges up to 40 degrees are smooth. Normals of facets are computed; the
//! colours that some programs hide in binary files are ignored with a warning.
//! Source: 3D Systems, StereoLithography Interface Specification, 1989.

use super::polygon::has_three_corners;
use super::staging::bare_scene;
use super::stream::{Stream, failed};
use super::vertices::NONE;
use crate::scene::shape::compute_smooth_normals;
use crate::scene::{Geometry, Location, Material, MaterialId, Mesh, MeshId, Object, Scene, SceneError, Transform};
use glam::Vec3;
use std::collections::HashMap;
use std::path::Path;

/// Edges sharper than this stay sharp, radians (40 degrees).
const CREASE: f64 = 0.698;
/// Bytes before the triangles of a binary file, the last four of which are their number.
const HEADER: usize = 84;
/// Bytes of a triangle: normal and three corners in 32-bit floats, two more bytes.
const RECORD: usize = 50;

/// Loads the file as a scene of one mesh in the house's grey. `load::load` stages it.
pub fn load(path: &Path) -> Result<Scene, SceneError> {
    let mut scene = bare_scene(path);
    let mut stream = Stream::open(path)?;
    let mut facets = Facets::default();
    match is_text(&mut stream).map_err(|error| failed(path, error))? {
        true => facets.read_text(path, &mut stream)?,
        false => facets.read_binary(path, &mut stream, &mut scene.warnings)?,
    }
    if facets.mesh.triangles.is_empty() {
        return Err(SceneError::bad(Location::file(path), "the file has no triangles"));
    }
    if facets.degenerate > 0 {
        let message = format!("{}: triangles with a repeated corner left out: {}", path.display(), facets.degenerate);
        scene.warnings.push(message);
    }
    let mut mesh = facets.mesh;
    mesh.name = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    compute_smooth_normals(&mut mesh, CREASE);
    scene.materials.push(Material::grey("stl"));
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

/// Text begins with `solid`, but so do the headers of some binary files: those have the length that their number asks for.
fn is_text(stream: &mut Stream) -> std::io::Result<bool> {
    let length = stream.remaining();
    let start = stream.peek(1024)?;
    let count = start.get(HEADER - 4..HEADER).map(|b| u64::from(u32::from_le_bytes([b[0], b[1], b[2], b[3]])));
    let is_binary = count.is_some_and(|count| length == Some(HEADER as u64 + RECORD as u64 * count));
    let begins = start.trim_ascii_start().get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid"));
    Ok(begins && !is_binary && !start.contains(&0))
}

/// Triangles so far.
#[derive(Default)]
struct Facets {
    mesh: Mesh,
    /// Vertices by the bits of their places.
    vertices: HashMap<[u32; 3], u32>,
    degenerate: usize,
}

impl Facets {
    /// Appends a triangle; what is wrong with it.
    fn push(&mut self, corners: [Vec3; 3]) -> Result<(), String> {
        let mut triangle = [0; 3];
        for (vertex, corner) in triangle.iter_mut().zip(corners) {
            if !corner.is_finite() {
                return Err(format!("the corner {corner} is not finite"));
            }
            // Adding zero turns -0 into +0.
            let corner = corner + Vec3::ZERO;
            let count = self.mesh.positions.len() as u32;
            *vertex = *self.vertices.entry(corner.to_array().map(f32::to_bits)).or_insert(count);
            if *vertex == count {
                self.mesh.positions.push(corner);
            }
        }
        if self.mesh.positions.len() >= NONE as usize - 3 {
            return Err("more vertices than 32 bits can count".to_owned());
        }
        if has_three_corners(&triangle) {
            self.mesh.triangles.push(triangle);
        } else {
            self.degenerate += 1;
        }
        Ok(())
    }

    /// `facet normal .. outer loop vertex .. vertex .. vertex .. endloop endfacet`, in lines; only vertices count.
    fn read_text(&mut self, path: &Path, stream: &mut Stream) -> Result<(), SceneError> {
        let mut corners: Vec<Vec3> = Vec::new();
        let mut line = 0;
        while stream.next_line().map_err(|error| failed(path, error))? {
            line += 1;
            let bad = |message: String| SceneError::bad(Location { file: path.to_owned(), line, column: 0 }, message);
            let text = String::from_utf8_lossy(stream.line());
            let mut words = text.split_ascii_whitespace();
            match words.next().unwrap_or_default().to_ascii_lowercase().as_str() {
                "vertex" => {
                    let mut place = [0.0; 3];
                    for number in &mut place {
                        let word = words.next().unwrap_or_default();
                        *number = word.parse().map_err(|_| bad(format!("expected a number, found {word:?}")))?;
                    }
                    corners.push(Vec3::from_array(place));
                }
                "endloop" | "endfacet" if !corners.is_empty() => {
                    let [a, b, c] = corners[..] else {
                        return Err(bad(format!("a facet has three corners, found {}", corners.len())));
                    };
                    self.push([a, b, c]).map_err(bad)?;
                    corners.clear();
                }
                // Names may be anything.
                "" | "solid" | "endsolid" | "facet" | "outer" | "endloop" | "endfacet" => {}
                word => return Err(bad(format!("expected the next part of a facet, found {word:?}"))),
            }
        }
        if !corners.is_empty() {
            let location = Location { file: path.to_owned(), line, column: 0 };
            return Err(SceneError::bad(location, "the file ends within a facet"));
        }
        Ok(())
    }

    fn read_binary(&mut self, path: &Path, stream: &mut Stream, warnings: &mut Vec<String>) -> Result<(), SceneError> {
        let file = path.display();
        let bad = |message: String| SceneError::bad(Location::file(path), message);
        let header = stream.peek(HEADER).map_err(|error| failed(path, error))?;
        let Some(b) = header.get(HEADER - 4..HEADER) else {
            return Err(bad("not an STL file: neither `solid` nor a binary header".to_owned()));
        };
        let count = u32::from_le_bytes([b[0], b[1], b[2], b[3]]);
        // Materialise writes the colour of the whole part there.
        let mut is_colored = header.windows(6).any(|word| word == b"COLOR=");
        stream.skip(HEADER);
        let needed = u64::from(count) * RECORD as u64;
        if let Some(rest) = stream.remaining().filter(|rest| *rest < needed) {
            return Err(bad(format!("claims {count} triangles, but only {rest} bytes follow, {RECORD} for each")));
        }
        for index in 0..count {
            let record = stream.peek(RECORD).map_err(|error| failed(path, error))?;
            if record.len() < RECORD {
                return Err(bad(format!("the file ends in triangle {index} of {count}")));
            }
            let number = |at: usize| f32::from_le_bytes([record[at], record[at + 1], record[at + 2], record[at + 3]]);
            let corner = |k: usize| Vec3::from_array([12, 16, 20].map(|at| number(at + 12 * k)));
            is_colored |= record[48..] != [0, 0];
            let corners = [corner(0), corner(1), corner(2)];
            stream.skip(RECORD);
            self.push(corners).map_err(|message| bad(format!("triangle {index} of {count}: {message}")))?;
        }
        if is_colored {
            warnings.push(format!("{file}: ignored: colours of triangles"));
        }
        if let Some(rest) = stream.remaining().filter(|rest| *rest > 0) {
            warnings.push(format!("{file}: ignored: {rest} bytes after the last triangle"));
        }
        Ok(())
    }
}
