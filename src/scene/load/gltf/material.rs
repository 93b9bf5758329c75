//! Materials: glTF's metallic-roughness said in the words of our models.
//!
//! | glTF | here |
//! |---|---|
//! | unlit | `Emissive` in the base colour |
//! | metal, roughness < 0.1, neither from a texture | `Mirror` in the base colour |
//! | else | `Principled`: base colour, metallic, roughness, index (1.5); each times its texture |
//! | transmission with a volume | `Dielectric` with Beer absorption; a texture of the share counts by its mean |
//! | transmission of a thin surface | filtered transparency |
//! | BLEND | opacity; interpolated transparency where no texture varies it |
//! | MASK | opacity 0 or 1 |
//! | normal, emissive textures | as they are; occlusion is left to the integrators, which find it themselves |
//! | pbrSpecularGlossiness | `glossy` |
//!
//! Under `whitted`, which has no other way to show a reflection, metals and smooth surfaces get a mirror branch that fades
//! with roughness.

use super::Failure;
use super::glossy;
use super::texture::{Textures, coordinate_set};
use crate::scene::load::image::ColorSpace;
use crate::scene::load::texture_files::intern;
use crate::scene::{
    Channel, Material, Model, Parameter, Principled, Rgb, Scene, Texture, TextureBinding, Transparency,
};
use gltf::json::extensions::material::Volume;
use gltf::json::material::{AlphaMode, NormalTexture};
use gltf::json::texture::Info;
use gltf::json::validation::Checked;
use std::collections::BTreeSet;

/// A converted material, and which set of texture coordinates it wants, if any.
pub(super) struct Converted {
    pub material: Material,
    pub set: Option<u32>,
}

/// What glTF's two workflows have in common.
pub(super) struct Surface {
    /// Linear.
    pub base: Rgb,
    pub alpha: f32,
    /// Times the texture's colour, and its alpha.
    pub base_texture: Option<Texture>,
    /// Whether its alpha is 1 everywhere.
    pub opaque: bool,
    pub metallic: f32,
    pub roughness: f32,
    /// Times green for roughness, and blue for metallic.
    pub texture: Option<Texture>,
    pub eta: f32,
}

/// Below this roughness a metal is a mirror.
const MIRROR_ROUGHNESS: f32 = 0.1;
/// Smallest roughness: the highlight of a light without size stays wider than a pixel.
const ROUGHNESS_MIN: f32 = 0.14;

/// A material under way.
struct Maker<'m, 'a> {
    place: String,
    textures: &'m mut Textures<'a>,
    scene: &'m mut Scene,
    notes: &'m mut BTreeSet<String>,
    material: Material,
    set: Option<u32>,
}

pub(super) fn convert(
    source: &gltf::json::Material,
    index: usize,
    textures: &mut Textures,
    scene: &mut Scene,
    notes: &mut BTreeSet<String>,
) -> Result<Converted, Failure> {
    let place = format!("materials[{index}]");
    let material = Material::grey(source.name.clone().unwrap_or_else(|| place.clone()));
    let mut maker = Maker { place, textures, scene, notes, material, set: None };
    maker.make(source)?;
    Ok(Converted { material: maker.material, set: maker.set })
}

impl Maker<'_, '_> {
    fn make(&mut self, source: &gltf::json::Material) -> Result<(), Failure> {
        let extensions = source.extensions.as_ref();
        let surface = self.surface(source)?;
        let unlit = extensions.is_some_and(|e| e.unlit.is_some());
        self.material.color = surface.base;
        if unlit {
            self.material.model = Model::Emissive;
        } else {
            make_principled(&mut self.material, &surface);
        }
        if let Some(texture) = &surface.base_texture {
            self.bind(Parameter::Color, Channel::Rgb, 1.0, texture.clone());
        }
        if let (Some(texture), Model::Principled(_)) = (&surface.texture, &self.material.model) {
            self.bind(Parameter::Roughness, Channel::G, 1.0, texture.clone());
            self.bind(Parameter::Metallic, Channel::B, 1.0, texture.clone());
        }
        let transmission = extensions.and_then(|e| e.transmission.as_ref());
        if let Some(transmission) = transmission.filter(|_| !unlit && surface.metallic <= 0.5) {
            let mut factor = clamp01(transmission.transmission_factor.0);
            if let Some(info) = transmission.transmission_texture.as_ref().filter(|_| factor > 0.0) {
                factor = clamp01(factor * self.textures.mean_red(info, &self.place)?);
                self.notes.insert("transmission textures count by their mean".to_owned());
            }
            let volume = extensions.and_then(|e| e.volume.as_ref());
            transmit(&mut self.material, &surface, factor, volume);
        }
        self.cover(source, &surface)?;
        self.emit(source)?;
        if let Some(normal) = &source.normal_texture {
            let info = normal_info(normal);
            let strength = if normal.scale.is_finite() { normal.scale.clamp(-100.0, 100.0) } else { 1.0 };
            if let Some(texture) = self.texture(&info, ColorSpace::Linear)? {
                self.bind(Parameter::Normal, Channel::Rgb, strength, texture);
            }
        }
        Ok(())
    }

