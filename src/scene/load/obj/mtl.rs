//! MTL: the materials of OBJ files, as written.
//!
//! Sources: Alias|Wavefront, Advanced Visualizer manual, appendix B1 "Material library file (.mtl)", 1995; and the keys for
//! physically based materials that Exocortex added ("Extending Wavefront MTL to support PBR").

use super::map::Map;
use super::statement::{Statement, Statements, decode};
use crate::scene::{Rgb, SceneError};
use std::collections::HashMap;
use std::path::Path;

/// Materials by name.
pub type Library = HashMap<String, Entry>;

/// Keys that a warning names; a file that is no MTL has more than anyone reads.
const IGNORED_MAX: usize = 16;

/// One `newmtl`. What the file does not say is None.
#[derive(Clone, Debug, Default)]
pub struct Entry {
    pub ambient: Option<Rgb>,
    pub diffuse: Option<Rgb>,
    pub specular: Option<Rgb>,
    pub emission: Option<Rgb>,
    /// `Tf`: colour of light that passes through.
    pub filter: Option<Rgb>,
    /// `Ns`
    pub exponent: Option<f32>,
    /// `d`
    pub opacity: Option<f32>,
    /// `Tr`
    pub transparency: Option<f32>,
    /// `Ni`: index of refraction.
    pub eta: Option<f32>,
    pub illum: Option<u32>,
    /// `Pr`, as are the next ones, 0 to 1.
    pub roughness: Option<f32>,
    pub metallic: Option<f32>,
    pub sheen: Option<f32>,
    /// `Pc`, as written.
    pub coat: Option<f32>,
    pub coat_roughness: Option<f32>,
    pub anisotropic: Option<f32>,
    /// The last one of each kind counts.
    pub maps: HashMap<MapKind, Map>,
}

/// What a picture changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum MapKind {
    Diffuse,
    Specular,
    Emission,
    Exponent,
    Opacity,
    Bump,
    Normal,
    Roughness,
    Metallic,
    Sheen,
    Coat,
    Anisotropic,
}

impl MapKind {
    fn named(keyword: &str) -> Option<Self> {
        Some(match keyword {
            "map_kd" => Self::Diffuse,
            "map_ks" => Self::Specular,
            "map_ke" => Self::Emission,
            "map_ns" => Self::Exponent,
            "map_d" => Self::Opacity,
            "bump" | "map_bump" => Self::Bump,
            "norm" | "map_norm" => Self::Normal,
            "map_pr" => Self::Roughness,
            // Blender writes `map_refl` where no key for physically based materials is asked for.
            "map_pm" | "map_refl" => Self::Metallic,
            "map_ps" => Self::Sheen,
            "map_pc" => Self::Coat,
            "map_aniso" => Self::Anisotropic,
            _ => return None,
        })
    }
}

/// Adds the materials of `file` to `library`; the first of a name stays.
pub fn read_library(file: &Path, library: &mut Library, warnings: &mut Vec<String>) -> Result<(), SceneError> {
    let mut current: Option<(String, Entry)> = None;
    let mut ignored: Vec<String> = Vec::new();
    let mut statements = Statements::open(file)?;
    while let Some(statement) = statements.next()? {
        let keyword = decode(statement.keyword()).to_ascii_lowercase();
        if keyword == "newmtl" {
            keep(library, current.replace((statement.name(), Entry::default())));
            continue;
        }
        let Some((_, entry)) = &mut current else {
            let message = format!("{:?} comes before any \"newmtl\"", decode(statement.keyword()));
            return Err(statement.bad(message));
        };
        if !entry.read(&keyword, &statement)? {
            let name: String = decode(statement.keyword()).chars().take(32).flat_map(char::escape_debug).collect();
            if ignored.len() <= IGNORED_MAX && !ignored.contains(&name) {
                ignored.push(name);
            }
        }
    }
    keep(library, current);
    if !ignored.is_empty() {
        let rest = if ignored.len() > IGNORED_MAX { " and more" } else { "" };
        ignored.truncate(IGNORED_MAX);
        warnings.push(format!("{}: ignored: {}{rest}", file.display(), ignored.join(", ")));
    }
    Ok(())
}

fn keep(library: &mut Library, entry: Option<(String, Entry)>) {
    if let Some((name, entry)) = entry {
        library.entry(name).or_insert(entry);
    }
}

impl Entry {
    /// Takes the statement over; false if it is of no use here. `keyword` is in lower case.
    fn read(&mut self, keyword: &str, statement: &Statement) -> Result<bool, SceneError> {
        let number = || -> Result<f32, SceneError> { Ok(statement.numbers::<1>()?[0]) };
        let share = || -> Result<Option<f32>, SceneError> { Ok(Some(number()?.clamp(0.0, 1.0))) };
        match keyword {
            "ka" => self.ambient = color(statement, 1.0)?,
            "kd" => self.diffuse = color(statement, 1.0)?,
            "ks" => self.specular = color(statement, 1.0)?,
            "ke" => self.emission = color(statement, f32::MAX)?,
            "tf" => self.filter = color(statement, 1.0)?,
            "ns" => self.exponent = Some(number()?.clamp(0.0, 1.0e6)),
            "ni" => self.eta = Some(number()?),
            // `d -halo factor` is transparent in the middle only; its factor stands for all.
            "d" => {
                let word = statement.words().filter(|word| !word.eq_ignore_ascii_case(b"-halo")).last();
                let Some(word) = word else { return Err(statement.bad("\"d\" needs a number")) };
                self.opacity = Some(statement.number(word)?.clamp(0.0, 1.0));
            }
            "tr" => self.transparency = share()?,
            "illum" => {
                let word = statement.words().next().unwrap_or_default();
                let illum = decode(word).parse::<u32>().ok().filter(|illum| *illum <= 10);
                self.illum = Some(illum.ok_or_else(|| {
                    let message = format!("\"illum\" must be 0 to 10, found {:?}", decode(word));
                    SceneError::bad(statement.location_of(word), message)
                })?);
            }
            "pr" => self.roughness = share()?,
            "pm" => self.metallic = share()?,
            "ps" => self.sheen = share()?,
            "pc" => self.coat = Some(number()?.max(0.0)),
            "pcr" => self.coat_roughness = share()?,
            "aniso" => self.anisotropic = share()?,
            // A turn of what is not anisotropic changes nothing.
            "anisor" => return Ok(number()? == 0.0 || self.anisotropic.unwrap_or(0.0) == 0.0),
            _ => match MapKind::named(keyword) {
                Some(kind) => {
                    self.maps.insert(kind, Map::read(statement)?);
                }
                None => return Ok(false),
            },
        }
        Ok(true)
    }
}

/// `r g b`, or one number for all, 0 to `most`; None for the spectral and CIE forms, which are ignored.
fn color(statement: &Statement, most: f32) -> Result<Option<Rgb>, SceneError> {
    let first = statement.words().next().unwrap_or_default();
    if first.eq_ignore_ascii_case(b"spectral") || first.eq_ignore_ascii_case(b"xyz") {
        return Ok(None);
    }
    let color = match statement.words().count() {
        1 | 2 => Rgb::splat(statement.numbers::<1>()?[0]),
        _ => Rgb::from_array(statement.numbers::<3>()?),
    };
    Ok(Some(color.clamp(Rgb::ZERO, Rgb::splat(most))))
}
