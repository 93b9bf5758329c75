//! Images, samplers and texture transforms.

use super::Failure;
use super::source::{Buffers, file_of, read_uri};
use crate::scene::load::image::{ColorSpace, srgb_to_linear, texture_from_bytes};
use crate::scene::{Scene, SceneError, Texture, TextureData, TextureId, Wrap};
use glam::{DAffine2, DVec2};
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
    pictures: HashMap<(usize, bool), Texture>,
    means: HashMap<(usize, bool), [f64; 4]>,
    made: HashMap<(usize, [u8; 3]), TextureId>,
}

/// How a material uses a texture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Use {
    pub texture: TextureId,
    pub coordinates: Coordinates,
}

/// Which uvs, and what happens to them before the look-up (KHR_texture_transform).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Coordinates {
    pub set: u32,
    pub transform: DAffine2,
}

impl<'a> Textures<'a> {
    pub fn new(root: &'a Root, buffers: &'a Buffers<'a>, folder: &'a Path, file: &'a Path) -> Self {
        let (pictures, means, made) = (HashMap::new(), HashMap::new(), HashMap::new());
        Self { root, buffers, folder, file, pictures, means, made }
    }

    /// The colour texture that `info` asks for, added to `scene` unless it is there.
    pub fn color(&mut self, scene: &mut Scene, info: &Info, place: &str) -> Result<Use, Failure> {
        let (image, wraps, nearest) = self.resolve(info, place)?;
        let key = (image, [wrap_code(wraps[0]), wrap_code(wraps[1]), u8::from(nearest)]);
        let texture = match self.made.get(&key) {
            Some(id) => *id,
            None => {
                let mut texture = self.picture(image, ColorSpace::Srgb)?.clone();
                [texture.wrap_u, texture.wrap_v] = wraps;
                texture.bilinear = !nearest;
                scene.textures.push(texture);
                let id = TextureId(scene.textures.len() as u32 - 1);
                self.made.insert(key, id);
                id
            }
        };
        Ok(Use { texture, coordinates: coordinates(info) })
    }

    /// The mean of all texels, linear RGBA, for what our models have no texture for.
    pub fn mean(&mut self, info: &Info, space: ColorSpace, place: &str) -> Result<[f64; 4], Failure> {
        let (image, ..) = self.resolve(info, place)?;
        let key = (image, space == ColorSpace::Srgb);
        if let Some(mean) = self.means.get(&key) {
            return Ok(*mean);
        }
        let mean = mean_of(&self.picture(image, space)?.data);
        self.means.insert(key, mean);
        Ok(mean)
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

    fn picture(&mut self, index: usize, space: ColorSpace) -> Result<&Texture, Failure> {
        let key = (index, space == ColorSpace::Srgb);
        if !self.pictures.contains_key(&key) {
            let picture = self.read(index, space)?;
            self.pictures.insert(key, picture);
        }
        Ok(&self.pictures[&key])
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

fn wrap_code(wrap: Wrap) -> u8 {
    match wrap {
        Wrap::Repeat => 0,
        Wrap::Clamp => 1,
        Wrap::Mirror => 2,
    }
}

/// Offset times rotation times scale, in glTF's uvs, whose v points down the image. A positive rotation turns u towards -v:
/// the matrix printed in the extension has the other sign, a known slip (KhronosGroup/glTF issue 1563).
fn coordinates(info: &Info) -> Coordinates {
    let transform = info.extensions.as_ref().and_then(|e| e.texture_transform.as_ref());
    let Some(t) = transform else {
        return Coordinates { set: info.tex_coord, transform: DAffine2::IDENTITY };
    };
    let (s, c) = (libm::sin(f64::from(t.rotation.0)), libm::cos(f64::from(t.rotation.0)));
    let [sx, sy] = t.scale.0.map(f64::from);
    let matrix2 = glam::DMat2::from_cols(DVec2::new(c * sx, -s * sx), DVec2::new(s * sy, c * sy));
    let translation = DVec2::from_array(t.offset.0.map(f64::from));
    let transform = DAffine2 { matrix2, translation };
    let transform = if transform.is_finite() { transform } else { DAffine2::IDENTITY };
    Coordinates { set: t.tex_coord.unwrap_or(info.tex_coord), transform }
}

fn mean_of(data: &TextureData) -> [f64; 4] {
    // Codes are counted first: 256 conversions a channel instead of one a texel.
    let of_codes = |texels: &[[u8; 4]], encoded: bool| {
        let mut counts = [[0u64; 256]; 4];
        for texel in texels {
            for lane in 0..4 {
                counts[lane][usize::from(texel[lane])] += 1;
            }
        }
        std::array::from_fn(|lane| {
            let value = |code: usize| {
                let v = code as f64 / 255.0;
                if encoded && lane < 3 { srgb_to_linear(v) } else { v }
            };
            let sum: f64 = counts[lane].iter().enumerate().map(|(code, n)| value(code) * *n as f64).sum();
            sum / texels.len() as f64
        })
    };
    match data {
        TextureData::Srgb8(texels) => of_codes(texels, true),
        TextureData::Linear8(texels) => of_codes(texels, false),
        TextureData::Float(texels) => {
            std::array::from_fn(|lane| texels.iter().map(|t| f64::from(t[lane])).sum::<f64>() / texels.len() as f64)
        }
        // No file holds one.
        TextureData::Pattern(_) => [1.0; 4],
    }
}
