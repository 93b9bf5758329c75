//! The textures of a material: a file or a pattern, how it is laid on, and what it varies.

use super::document::{Document, Node, Value};
use super::keys::Range;
use super::material_format::TEXTURE;
use super::reader::{Reader, Result};
use crate::scene::load::image::ColorSpace;
use crate::scene::load::texture_files::{TextureFiles, intern, or_absent};
use crate::scene::{
    Channel, Parameter, Pattern, PatternKind, Rgb, SceneError, Texture, TextureBinding, TextureId, Wrap,
};
use std::path::{Path, PathBuf};

/// The keys of a material that take a texture, and what each varies.
const KEYS: &[(&str, Parameter)] = &[
    ("texture", Parameter::Color),
    ("specular_texture", Parameter::SpecularColor),
    ("emission_texture", Parameter::Emission),
    ("roughness_texture", Parameter::Roughness),
    ("roughness_u_texture", Parameter::RoughnessU),
    ("roughness_v_texture", Parameter::RoughnessV),
    ("metallic_texture", Parameter::Metallic),
    ("opacity_texture", Parameter::Opacity),
    ("weight_texture", Parameter::Weight),
    ("normal_map", Parameter::Normal),
    ("bump_map", Parameter::Bump),
    ("anisotropic_texture", Parameter::Anisotropic),
    ("spec_trans_texture", Parameter::SpecTrans),
    ("spec_tint_texture", Parameter::SpecTint),
    ("sheen_texture", Parameter::Sheen),
    ("sheen_tint_texture", Parameter::SheenTint),
    ("flatness_texture", Parameter::Flatness),
    ("clearcoat_texture", Parameter::Clearcoat),
    ("clearcoat_gloss_texture", Parameter::ClearcoatGloss),
];

/// The textures read so far; equal ones are kept once.
#[derive(Debug, Default)]
pub struct Textures {
    pub list: Vec<Texture>,
    files: TextureFiles,
    /// What the scene goes without.
    pub warnings: Vec<String>,
}

impl Textures {
    /// All textures that the keys of `material` ask for; a file that is not there is left out, as if its key had not been written.
    pub fn read(&mut self, material: &Reader) -> Vec<TextureBinding> {
        let mut bindings = Vec::new();
        for &(key, parameter) in KEYS {
            if let Some(node) = material.node(key) {
                let binding = material.attempt(|| self.read_binding(material, key, node, parameter));
                bindings.extend(binding.flatten());
            }
        }
        bindings
    }

    /// The picture that the key `image` of the background asks for: around the scene once, from pole to pole. A file that is
    /// not there is a white one, as `scale` is all that is known of the light.
    pub fn read_environment(&mut self, background: &Reader) -> Result<Option<TextureId>> {
        let Some(file) = background.text("image")? else { return Ok(None) };
        let texture = self.load(background, "image", file, ColorSpace::Srgb)?;
        let texture = texture.unwrap_or_else(|| Texture::uniform(Rgb::ONE));
        Ok(Some(intern(&mut self.list, Texture { wrap_v: Wrap::Clamp, ..texture })))
    }

    fn read_binding(
        &mut self,
        material: &Reader,
        key: &str,
        node: &Node,
        parameter: Parameter,
    ) -> Result<Option<TextureBinding>> {
        // What is no colour is stored as it is.
        let is_color = matches!(parameter, Parameter::Color | Parameter::SpecularColor | Parameter::Emission);
        let space = if is_color { ColorSpace::Srgb } else { ColorSpace::Linear };
        let is_vector = is_color || parameter == Parameter::Normal;
        let plain = if is_vector { Channel::Rgb } else { Channel::R };
        let (texture, channel, scale) = match &node.value {
            Value::String(file) => (self.load(material, key, file, space)?, plain, None),
            Value::Table(_) => {
                let table = Reader::open(material.document, node, &TEXTURE)?;
                let channel = read_channel(&table, parameter)?.unwrap_or(plain);
                let scale = read_scale(&table, parameter)?;
                (self.read_table(&table, space)?, channel, scale)
            }
            _ => return Err(material.mismatch(key, node)),
        };
        let Some(texture) = texture else { return Ok(None) };
        let texture = intern(&mut self.list, texture);
        Ok(Some(TextureBinding { parameter, texture, channel, scale: scale.unwrap_or(1.0) }))
    }

