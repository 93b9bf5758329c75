//! Images, samplers and texture transforms.

use super::Failure;
use super::source::{Buffers, file_of, read_uri};
use crate::scene::load::image::{ColorSpace, texture_from_bytes};
use crate::scene::load::texture_files::or_absent;
use crate::scene::{SceneError, Texture, TextureData, Wrap};
use gltf::json::extensions::texture::TextureTransform;
use gltf::json::texture::{Info, MagFilter, WrappingMode};
use gltf::json::validation::Checked;
use gltf::json::{Image, Root};
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// Reads and shares the pictures of one file.
pub(super) struct Textures<'a> {
    pub root: &'a Root,
    pub buffers: &'a Buffers<'a>,
    pub folder: &'a Path,
    /// The glTF itself, for messages.
    pub file: &'a Path,
    /// None: its file is not there.
    pictures: HashMap<(usize, bool), Option<Texture>>,
    opaque: HashMap<usize, bool>,
    /// What the scene goes without.
    pub warnings: Vec<String>,
}

impl<'a> Textures<'a> {
    pub fn new(root: &'a Root, buffers: &'a Buffers<'a>, folder: &'a Path, file: &'a Path) -> Self {
        Self { root, buffers, folder, file, pictures: HashMap::new(), opaque: HashMap::new(), warnings: Vec::new() }
    }

    /// The texture that `info` asks for, as it is to be laid on; none if its file is not there.
    pub fn texture(&mut self, info: &Info, space: ColorSpace, place: &str) -> Result<Option<Texture>, Failure> {
        let (image, wraps, nearest) = self.resolve(info, place)?;
        let Some(mut texture) = self.picture(image, space)?.cloned() else { return Ok(None) };
        [texture.wrap_u, texture.wrap_v] = wraps;
        texture.bilinear = !nearest;
        lay_on(&mut texture, info);
        Ok(Some(texture))
    }

    /// Whether no texel of the picture lets anything through.
    pub fn is_opaque(&mut self, info: &Info, place: &str) -> Result<bool, Failure> {
        let (image, ..) = self.resolve(info, place)?;
        if let Some(opaque) = self.opaque.get(&image) {
            return Ok(*opaque);
        }
        let opaque = match self.picture(image, ColorSpace::Srgb)?.map(|picture| &picture.data) {
            Some(TextureData::Srgb8(texels) | TextureData::Linear8(texels)) => {
                texels.iter().all(|texel| texel[3] == 255)
            }
            Some(TextureData::Float(texels)) => texels.iter().all(|texel| texel[3] >= 1.0),
            Some(TextureData::Pattern(_)) | None => true,
        };
        self.opaque.insert(image, opaque);
        Ok(opaque)
    }

    /// Mean of the picture's red channel, 0 to 1.
    pub fn mean_red(&mut self, info: &Info, place: &str) -> Result<f32, Failure> {
        let (image, ..) = self.resolve(info, place)?;
        let mean = |texels: &[[u8; 4]]| {
            let sum: u64 = texels.iter().map(|texel| u64::from(texel[0])).sum();
            sum as f64 / (255.0 * texels.len().max(1) as f64)
        };
        Ok(match self.picture(image, ColorSpace::Linear)?.map(|picture| &picture.data) {
            Some(TextureData::Srgb8(texels) | TextureData::Linear8(texels)) => mean(texels) as f32,
            Some(TextureData::Float(texels)) => {
                let sum: f64 = texels.iter().map(|texel| f64::from(texel[0])).sum();
                (sum / texels.len().max(1) as f64) as f32
            }
            Some(TextureData::Pattern(_)) | None => 1.0,
        })
    }

