//! `gonio render --gallery`: every scene of a folder as a picture, and a page that shows them all.

use super::interrupt::Interrupt;
use super::setup::{BackendFlags, SceneFlags, bake_scene_with, check_film, film_of};
use super::sheet::{self, Sheet};
use super::team;
use super::{ExitCode, Usage};
use crate::bake::{BakeError, Baker};
use crate::film::{Film, FilmError, OutputFile, Rect};
use crate::plot::figure::Frame;
use crate::plot::lecture::{ROWS, caption, numbered, plots};
use crate::plot::page::{self, Content, Entry, Part, page};
use crate::plot::panels::Picture;
use crate::plot::{Figure, Format, render};
use crate::scene::{Location, Scene, SceneError};
use crate::watch::Watch;
use std::io::Write;
use std::path::{Path, PathBuf};

/// Width of the page's plots, pixels: a telephone shows it without loss.
const PLOT: u32 = 500;

/// Renders the `.toml` files of `folder` into `into`: a PNG each, and `index.html`. What that page has already is not rendered
/// again; where the user interrupts, the page is written with what there is.
pub fn run(folder: &Path, into: &Path, flags: &SceneFlags, backend: &BackendFlags) -> anyhow::Result<ExitCode> {
    let scenes = scenes_in(folder)?;
    let interrupt = Interrupt::listen()?;
    std::fs::create_dir_all(into).map_err(|error| FilmError::write(into, error))?;
    let index = into.join("index.html");
    let before = std::fs::read_to_string(&index).unwrap_or_default();
    let gallery = Gallery { into, flags, backend, interrupt: &interrupt, before };
    let mut parts: Vec<Part> = Vec::new();
    let mut kept = 0;
    let mut to_come: Vec<String> = Vec::new();
    for path in &scenes {
        let entry = match interrupt.exit_code() {
            None => gallery.entry_of(path)?,
            Some(_) => None,
        };
        let Some((entry, is_kept)) = entry else {
            to_come.push(stem(path));
            continue;
        };
        kept += usize::from(is_kept);
        match parts.iter_mut().find(|part| entry.row.is_some() && part.entries[0].row == entry.row) {
            Some(part) => part.entries.push(entry),
            None => parts.push(Part { entries: vec![entry] }),
        }
    }
    // Rows first, in the lecture's order; scenes of no row after them.
    parts.sort_by_key(|part| part.entries[0].row.unwrap_or(u32::MAX));
    let shown: Vec<u32> = scenes.iter().filter_map(|path| numbered(&stem(path)).0).collect();
    if !shown.is_empty() {
        let missing = ROWS.iter().filter(|row| !shown.contains(&row.number));
        to_come.extend(missing.map(|row| format!("{} {}", row.number, row.title)));
    }
    let facts = format!("gonio {}", env!("CARGO_PKG_VERSION"));
    write(&index, page("Illumination models", &facts, &parts, &to_come).as_bytes())?;
    let told = if kept > 0 { format!(", {kept} as they were") } else { String::new() };
    writeln!(std::io::stdout(), "{} scenes{told}, {}", scenes.len(), index.display())?;
    Ok(interrupt.exit_code().map_or(ExitCode::SUCCESS, ExitCode::from))
}

fn stem(path: &Path) -> String {
    path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default()
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

/// What is being made.
struct Gallery<'a> {
    into: &'a Path,
    flags: &'a SceneFlags,
    backend: &'a BackendFlags,
    interrupt: &'a Interrupt,
    /// The page that is there.
    before: String,
}

