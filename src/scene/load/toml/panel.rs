//! `[[panel]]`: the same scene several times side by side, each time with some keys changed.

use super::document::{Document, Place, Value};
use super::format::{FILM, PANEL, SCENE};
use super::overrides::Override;
use super::reader::{Reader, Result};
use super::scene_from_document;
use crate::scene::Scene;
use std::path::Path;

/// The panels of a scene file and how they stand.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Layout {
    pub labels: Vec<String>,
    /// In a row; None: all of them.
    pub columns: Option<u32>,
}

/// A change, and where it was written.
type Change = (Override, Place);

impl Layout {
    /// What `text` says of panels, which may be nothing.
    pub fn from_text(file: &Path, text: String, overrides: &[Override]) -> Result<Self> {
        let mut document = Document::parse(file, text)?;
        document.apply(overrides)?;
        match document.attempt(|| Self::read(&document)) {
            Some(layout) if !document.is_faulty() => Ok(layout),
            // The scene's faults are told beside those of its panels.
            _ => scene_from_document(&document).map(|_| Self::default()),
        }
    }

    fn read(document: &Document) -> Result<Self> {
        let root = Reader::open(document, &document.root, &SCENE)?;
        let mut layout = Self::default();
        for panel in root.tables("panel", &PANEL)? {
            let label = panel.required("label", panel.text("label")?)?;
            if layout.labels.iter().any(|known| known == label) {
                return Err(panel.bad("label", format!("there are two panels {label:?}")));
            }
            changes(&panel)?;
            layout.labels.push(label.to_owned());
        }
        layout.columns = root.table("film", &FILM)?.map(|film| film.integer("columns")).transpose()?.flatten();
        Ok(layout)
    }
}

/// The scene of panel number `panel`: its changes first, then `overrides`.
pub fn panel_from_text(file: &Path, text: String, overrides: &[Override], panel: usize) -> Result<Scene> {
    let mut document = Document::parse(file, text)?;
    // Once for what they say of panels, and once more below to have the last word.
    document.apply(overrides)?;
    let changes = {
        let root = Reader::open(&document, &document.root, &SCENE)?;
        root.tables("panel", &PANEL)?.get(panel).map(changes).transpose()?.unwrap_or_default()
    };
    for (change, place) in &changes {
        document.change(change, *place)?;
    }
    document.apply(overrides)?;
    scene_from_document(&document)
}

fn changes(panel: &Reader) -> Result<Vec<Change>> {
    let items = panel.array("set")?.unwrap_or_default();
    let change = |item: &super::document::Node| match &item.value {
        Value::String(text) => {
            let change = text.parse::<Override>().map_err(|message| panel.document.bad(item.place, message))?;
            Ok((change, item.place))
        }
        _ => Err(panel.mismatch("set", item)),
    };
    items.iter().map(change).collect()
}
