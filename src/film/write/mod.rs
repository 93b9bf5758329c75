//! Picture files of a film: one file per format.

mod exr;
mod hdr;
mod png;

pub use png::write_rgb8;

use super::display::Display;
use super::{Film, FilmError, gfilm};
use std::io::{self, Write};
use std::path::Path;

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
    pub fn from_path(path: &Path) -> Result<Self, FilmError> {
        if path == Path::new("-") {
            return Ok(Self::Png);
        }
        let extension = path.extension().map(|e| e.to_string_lossy().into_owned());
        let found = match &extension {
            Some(extension) => format!("unknown extension .{extension}"),
            None => "no extension".into(),
        };
        extension.and_then(|e| Self::from_name(&e)).ok_or_else(|| {
            FilmError::Usage(format!(
                "{}: {found}; allowed: .png, .exr, .hdr, .gfilm",
                path.display()
            ))
        })
    }
}

/// Bits of a PNG's channel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Depth {
    #[default]
    Eight,
    Sixteen,
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

    /// An error names what is allowed.
    pub fn from_name(name: &str) -> Result<Self, String> {
        let named = Self::ALL.iter().find(|(n, _)| *n == name);
        named
            .map(|(_, aov)| *aov)
            .ok_or_else(|| "allowed: depth, normal, albedo, object, material, samples".into())
    }
}

/// What to write.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    pub format: Format,
    /// PNG only.
    pub depth: Depth,
    /// Curve and exposure: PNG only; `transparent`: PNG and EXR.
    pub display: Display,
    /// EXR only; those the film does not keep are left out.
    pub aovs: Vec<Aov>,
}

impl Settings {
    /// What the film itself asks for, with every auxiliary channel it has.
    pub fn of(film: &Film, format: Format) -> Self {
        let spec = film.spec();
        let display = Display {
            tonemap: spec.tonemap,
            exposure: spec.exposure,
            transparent: spec.transparent,
        };
        let aovs = if spec.aovs {
            Aov::ALL.map(|(_, aov)| aov).into()
        } else {
            Vec::new()
        };
        Self {
            format,
            depth: Depth::Eight,
            display,
            aovs,
        }
    }
}

/// Writes the film in the format of `settings`; the same film and settings give the same bytes.
pub fn write(film: &Film, settings: &Settings, out: &mut dyn Write) -> io::Result<()> {
    match settings.format {
        Format::Png => png::write(film, settings, out),
        Format::Exr => exr::write(film, settings, out),
        Format::Hdr => hdr::write(film, out),
        Format::Gfilm => gfilm::write(film, out),
    }
}

/// Writes into an opened file and gives it its name.
pub fn write_file(
    film: &Film,
    settings: &Settings,
    mut file: super::OutputFile,
) -> Result<(), FilmError> {
    let written = write(film, settings, &mut file);
    written.map_err(|e| FilmError::write(file.path(), e))?;
    file.commit()
}

/// What every picture file says about where it came from, in this order.
fn facts(film: &Film) -> [(&'static str, String); 7] {
    let spec = film.spec();
    [
        ("Software", format!("gonio {}", spec.version)),
        ("Film-Hash", film.hash().to_string()),
        ("Samples", film.samples().to_string()),
        ("Seed", spec.seed.to_string()),
        ("Integrator", spec.integrator.clone()),
        ("Scene", spec.scene_name.clone()),
        (
            "Scene-Digest",
            blake3::Hash::from(spec.scene_digest).to_string(),
        ),
    ]
}
