//! Picture files of a film: one file per format.

mod exr;
mod hdr;
mod png;

pub use self::exr::write_linear;
pub use hdr::rgbe;
pub use png::{Plate, write_rgb8};

use super::{Film, FilmError, OutputFile, gfilm};
use std::io::{self, Write};
use std::path::Path;
use std::str::FromStr;

/// File formats that can be written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Displayed: tone curve, sRGB, 8 or 16 bits.
    Png,
    /// Linear f32 and auxiliary channels.
    Exr,
    /// Linear, 8 bits and a shared exponent (Radiance).
    Hdr,
    /// The film itself.
    Gfilm,
}

impl Format {
    /// By its name or a file's extension, in any case.
    pub fn from_name(name: &str) -> Option<Self> {
        match name.to_ascii_lowercase().as_str() {
            "png" => Some(Self::Png),
            "exr" => Some(Self::Exr),
            "hdr" | "pic" => Some(Self::Hdr),
            "gfilm" => Some(Self::Gfilm),
            _ => None,
        }
    }

    /// By the path's extension; PNG for standard output, `-`.
    pub fn of(path: &Path) -> Result<Self, FilmError> {
        if path == Path::new("-") {
            return Ok(Self::Png);
        }
        let extension = path.extension().map(|e| e.to_string_lossy().into_owned());
        let found = match &extension {
            Some(extension) => format!("unknown extension .{extension}"),
            None => "no extension".into(),
        };
        extension
            .and_then(|e| Self::from_name(&e))
            .ok_or_else(|| FilmError::Usage(format!("{}: {found}; allowed: .png, .exr, .hdr, .gfilm", path.display())))
    }

    /// Whether files of this format can hold auxiliary values.
    pub fn has_layers(self) -> bool {
        matches!(self, Self::Exr | Self::Gfilm)
    }
}

/// Auxiliary channels an EXR can carry.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Aov {
    Depth,
    Normal,
    Albedo,
    Object,
    Material,
    Samples,
}

impl Aov {
    pub const ALL: [(&str, Self); 6] = [
        ("depth", Self::Depth),
        ("normal", Self::Normal),
        ("albedo", Self::Albedo),
        ("object", Self::Object),
        ("material", Self::Material),
        ("samples", Self::Samples),
    ];
}

impl FromStr for Aov {
    type Err = String;

    /// An error names what is allowed.
    fn from_str(name: &str) -> Result<Self, String> {
        let named = Self::ALL.iter().find(|(n, _)| *n == name);
        named.map(|(_, aov)| *aov).ok_or_else(|| "allowed: depth, normal, albedo, object, material, samples".into())
    }
}

/// How a film becomes a file. How it is displayed is the film's own (`Film::set_display`).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Picture<'a> {
    pub format: Format,
    /// PNG only: 16 bits a channel instead of 8.
    pub sixteen_bit: bool,
    /// EXR only; those the film does not keep are left out. A gfilm keeps what the film has.
    pub aovs: &'a [Aov],
}

impl Picture<'_> {
    /// Writes the film into an opened file, which is still to be committed.
    pub fn write(&self, film: &Film, file: &mut OutputFile) -> Result<(), FilmError> {
        let written = self.write_to(film, file).and_then(|()| file.flush());
        written.map_err(|e| FilmError::write(file.path(), e))
    }

    /// Writes the film; the same film and settings give the same bytes.
    pub fn write_to(&self, film: &Film, out: &mut dyn Write) -> io::Result<()> {
        match self.format {
            Format::Png => png::write(film, self.sixteen_bit, out),
            Format::Exr => exr::write(film, self.aovs, out),
            Format::Hdr => hdr::write(film, out),
            Format::Gfilm => gfilm::write(film, out),
        }
    }
}

/// What every picture file says about where it came from, in this order.
pub fn facts(film: &Film) -> Vec<(&'static str, String)> {
    let spec = film.spec();
    let mut facts = vec![
        ("Software", format!("gonio {}", spec.version)),
        ("Film-Hash", film.hash().to_string()),
        ("Samples", film.samples().to_string()),
        ("Seed", spec.seed.to_string()),
        ("Integrator", spec.integrator.clone()),
        ("Scene", spec.scene_name.clone()),
        ("Scene-Digest", blake3::Hash::from(spec.scene_digest).to_string()),
    ];
    if film.limited_count() > 0 {
        facts.push(("Limited-Contributions", film.limited_count().to_string()));
    }
    facts
}
