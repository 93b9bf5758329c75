//! `<texture>`: pictures and checkerboards, in the house's convention that v = 0 is a picture's bottom row.
//!
//! In Mitsuba v = 0 is the top row. Meshes are turned over when they are loaded (v becomes 1 - v), and `to_uv` with them.

use super::document::{Document, Node, Result};
use super::object::Object;
use super::spectrum::Role;
use crate::scene::load::image::ColorSpace;
use crate::scene::load::texture_files::{TextureFiles, intern, or_absent};
use crate::scene::{Rgb, Scene, Texture, TextureData, TextureId, Wrap};
use std::sync::Arc;

/// What varies over a surface.
#[derive(Clone, Debug, PartialEq)]
pub enum Varying {
    Texture(TextureId),
    /// What the mesh brings along.
    Attribute {
        name: String,
        scale: f32,
    },
}

/// Reads textures into a scene; equal ones once.
#[derive(Debug)]
pub struct Textures {
    files: TextureFiles,
}

impl Default for Textures {
    fn default() -> Self {
        Self { files: TextureFiles::of_mitsuba() }
    }
}

impl Textures {
    /// The texture in `node`; none, with a warning, if its file is not there. `number`: it stands for one, not for a colour.
    pub fn read(
        &mut self,
        document: &Document,
        node: Node,
        number: bool,
        scene: &mut Scene,
    ) -> Result<Option<Varying>> {
        let object = Object::open(document, node)?;
        let texture = match object.plugin.name {
            "bitmap" => match self.bitmap(&object, &mut scene.warnings)? {
                Some(texture) => texture,
                None => return Ok(None),
            },
            "checkerboard" => checkerboard(&object, number)?,
            "rawconstant" => raw_constant(&object)?,
            // mesh_attribute
            _ => {
                let scale = object.float_in("scale", 0.0, 1e6)?.unwrap_or(1.0) as f32;
                return Ok(Some(Varying::Attribute { name: super::attribute::name_of(&object)?, scale }));
            }
        };
        Ok(Some(Varying::Texture(intern(&mut scene.textures, texture))))
    }

    /// The picture that `filename` names, as it lies in its file; none, with a warning, if it is not there.
    pub fn picture(
        &mut self,
        object: &Object,
        space: ColorSpace,
        warnings: &mut Vec<String>,
    ) -> Result<Option<Texture>> {
        let Some(node) = object.property("filename") else { return object.required("filename", None) };
        let read = object.document.find_file(node, "value").and_then(|path| self.files.load(&path, space));
        or_absent(read, object.document.location_of(node), warnings)
    }

    /// The texture with its luminance in every channel: what a number takes from a coloured picture.
    pub fn grey(&mut self, id: TextureId, scene: &mut Scene) -> TextureId {
        let texture = &scene.textures[id.0 as usize];
        let coloured = match &texture.data {
            TextureData::Srgb8(texels) | TextureData::Linear8(texels) => {
                texels.iter().any(|[r, g, b, _]| r != g || g != b)
            }
            TextureData::Float(texels) => texels.iter().any(|[r, g, b, _]| r != g || g != b),
            TextureData::Pattern(_) => false,
        };
        if !coloured {
            return id;
        }
        let spread = luminances(&texture.data).into_iter().map(|v| [v, v, v, 1.0]).collect();
        let grey = Texture { data: TextureData::Float(Arc::new(spread)), ..texture.clone() };
        intern(&mut scene.textures, grey)
    }

    fn bitmap(&mut self, object: &Object, warnings: &mut Vec<String>) -> Result<Option<Texture>> {
        let space = if object.boolean("raw")?.unwrap_or(false) { ColorSpace::Linear } else { ColorSpace::Srgb };
        let Some(mut texture) = self.picture(object, space, warnings)? else { return Ok(None) };
        texture.bilinear = object.choice("filter_type", &[("bilinear", true), ("nearest", false)])?.unwrap_or(true);
        let modes = [("repeat", Wrap::Repeat), ("mirror", Wrap::Mirror), ("clamp", Wrap::Clamp)];
        let wrap = object.choice("wrap_mode", &modes)?.unwrap_or(Wrap::Repeat);
        (texture.wrap_u, texture.wrap_v) = (wrap, wrap);
        place(&mut texture, object)?;
        Ok(Some(texture))
    }
}

/// One number for all channels, or three.
fn raw_constant(object: &Object) -> Result<Texture> {
    let Some(node) = object.property("value") else { return object.required("value", None) };
    let value = match object.document.tag(node) {
        "vector" | "point" => object.vector("value")?.map(|v| v.as_vec3()),
        _ => object.float("value")?.map(|v| Rgb::splat(v as f32)),
    };
    Ok(Texture { name: "rawconstant".to_owned(), ..Texture::uniform(value.unwrap_or_default()) })
}

/// Of every texel; none of a pattern, which no scene of Mitsuba's has.
fn luminances(data: &TextureData) -> Vec<f32> {
    let luminance = |[r, g, b]: [f32; 3]| (0.212671 * r + 0.715160 * g) + 0.072169 * b;
    let linear = |code: u8| crate::scene::load::image::srgb_to_linear(f64::from(code) / 255.0) as f32;
    match data {
        TextureData::Srgb8(texels) => texels.iter().map(|t| luminance([t[0], t[1], t[2]].map(linear))).collect(),
        TextureData::Linear8(texels) => {
            texels.iter().map(|t| luminance([t[0], t[1], t[2]].map(|code| f32::from(code) / 255.0))).collect()
        }
        TextureData::Float(texels) => texels.iter().map(|t| luminance([t[0], t[1], t[2]])).collect(),
        TextureData::Pattern(_) => Vec::new(),
    }
}

/// Two by two texels: `color0` where u and v lie in the same half of their tile. As a number it is the other way round in
/// Mitsuba 3.9, whose `eval` and `eval_1` differ.
fn checkerboard(object: &Object, number: bool) -> Result<Texture> {
    let color = |name: &str, default: f32| {
        let color = object.color(name, Role::Reflectance)?.unwrap_or(glam::Vec3::splat(default));
        Ok([color.x, color.y, color.z, 1.0])
    };
    let (a, b) = (color("color0", 0.4)?, color("color1", 0.2)?);
    let (a, b) = if number { (b, a) } else { (a, b) };
    let mut texture = Texture::new("checkerboard", 2, 2, TextureData::Float(Arc::new(vec![a, b, b, a])));
    texture.bilinear = false;
    place(&mut texture, object)?;
    Ok(texture)
}

/// Sets what `to_uv` says: u' = a u + b v + c and v' = d u + e v + f in Mitsuba's coordinates.
fn place(texture: &mut Texture, object: &Object) -> Result<()> {
    let map = object.transform("to_uv")?.0;
    let (u, v, o) = (map.matrix3.x_axis, map.matrix3.y_axis, map.translation);
    texture.scale = [u.x as f32, v.y as f32];
    // v = 1 - v here, and v' likewise.
    texture.shear = [-v.x as f32, -u.y as f32];
    texture.offset = [(v.x + o.x) as f32, (1.0 - v.y - o.y) as f32];
    Ok(())
}
