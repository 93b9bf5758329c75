//! The materials of MTL files in the words of our models.
//!
//! | MTL | here |
//! |---|---|
//! | `illum 0` | `Emissive`: unlit, in `Kd` |
//! | `illum` 4, 6 or 7 with an index `Ni` | `Dielectric`, `Tf` the factor on what passes |
//! | `Pr`, `Pm` ... or a picture for one of them or for `Ns` | `Principled` in `Kd` |
//! | `Ks`, unless `illum 1` | `BlinnPhong` ("Blinn's interpretation of Phong"); 3, 5 and 8 with a mirror branch |
//! | else | `Lambert` |
//! | `d`, `Tr` | the background shows through, or opacity where a picture says so |

use super::map::{Map, change};
use super::mtl::{Entry, MapKind};
use crate::scene::load::image::ColorSpace;
use crate::scene::load::texture_files::{TextureFiles, intern};
use crate::scene::{
    Channel, Material, MaterialId, Mesh, Model, Parameter, Principled, Rgb, Scene, Texture, TextureBinding,
    TextureData, Transparency,
};

/// The exponent of highlights where a file says none.
const EXPONENT: f32 = 32.0;
/// Smallest roughness: the highlight of a light without size stays wider than a pixel.
const ROUGHNESS_MIN: f32 = 0.14;
/// Below this roughness a metal is a mirror.
const MIRROR_ROUGHNESS: f32 = 0.1;
/// Coats of this `Pc` are whole: Blender writes four times the weight.
const COAT_WHOLE: f32 = 4.0;
/// The height of white in a bump map of `-bm 1`, in sides of the picture as it lies on the surface. No standard says one.
const BUMP_HEIGHT: f32 = 0.02;

/// Makes materials for the faces of one mesh.
pub struct Maker<'m> {
    pub scene: &'m mut Scene,
    mesh: &'m Mesh,
    files: TextureFiles,
}

impl<'m> Maker<'m> {
    pub fn new(scene: &'m mut Scene, mesh: &'m Mesh) -> Self {
        Self { scene, mesh, files: TextureFiles::default() }
    }

    /// The material that `entry` describes, and that will be `id`.
    pub fn make(&mut self, entry: &Entry, name: &str, id: MaterialId) -> Material {
        let mut material = Material {
            k_a: entry.ambient.map_or(1.0, |ambient| ambient.max_element().min(1.0)),
            color: entry.base_color(),
            emission: factor(entry.emission, entry.maps.contains_key(&MapKind::Emission)).unwrap_or(Rgb::ZERO),
            ..Material::grey(name)
        };
        let refracts = entry.refracted();
        if entry.illum == Some(0) {
            material.model = Model::Emissive;
        } else if let Some(eta) = refracts {
            material.model = Model::Dielectric { eta, absorption: Rgb::ZERO };
            // Its colour would tint what is reflected.
            (material.color, material.specular_color) = (Rgb::ONE, entry.filter.unwrap_or(Rgb::ONE));
        } else if entry.is_principled() {
            self.make_principled(entry, &mut material);
        } else {
            make_glossy(entry, &mut material);
        }
        if refracts.is_none() {
            self.bind(entry, MapKind::Diffuse, Parameter::Color, &mut material);
            self.cover(entry, &mut material);
        }
        if matches!(material.model, Model::BlinnPhong { .. }) {
            self.bind(entry, MapKind::Specular, Parameter::SpecularColor, &mut material);
        }
        if material.emission != Rgb::ZERO {
            self.bind(entry, MapKind::Emission, Parameter::Emission, &mut material);
        }
        self.bend(entry, id, &mut material);
        material
    }

    fn load(&mut self, map: &Map, space: ColorSpace) -> Option<Texture> {
        map.load(space, &mut self.files, &mut self.scene.warnings)
    }

