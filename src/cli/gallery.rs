//! `gonio render --gallery`: every scene of a folder as a picture, and a page that shows them all.

use super::Usage;
use super::interrupt::Interrupt;
use super::setup::{BackendFlags, SceneFlags, bake_scene, film_of};
use crate::film::display::encode;
use crate::film::{FilmError, OutputFile, Rect};
use crate::plot::lecture::{Panels, caption, formula, panels, plot};
use crate::plot::page::{Entry, page};
use crate::plot::panels::{Picture, labelled, side_by_side};
use crate::plot::{Format, render};
use crate::render::{Job, Watch};
use crate::scene::Location;
use crate::scene::SceneError;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::atomic::AtomicBool;

/// Size of the page's plots, pixels.
const PLOT: [u32; 2] = [900, 560];

/// Renders the `.toml` files of `folder` into `into`: a PNG each, and `index.html`.
pub fn run(folder: &Path, into: &Path, flags: &SceneFlags, backend: &BackendFlags) -> anyhow::Result<ExitCode> {
    let scenes = scenes_in(folder)?;
    let interrupt = Interrupt::listen()?;
    std::fs::create_dir_all(into).map_err(|error| FilmError::write(into, error))?;
    let mut entries = Vec::new();
    for path in &scenes {
        let entry = entry_of(path, flags, backend)?;
        write(&into.join(&entry.name).with_extension("png"), &entry.picture)?;
        entries.push(entry);
        if let Some(code) = interrupt.exit_code() {
            return Ok(ExitCode::from(code));
        }
    }
    // Rows first, in the lecture's order; scenes of no row after them.
    entries.sort_by_key(|entry| (entry.row.unwrap_or(u32::MAX), entry.name.clone()));
    let index = into.join("index.html");
    write(&index, page("Illumination models", &entries).as_bytes())?;
    writeln!(std::io::stdout(), "{} scenes, {}", entries.len(), index.display())?;
    Ok(ExitCode::SUCCESS)
}

fn write(path: &Path, bytes: &[u8]) -> Result<(), FilmError> {
    let mut file = OutputFile::open(path)?;
    file.write_all(bytes).map_err(|error| FilmError::write(path, error))?;
    file.commit()
}

/// The folder's scene files, by name.
fn scenes_in(folder: &Path) -> anyhow::Result<Vec<PathBuf>> {
    let unreadable = |source| SceneError::Io { location: Location::file(folder), source };
    let files = std::fs::read_dir(folder).map_err(unreadable)?;
    let paths: Result<Vec<PathBuf>, _> = files.map(|file| file.map(|file| file.path())).collect();
    let mut scenes = paths.map_err(unreadable)?;
    scenes.retain(|path| path.extension().is_some_and(|extension| extension == "toml"));
    scenes.sort();
    if scenes.is_empty() {
        return Err(Usage(format!("{}: no .toml scene in this folder", folder.display())).into());
    }
    Ok(scenes)
}

fn entry_of(path: &Path, flags: &SceneFlags, backend: &BackendFlags) -> anyhow::Result<Entry> {
    let unreadable = |source| SceneError::Io { location: Location::file(path), source };
    let text = std::fs::read_to_string(path).map_err(unreadable)?;
    let name = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    let picture = match panels(&name) {
        Panels::Columns(names) => labelled(&picture(path, flags, backend)?, names)?,
        Panels::Variants(variants) => {
            let one = |(name, key): &(&'static str, &str)| -> anyhow::Result<(&'static str, Picture)> {
                let mut flags = flags.clone();
                flags.set.push((*key).to_owned());
                Ok((name, self::picture(path, &flags, backend)?))
            };
            side_by_side(&variants.iter().map(one).collect::<anyhow::Result<Vec<_>>>()?)?
        }
    };
    let (row, caption) = caption(&text);
    let figure = row.and_then(plot).transpose()?;
    let plot = figure.map(|figure| render(&figure, Format::Svg, PLOT)).transpose()?;
    Ok(Entry {
        name,
        row,
        caption,
        formula: row.and_then(formula),
        picture: picture.png()?,
        plot: plot.map(|svg| String::from_utf8_lossy(&svg).into_owned()),
        text,
    })
}

/// The scene as a display shows it.
fn picture(path: &Path, flags: &SceneFlags, backend: &BackendFlags) -> anyhow::Result<Picture> {
    let scene = flags.load(path)?;
    let data = bake_scene(&scene)?;
    let mut film = film_of(&scene, &data, Rect::whole(scene.film.width, scene.film.height));
    let mut renderer = backend.renderer(&data)?;
    log::info!("{} on {}", path.display(), renderer.name());
    let watch = Watch { abort: &AtomicBool::new(false), advance: &|_| {} };
    renderer.accumulate(&Job { crop: film.crop(), samples: 0..scene.settings.samples }, &mut film, &watch)?;
    let codes = encode(&film.resolve(), &film.spec().display(), 255);
    let pixels = codes.iter().flat_map(|[r, g, b, _]| [*r as u8, *g as u8, *b as u8]).collect();
    Ok(Picture { width: scene.film.width, height: scene.film.height, pixels })
}
