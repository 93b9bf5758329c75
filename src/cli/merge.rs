//! `gonio merge`: one film of several.

use super::ExitCode;
use super::output::OutputFlags;
use crate::film::read::read_film;
use crate::film::write::Aov;
use crate::film::{FilmError, OutputFile};
use anyhow::{Context, Result};
use clap::Args;
use std::path::{Path, PathBuf};

/// Adds films of the same picture with different samples; the result is the film of all samples at once, bit for bit.
///
/// One film alone is only converted. Prints the film hash.
#[derive(Args, Clone, Debug)]
#[command(after_help = "\
Examples:
  gonio merge a.gfilm b.gfilm -o whole.gfilm              samples of two machines
  gonio merge a.gfilm b.gfilm -o whole.png                the picture that one machine would have made
  gonio merge film.gfilm -o picture.exr                   one film, converted
  gonio merge film.gfilm -o brighter.png --exposure 1     and displayed differently")]
pub struct MergeArgs {
    /// Films, `.gfilm`; `-` is standard input, once
    #[arg(required = true, value_name = "FILM")]
    pub films: Vec<PathBuf>,
    /// What to write: .gfilm, .png, .jpg, .webp, .exr or .hdr; `-` is standard output
    #[arg(short, long, value_name = "FILE")]
    pub output: PathBuf,
    #[command(flatten)]
    pub picture: OutputFlags,
}

/// Runs the subcommand.
pub fn run(args: &MergeArgs) -> Result<ExitCode> {
    if args.films.iter().filter(|path| path.as_path() == Path::new("-")).count() > 1 {
        return Err(FilmError::Usage("only one film can be standard input".into()).into());
    }
    let format = args.picture.format_of(&args.output)?;
    let output = OutputFile::open(&args.output)?;
    let mut paths = args.films.iter();
    let first = paths.next().context("no film given")?;
    let mut film = read_film(first)?;
    for path in paths {
        let other = read_film(path)?;
        film.merge(&other).map_err(|error| FilmError::bad(path, format!("cannot be merged: {error}")))?;
        if other.spec().version != film.spec().version {
            let (here, there) = (&film.spec().version, &other.spec().version);
            log::warn!("{}: made by gonio {there}, {} by gonio {here}", path.display(), first.display());
        }
    }
    let layers = if film.spec().aovs { Aov::ALL.map(|(_, aov)| aov).to_vec() } else { Vec::new() };
    args.picture.write(&mut film, format, &layers, output)?;
    Ok(ExitCode::SUCCESS)
}
