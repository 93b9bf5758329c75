//! A scene file as the pictures that it asks for.

use super::toml::{self, Override};
use super::{finished, load_format, toml_text};
use crate::scene::{Scene, SceneError};
use std::path::{Path, PathBuf};

/// A scene file whose panels are loaded one after the other; most files have none.
pub struct Panels {
    path: PathBuf,
    /// Of a TOML scene, read once: standard input gives it only once.
    text: Option<String>,
    overrides: Vec<Override>,
    defines: Vec<(String, String)>,
    layout: toml::Layout,
}

impl Panels {
    /// Reads what `path` says of panels; arguments as of `load_with`.
    pub fn open(path: &Path, overrides: &[Override], defines: &[(String, String)]) -> Result<Self, SceneError> {
        let (overrides, defines) = (overrides.to_vec(), defines.to_vec());
        let (path, text, layout) = match toml_text(path, &defines)? {
            Some((name, text)) => {
                let layout = toml::Layout::from_text(&name, text.clone(), &overrides)?;
                (name, Some(text), layout)
            }
            None => (path.to_owned(), None, toml::Layout::default()),
        };
        Ok(Self { path, text, overrides, defines, layout })
    }

    /// What stands under each panel; none where the scene itself is the picture.
    pub fn labels(&self) -> &[String] {
        &self.layout.labels
    }

    /// The file's text; empty where it is no TOML.
    pub fn text(&self) -> &str {
        self.text.as_deref().unwrap_or_default()
    }

    /// Panels in a row.
    pub fn columns(&self) -> usize {
        self.layout.columns.map_or(self.labels().len(), |columns| columns as usize).max(1)
    }

    /// The scene of a panel, or the scene as it is without any panel's changes.
    pub fn scene(&self, panel: Option<usize>) -> Result<Scene, SceneError> {
        let scene = match (&self.text, panel) {
            (Some(text), Some(panel)) => toml::panel_from_text(&self.path, text.clone(), &self.overrides, panel),
            (Some(text), None) => toml::scene_from_text(&self.path, text.clone(), &self.overrides),
            (None, _) => load_format(&self.path, &self.overrides, &self.defines),
        };
        scene.map(finished)
    }
}