    /// Multiplies a parameter by the picture of `kind`, if there is one: a colour by its colours, a number by one channel.
    fn bind(&mut self, entry: &Entry, kind: MapKind, parameter: Parameter, material: &mut Material) {
        let Some(map) = entry.maps.get(&kind) else { return };
        let is_color = matches!(parameter, Parameter::Color | Parameter::SpecularColor | Parameter::Emission);
        let (space, channel) = match is_color {
            true => (ColorSpace::Srgb, map.channel.unwrap_or(Channel::Rgb)),
            false => (ColorSpace::Linear, map.channel.unwrap_or(Channel::R)),
        };
        if let Some(texture) = self.load(map, space) {
            self.put(texture, parameter, channel, 1.0, material);
        }
    }

    fn put(&mut self, texture: Texture, parameter: Parameter, channel: Channel, scale: f32, material: &mut Material) {
        let texture = intern(&mut self.scene.textures, texture);
        material.textures.push(TextureBinding { parameter, texture, channel, scale });
    }

    fn make_principled(&mut self, entry: &Entry, material: &mut Material) {
        let has = |kind| entry.maps.contains_key(&kind);
        let value = |number: Option<f32>, kind| factor(number, has(kind)).unwrap_or(0.0);
        let is_textured = [MapKind::Roughness, MapKind::Exponent, MapKind::Metallic].into_iter().any(has);
        let roughness = match (entry.roughness, entry.exponent) {
            _ if has(MapKind::Roughness) || has(MapKind::Exponent) => factor(entry.roughness, true).unwrap_or(1.0),
            (Some(roughness), _) => roughness,
            (None, Some(exponent)) => roughness_of(exponent),
            (None, None) => Principled::default().roughness,
        };
        let metallic = value(entry.metallic, MapKind::Metallic);
        if metallic > 0.5 && roughness < MIRROR_ROUGHNESS && !is_textured {
            material.model = Model::Mirror;
            return;
        }
        let coat_alpha = entry.coat_roughness.map_or(0.0, |roughness| roughness * roughness);
        material.model = Model::Principled(Principled {
            roughness: roughness.max(ROUGHNESS_MIN),
            metallic,
            eta: entry.eta.filter(|eta| *eta > 1.001).unwrap_or(1.5).min(5.0),
            sheen: value(entry.sheen, MapKind::Sheen),
            clearcoat: (value(entry.coat, MapKind::Coat) / COAT_WHOLE).min(1.0),
            // Its roughness alpha is 0.1 to 0.001.
            clearcoat_gloss: ((0.1 - coat_alpha) / 0.099).clamp(0.0, 1.0),
            anisotropic: value(entry.anisotropic, MapKind::Anisotropic),
            ..Principled::default()
        });
        if metallic > 0.5 && !is_textured {
            // `whitted` has no other way to show a reflection; its hue tints the branch.
            let brightest = material.color.max_element();
            material.specular_color = if brightest > 0.0 { material.color / brightest } else { Rgb::ONE };
            material.k_r = brightest * (1.0 - roughness) * (1.0 - roughness);
        }
        match entry.maps.get(&MapKind::Exponent).filter(|_| !has(MapKind::Roughness)) {
            Some(map) => {
                if let Some(texture) = self.load(map, ColorSpace::Linear) {
                    let texture = rough(texture, entry.exponent, map.channel);
                    self.put(texture, Parameter::Roughness, Channel::R, 1.0, material);
                }
            }
            None => self.bind(entry, MapKind::Roughness, Parameter::Roughness, material),
        }
        self.bind(entry, MapKind::Metallic, Parameter::Metallic, material);
        self.bind(entry, MapKind::Sheen, Parameter::Sheen, material);
        self.bind(entry, MapKind::Coat, Parameter::Clearcoat, material);
        self.bind(entry, MapKind::Anisotropic, Parameter::Anisotropic, material);
    }

    /// `d`, `Tr` and `map_d`.
    fn cover(&mut self, entry: &Entry, material: &mut Material) {
        let opacity = entry.covered();
        let map = entry.maps.get(&MapKind::Opacity);
        if let Some((map, texture)) = map.and_then(|map| Some((map, self.load(map, ColorSpace::Linear)?))) {
            // The picture of a leaf has its outline in the alpha channel; one that has none is a drawing of it.
            let channel = if is_opaque(&texture.data) { Channel::R } else { Channel::A };
            material.opacity = factor(Some(opacity), true).unwrap_or(1.0);
            self.put(texture, Parameter::Opacity, map.channel.unwrap_or(channel), 1.0, material);
        } else if opacity < 1.0 {
            material.transparency = Some(Transparency::Interpolated { k_t: 1.0 - opacity });
        }
    }

