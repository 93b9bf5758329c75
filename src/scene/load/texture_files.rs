//! Pictures that several materials use are decoded once and kept once.

use super::image::{ColorSpace, load_texture, load_texture_for};
use crate::picture::Purpose;
use crate::scene::{SceneError, Texture, TextureId};
use std::collections::HashMap;
use std::fmt::Display;
use std::path::{Path, PathBuf};

/// The pictures read so far, as they lie in their files.
#[derive(Debug, Default)]
pub struct TextureFiles {
    read: HashMap<(PathBuf, bool), Texture>,
    /// EXR and HDR files are read as Mitsuba reads them.
    as_mitsuba: bool,
}

impl TextureFiles {
    /// Of a scene of Mitsuba's.
    pub fn of_mitsuba() -> Self {
        Self { as_mitsuba: true, ..Self::default() }
    }

    /// The texture in `path`; its texels are shared with every other user of the file.
    pub fn load(&mut self, path: &Path, space: ColorSpace) -> Result<Texture, SceneError> {
        let key = (path.to_owned(), space == ColorSpace::Linear);
        if let Some(texture) = self.read.get(&key) {
            return Ok(texture.clone());
        }
        let texture = match self.as_mitsuba {
            true => load_texture_for(path, space, Purpose::Mitsuba)?,
            false => load_texture(path, space)?,
        };
        self.read.insert(key, texture.clone());
        Ok(texture)
    }
}

/// What becomes of a texture whose file cannot be read, in scenes of every format: the scene is drawn without it, and a warning
/// says so. A file that can be read and is no picture stays an error. `asked`: the place that asks for the file.
pub fn or_absent<T>(
    read: Result<T, SceneError>,
    asked: impl Display,
    warnings: &mut Vec<String>,
) -> Result<Option<T>, SceneError> {
    match read {
        Ok(texture) => Ok(Some(texture)),
        Err(error) if error.is_io() => {
            let (asked, error) = (asked.to_string(), error.to_string());
            // Some errors name that place already.
            let reason = error.strip_prefix(&format!("{asked}: ")).unwrap_or(&error);
            let warning = format!("{asked}: no texture: {reason}");
            if !warnings.contains(&warning) {
                warnings.push(warning);
            }
            Ok(None)
        }
        Err(error) => Err(error),
    }
}

/// The index of `texture` in `textures`, where it is put unless an equal one is there.
pub fn intern(textures: &mut Vec<Texture>, texture: Texture) -> TextureId {
    let known = textures.iter().position(|other| *other == texture);
    let index = known.unwrap_or_else(|| {
        textures.push(texture);
        textures.len() - 1
    });
    TextureId(index as u32)
}
