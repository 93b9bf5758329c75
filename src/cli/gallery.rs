//! `gonio render --gallery`: every scene of a folder as a picture, and a page that shows them all.

use super::interrupt::Interrupt;
use super::setup::{BackendFlags, SceneFlags, bake_scene_with, check_film, film_of};
use super::sheet::{self, Sheet};
use super::team;
use super::{ExitCode, Usage};
use crate::bake::Baker;
use crate::film::{Film, FilmError, OutputFile, Rect};
use crate::plot::figure::Frame;
use crate::plot::lecture::{caption, numbered, plots};
use crate::plot::page::{Entry, Part, page};
use crate::plot::panels::Picture;
use crate::plot::{Figure, Format, render};
use crate::scene::{Location, Scene, SceneError};
use crate::watch::Watch;
use std::io::Write;
use std::path::{Path, PathBuf};

/// Width of the page's plots, pixels: a telephone shows it without loss.
const PLOT: u32 = 500;

/// Renders the `.toml` files of `folder` into `into`: a PNG each, and `index.html`.
pub fn run(folder: &Path, into: &Path, flags: &SceneFlags, backend: &BackendFlags) -> anyhow::Result<ExitCode> {
    let scenes = scenes_in(folder)?;
    let interrupt = Interrupt::listen()?;
    std::fs::create_dir_all(into).map_err(|error| FilmError::write(into, error))?;
    let mut parts: Vec<Part> = Vec::new();
    for path in &scenes {
        let entry = entry_of(path, into, flags, backend)?;
        match parts.iter_mut().find(|part| entry.row.is_some() && part.entries[0].row == entry.row) {
            Some(part) => part.entries.push(entry),
            None => parts.push(Part { entries: vec![entry] }),
        }
        if let Some(code) = interrupt.exit_code() {
            return Ok(ExitCode::from(code));
        }
    }
    // Rows first, in the lecture's order; scenes of no row after them.
    parts.sort_by_key(|part| part.entries[0].row.unwrap_or(u32::MAX));
    let index = into.join("index.html");
    write(&index, page("Illumination models", &parts).as_bytes())?;
    writeln!(std::io::stdout(), "{} scenes, {}", scenes.len(), index.display())?;
    Ok(ExitCode::SUCCESS)
}

/// The scene's plots as SVG.
fn plots_of(row: u32, title: &str, scene: &Scene) -> anyhow::Result<Vec<String>> {
    let svg = |figure: &Figure| {
        let height = match figure.frame {
            Frame::Bodies(_) | Frame::Ramp { .. } => 290,
            _ => 470,
        };
        Ok(String::from_utf8_lossy(&render(figure, Format::Svg, [PLOT, height])?).into_owned())
    };
    plots(row, title, scene)?.iter().map(svg).collect()
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

/// What the page shows of the scene in `path`, whose picture goes into `folder`.
fn entry_of(path: &Path, folder: &Path, flags: &SceneFlags, backend: &BackendFlags) -> anyhow::Result<Entry> {
    let stem = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    let sheet = Sheet::open(flags, path)?;
    let text = sheet.text().to_owned();
    let mut films = Vec::new();
    let mut baker = sheet.is_divided().then(Baker::default);
    for scene in sheet.scenes() {
        let (label, scene) = scene?;
        films.push((label.map(str::to_owned), film(&scene, baker.as_mut(), backend)?));
    }
    let pictures: Vec<_> = films.iter().map(|(label, film)| (label.clone(), sheet::displayed(film, 255))).collect();
    let whole = sheet::composed(&sheet, &pictures)?;
    write(&folder.join(&stem).with_extension("png"), &sheet::png(&whole)?)?;
    let png = |(label, picture): &(Option<String>, Picture)| Ok((label.clone(), sheet::png(picture)?));
    let (row, title) = numbered(&stem);
    Ok(Entry {
        row,
        title: title.replace('-', " "),
        caption: caption(&text),
        pictures: pictures.iter().map(png).collect::<anyhow::Result<_>>()?,
        columns: sheet.columns(),
        plots: row.map_or(Ok(Vec::new()), |row| plots_of(row, title, &flags.load(path)?))?,
        text,
        name: stem.clone(),
    })
}

/// All samples of the scene.
fn film(scene: &Scene, baker: Option<&mut Baker>, backend: &BackendFlags) -> anyhow::Result<Film> {
    let frame = Rect::whole(scene.film.width, scene.film.height);
    check_film(scene, frame)?;
    let data = bake_scene_with(scene, baker, &|| false)?;
    let film = film_of(scene, &data, frame);
    let session = team::session(backend, &data, film)?;
    session.render(0..scene.settings.samples, &Watch::default())?;
    log::info!("{} on {}", scene.name, session.names().join(" + "));
    Ok(session.into_film())
}