    /// Bump and normal maps. Blender calls its normal maps `map_Bump`: their texels give them away.
    fn bend(&mut self, entry: &Entry, id: MaterialId, material: &mut Material) {
        let normal = entry.maps.get(&MapKind::Normal);
        let Some(map) = normal.or(entry.maps.get(&MapKind::Bump)) else { return };
        let Some(texture) = self.load(map, ColorSpace::Linear) else { return };
        if normal.is_some() || are_normals(&texture.data) {
            let strength = map.strength.clamp(0.0, 100.0);
            self.put(texture, Parameter::Normal, Channel::Rgb, strength, material);
        } else {
            let repeats = libm::sqrtf((texture.scale[0] * texture.scale[1]).abs()).max(1e-6);
            let height = map.strength * BUMP_HEIGHT * self.units_per_uv(id) / repeats;
            self.put(texture, Parameter::Bump, map.channel.unwrap_or(Channel::R), height, material);
        }
    }

    /// Scene units that a unit of texture coordinates covers on the faces of a material, on average; 1 where there are none.
    fn units_per_uv(&self, id: MaterialId) -> f32 {
        let mesh = self.mesh;
        let (mut surface, mut plane) = (0.0f64, 0.0f64);
        for (triangle, face) in mesh.triangles.iter().zip(&mesh.face_materials) {
            if *face != id || mesh.uvs.is_empty() {
                continue;
            }
            let [a, b, c] = triangle.map(|i| mesh.positions[i as usize].as_dvec3());
            let [s, t, r] = triangle.map(|i| mesh.uvs[i as usize].as_dvec2());
            surface += (b - a).cross(c - a).length();
            plane += (t - s).perp_dot(r - s).abs();
        }
        let units = libm::sqrt(surface / plane) as f32;
        if units.is_finite() && units > 0.0 { units } else { 1.0 }
    }
}

/// A lobe that keeps energy. Blinn's as printed gives back up to 8 / (n + 2) of `Ks`, four times of it where n is 0: a wide
/// one is scaled down to `Ks`, and where `Kd` and what the lobe gives back are more than there is, both are. The power 0 is no
/// highlight at all: MeshLab writes `Ks 1` and `Ns 0` for everything that has a texture.
fn make_glossy(entry: &Entry, material: &mut Material) {
    let specular = entry.specular.or(entry.maps.get(&MapKind::Specular).map(|_| Rgb::ONE)).unwrap_or(Rgb::ZERO);
    let (k_s, exponent) = (specular.max_element(), entry.exponent.unwrap_or(EXPONENT));
    if k_s <= 0.0 || entry.illum == Some(1) || exponent < 1.0 {
        material.model = Model::Lambert;
        return;
    }
    let given_back = 8.0 / (exponent + 2.0);
    let whole = (material.color + specular * given_back.min(1.0)).max_element().max(1.0);
    material.model = Model::BlinnPhong { exponent };
    material.color /= whole;
    material.specular_color = specular / k_s;
    material.k_s = k_s / given_back.max(1.0) / whole;
    material.k_r = if matches!(entry.illum, Some(3 | 5 | 8)) { k_s } else { 0.0 };
}

impl Entry {
    /// Kd; many files leave it black, or out, where a map gives the colour.
    fn base_color(&self) -> Rgb {
        let color = factor(self.diffuse, self.maps.contains_key(&MapKind::Diffuse));
        color.unwrap_or(Material::grey("").color)
    }

    /// The index of what refracts.
    fn refracted(&self) -> Option<f32> {
        let eta = self.eta.filter(|eta| (eta - 1.0).abs() > 1.0e-3 && *eta >= 0.01)?;
        matches!(self.illum, Some(4 | 6 | 7)).then_some(eta.min(20.0))
    }