impl Gallery<'_> {
    /// What the page shows of the scene in `path`, and whether it did before; none where the user interrupts.
    fn entry_of(&self, path: &Path) -> anyhow::Result<Option<(Entry, bool)>> {
        let unreadable = |source| SceneError::Io { location: Location::file(path), source };
        let text = std::fs::read_to_string(path).map_err(unreadable)?;
        let (stem, key) = (stem(path), self.key(path, &text));
        let picture = self.into.join(&stem).with_extension("png");
        let kept = page::kept(&self.before, &stem, &key).filter(|_| picture.is_file());
        let is_kept = kept.is_some();
        let Some(body) = kept.map_or_else(|| self.body(path, &picture, text), |body| Ok(Some(body)))? else {
            return Ok(None);
        };
        let (row, title) = numbered(&stem);
        Ok(Some((Entry { row, title: title.replace('-', " "), key, body, name: stem.clone() }, is_kept)))
    }

    /// Stands for what a scene's picture and HTML depend on: the program, the flags, the scene file and the files it names.
    fn key(&self, path: &Path, text: &str) -> String {
        let mut hasher = blake3::Hasher::new();
        hasher.update(format!("{} {:?}\n{text}", env!("CARGO_PKG_VERSION"), self.flags).as_bytes());
        let folder = path.parent().unwrap_or(Path::new(""));
        // Every word in quotation marks that is a file's name; what is none changes nothing.
        for file in text.split('"').map(|word| folder.join(word)).filter(|file| file.is_file()) {
            if let Ok(bytes) = std::fs::read(&file) {
                hasher.update(&bytes);
            }
        }
        hasher.finalize().to_hex()[..32].to_owned()
    }

    /// Renders the scene into `picture`, and gives its HTML.
    fn body(&self, path: &Path, picture: &Path, text: String) -> anyhow::Result<Option<String>> {
        let sheet = Sheet::open(self.flags, path)?;
        let mut films = Vec::new();
        let mut settings = String::new();
        let mut baker = sheet.is_divided().then(Baker::default);
        for scene in sheet.scenes() {
            let (label, scene) = scene?;
            let Some(film) = self.film(&scene, baker.as_mut())? else { return Ok(None) };
            let spec = film.spec();
            let (size, samples) = (format!("{} x {}", spec.width, spec.height), scene.settings.samples);
            settings = format!("{}, {samples} samples, seed {}, {size} pixels", spec.integrator, spec.seed);
            films.push((label.map(str::to_owned), film));
        }
        let pictures: Vec<_> = films.iter().map(|(label, film)| (label.clone(), sheet::displayed(film, 255))).collect();
        let whole = sheet::composed(&sheet, &pictures)?;
        write(picture, &sheet::png(&whole)?)?;
        let png = |(label, picture): &(Option<String>, Picture)| Ok((label.clone(), sheet::png(picture)?));
        let name = stem(path);
        let (row, title) = numbered(&name);
        Ok(Some(page::body(&Content {
            caption: caption(&text),
            settings,
            pictures: pictures.iter().map(png).collect::<anyhow::Result<_>>()?,
            columns: sheet.columns(),
            plots: row.map_or(Ok(Vec::new()), |row| plots_of(row, title, &self.flags.load(path)?))?,
            text,
            name: name.clone(),
        })))
    }

    /// All samples of the scene; none where the user interrupts.
    fn film(&self, scene: &Scene, baker: Option<&mut Baker>) -> anyhow::Result<Option<Film>> {
        let frame = Rect::whole(scene.film.width, scene.film.height);
        check_film(scene, frame)?;
        let asked = || self.interrupt.exit_code().is_some();
        let data = match bake_scene_with(scene, baker, &asked) {
            Err(error) if matches!(error.downcast_ref(), Some(BakeError::Aborted)) => return Ok(None),
            data => data?,
        };
        let film = film_of(scene, &data, frame);
        let session = team::session(self.backend, &data, film)?;
        match session.render(0..scene.settings.samples, &Watch::default().asking(&asked)) {
            Err(_) if asked() => return Ok(None),
            rendered => rendered?,
        };
        log::info!("{} on {}", scene.name, session.names().join(" + "));
        let film = session.into_film();
        // Part of a picture is not shown.
        Ok(Some(film).filter(|film| film.samples().total() == u64::from(scene.settings.samples)))
    }
}
