//! MTL: the materials of OBJ files.
//!
//! Source: Alias|Wavefront, Advanced Visualizer manual, appendix B1 "Material library file (.mtl)", 1995.

use super::statement::{Statement, statements};
use crate::scene::load::image::ColorSpace;
use crate::scene::load::text::read_bytes;
use crate::scene::load::texture_files::TextureFiles;
use crate::scene::{Material, Model, Rgb, SceneError, Texture, Transparency, Wrap};
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// One `newmtl`, as written.
#[derive(Clone, Debug)]
pub struct Entry {
    ambient: Option<Rgb>,
    diffuse: Option<Rgb>,
    specular: Rgb,
    emission: Rgb,
    /// Colour of light that passes through.
    filter: Rgb,
    exponent: f32,
    opacity: f32,
    /// Index of refraction; 1 where the file says nothing.
    eta: f32,
    illum: Option<u32>,
    map: Option<Map>,
}

/// `map_Kd`.
#[derive(Clone, Debug)]
struct Map {
    file: PathBuf,
    /// Where it was asked for, for warnings.
    place: String,
    scale: [f32; 2],
    offset: [f32; 2],
    wrap: Wrap,
}

/// Adds the materials of `file` to `library`; the first of a name stays.
pub fn read_library(
    file: &Path,
    library: &mut HashMap<String, Entry>,
    warnings: &mut Vec<String>,
) -> Result<(), SceneError> {
    let bytes = read_bytes(file)?;
    let text = String::from_utf8_lossy(&bytes);
    let mut current: Option<(String, Entry)> = None;
    let mut skipped: Vec<String> = Vec::new();
    for statement in statements(file, &text) {
        if statement.keyword() == "newmtl" {
            let name = statement.rest();
            if name.is_empty() {
                return Err(statement.bad("\"newmtl\" needs a name"));
            }
            let next = Some((name.to_owned(), Entry::new()));
            keep(library, std::mem::replace(&mut current, next));
            continue;
        }
        let Some((_, entry)) = &mut current else {
            return Err(statement.bad(format!("{:?} comes before any \"newmtl\"", statement.keyword())));
        };
        let keyword = statement.keyword().to_owned();
        if !entry.read(&statement)? && !skipped.contains(&keyword) {
            skipped.push(keyword);
        }
    }
    keep(library, current);
    if !skipped.is_empty() {
        warnings.push(format!("{}: ignored: {}", file.display(), skipped.join(", ")));
    }
    Ok(())
}

fn keep(library: &mut HashMap<String, Entry>, entry: Option<(String, Entry)>) {
    if let Some((name, entry)) = entry {
        library.entry(name).or_insert(entry);
    }
}

impl Entry {
    fn new() -> Self {
        Self {
            ambient: None,
            diffuse: None,
            specular: Rgb::ZERO,
            emission: Rgb::ZERO,
            filter: Rgb::ONE,
            exponent: 32.0,
            opacity: 1.0,
            eta: 1.0,
            illum: None,
            map: None,
        }
    }

    /// Takes the statement over; false if it is of no use here.
    fn read(&mut self, statement: &Statement) -> Result<bool, SceneError> {
        let number = || -> Result<f32, SceneError> { Ok(statement.numbers::<1>()?[0]) };
        match statement.keyword() {
            "Ka" => self.ambient = color(statement)?,
            "Kd" => self.diffuse = color(statement)?,
            "Ks" => self.specular = color(statement)?.unwrap_or(self.specular),
            "Ke" => self.emission = color(statement)?.unwrap_or(self.emission),
            "Tf" => self.filter = color(statement)?.unwrap_or(self.filter),
            "Ns" => self.exponent = number()?.clamp(0.0, 1.0e6),
            "Ni" => self.eta = number()?,
            // `d -halo factor` is transparent in the middle only; its factor stands for all.
            "d" => {
                let word = statement.words().filter(|word| *word != "-halo").last();
                self.opacity = match word {
                    Some(word) => statement.number(word)?.clamp(0.0, 1.0),
                    None => return Err(statement.bad("\"d\" needs a number")),
                };
            }
            "Tr" => self.opacity = 1.0 - number()?.clamp(0.0, 1.0),
            "illum" => {
                let word = statement.words().next().unwrap_or("");
                let illum = word.parse::<u32>().ok().filter(|illum| *illum <= 10);
                self.illum = Some(illum.ok_or_else(|| {
                    SceneError::bad(statement.location_of(word), format!("\"illum\" must be 0 to 10, found {word:?}"))
                })?);
            }
            "map_Kd" => self.map = Some(Map::read(statement)?),
            _ => return Ok(false),
        }
        Ok(true)
    }

