//! Mitsuba's `.serialized` meshes: zlib streams behind each other, their places at the end of the file.
//!
//! Source: Mitsuba 3 documentation, "Serialized mesh loader", versions 3 and 4 of the format.

use crate::scene::load::text::read_bytes;
use crate::scene::{Location, Mesh, SceneError};
use glam::{Vec2, Vec3};
use std::path::Path;

const IDENTIFIER: u16 = 0x041c;
const HAS_NORMALS: u32 = 0x0001;
const HAS_UVS: u32 = 0x0002;
const HAS_COLORS: u32 = 0x0008;
const FACE_NORMALS: u32 = 0x0010;
const DOUBLE: u32 = 0x2000;
/// Bytes of one mesh when it is unpacked.
const UNPACKED_MAX: usize = 1 << 31;
/// zlib makes no more than this of one byte (1032 and a little).
const EXPANSION_MAX: usize = 1040;
/// Meshes of a file.
const SHAPES_MAX: u32 = 1 << 20;
/// Characters of a name.
const NAME_MAX: usize = 1 << 16;

/// Mesh `index` of the file; without normals if it has none or asks for flat faces. uvs are as they stand in the file.
pub fn read_mesh(path: &Path, index: u32) -> Result<Mesh, SceneError> {
    let bytes = read_bytes(path)?;
    mesh_from_bytes(&bytes, index).map_err(|message| SceneError::bad(Location::file(path), message))
}

fn mesh_from_bytes(bytes: &[u8], index: u32) -> Result<Mesh, String> {
    let version = check_header(bytes, 0)?;
    let start = start_of(bytes, version, index)?;
    // Each mesh has a header of its own.
    let version = check_header(bytes, start)?;
    let packed = bytes.get(start + 4..).unwrap_or(&[]);
    let limit = UNPACKED_MAX.min(packed.len().saturating_mul(EXPANSION_MAX));
    let unpacked = miniz_oxide::inflate::decompress_to_vec_zlib_with_limit(packed, limit)
        .map_err(|error| format!("mesh {index} cannot be unpacked: {error}"))?;
    parse(&mut Cursor { bytes: &unpacked }, version)
}

fn check_header(bytes: &[u8], start: usize) -> Result<u16, String> {
    let mut cursor = Cursor { bytes: bytes.get(start..).unwrap_or(&[]) };
    let (identifier, version) = (u16::from_le_bytes(cursor.take()?), u16::from_le_bytes(cursor.take()?));
    if identifier != IDENTIFIER {
        return Err(format!(
            "byte {start}: not a serialized mesh: it begins with {identifier:#06x}, not {IDENTIFIER:#06x}"
        ));
    }
    match version {
        3 | 4 => Ok(version),
        _ => Err(format!("byte {start}: version {version} of the format; 3 and 4 are known")),
    }
}

/// Where mesh `index` starts: the list at the end of the file says.
fn start_of(bytes: &[u8], version: u16, index: u32) -> Result<usize, String> {
    let end = bytes.len();
    let count = match bytes.last_chunk() {
        Some(last) => u32::from_le_bytes(*last),
        None => return Err("the file ends early".to_owned()),
    };
    let width = if version == 4 { 8 } else { 4 };
    let list = (count as usize).checked_mul(width).and_then(|size| end.checked_sub(size + 4));
    let Some(list) = list.filter(|_| (1..=SHAPES_MAX).contains(&count)) else {
        // Files of one mesh may lack the list.
        return if index == 0 { Ok(0) } else { Err(format!("the file claims {count} meshes, more than it can hold")) };
    };
    if index >= count {
        return Err(format!("there is no mesh {index}: the file has {count}, counted from 0"));
    }
    let mut cursor = Cursor { bytes: &bytes[list + index as usize * width..] };
    let start =
        if version == 4 { u64::from_le_bytes(cursor.take()?) } else { u32::from_le_bytes(cursor.take()?).into() };
    usize::try_from(start)
        .ok()
        .filter(|start| *start < list)
        .ok_or_else(|| format!("mesh {index} starts at byte {start}, outside the file"))
}

