//! Faces and strips of a PLY file become triangles, and their corners vertices of a mesh.

use super::header::{Element, Header};
use super::numbers::Values;
use super::vertex::{Color, has_colors};
use crate::scene::Mesh;
use crate::scene::load::polygon::{Triangulator, unroll_strip};
use crate::scene::load::vertices::{NONE, Vertices, gather};
use glam::{Vec2, Vec3};
use std::collections::HashMap;

/// What of a face is used beside the indices of its vertices.
#[derive(Default)]
pub(super) struct Columns {
    list: usize,
    /// Texture coordinates of the corners, two numbers each.
    wedges: Option<usize>,
    /// Which picture it shows.
    number: Option<usize>,
    color: Option<Color>,
}

impl Columns {
    /// None without a list of indices. `apart`: vertices may be doubled for what belongs to faces.
    pub fn find(element: &Element, header: &Header, apart: bool) -> Option<Self> {
        let list = element.find_list(&["vertex_indices", "vertex_index"])?;
        if !apart || element.name != "face" {
            return Some(Self { list, ..Self::default() });
        }
        Some(Self {
            list,
            wedges: element.find_list(&["texcoord"]),
            number: element.find(&["texnumber"]).filter(|_| header.textures.len() > 1),
            color: Color::find(element).filter(|_| !has_colors(header)),
        })
    }

    /// Whether corners of one vertex may differ.
    fn tell_apart(&self) -> bool {
        self.wedges.is_some() || self.color.is_some()
    }
}

/// Faces so far.
pub(super) struct Faces {
    triangulator: Triangulator,
    /// Vertices of the mesh by index, texture coordinates and colour, where faces tell them apart.
    vertices: Option<Vertices<4>>,
    palette: Vec<Vec3>,
    colors: HashMap<[u32; 3], u32>,
    /// The picture of each triangle, where faces name one.
    pub numbers: Vec<u32>,
    /// Faces with fewer than three corners, and triangles with a repeated one.
    pub degenerate: usize,
    corners: Vec<u32>,
    indices: Vec<u32>,
}

impl Faces {
    pub fn new() -> Self {
        Self {
            triangulator: Triangulator::new(),
            vertices: None,
            palette: Vec::new(),
            colors: HashMap::new(),
            numbers: Vec::new(),
            degenerate: 0,
            corners: Vec::new(),
            indices: Vec::new(),
        }
    }

    /// Appends the triangles of a face.
    pub fn push(&mut self, values: &Values, columns: &Columns, mesh: &mut Mesh) -> Result<(), String> {
        self.read_indices(values.list(columns.list), mesh.positions.len())?;
        if self.indices.len() < 3 {
            self.degenerate += 1;
            return Ok(());
        }
        self.corners.clear();
        if columns.tell_apart() {
            self.find_vertices(values, columns, mesh.positions.len())?;
        } else {
            self.corners.extend(&self.indices);
        }
        let before = mesh.triangles.len();
        let vertices = self.vertices.as_ref();
        let place = |corner| vertices.map_or(corner as usize, |vertices| vertices.position(corner));
        let position = |corner| mesh.positions[place(corner)];
        self.degenerate += self.triangulator.triangulate(&self.corners, position, &mut mesh.triangles);
        if let Some(number) = columns.number {
            let number = values.scalars[number];
            // -1 is none, as is everything that is no index.
            self.numbers.resize(before, NONE);
            self.numbers.resize(mesh.triangles.len(), if number >= 0.0 { number as u32 } else { NONE });
        }
        Ok(())
    }

    /// Appends the triangles of a strip; -1 starts a new one.
    pub fn push_strip(&mut self, values: &Values, columns: &Columns, mesh: &mut Mesh) -> Result<(), String> {
        for strip in values.list(columns.list).split(|value| *value == -1.0) {
            self.read_indices(strip, mesh.positions.len())?;
            unroll_strip(&self.indices, &mut mesh.triangles);
        }
        Ok(())
    }

    fn read_indices(&mut self, items: &[f64], count: usize) -> Result<(), String> {
        self.indices.clear();
        for item in items {
            let index = *item as u32;
            if f64::from(index) != *item || index == NONE {
                return Err(format!("{item} is not the index of a vertex"));
            }
            if index as usize >= count {
                return Err(format!("vertex {index} of {count}"));
            }
            self.indices.push(index);
        }
        Ok(())
    }

    /// The vertices of a face whose corners have something of their own.
    fn find_vertices(&mut self, values: &Values, columns: &Columns, count: usize) -> Result<(), String> {
        // A list of another length is not two numbers for each corner.
        let wedges = columns.wedges.map(|list| values.list(list)).filter(|uvs| uvs.len() == 2 * self.indices.len());
        let color = columns.color.as_ref().map_or(NONE, |color| {
            let value = color.value(values);
            *self.colors.entry(value.to_array().map(f32::to_bits)).or_insert_with(|| {
                self.palette.push(value);
                self.palette.len() as u32 - 1
            })
        });
        let vertices = self.vertices.get_or_insert_with(Vertices::new);
        for (i, index) in self.indices.iter().enumerate() {
            let word = |k: usize| wedges.map_or(NONE, |uvs| (uvs[2 * i + k] as f32).to_bits());
            let vertex = vertices.find_or_add([*index, word(0), word(1), color], count);
            self.corners.push(vertex.ok_or("more vertices than 32 bits can count")?);
        }
        Ok(())
    }

    /// Gives the vertices of `mesh` what belongs to faces. What it returns is the vertex of the file that each vertex was, or
    /// nothing where they are those of the file.
    pub fn finish(self, mesh: &mut Mesh) -> Vec<u32> {
        let Some(vertices) = self.vertices else { return Vec::new() };
        let [at, u, v, color] = vertices.into_words();
        mesh.positions = gather(&at, std::mem::take(&mut mesh.positions), Vec3::ZERO);
        mesh.normals = of_vertices(&at, std::mem::take(&mut mesh.normals), Vec3::ZERO);
        mesh.colors = of_vertices(&at, std::mem::take(&mut mesh.colors), Vec3::ONE);
        mesh.uvs = of_vertices(&at, std::mem::take(&mut mesh.uvs), Vec2::ZERO);
        if !u.is_empty() {
            mesh.uvs.resize(at.len(), Vec2::ZERO);
            for (uv, (u, v)) in mesh.uvs.iter_mut().zip(u.iter().zip(&v)) {
                let wedge = Vec2::new(f32::from_bits(*u), f32::from_bits(*v));
                // Not finite where a corner has none.
                *uv = if wedge.is_finite() { wedge } else { *uv };
            }
        }
        if !color.is_empty() {
            mesh.colors = gather(&color, self.palette, Vec3::ONE);
        }
        at
    }
}

/// What vertices had before they were told apart; nothing stays nothing.
fn of_vertices<T: Copy>(at: &[u32], values: Vec<T>, default: T) -> Vec<T> {
    if values.is_empty() { values } else { gather(at, values, default) }
}
