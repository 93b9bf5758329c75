//! Pictures that several materials use are decoded once and kept once; and files that others name.

use super::confine;
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

/// What becomes of a texture whose file is not there, in scenes of every format: the scene is drawn without it, and a warning
/// says so. A file that is there and is no picture stays an error. `asked`: the place that asks for the file.
pub fn or_absent<T>(
    read: Result<T, SceneError>,
    asked: impl Display,
    warnings: &mut Vec<String>,
) -> Result<Option<T>, SceneError> {
    match read {
        Ok(texture) => Ok(Some(texture)),
        Err(error) if error.is_absent() => {
            let (asked, error) = (asked.to_string(), error.to_string());
            // Some errors name that place already.
            let reason = error.strip_prefix(&format!("{asked}: ")).unwrap_or(&error);
            warnings.push(format!("{asked}: no texture: {reason}"));
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

/// The file that `name` in a file of `folder` means. Paths from Windows are read everywhere; where the file is not at the
/// place of another computer that its path tells, it may lie in `folder`.
pub fn beside(folder: &Path, name: &str) -> PathBuf {
    let name = name.replace('\\', "/");
    let path = folder.join(&name);
    if !confine::is_file(&path)
        && let Some((_, last)) = name.rsplit_once('/')
        && confine::is_file(&folder.join(last))
    {
        return folder.join(last);
    }
    path
}

/// Names after a keyword: several, each of which may stand in quotation marks, or one that has spaces.
pub fn words_or_whole(folder: &Path, text: &str) -> Vec<String> {
    let is_one = confine::is_file(&beside(folder, text));
    if is_one || !text.contains(char::is_whitespace) {
        return if text.is_empty() { Vec::new() } else { vec![text.to_owned()] };
    }
    let mut names = vec![String::new()];
    let mut is_quoted = false;
    for character in text.chars() {
        is_quoted ^= character == '"';
        if character.is_whitespace() && !is_quoted {
            names.push(String::new());
        } else if let Some(name) = names.last_mut() {
            name.push(character);
        }
    }
    names.retain(|name| !name.is_empty());
    names
}
