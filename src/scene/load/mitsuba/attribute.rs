//! `mesh_attribute`: what a mesh brings along for its vertices or faces.
//!
//! A single attribute that is the colour of a shape's only material becomes vertex colours. All others become a picture in which
//! each triangle has a block of 2 x 2 texels: read between their middles, it is the attribute, exactly and everywhere, and any
//! number of a material may be one. The mesh then has texture coordinates of its own, so nothing else may need those of the file.

use super::Loader;
use super::document::{Document, Node, Result};
use super::object::Object;
use crate::scene::load::ply::Attribute;
use crate::scene::load::texture_files::intern;
use crate::scene::{Mesh, Rgb, Texture, TextureData, TextureId, Wrap};
use glam::{Vec2, Vec3};
use std::sync::Arc;

/// Properties that are the colour which vertex colours multiply.
const COLORS: [&str; 3] = ["reflectance", "diffuse_reflectance", "base_color"];
/// Properties that turn with the texture coordinates.
const TURNED: [&str; 3] = ["alpha_u", "alpha_v", "anisotropic"];

/// How a shape shows attributes of its mesh.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub enum Shown {
    #[default]
    Nothing,
    /// This one as vertex colours.
    Colors(String),
    /// Several, or not as a colour.
    Picture,
}

/// A mesh whose attributes become pictures: its triangles by their vertices in the file.
#[derive(Debug)]
pub struct Pictured {
    triangles: Vec<[u32; 3]>,
    attributes: Vec<Attribute>,
}

/// What the elements of a shape ask for.
#[derive(Default)]
struct Uses {
    /// Names of attributes, and whether each stands for a base colour.
    attributes: Vec<(String, bool)>,
    materials: u32,
    /// The first element that needs the file's own texture coordinates.
    placed: Option<Node>,
}

impl Uses {
    fn find(&mut self, document: &Document, written: Node, nesting: u32) -> Result<()> {
        let node = document.resolve(written)?;
        let name = document.attribute(written, "name").unwrap_or("");
        match document.tag(node) {
            "texture" if document.attribute(node, "type") == Some("mesh_attribute") => {
                let attribute = name_of(&Object::open(document, node)?)?;
                self.attributes.push((attribute, COLORS.contains(&name)));
            }
            "texture" => self.placed = self.placed.or(Some(written)),
            "bsdf" | "emitter" if nesting < super::bsdf::NESTING_MAX => {
                let inner = |child: &&Node| document.resolve(**child).is_ok_and(|child| document.tag(child) == "bsdf");
                if document.tag(node) == "bsdf" && !document.children(node).iter().any(|child| inner(&child)) {
                    self.materials += 1;
                }
                for child in document.children(node) {
                    self.find(document, *child, nesting + 1)?;
                }
            }
            _ if TURNED.contains(&name) => self.placed = self.placed.or(Some(written)),
            _ => {}
        }
        Ok(())
    }
}

/// The name of the attribute that a `mesh_attribute` shows.
pub fn name_of(object: &Object) -> Result<String> {
    Ok(object.text("name")?.unwrap_or("vertex_color").to_owned())
}