    /// Image index, wrap modes, and whether the nearest texel is wanted.
    fn resolve(&self, info: &Info, place: &str) -> Result<(usize, [Wrap; 2], bool), Failure> {
        let Some(texture) = self.root.textures.get(info.index.value()) else {
            let message = format!("refers to texture {}; there are {}", info.index, self.root.textures.len());
            return Err(Failure::new(place, message));
        };
        let place = format!("textures[{}]", info.index);
        let webp = texture
            .extensions
            .as_ref()
            .and_then(|e| e.others.get("EXT_texture_webp")?.get("source")?.as_u64())
            .and_then(|source| usize::try_from(source).ok());
        let image = webp.unwrap_or(texture.source.value());
        if image >= self.root.images.len() {
            let message = format!("has no image, or one of {} that is not there", self.root.images.len());
            return Err(Failure::new(place, message));
        }
        let Some(sampler) = texture.sampler else {
            return Ok((image, [Wrap::Repeat; 2], false));
        };
        let Some(sampler) = self.root.samplers.get(sampler.value()) else {
            let message = format!("refers to sampler {sampler}; there are {}", self.root.samplers.len());
            return Err(Failure::new(place, message));
        };
        let wrap = |mode: &Checked<WrappingMode>| match mode {
            Checked::Valid(WrappingMode::ClampToEdge) => Wrap::Clamp,
            Checked::Valid(WrappingMode::MirroredRepeat) => Wrap::Mirror,
            Checked::Valid(WrappingMode::Repeat) | Checked::Invalid => Wrap::Repeat,
        };
        let nearest = matches!(sampler.mag_filter, Some(Checked::Valid(MagFilter::Nearest)));
        Ok((image, [wrap(&sampler.wrap_s), wrap(&sampler.wrap_t)], nearest))
    }

    /// The picture as it lies in its file; none, with a warning, if the file is not there.
    fn picture(&mut self, index: usize, space: ColorSpace) -> Result<Option<&Texture>, Failure> {
        let key = (index, space == ColorSpace::Srgb);
        if !self.pictures.contains_key(&key) {
            let read = self.read(index, space).map_err(|failure| failure.at(self.file));
            let asked = format!("{}: images[{index}]", self.file.display());
            let picture = or_absent(read, asked, &mut self.warnings).map_err(|e| Failure::Other(Box::new(e)))?;
            self.pictures.insert(key, picture);
        }
        Ok(self.pictures[&key].as_ref())
    }

    fn read(&self, index: usize, space: ColorSpace) -> Result<Texture, Failure> {
        let image: &Image = &self.root.images[index];
        let place = format!("images[{index}]");
        let label = PathBuf::from(format!("{}: {place}", self.file.display()));
        let decoded = |bytes: &[u8], name: &Path| {
            texture_from_bytes(bytes, name, space).map_err(|e: SceneError| Failure::Other(Box::new(e)))
        };
        match (&image.uri, image.buffer_view) {
            (Some(uri), _) => {
                let bytes = read_uri(uri, self.folder, &place)?;
                let name = if uri.starts_with("data:") { label } else { file_of(uri, self.folder).unwrap_or(label) };
                decoded(&bytes, &name)
            }
            (None, Some(view)) => decoded(self.buffers.view(self.root, view, &place)?.0, &label),
            (None, None) => Err(Failure::new(place, "has neither uri nor bufferView")),
        }
    }
}

/// Set of texture coordinates that `info` uses.
pub(super) fn coordinate_set(info: &Info) -> u32 {
    transform_of(info).and_then(|t| t.tex_coord).unwrap_or(info.tex_coord)
}

fn transform_of(info: &Info) -> Option<&TextureTransform> {
    info.extensions.as_ref()?.texture_transform.as_ref()
}

/// KHR_texture_transform: offset times rotation times scale, in glTF's uvs, whose v points down the image. A positive
/// rotation turns u towards -v: the matrix printed in the extension has the other sign, a known slip (KhronosGroup/glTF
/// issue 1563). Ours has v' = 1 - v on both sides of it.
fn lay_on(texture: &mut Texture, info: &Info) {
    let Some(t) = transform_of(info) else { return };
    let (s, c) = (libm::sin(f64::from(t.rotation.0)), libm::cos(f64::from(t.rotation.0)));
    let [sx, sy] = t.scale.0.map(f64::from);
    let [x, y] = t.offset.0.map(f64::from);
    // (u', v') = (c sx u + s sy v + x, -s sx u + c sy v + y)
    let scale = [c * sx, c * sy];
    let shear = [-s * sy, s * sx];
    let offset = [s * sy + x, 1.0 - c * sy - y];
    if [scale, shear, offset].as_flattened().iter().all(|v| v.is_finite()) {
        let single = |pair: [f64; 2]| pair.map(|v| v as f32);
        (texture.scale, texture.shear, texture.offset) = (single(scale), single(shear), single(offset));
    }
}
