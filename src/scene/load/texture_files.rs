//! Pictures that several materials use are decoded once and kept once.

use super::image::{ColorSpace, load_texture};
use crate::scene::{SceneError, Texture, TextureId};
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// The pictures read so far, as they lie in their files.
#[derive(Debug, Default)]
pub struct TextureFiles {
    read: HashMap<(PathBuf, bool), Texture>,
}

impl TextureFiles {
    /// The texture in `path`; its texels are shared with every other user of the file.
    pub fn load(&mut self, path: &Path, space: ColorSpace) -> Result<Texture, SceneError> {
        let key = (path.to_owned(), space == ColorSpace::Linear);
        if let Some(texture) = self.read.get(&key) {
            return Ok(texture.clone());
        }
        let texture = load_texture(path, space)?;
        self.read.insert(key, texture.clone());
        Ok(texture)
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