impl Loader<'_> {
    /// How the material and the emitter of a shape show attributes. Only files with attributes can; `shape` names the plug-in.
    pub fn shown_attributes(&self, shape: &Object) -> Result<Shown> {
        let mut uses = Uses::default();
        for child in shape.nested("bsdf").into_iter().chain(shape.nested("emitter")) {
            uses.find(self.document, child.written, 0)?;
        }
        let Some((name, _)) = uses.attributes.first() else { return Ok(Shown::Nothing) };
        if !matches!(shape.plugin.name, "ply" | "serialized") {
            let message =
                format!("a {} has no attribute {name:?}: only meshes of type ply or serialized do", shape.plugin.name);
            return Err(self.document.bad(shape.node, message));
        }
        match (uses.attributes.as_slice(), uses.materials, uses.placed) {
            ([(name, true)], 1, _) => Ok(Shown::Colors(name.clone())),
            (_, _, None) => Ok(Shown::Picture),
            (_, _, Some(other)) => {
                let message =
                    format!("what follows texture coordinates is not supported beside the attribute {name:?}");
                Err(self.document.bad(other, message))
            }
        }
    }

    /// Puts the attributes into the finished mesh as `shown` says. What it returns is kept for `attribute_texture`.
    pub fn show_attributes(
        &self,
        shape: &Object,
        shown: &Shown,
        mesh: &mut Mesh,
        mut attributes: Vec<Attribute>,
    ) -> Result<Option<Pictured>> {
        mesh.colors.clear();
        // Strips make triangles that have none.
        let (vertices, faces) = (mesh.positions.len(), mesh.triangles.len());
        attributes.retain(|attribute| attribute.values.len() == if attribute.on_faces { faces } else { vertices });
        match shown {
            Shown::Nothing => Ok(None),
            Shown::Colors(name) => {
                let found = find_attribute(self.document, shape.node, name, &attributes)?;
                if found.on_faces {
                    part_faces(mesh);
                    mesh.colors = found.values.iter().flat_map(|value| [*value; 3]).collect();
                } else {
                    mesh.colors = found.values.clone();
                }
                mesh.colors.iter_mut().for_each(|color| *color = color.max(Vec3::ZERO));
                Ok(None)
            }
            Shown::Picture => {
                let triangles = mesh.triangles.clone();
                part_faces(mesh);
                let grid = Grid::of(triangles.len());
                mesh.uvs = (0..triangles.len()).flat_map(|face| grid.corners(face)).collect();
                Ok(Some(Pictured { triangles, attributes }))
            }
        }
    }

    /// The picture of an attribute of the mesh whose material is being made; white where there is none, for materials that no
    /// shape refers to.
    pub fn attribute_texture(&mut self, node: Node, name: &str, scale: f32) -> Result<TextureId> {
        let Some(Pictured { triangles, attributes }) = self.showing.and_then(|mesh| self.pictured.get(&mesh)) else {
            return Ok(intern(&mut self.scene.textures, Texture::uniform(Rgb::ONE)));
        };
        let attribute = find_attribute(self.document, node, name, attributes)?;
        let grid = Grid::of(triangles.len());
        let mut texels = vec![[0.0f32; 4]; (grid.width() * grid.height()) as usize];
        for (face, corners) in triangles.iter().enumerate() {
            let value = |corner: usize| {
                let index = if attribute.on_faces { face } else { corners[corner] as usize };
                attribute.values.get(index).copied().unwrap_or(Vec3::ZERO) * scale
            };
            let [a, b, c] = [value(0), value(1), value(2)];
            // The fourth corner makes it a plane over the block.
            for (place, value) in grid.texels(face).into_iter().zip([a, b, c, b + c - a]) {
                texels[place] = [value.x, value.y, value.z, 1.0];
            }
        }
        let data = TextureData::Float(Arc::new(texels));
        let mut texture = Texture::new(name, grid.width(), grid.height(), data);
        (texture.wrap_u, texture.wrap_v) = (Wrap::Clamp, Wrap::Clamp);
        texture.extrapolated = true;
        Ok(intern(&mut self.scene.textures, texture))
    }
}

fn find_attribute<'a>(document: &Document, at: Node, name: &str, all: &'a [Attribute]) -> Result<&'a Attribute> {
    all.iter().find(|attribute| attribute.name == name).ok_or_else(|| {
        let names: Vec<&str> = all.iter().map(|attribute| attribute.name.as_str()).collect();
        let known = if names.is_empty() { "it has none".to_owned() } else { format!("it has {}", names.join(", ")) };
        document.bad(at, format!("the mesh has no attribute {name:?}; {known}"))
    })
}

/// Gives every triangle vertices of its own.
fn part_faces(mesh: &mut Mesh) {
    fn part<T: Copy>(triangles: &[[u32; 3]], values: &mut Vec<T>) {
        if !values.is_empty() {
            *values = triangles.iter().flatten().map(|corner| values[*corner as usize]).collect();
        }
    }
    let triangles = std::mem::take(&mut mesh.triangles);
    part(&triangles, &mut mesh.positions);
    part(&triangles, &mut mesh.normals);
    part(&triangles, &mut mesh.uvs);
    mesh.triangles = (0..triangles.len() as u32).map(|face| [3 * face, 3 * face + 1, 3 * face + 2]).collect();
}

/// Where the blocks of triangles lie in a picture: row by row from the top.
#[derive(Clone, Copy, Debug)]
struct Grid {
    columns: u32,
    rows: u32,
}

impl Grid {
    fn of(triangles: usize) -> Self {
        let columns = libm::ceil(libm::sqrt(triangles as f64)).max(1.0) as u32;
        Self { columns, rows: (triangles as u32).div_ceil(columns).max(1) }
    }

    fn width(self) -> u32 {
        2 * self.columns
    }

    fn height(self) -> u32 {
        2 * self.rows
    }

    /// Column and row of a block's upper left texel.
    fn block(self, face: usize) -> [u32; 2] {
        [2 * (face as u32 % self.columns), 2 * (face as u32 / self.columns)]
    }

    /// Texels of the three corners, and the one across the first.
    fn texels(self, face: usize) -> [usize; 4] {
        let [x, y] = self.block(face);
        [[x, y], [x + 1, y], [x, y + 1], [x + 1, y + 1]].map(|[x, y]| (y * self.width() + x) as usize)
    }

    /// Texture coordinates of the three corners: the middles of their texels.
    fn corners(self, face: usize) -> [Vec2; 3] {
        let [x, y] = self.block(face);
        [[x, y], [x + 1, y], [x, y + 1]].map(|[x, y]| {
            let middle = |at: u32, size: u32| (f64::from(at) + 0.5) / f64::from(size);
            Vec2::new(middle(x, self.width()) as f32, (1.0 - middle(y, self.height())) as f32)
        })
    }
}