    /// The texture of `info`, after noting which coordinates it wants.
    fn texture(&mut self, info: &Info, space: ColorSpace) -> Result<Option<Texture>, Failure> {
        let set = coordinate_set(info);
        if *self.set.get_or_insert(set) != set {
            self.notes
                .insert("textures of one material that want different TEXCOORD sets all use the first".to_owned());
        }
        self.textures.texture(info, space, &self.place)
    }

    fn optional(&mut self, info: Option<&Info>, space: ColorSpace) -> Result<Option<Texture>, Failure> {
        info.map_or(Ok(None), |info| self.texture(info, space))
    }

    fn bind(&mut self, parameter: Parameter, channel: Channel, scale: f32, texture: Texture) {
        let texture = intern(&mut self.scene.textures, texture);
        self.material.textures.push(TextureBinding { parameter, texture, channel, scale });
    }

    fn surface(&mut self, source: &gltf::json::Material) -> Result<Surface, Failure> {
        let extensions = source.extensions.as_ref();
        if let Some(glossy) = extensions.and_then(|e| e.pbr_specular_glossiness.as_ref()) {
            let [diffuse, specular] = [&glossy.diffuse_texture, &glossy.specular_glossiness_texture];
            let opaque = self.is_opaque(diffuse.as_ref())?;
            let [diffuse, specular] = [
                self.optional(diffuse.as_ref(), ColorSpace::Srgb)?,
                self.optional(specular.as_ref(), ColorSpace::Srgb)?,
            ];
            return Ok(glossy::surface(glossy, diffuse, specular, opaque));
        }
        let pbr = &source.pbr_metallic_roughness;
        let [r, g, b, alpha] = pbr.base_color_factor.0;
        // 0 stands for infinity (KHR_materials_ior); 5 is beyond any glass.
        let eta = extensions.and_then(|e| e.ior.as_ref()).map_or(1.5, |ior| ior.ior.0);
        let base = pbr.base_color_texture.as_ref();
        let rough = pbr.metallic_roughness_texture.as_ref();
        Ok(Surface {
            base: clamp_color([r, g, b]),
            alpha: clamp01(alpha),
            opaque: self.is_opaque(base)?,
            base_texture: self.optional(base, ColorSpace::Srgb)?,
            metallic: clamp01(pbr.metallic_factor.0),
            roughness: clamp01(pbr.roughness_factor.0),
            texture: self.optional(rough, ColorSpace::Linear)?,
            eta: if eta >= 1.0 { eta.min(5.0) } else { 5.0 },
        })
    }

    fn is_opaque(&mut self, info: Option<&Info>) -> Result<bool, Failure> {
        info.map_or(Ok(true), |info| self.textures.is_opaque(info, &self.place))
    }

    /// alphaMode.
    fn cover(&mut self, source: &gltf::json::Material, surface: &Surface) -> Result<(), Failure> {
        let alpha_texture = surface.base_texture.clone().filter(|_| !surface.opaque);
        match source.alpha_mode {
            Checked::Valid(AlphaMode::Opaque) => {}
            Checked::Valid(AlphaMode::Blend) => match alpha_texture {
                Some(texture) => {
                    self.material.opacity = surface.alpha;
                    self.bind(Parameter::Opacity, Channel::A, 1.0, texture);
                }
                None if surface.alpha < 1.0 && self.takes_alpha() => {
                    self.material.transparency = Some(Transparency::Interpolated { k_t: 1.0 - surface.alpha });
                }
                None => {}
            },
            Checked::Valid(AlphaMode::Mask) => {
                let cutoff = source.alpha_cutoff.map_or(0.5, |cutoff| cutoff.0);
                match alpha_texture {
                    Some(texture) => {
                        self.material.opacity = surface.alpha;
                        self.bind(Parameter::Mask, Channel::A, cutoff, texture);
                    }
                    None => self.material.opacity = if surface.alpha >= cutoff { 1.0 } else { 0.0 },
                }
            }
            Checked::Invalid => {
                return Err(Failure::new(&*self.place, "unknown alphaMode; allowed are OPAQUE, MASK, BLEND"));
            }
        }
        Ok(())
    }

