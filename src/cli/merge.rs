//! `gonio merge`: one film of several.

use crate::film::display::tonemap_from_name;
use crate::film::read::read_film;
use crate::film::write::{self, Depth, Format, Settings};
use crate::film::{FilmError, OutputFile};
use crate::scene::ToneMap;
use anyhow::{Context, Result};
use clap::Args;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Adds films of the same picture with different samples; the result is the film of all samples at once, bit for bit.
///
/// One film alone is only converted. Prints the film hash.
#[derive(Args, Clone, Debug)]
pub struct MergeArgs {
    /// Films, `.gfilm`; `-` is standard input, once
    #[arg(required = true, value_name = "FILM")]
    pub films: Vec<PathBuf>,
    /// What to write: .gfilm, .png, .exr or .hdr; `-` is standard output
    #[arg(short, long, value_name = "FILE")]
    pub output: PathBuf,
    /// Format, where the output's name does not tell: png, exr, hdr, gfilm
    #[arg(long, value_name = "NAME", value_parser = format_name)]
    pub format: Option<Format>,
    /// Bits of a PNG: 8 or 16
    #[arg(long, value_name = "BITS", value_parser = bits, default_value = "8")]
    pub bits: Depth,
    /// Exposure of a PNG in stops [default: the film's]
    #[arg(long, value_name = "EV", allow_negative_numbers = true, value_parser = stops)]
    pub exposure: Option<f32>,
    /// Tone curve of a PNG: clamp, normalise, reinhard [default: the film's]
    #[arg(long, value_name = "NAME", value_parser = tonemap_from_name)]
    pub tonemap: Option<ToneMap>,
}

fn format_name(name: &str) -> Result<Format, String> {
    Format::from_name(name).ok_or_else(|| "allowed: png, exr, hdr, gfilm".into())
}

fn bits(text: &str) -> Result<Depth, String> {
    match text {
        "8" => Ok(Depth::Eight),
        "16" => Ok(Depth::Sixteen),
        _ => Err("allowed: 8, 16".into()),
    }
}

fn stops(text: &str) -> Result<f32, String> {
    match text.parse::<f32>() {
        Ok(value) if (-100.0..=100.0).contains(&value) => Ok(value),
        _ => Err("expected stops from -100 to 100".into()),
    }
}

/// Runs the subcommand.
pub fn run(args: &MergeArgs) -> Result<ExitCode> {
    if args
        .films
        .iter()
        .filter(|path| path.as_path() == Path::new("-"))
        .count()
        > 1
    {
        return Err(FilmError::Usage("only one film can be standard input".into()).into());
    }
    let format = match args.format {
        Some(format) => format,
        None => Format::from_path(&args.output)?,
    };
    let output = OutputFile::open(&args.output)?;
    let mut paths = args.films.iter();
    let first = paths.next().context("no film given")?;
    let mut film = read_film(first)?;
    for path in paths {
        let other = read_film(path)?;
        film.merge(&other)
            .map_err(|error| FilmError::bad(path, format!("cannot be merged: {error}")))?;
        if other.spec().version != film.spec().version {
            let (here, there) = (&film.spec().version, &other.spec().version);
            eprintln!(
                "warning: {}: made by gonio {there}, {} by gonio {here}",
                path.display(),
                first.display()
            );
        }
    }
    let mut settings = Settings::of(&film, format);
    settings.depth = args.bits;
    settings.display.exposure = args.exposure.unwrap_or(settings.display.exposure);
    settings.display.tonemap = args.tonemap.unwrap_or(settings.display.tonemap);
    let piped = output.is_stdout();
    write::write_file(&film, &settings, output)?;
    let report = format!("film {}\nsamples {}\n", film.hash(), film.samples());
    // stdout carries results only, and one at a time.
    match piped {
        true => eprint!("{report}"),
        false => std::io::stdout()
            .write_all(report.as_bytes())
            .context("cannot write standard output")?,
    }
    Ok(ExitCode::SUCCESS)
}
