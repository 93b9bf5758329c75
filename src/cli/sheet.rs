//! A scene file as one picture: the scene itself, or its panels side by side.

use super::Usage;
use super::output::{Backdrop, OutputFlags};
use super::setup::SceneFlags;
use crate::film::display::encode_over;
use crate::film::write::{Format, Plate, facts};
use crate::film::{Film, FilmError, OutputFile};
use crate::plot::panels::{self, Picture};
use crate::scene::Scene;
use crate::scene::load::Panels;
use std::io::Write;
use std::path::Path;

/// The panels of a scene file that the flags ask for.
pub struct Sheet<'a> {
    flags: &'a SceneFlags,
    panels: Panels,
    /// None: the scene as it is.
    chosen: Vec<Option<usize>>,
}

impl<'a> Sheet<'a> {
    /// All panels of `path`, or the one that `--panel` names.
    pub fn open(flags: &'a SceneFlags, path: &Path) -> anyhow::Result<Self> {
        let panels = flags.panels(path)?;
        let count = panels.labels().len();
        let chosen = match &flags.panel {
            Some(name) => vec![Some(find(panels.labels(), name)?)],
            None if count == 0 => vec![None],
            None => (0..count).map(Some).collect(),
        };
        Ok(Self { flags, panels, chosen })
    }

    /// Whether the picture is made of panels; otherwise it is that of one film.
    pub fn is_divided(&self) -> bool {
        self.flags.panel.is_none() && self.chosen != [None]
    }

    /// Each panel's name (None: the scene has no panels) and its scene, loaded when it is its turn.
    pub fn scenes(&self) -> impl Iterator<Item = anyhow::Result<(Option<&str>, Scene)>> {
        self.chosen.iter().map(|panel| {
            let label = panel.map(|index| self.panels.labels()[index].as_str());
            Ok((label, self.flags.adjusted(self.panels.scene(*panel)?)?))
        })
    }

    /// For what one film alone can do.
    pub fn refuse(&self, what: &str) -> Usage {
        let labels = quoted(self.panels.labels());
        Usage(format!("{what}: the scene has panels, each a film of its own; choose one by --panel: {labels}"))
    }

    /// Panels in a row.
    pub fn columns(&self) -> usize {
        self.panels.columns()
    }
}

/// The panel of this name or number.
fn find(labels: &[String], name: &str) -> Result<usize, Usage> {
    let index = labels.iter().position(|label| label == name).or_else(|| name.parse().ok());
    index.filter(|index| *index < labels.len()).ok_or_else(|| match labels.len() {
        0 => Usage(format!("--panel {name}: the scene has no panels")),
        _ => Usage(format!("--panel {name}: there are {}", quoted(labels))),
    })
}

fn quoted(labels: &[String]) -> String {
    labels.iter().map(|label| format!("{label:?}")).collect::<Vec<_>>().join(", ")
}

/// A film as a display shows it.
pub fn displayed(film: &Film, max: u16) -> Picture {
    displayed_over(film, None, max)
}

fn displayed_over(film: &Film, backdrop: Option<Backdrop>, max: u16) -> Picture {
    let image = film.resolve();
    let pixels = encode_over(&image, &film.spec().display(), backdrop.map(Backdrop::light), max);
    Picture { width: image.width, height: image.height, max, pixels }
}

/// The one picture, or all of them with their names.
pub fn composed(sheet: &Sheet, pictures: &[(Option<String>, Picture)]) -> anyhow::Result<Picture> {
    if let [(None, picture)] = pictures {
        return Ok(picture.clone());
    }
    let named: Vec<(&str, Picture)> =
        pictures.iter().map(|(label, picture)| (label.as_deref().unwrap_or_default(), picture.clone())).collect();
    Ok(panels::sheet(&named, sheet.columns())?)
}

/// A PNG of a picture without facts.
pub fn png(picture: &Picture) -> anyhow::Result<Vec<u8>> {
    let mut file = Vec::new();
    plate(picture, false, None).write(Format::Png, &[], &mut file)?;
    Ok(file)
}

fn plate(picture: &Picture, transparent: bool, gamma: Option<f32>) -> Plate<'_> {
    let (width, height) = (picture.width, picture.height);
    Plate { width, height, pixels: &picture.pixels, sixteen_bit: picture.max > 255, transparent, gamma }
}

/// Writes panels as one picture with their names, and prints of each what is printed of a film.
pub fn write(
    sheet: &Sheet,
    films: &mut [(Option<String>, Film)],
    flags: &OutputFlags,
    format: Format,
    mut output: OutputFile,
) -> anyhow::Result<()> {
    let max = if flags.sixteen_bit() && format == Format::Png { 65_535 } else { 255 };
    let (mut report, mut texts, mut pictures) = (String::new(), Vec::new(), Vec::new());
    for (label, film) in films.iter_mut() {
        flags.apply(film);
        let name = label.as_deref().unwrap_or_default();
        report += &format!("panel {name}\nfilm {}\nsamples {}\n", film.hash(), film.samples());
        texts.extend(facts(film).into_iter().map(|(keyword, text)| (keyword, format!("{name}: {text}"))));
        pictures.push((label.clone(), displayed_over(film, flags.background, max)));
    }
    let whole = composed(sheet, &pictures)?;
    // Panels that are encoded differently are compared as they are, on a display of sRGB.
    let gammas = films.iter().map(|(_, film)| film.spec().gamma);
    let gamma = gammas.reduce(|a, b| if a == b { a } else { None }).flatten();
    let transparent = flags.background.is_none() && films.iter().any(|(_, film)| film.spec().transparent);
    let written = plate(&whole, transparent, gamma).write(format, &texts, &mut output).and_then(|()| output.flush());
    written.map_err(|error| FilmError::write(output.path(), error))?;
    let piped = output.is_stdout();
    output.commit()?;
    super::output::print_report(&report, piped)
}

/// The format of a picture of panels: one that a display shows.
pub fn format_of(sheet: &Sheet, flags: &OutputFlags, path: &Path) -> anyhow::Result<Format> {
    let format = flags.format_of(path)?;
    match format {
        _ if format.is_displayed() => Ok(format),
        _ if sheet.is_divided() => Err(sheet.refuse(&format!("{} is no .png", path.display())).into()),
        _ => Ok(format),
    }
}