fn parse(cursor: &mut Cursor, version: u16) -> Result<Mesh, String> {
    let flags = u32::from_le_bytes(cursor.take()?);
    let mut mesh = Mesh::default();
    if version == 4 {
        let end = cursor.bytes.iter().take(NAME_MAX).position(|b| *b == 0).ok_or("the name has no end")?;
        mesh.name = String::from_utf8_lossy(&cursor.bytes[..end]).into_owned();
        cursor.bytes = &cursor.bytes[end + 1..];
    }
    let (vertices, faces) = (u64::from_le_bytes(cursor.take()?), u64::from_le_bytes(cursor.take()?));
    let double = flags & DOUBLE != 0;
    let scalar = if double { 8 } else { 4 };
    let per_vertex = scalar
        * (3 + if flags & HAS_NORMALS != 0 { 3 } else { 0 }
            + if flags & HAS_UVS != 0 { 2 } else { 0 }
            + if flags & HAS_COLORS != 0 { 3 } else { 0 });
    let needed = vertices.checked_mul(per_vertex).zip(faces.checked_mul(12)).and_then(|(a, b)| a.checked_add(b));
    if needed.is_none_or(|needed| needed > cursor.bytes.len() as u64) || vertices >= u64::from(u32::MAX) {
        let message =
            format!("it claims {vertices} vertices and {faces} faces, but {} bytes follow", cursor.bytes.len());
        return Err(message);
    }
    let vertices = vertices as usize;
    mesh.positions = vectors(cursor, vertices, double)?;
    if let Some(place) = mesh.positions.iter().position(|p| !p.is_finite()) {
        return Err(format!("the position of vertex {place} is not finite"));
    }
    if flags & HAS_NORMALS != 0 {
        mesh.normals = vectors(cursor, vertices, double)?;
    }
    if flags & FACE_NORMALS != 0 {
        mesh.normals.clear();
    }
    if flags & HAS_UVS != 0 {
        for _ in 0..vertices {
            let uv = Vec2::new(cursor.scalar(double)?, cursor.scalar(double)?);
            mesh.uvs.push(if uv.is_finite() { uv } else { Vec2::ZERO });
        }
    }
    if flags & HAS_COLORS != 0 {
        let usable = |c: Vec3| if c.is_finite() { c.max(Vec3::ZERO) } else { Vec3::ZERO };
        mesh.colors = vectors(cursor, vertices, double)?.into_iter().map(usable).collect();
    }
    for face in 0..faces {
        let mut corners = [0; 3];
        for corner in &mut corners {
            *corner = u32::from_le_bytes(cursor.take()?);
            if *corner as usize >= vertices {
                return Err(format!("face {face} refers to vertex {corner} of {vertices}"));
            }
        }
        mesh.triangles.push(corners);
    }
    if mesh.triangles.is_empty() {
        return Err("the mesh has no faces".to_owned());
    }
    Ok(mesh)
}

fn vectors(cursor: &mut Cursor, count: usize, double: bool) -> Result<Vec<Vec3>, String> {
    (0..count).map(|_| Ok(Vec3::new(cursor.scalar(double)?, cursor.scalar(double)?, cursor.scalar(double)?))).collect()
}

/// What is left of a stream.
struct Cursor<'a> {
    bytes: &'a [u8],
}

impl Cursor<'_> {
    fn take<const N: usize>(&mut self) -> Result<[u8; N], String> {
        let (first, rest) = self.bytes.split_first_chunk().ok_or("the file ends early")?;
        self.bytes = rest;
        Ok(*first)
    }

    fn scalar(&mut self, double: bool) -> Result<f32, String> {
        Ok(if double { f64::from_le_bytes(self.take()?) as f32 } else { f32::from_le_bytes(self.take()?) })
    }
}
