//! Flags of every command that writes a picture of a film.

use crate::film::tone::tonemap_from_name;
use crate::film::write::{Aov, Format, Picture};
use crate::film::{Film, FilmError, OutputFile};
use crate::scene::load::toml::color_from_text;
use crate::scene::{Rgb, ToneMap};
use anyhow::{Context, Result};
use clap::Args;
use std::io::Write;
use std::path::Path;

#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Output")]
pub struct OutputFlags {
    /// Format, where the output's name does not tell: png, jpg, webp, exr, hdr, gfilm.
    #[arg(long, value_name = "NAME", value_parser = format_name)]
    pub format: Option<Format>,
    /// Bits a channel of a PNG.
    #[arg(long, default_value = "8", value_parser = ["8", "16"])]
    pub bits: String,
    /// Exposure of a picture for displays in stops; the scene's if not given.
    #[arg(long, value_name = "EV", allow_negative_numbers = true, value_parser = stops)]
    pub exposure: Option<f32>,
    /// Tone curve of a picture for displays: clamp, normalise, reinhard, aces, agx; the scene's if not given.
    #[arg(long, value_name = "NAME", value_parser = tonemap_from_name)]
    pub tonemap: Option<ToneMap>,
    /// Encoding of a picture for displays: light to the power 1/N, or `srgb`; the scene's if not given.
    #[arg(long, value_name = "N|srgb", allow_negative_numbers = true, value_parser = gamma)]
    pub gamma: Option<Gamma>,
    /// A colour behind everything instead of what surrounds the scene, which lights it all the same: white, #20242c or
    /// [0.1,0.2,0.3]. A model then stands on no ground. Formats of linear light keep it as alpha.
    #[arg(long, value_name = "COLOR", value_parser = backdrop)]
    pub background: Option<Backdrop>,
}

/// Linear light of the display.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Backdrop(pub Rgb);

impl Backdrop {
    /// Its channels, 0 to 1.
    pub fn light(self) -> [f32; 3] {
        self.0.to_array()
    }
}

fn backdrop(text: &str) -> Result<Backdrop, String> {
    let color = color_from_text(text).filter(|color| color.max_element() <= 1.0);
    color.map(Backdrop).ok_or_else(|| "expected a colour: a name, #rrggbb, or [r,g,b] of linear light, 0 to 1".into())
}

fn format_name(name: &str) -> Result<Format, String> {
    Format::from_name(name).ok_or_else(|| format!("allowed: {}", Format::NAMES.join(", ")))
}

fn stops(text: &str) -> Result<f32, String> {
    match text.parse::<f32>() {
        Ok(value) if (-100.0..=100.0).contains(&value) => Ok(value),
        _ => Err("expected stops from -100 to 100".into()),
    }
}

/// None is sRGB. A type of its own: a flag's `Option` says whether it was given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gamma(pub Option<f32>);

fn gamma(text: &str) -> Result<Gamma, String> {
    match text.parse::<f32>() {
        Ok(value) if (0.1..=10.0).contains(&value) => Ok(Gamma(Some(value))),
        _ if text == "srgb" => Ok(Gamma(None)),
        _ => Err("expected srgb or a number from 0.1 to 10".into()),
    }
}

impl OutputFlags {
    /// The format for `path`.
    pub fn format_of(&self, path: &Path) -> Result<Format, FilmError> {
        self.format.map_or_else(|| Format::of(path), Ok)
    }

    /// Bits a channel of a PNG.
    pub fn sixteen_bit(&self) -> bool {
        self.bits == "16"
    }

    /// Displays the film as the flags say.
    pub fn apply(&self, film: &mut Film) {
        let tonemap = self.tonemap.unwrap_or(film.spec().tonemap);
        let gamma = self.gamma.map_or(film.spec().gamma, |Gamma(gamma)| gamma);
        film.set_display(tonemap, self.exposure.unwrap_or(film.spec().exposure), gamma);
    }

    /// Writes the film and prints its hash and samples.
    pub fn write(&self, film: &mut Film, format: Format, aovs: &[Aov], mut output: OutputFile) -> Result<()> {
        self.apply(film);
        let picture =
            Picture { format, sixteen_bit: self.sixteen_bit(), backdrop: self.background.map(Backdrop::light), aovs };
        picture.write(film, &mut output)?;
        let piped = output.is_stdout();
        output.commit()?;
        print_report(&format!("film {}\nsamples {}\n", film.hash(), film.samples()), piped)
    }
}

/// Prints on stdout, unless that carries the picture.
pub fn print_report(report: &str, piped: bool) -> Result<()> {
    if piped {
        return std::io::stderr().write_all(report.as_bytes()).context("cannot write standard error");
    }
    std::io::stdout().write_all(report.as_bytes()).context("cannot write standard output")
}
