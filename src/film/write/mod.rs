//! Picture files of a film: one file per format.

mod exr;
mod hdr;
mod photo;
mod png;

pub use self::exr::write_linear;
pub use hdr::rgbe;
pub use png::write_rgb8;

use super::display::encode_over;
use super::{Film, FilmError, OutputFile, gfilm};
use std::io::{self, Write};
use std::path::Path;
use std::str::FromStr;

/// File formats that can be written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Displayed: tone curve, sRGB, 8 or 16 bits.
    Png,
    /// Displayed: tone curve, sRGB, 8 bits, lossy, without alpha.
    Jpeg,
    /// Displayed: tone curve, sRGB, 8 bits, lossless.
    Webp,
    /// Linear f32 and auxiliary channels.
    Exr,
    /// Linear, 8 bits and a shared exponent (Radiance).
    Hdr,
    /// The film itself.
    Gfilm,
}

impl Format {
    /// What there is, for messages.
    pub const NAMES: [&str; 6] = ["png", "jpg", "webp", "exr", "hdr", "gfilm"];

    /// By its name or a file's extension, in any case.
    pub fn from_name(name: &str) -> Option<Self> {
        match name.to_ascii_lowercase().as_str() {
            "png" => Some(Self::Png),
            "jpg" | "jpeg" => Some(Self::Jpeg),
            "webp" => Some(Self::Webp),
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
        extension.and_then(|e| Self::from_name(&e)).ok_or_else(|| {
            FilmError::Usage(format!("{}: {found}; allowed: .{}", path.display(), Self::NAMES.join(", .")))
        })
    }

    /// Whether files of this format hold what a display shows.
    pub fn is_displayed(self) -> bool {
        matches!(self, Self::Png | Self::Jpeg | Self::Webp)
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
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Picture<'a> {
    pub format: Format,
    /// PNG only: 16 bits a channel instead of 8.
    pub sixteen_bit: bool,
    /// Displayed formats only: what a film without a background is shown before, linear Rec. 709 of the display, 0 to 1.
    pub backdrop: Option<[f32; 3]>,
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
            Format::Png | Format::Jpeg | Format::Webp => self.write_displayed(film, out),
            Format::Exr => exr::write(film, self.aovs, out),
            Format::Hdr => hdr::write(film, out),
            Format::Gfilm => gfilm::write(film, out),
        }
    }
}

impl Picture<'_> {
    /// The displayed film with the facts as text.
    fn write_displayed(&self, film: &Film, out: &mut dyn Write) -> io::Result<()> {
        let image = film.resolve();
        let display = film.spec().display();
        let sixteen_bit = self.sixteen_bit && self.format == Format::Png;
        let pixels = encode_over(&image, &display, self.backdrop, if sixteen_bit { 65_535 } else { 255 });
        let plate = Plate {
            width: image.width,
            height: image.height,
            pixels: &pixels,
            sixteen_bit,
            transparent: display.transparent && self.backdrop.is_none(),
            gamma: display.gamma,
        };
        plate.write(self.format, &facts(film), out)
    }
}

/// A displayed picture: what `encode` gives, and what else a file says of it.
#[derive(Clone, Copy, Debug)]
pub struct Plate<'a> {
    pub width: u32,
    pub height: u32,
    /// Integers of 0..=255, or 0..=65,535.
    pub pixels: &'a [[u16; 4]],
    /// PNG only.
    pub sixteen_bit: bool,
    /// With alpha.
    pub transparent: bool,
    /// None: sRGB. Only PNG says it.
    pub gamma: Option<f32>,
}

impl Plate<'_> {
    /// As a file of a displayed format with `facts`, keywords and texts.
    pub fn write(&self, format: Format, facts: &[(&'static str, String)], out: &mut dyn Write) -> io::Result<()> {
        match format {
            Format::Jpeg | Format::Webp => photo::write(self, format, facts, out),
            _ => png::write(self, facts, out),
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