    /// The house's material: illum 0 is unlit, 1 Lambert, 2 Blinn-Phong ("Blinn's interpretation of Phong"), 3, 5 and 8
    /// with a mirror branch, 4, 6 and 7 a dielectric if there is an index; what else is not opaque lets the background through.
    /// The texture that multiplies its colour is returned beside it.
    pub fn material(
        &self,
        name: &str,
        files: &mut TextureFiles,
        warnings: &mut Vec<String>,
    ) -> (Material, Option<Texture>) {
        let texture = self.map.as_ref().and_then(|map| map.load(files, warnings));
        let k_s = self.specular.max_element();
        let shiny = k_s > 0.0 && self.illum != Some(1);
        let refracts = matches!(self.illum, Some(4 | 6 | 7)) && (self.eta - 1.0).abs() > 1.0e-3 && self.eta >= 0.01;
        let model = match self.illum {
            Some(0) => Model::Emissive,
            _ if refracts => Model::Dielectric { eta: self.eta.min(20.0), absorption: Rgb::ZERO },
            _ if shiny => Model::BlinnPhong { exponent: self.exponent },
            _ => Model::Lambert,
        };
        let transparent = self.opacity < 1.0 && !refracts;
        let specular = if k_s > 0.0 { self.specular / k_s } else { Rgb::ONE };
        let material = Material {
            // Of a dielectric it would tint what is reflected.
            color: if refracts { Rgb::ONE } else { self.base_color(texture.is_some()) },
            k_a: self.ambient.map_or(1.0, |ambient| ambient.max_element().min(1.0)),
            k_s: if shiny { k_s } else { 0.0 },
            k_r: if shiny && matches!(self.illum, Some(3 | 5 | 8)) { k_s } else { 0.0 },
            specular_color: if refracts { self.filter } else { specular },
            transparency: transparent.then_some(Transparency::Interpolated { k_t: 1.0 - self.opacity }),
            emission: self.emission,
            model,
            ..Material::grey(name)
        };
        (material, texture)
    }

    /// Kd; many files leave it black, or out, where a map gives the colour.
    fn base_color(&self, textured: bool) -> Rgb {
        match self.diffuse {
            Some(Rgb::ZERO) | None if textured => Rgb::ONE,
            Some(color) => color,
            None => Material::grey("").color,
        }
    }
}

/// `r g b`, or one number for all; None for the spectral and CIE forms, which are ignored. Reflectances stay within 0 to 1,
/// emission only above 0.
fn color(statement: &Statement) -> Result<Option<Rgb>, SceneError> {
    let first = statement.words().next().unwrap_or("");
    if matches!(first, "spectral" | "xyz") {
        return Ok(None);
    }
    let color = match statement.words().count() {
        1 | 2 => Rgb::splat(statement.numbers::<1>()?[0]),
        _ => Rgb::from_array(statement.numbers::<3>()?),
    };
    let most = if statement.keyword() == "Ke" { f32::MAX } else { 1.0 };
    Ok(Some(color.clamp(Rgb::ZERO, Rgb::splat(most))))
}

impl Map {
    fn read(statement: &Statement) -> Result<Self, SceneError> {
        let mut map = Self {
            file: PathBuf::new(),
            place: statement.location().to_string(),
            scale: [1.0; 2],
            offset: [0.0; 2],
            wrap: Wrap::Repeat,
        };
        let mut rest = statement.rest();
        while rest.starts_with('-') {
            let (option, after) = split_word(rest);
            let (count, all_numbers) = match option {
                "-s" | "-o" | "-t" => (3, true),
                "-mm" => (2, true),
                "-blendu" | "-blendv" | "-clamp" | "-cc" | "-imfchan" | "-type" | "-boost" | "-bm" | "-texres" => {
                    (1, false)
                }
                // A file name may begin so.
                _ => break,
            };
            rest = after;
            let mut values = Vec::new();
            while values.len() < count {
                let (word, after) = split_word(rest);
                // -s, -o and -t take one to three numbers; a name follows them.
                if word.is_empty() || (all_numbers && word.parse::<f32>().is_err()) || after.is_empty() {
                    break;
                }
                values.push(word);
                rest = after;
            }
            map.apply(statement, option, &values)?;
        }
        if rest.is_empty() {
            return Err(statement.bad("\"map_Kd\" needs a file name"));
        }
        // Files from Windows are read everywhere.
        map.file = statement.folder().join(rest.replace('\\', "/"));
        Ok(map)
    }

    fn apply(&mut self, statement: &Statement, option: &str, values: &[&str]) -> Result<(), SceneError> {
        let target = match option {
            "-s" => &mut self.scale,
            "-o" => &mut self.offset,
            "-clamp" => {
                if values == ["on"] {
                    self.wrap = Wrap::Clamp;
                }
                return Ok(());
            }
            _ => return Ok(()),
        };
        for (number, word) in target.iter_mut().zip(values) {
            *number = statement.number(word)?;
        }
        Ok(())
    }

    fn load(&self, files: &mut TextureFiles, warnings: &mut Vec<String>) -> Option<Texture> {
        match files.load(&self.file, ColorSpace::Srgb) {
            Ok(texture) => Some(Texture {
                wrap_u: self.wrap,
                wrap_v: self.wrap,
                scale: self.scale,
                offset: self.offset,
                ..texture
            }),
            Err(error) => {
                warnings.push(format!("{}: no texture: {error}", self.place));
                None
            }
        }
    }
}

/// The first word and what follows it.
fn split_word(text: &str) -> (&str, &str) {
    let (word, rest) = text.split_once(char::is_whitespace).unwrap_or((text, ""));
    (word, rest.trim_start())
}
