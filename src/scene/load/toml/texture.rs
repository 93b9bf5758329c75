//! `texture` of a material: a file and how it is laid on.

use super::document::{Document, Value};
use super::format::TEXTURE;
use super::keys::Range;
use super::reader::{Reader, Result};
use crate::scene::load::image::ColorSpace;
use crate::scene::load::texture_files::{TextureFiles, intern};
use crate::scene::{SceneError, Texture, TextureId, Wrap};
use std::path::{Path, PathBuf};

/// The textures read so far; equal ones are kept once.
#[derive(Debug, Default)]
pub struct Textures {
    pub list: Vec<Texture>,
    files: TextureFiles,
}

impl Textures {
    /// The texture that the key `texture` of `material` asks for.
    pub fn read(&mut self, material: &Reader) -> Result<Option<TextureId>> {
        let Some(node) = material.node("texture") else { return Ok(None) };
        let texture = match &node.value {
            Value::String(file) => self.load(material, "texture", file, ColorSpace::Srgb)?,
            Value::Table(_) => self.read_table(&Reader::open(material.document, node, &TEXTURE)?)?,
            _ => return Err(material.mismatch("texture", node)),
        };
        Ok(Some(intern(&mut self.list, texture)))
    }

    /// The picture that the key `image` of the background asks for: around the scene once, from pole to pole.
    pub fn read_environment(&mut self, background: &Reader) -> Result<Option<TextureId>> {
        let Some(file) = background.text("image")? else { return Ok(None) };
        let texture = self.load(background, "image", file, ColorSpace::Srgb)?;
        Ok(Some(intern(&mut self.list, Texture { wrap_v: Wrap::Clamp, ..texture })))
    }

    fn read_table(&mut self, table: &Reader) -> Result<Texture> {
        let file = table.required("file", table.text("file")?)?;
        let space = table.choice("colorspace", &[("srgb", ColorSpace::Srgb), ("linear", ColorSpace::Linear)])?;
        let mut texture = self.load(table, "file", file, space.unwrap_or_default())?;
        if let Some(bilinear) = table.choice("filter", &[("bilinear", true), ("nearest", false)])? {
            texture.bilinear = bilinear;
        }
        if let Some([wrap_u, wrap_v]) = read_wrap(table)? {
            (texture.wrap_u, texture.wrap_v) = (wrap_u, wrap_v);
        }
        let any = Range::new(-1.0e6, 1.0e6);
        if let Some(scale) = table.number_or_numbers::<2>("scale", any)? {
            texture.scale = scale.map(|number| number as f32);
        }
        if let Some(offset) = table.number_or_numbers::<2>("offset", any)? {
            texture.offset = offset.map(|number| number as f32);
        }
        Ok(texture)
    }

    fn load(&mut self, table: &Reader, key: &str, file: &str, space: ColorSpace) -> Result<Texture> {
        self.files.load(&beside(table.document, file), space).map_err(|error| refer(table, key, error))
    }
}

fn read_wrap(table: &Reader) -> Result<Option<[Wrap; 2]>> {
    let Some(node) = table.node("wrap") else { return Ok(None) };
    let wrap = |value: &Value| match value {
        Value::String(text) if text == "repeat" => Some(Wrap::Repeat),
        Value::String(text) if text == "clamp" => Some(Wrap::Clamp),
        Value::String(text) if text == "mirror" => Some(Wrap::Mirror),
        _ => None,
    };
    let both = match &node.value {
        Value::Array(items) => match items.as_slice() {
            [u, v] => wrap(&u.value).zip(wrap(&v.value)),
            _ => None,
        },
        value => wrap(value).map(|both| (both, both)),
    };
    both.map(|(u, v)| Some([u, v])).ok_or_else(|| table.mismatch("wrap", node))
}

/// A path written in the document: relative to its folder.
pub fn beside(document: &Document, file: &str) -> PathBuf {
    document.file.parent().unwrap_or(Path::new("")).join(file)
}

/// An error in a file that cannot be read names the place that asked for the file.
pub fn refer(table: &Reader, key: &str, error: SceneError) -> SceneError {
    match error {
        SceneError::Io { location: file, source } => {
            let location = table.document.location(table.node(key).map_or(table.place, |node| node.place));
            SceneError::Io { location, source: std::io::Error::new(source.kind(), format!("{file}: {source}")) }
        }
        bad => bad,
    }
}