    /// Glass and thin transmission say already what passes.
    fn takes_alpha(&self) -> bool {
        self.material.transparency.is_none() && !matches!(self.material.model, Model::Dielectric { .. })
    }

    fn emit(&mut self, source: &gltf::json::Material) -> Result<(), Failure> {
        let strength = source.extensions.as_ref().and_then(|e| e.emissive_strength.as_ref());
        let strength = strength.map_or(1.0, |s| s.emissive_strength.0);
        let strength = if strength > 0.0 { strength.min(1e6) } else { 0.0 };
        self.material.emission = clamp_color(source.emissive_factor.0) * strength;
        if let (Some(info), true) = (&source.emissive_texture, self.material.emission != Rgb::ZERO)
            && let Some(texture) = self.texture(info, ColorSpace::Srgb)?
        {
            self.bind(Parameter::Emission, Channel::Rgb, 1.0, texture);
        }
        Ok(())
    }
}

/// A normal texture as any other; its transform is an extension like theirs.
fn normal_info(normal: &NormalTexture) -> Info {
    let extensions = normal
        .extensions
        .as_ref()
        .and_then(|e| serde_json::from_value(serde_json::Value::Object(e.others.clone())).ok());
    Info { index: normal.index, tex_coord: normal.tex_coord, extensions, extras: Default::default() }
}

/// NaN becomes 0.
pub(super) fn clamp01(v: f32) -> f32 {
    if v > 0.0 { v.min(1.0) } else { 0.0 }
}

pub(super) fn clamp_color(rgb: [f32; 3]) -> Rgb {
    Rgb::from_array(rgb.map(clamp01))
}

fn make_principled(material: &mut Material, surface: &Surface) {
    let smooth = surface.texture.is_none().then_some((1.0 - surface.roughness) * (1.0 - surface.roughness));
    let metal = surface.metallic > 0.5;
    if metal && smooth.is_some() && surface.roughness < MIRROR_ROUGHNESS {
        material.model = Model::Mirror;
        return;
    }
    material.model = Model::Principled(Principled {
        roughness: surface.roughness.max(ROUGHNESS_MIN),
        metallic: surface.metallic,
        eta: surface.eta.max(1.0001),
        ..Principled::default()
    });
    let f0 = (surface.eta - 1.0) / (surface.eta + 1.0);
    match smooth {
        Some(smooth) if metal => {
            // The hue goes into the specular colour, which tints the branch.
            let brightest = surface.base.max_element();
            material.specular_color = if brightest > 0.0 { surface.base / brightest } else { Rgb::ONE };
            material.k_r = brightest * smooth;
        }
        Some(_) if surface.roughness < MIRROR_ROUGHNESS => material.k_r = f0 * f0,
        _ => {}
    }
}

/// KHR_materials_transmission, with and without KHR_materials_volume.
fn transmit(material: &mut Material, surface: &Surface, factor: f32, volume: Option<&Volume>) {
    if factor <= 0.0 {
        return;
    }
    let solid = volume.filter(|v| v.thickness_factor.0 > 0.0 && factor > 0.5);
    let Some(volume) = solid else {
        material.color *= 1.0 - factor;
        material.transparency = Some(Transparency::Filtered { k_t: factor, color: surface.base });
        return;
    };
    // attenuationColor is what is left after attenuationDistance: sigma = -ln(color) / distance.
    let distance = f64::from(volume.attenuation_distance.0);
    let absorption = volume.attenuation_color.0.map(|c| {
        let sigma = -libm::log(f64::from(clamp01(c)).max(1e-6)) / distance;
        if sigma.is_finite() && sigma > 0.0 { sigma as f32 } else { 0.0 }
    });
    let absorption = Rgb::from_array(absorption);
    material.model = Model::Dielectric { eta: surface.eta.max(1.0001), absorption };
    material.specular_color = surface.base;
    (material.color, material.textures) = (Rgb::ONE, Vec::new());
    (material.k_a, material.k_d, material.k_s, material.k_r) = (0.0, 0.0, 1.0, 0.0);
}