    /// None where its file is not there.
    fn read_table(&mut self, table: &Reader, space: ColorSpace) -> Result<Option<Texture>> {
        table.exclusive("file", "pattern")?;
        let chosen = table.choice("colorspace", &[("srgb", ColorSpace::Srgb), ("linear", ColorSpace::Linear)])?;
        let read = match read_pattern(table)? {
            Some(pattern) => Some(Texture::pattern("pattern", pattern)),
            None => {
                let file = table.required("file", table.text("file")?)?;
                self.load(table, "file", file, chosen.unwrap_or(space))?
            }
        };
        let Some(mut texture) = read else { return Ok(None) };
        if let Some(bilinear) = table.choice("filter", &[("bilinear", true), ("nearest", false)])? {
            texture.bilinear = bilinear;
        }
        if let Some([wrap_u, wrap_v]) = read_wrap(table)? {
            (texture.wrap_u, texture.wrap_v) = (wrap_u, wrap_v);
        }
        texture.mipmap = table.boolean("mipmap")?.unwrap_or(false);
        let any = Range::new(-1.0e6, 1.0e6);
        let scale = table.number_or_numbers::<2>("scale", any)?.unwrap_or([1.0; 2]);
        // The image turns one way if its coordinates turn the other.
        let (sin, cos) = sin_cos(table.number("rotate")?.unwrap_or(0.0));
        texture.scale = [(scale[0] * cos) as f32, (scale[1] * cos) as f32];
        texture.shear = [(scale[1] * sin) as f32, (-scale[0] * sin) as f32];
        if let Some(offset) = table.number_or_numbers::<2>("offset", any)? {
            texture.offset = offset.map(|number| number as f32);
        }
        Ok(Some(texture))
    }

    fn load(&mut self, table: &Reader, key: &str, file: &str, space: ColorSpace) -> Result<Option<Texture>> {
        let read = self.files.load(&beside(table.document, file), space).map_err(|error| refer(table, key, error));
        let place = table.node(key).map_or(table.place, |node| node.place);
        or_absent(read, table.document.location(place), &mut self.warnings)
    }
}

/// Sine and cosine of an angle in degrees, exact for quarter turns.
fn sin_cos(degrees: f64) -> (f64, f64) {
    let quarters = degrees / 90.0;
    match (quarters == quarters.trunc(), quarters.rem_euclid(4.0) as u8) {
        (true, 0) => (0.0, 1.0),
        (true, 1) => (1.0, 0.0),
        (true, 2) => (0.0, -1.0),
        (true, _) => (-1.0, 0.0),
        (false, _) => (libm::sin(degrees.to_radians()), libm::cos(degrees.to_radians())),
    }
}

fn read_channel(table: &Reader, parameter: Parameter) -> Result<Option<Channel>> {
    let words = [("rgb", Channel::Rgb), ("r", Channel::R), ("g", Channel::G), ("b", Channel::B), ("a", Channel::A)];
    match table.choice("channel", &words)? {
        None | Some(Channel::Rgb) => Ok(None),
        Some(_) if parameter == Parameter::Normal => Err(table.bad("channel", "a normal map needs all three channels")),
        channel => Ok(channel),
    }
}

/// The strength of a normal map, the height of a bump map.
fn read_scale(table: &Reader, parameter: Parameter) -> Result<Option<f32>> {
    for (key, owner, allowed) in
        [("strength", Parameter::Normal, "normal_map"), ("height", Parameter::Bump, "bump_map")]
    {
        if parameter != owner && table.has(key) {
            return Err(table.bad(key, format!("{key:?} belongs to \"{allowed}\" only")));
        }
    }
    Ok(table.float("strength")?.or(table.float("height")?))
}

fn read_pattern(table: &Reader) -> Result<Option<Pattern>> {
    let words = [("checker", "checker"), ("noise", "noise"), ("gradient", "gradient"), ("zone-plate", "zone-plate")];
    let Some(name) = table.choice("pattern", &words)? else {
        for key in ["colors", "octaves", "gain", "seed"] {
            if table.has(key) {
                return Err(table.bad(key, format!("{key:?} needs \"pattern\" beside it")));
            }
        }
        return Ok(None);
    };
    for key in ["octaves", "gain", "seed"] {
        if name != "noise" && table.has(key) {
            return Err(table.bad(key, format!("{key:?} belongs to pattern = \"noise\" only")));
        }
    }
    for key in ["wrap", "filter", "colorspace"] {
        if table.has(key) {
            return Err(table.bad(key, format!("{key:?} is for images, not for patterns")));
        }
    }
    let kind = match name {
        "checker" => PatternKind::Checker,
        "noise" => PatternKind::Noise {
            octaves: table.integer("octaves")?.unwrap_or(6),
            gain: table.float("gain")?.unwrap_or(0.5),
            seed: table.integer("seed")?.unwrap_or(0),
        },
        "gradient" => PatternKind::Gradient,
        _ => PatternKind::ZonePlate,
    };
    let Some(items) = table.array("colors")? else {
        return Ok(Some(Pattern { kind, colors: [Rgb::ZERO, Rgb::ONE] }));
    };
    let color = |node: &Node| super::color::color(node, Range::NOT_NEGATIVE);
    match items {
        [first, second] => match (color(first), color(second)) {
            (Some(first), Some(second)) => Ok(Some(Pattern { kind, colors: [first, second] })),
            _ => Err(table.bad("colors", "\"colors\" must be two colours >= 0")),
        },
        _ => Err(table.bad("colors", format!("\"colors\" must be two colours >= 0, found {}", items.len()))),
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