    /// How much is covered, 0 to 1. `d` counts before `Tr`, its opposite. VTK writes `Tr 1` alone for what is opaque.
    fn covered(&self) -> f32 {
        match (self.opacity, self.transparency) {
            (Some(opacity), _) => opacity,
            (None, Some(transparency)) if transparency < 1.0 => 1.0 - transparency,
            (None, _) => 1.0,
        }
    }

    fn is_principled(&self) -> bool {
        let keys = [self.roughness, self.metallic, self.sheen, self.coat, self.coat_roughness, self.anisotropic];
        let maps = [
            MapKind::Exponent,
            MapKind::Roughness,
            MapKind::Metallic,
            MapKind::Sheen,
            MapKind::Coat,
            MapKind::Anisotropic,
        ];
        keys.iter().any(Option::is_some) || maps.iter().any(|kind| self.maps.contains_key(kind))
    }
}

/// What a picture multiplies: a factor that is left out, or nothing, is one there.
fn factor<T: One>(written: Option<T>, is_mapped: bool) -> Option<T> {
    match written {
        Some(value) if value != T::ZERO => Some(value),
        _ if is_mapped => Some(T::ONE),
        written => written,
    }
}

trait One: PartialEq + Sized {
    const ZERO: Self;
    const ONE: Self;
}

impl One for f32 {
    const ZERO: Self = 0.0;
    const ONE: Self = 1.0;
}

impl One for Rgb {
    const ZERO: Self = Self::ZERO;
    const ONE: Self = Self::ONE;
}

/// The roughness whose Beckmann lobe is as wide as Blinn's of this exponent: alpha = sqrt(2 / (n + 2)) is its square.
/// Source: Walter, Marschner, Li and Torrance 2007, section 5.2.
fn roughness_of(exponent: f32) -> f32 {
    libm::sqrtf(libm::sqrtf(2.0 / (exponent + 2.0)))
}

/// A map of exponents as one of roughness. With `Ns` the picture multiplies it; without, it is one of roughness already:
/// that is what Blender writes.
fn rough(texture: Texture, exponent: Option<f32>, channel: Option<Channel>) -> Texture {
    let lane = match channel {
        Some(Channel::G) => 1,
        Some(Channel::B) => 2,
        Some(Channel::A) => 3,
        _ => 0,
    };
    let data = change(&texture.data, |texel| {
        let value = texel[lane].clamp(0.0, 1.0);
        [exponent.map_or(value, |exponent| roughness_of(exponent * value)); 4]
    });
    Texture { data, ..texture }
}

fn is_opaque(data: &TextureData) -> bool {
    match data {
        TextureData::Srgb8(texels) | TextureData::Linear8(texels) => texels.iter().all(|texel| texel[3] == 255),
        TextureData::Float(texels) => texels.iter().all(|texel| texel[3] >= 1.0),
        TextureData::Pattern(_) => true,
    }
}

/// Whether a picture holds normals, not heights: almost all of its texels are of length one, upright, and it is not grey.
fn are_normals(data: &TextureData) -> bool {
    let (mut normals, mut colored, mut count) = (0u64, 0u64, 0u64);
    let mut look = |[r, g, b]: [f32; 3]| {
        let [x, y, z] = [r, g, b].map(|v| 2.0 * v - 1.0);
        let length = x * x + y * y + z * z;
        count += 1;
        normals += u64::from(z > 0.0 && length > 0.7 && length < 1.35);
        colored += u64::from(r.max(g).max(b) - r.min(g).min(b) > 0.03);
    };
    match data {
        TextureData::Linear8(texels) | TextureData::Srgb8(texels) => {
            texels.iter().for_each(|[r, g, b, _]| look([*r, *g, *b].map(|code| f32::from(code) / 255.0)));
        }
        TextureData::Float(texels) => texels.iter().for_each(|[r, g, b, _]| look([*r, *g, *b])),
        TextureData::Pattern(_) => return false,
    }
    10 * normals >= 9 * count && 2 * colored >= count
}
