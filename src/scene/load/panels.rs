//! A scene file as the pictures that it asks for.

use super::toml::{self, Override};
use super::{Controls, finished, load_format, toml_text};
use crate::scene::{Scene, SceneError};
use std::path::{Path, PathBuf};

/// A scene file whose panels are loaded one after the other; most files have none.
pub struct Panels {
    path: PathBuf,
    /// Of a TOML scene, read once: standard input gives it only once.
    text: Option<String>,
    overrides: Vec<Override>,
    defines: Vec<(String, String)>,
    controls: Controls,
    layout: toml::Layout,
}

impl Panels {
    /// Reads what `path` says of panels. `defines`: values for the parameters of a Mitsuba scene; other formats have none.
    pub fn open(path: &Path, overrides: &[Override], defines: &[(String, String)]) -> Result<Self, SceneError> {
        let (overrides, defines) = (overrides.to_vec(), defines.to_vec());
        let (path, text, layout) = match toml_text(path, &defines)? {
            Some((name, text)) => {
                let layout = toml::Layout::from_text(&name, text.clone(), &overrides)?;
                (name, Some(text), layout)
            }
            None => (path.to_owned(), None, toml::Layout::default()),
        };
        Ok(Self { path, text, overrides, defines, controls: Controls::default(), layout })
    }

    /// With every scene as `controls` want it.
    #[must_use]
    pub fn controlled(self, controls: Controls) -> Self {
        Self { controls, ..self }
    }

    /// What stands under each panel; none where the scene itself is the picture.
    pub fn labels(&self) -> &[String] {
        &self.layout.labels
    }

    /// Panels in a row.
    pub fn columns(&self) -> usize {
        self.layout.columns.map_or(self.labels().len(), |columns| columns as usize).max(1)
    }

    /// The scene of a panel, or the scene as it is without any panel's changes.
    pub fn scene(&self, panel: Option<usize>) -> Result<Scene, SceneError> {
        let Some(text) = &self.text else {
            return load_format(&self.path, &self.overrides, &self.defines, &self.controls).map(finished);
        };
        let (text, overrides) = self.controls.written_into(text.clone(), &self.overrides);
        let mut scene = match panel {
            Some(panel) => toml::panel_from_text(&self.path, text, &overrides, panel)?,
            None => toml::scene_from_text(&self.path, text, &overrides)?,
        };
        self.controls.adjust(&mut scene)?;
        Ok(finished(scene))
    }
}
