//! Materials: glTF's metallic-roughness said in the words of our models.
//!
//! | glTF | here |
//! |---|---|
//! | unlit | `Emissive` in the base colour |
//! | metallic > 0.5, roughness < 0.1 | `Mirror` in the base colour |
//! | metallic > 0.5 | Cook-Torrance, conductor with the reflectance of the base colour, m = roughness^2, and a mirror branch that fades with roughness |
//! | else | Cook-Torrance, dielectric of the given index (1.5), half specular, half diffuse with twice the base colour |
//! | transmission with a volume | `Dielectric` with Beer absorption |
//! | transmission of a thin surface | filtered transparency |
//! | BLEND | interpolated transparency of 1 - alpha |
//! | MASK | opaque, with a warning |
//!
//! Our models have one texture, for the base colour; of others the mean is used (metallic-roughness, emission, and the
//! base colour of metals) or they are left out (normal, occlusion), each with a warning.

use super::Failure;
use super::texture::{Coordinates, Textures};
use crate::scene::load::image::ColorSpace;
use crate::scene::{Fresnel, Lobe, Masking, Material, Model, Rgb, Scene, TextureBinding, Transparency};
use glam::Vec3;
use gltf::json::extensions::material::{PbrSpecularGlossiness, Volume};
use gltf::json::material::AlphaMode;
use gltf::json::texture::Info;
use gltf::json::validation::Checked;
use std::collections::BTreeSet;

/// A converted material, and how its texture is addressed.
pub(super) struct Converted {
    pub material: Material,
    pub coordinates: Option<Coordinates>,
}

/// What glTF's two workflows have in common.
struct Surface {
    /// Linear.
    base: Rgb,
    alpha: f32,
    texture: Option<Info>,
    metallic: f32,
    roughness: f32,
    eta: f32,
}

/// Below this roughness a metal is a mirror.
const MIRROR_ROUGHNESS: f32 = 0.1;
/// Smallest rms slope: a highlight of a directional light stays wider than a pixel.
const SLOPE_MIN: f32 = 0.02;
/// Share of the specular part of a dielectric; Cook-Torrance wants k_d + k_s = 1, so its colour is divided by the rest.
const SPECULAR_SHARE: f32 = 0.5;
/// Gulbrandsen's edge tint: measured metals lie between .8 and 1.
const EDGE_TINT: f64 = 0.9;

pub(super) fn convert(
    source: &gltf::json::Material,
    index: usize,
    textures: &mut Textures,
    scene: &mut Scene,
    notes: &mut BTreeSet<String>,
) -> Result<Converted, Failure> {
    let place = format!("materials[{index}]");
    let extensions = source.extensions.as_ref();
    let surface = surface(source, textures, &place, notes)?;
    let mut material = Material::grey(source.name.clone().unwrap_or_else(|| place.clone()));
    material.color = surface.base;
    let mut coordinates = None;
    let metal = surface.metallic > 0.5;
    let unlit = extensions.is_some_and(|e| e.unlit.is_some());
    let mut mean_alpha = 1.0;
    if let Some(info) = &surface.texture {
        let mean = textures.mean(info, ColorSpace::Srgb, &place)?;
        mean_alpha = mean[3] as f32;
        if metal && !unlit {
            notes.insert("base colour textures of metals are replaced by their mean".to_owned());
            material.color *= Vec3::new(mean[0] as f32, mean[1] as f32, mean[2] as f32);
        } else {
            let used = textures.color(scene, info, &place)?;
            material.textures.push(TextureBinding::color(used.texture));
            coordinates = Some(used.coordinates);
        }
    }
    if unlit {
        material.model = Model::Emissive;
    } else if metal {
        make_metal(&mut material, surface.roughness);
    } else {
        make_dielectric(&mut material, surface.roughness, surface.eta);
    }
    if let Some(transmission) = extensions.and_then(|e| e.transmission.as_ref()).filter(|_| !metal && !unlit) {
        if transmission.transmission_texture.is_some() {
            notes.insert("transmission textures are ignored".to_owned());
        }
        let volume = extensions.and_then(|e| e.volume.as_ref());
        transmit(&mut material, &surface, clamp01(transmission.transmission_factor.0), volume);
    }
    match source.alpha_mode {
        Checked::Valid(AlphaMode::Blend) => {
            if mean_alpha < 1.0 {
                notes.insert("alpha textures are replaced by their mean".to_owned());
            }
            let k_t = 1.0 - surface.alpha * mean_alpha;
            if k_t > 0.0 && material.transparency.is_none() && !matches!(material.model, Model::Dielectric { .. }) {
                material.transparency = Some(Transparency::Interpolated { k_t });
            }
        }
        Checked::Valid(AlphaMode::Mask) => {
            notes.insert("alpha masks are ignored: masked materials are drawn opaque".to_owned());
        }
        Checked::Valid(AlphaMode::Opaque) => {}
        Checked::Invalid => {
            return Err(Failure::new(place, "unknown alphaMode; allowed are OPAQUE, MASK, BLEND"));
        }
    }
    material.emission = emission(source, textures, &place, notes)?;
    note_ignored(source, notes);
    Ok(Converted { material, coordinates })
}

/// NaN becomes 0.
fn clamp01(v: f32) -> f32 {
    if v > 0.0 { v.min(1.0) } else { 0.0 }
}

fn clamp_color(rgb: [f32; 3]) -> Rgb {
    Rgb::from_array(rgb.map(clamp01))
}

fn surface(
    source: &gltf::json::Material,
    textures: &mut Textures,
    place: &str,
    notes: &mut BTreeSet<String>,
) -> Result<Surface, Failure> {
    let extensions = source.extensions.as_ref();
    if let Some(glossy) = extensions.and_then(|e| e.pbr_specular_glossiness.as_ref()) {
        return Ok(from_specular_glossiness(glossy));
    }
    let pbr = &source.pbr_metallic_roughness;
    let [r, g, b, alpha] = pbr.base_color_factor.0;
    let (mut metallic, mut roughness) = (clamp01(pbr.metallic_factor.0), clamp01(pbr.roughness_factor.0));
    if let Some(info) = &pbr.metallic_roughness_texture {
        notes.insert("metallic-roughness textures are replaced by their mean".to_owned());
        let mean = textures.mean(info, ColorSpace::Linear, place)?;
        roughness *= mean[1] as f32;
        metallic *= mean[2] as f32;
    }
    // 0 stands for infinity (KHR_materials_ior); 5 is beyond any glass.
    let eta = extensions.and_then(|e| e.ior.as_ref()).map_or(1.5, |ior| ior.ior.0);
    let eta = if eta >= 1.0 { eta.min(5.0) } else { 5.0 };
    let texture = pbr.base_color_texture.clone();
    Ok(Surface { base: clamp_color([r, g, b]), alpha: clamp01(alpha), texture, metallic, roughness, eta })
}

/// KHR_materials_pbrSpecularGlossiness: a dark diffuse and a bright specular colour is a metal, else the specular colour
/// says the index: F0 = ((eta - 1) / (eta + 1))^2.
fn from_specular_glossiness(glossy: &PbrSpecularGlossiness) -> Surface {
    let [r, g, b, alpha] = glossy.diffuse_factor.0;
    let diffuse = clamp_color([r, g, b]);
    let specular = clamp_color(glossy.specular_factor.0);
    let metal = specular.max_element() > 0.3 && diffuse.max_element() < 0.1;
    let root = libm::sqrt(f64::from(specular.max_element()));
    let eta = ((1.0 + root) / (1.0 - root).max(0.05)).clamp(1.01, 5.0) as f32;
    Surface {
        base: if metal { specular } else { diffuse },
        alpha: clamp01(alpha),
        texture: if metal { None } else { glossy.diffuse_texture.clone() },
        metallic: f32::from(u8::from(metal)),
        roughness: 1.0 - clamp01(glossy.glossiness_factor.0),
        eta,
    }
}

fn slope(roughness: f32) -> Vec<Lobe> {
    vec![Lobe::beckmann((roughness * roughness).max(SLOPE_MIN), 1.0)]
}

fn cook_torrance(roughness: f32, fresnel: Fresnel) -> Model {
    Model::CookTorrance { lobes: slope(roughness), fresnel, masking: Masking::VCavity, normalisation_1982: false }
}

fn make_metal(material: &mut Material, roughness: f32) {
    if roughness < MIRROR_ROUGHNESS {
        material.model = Model::Mirror;
        return;
    }
    // The hue goes into the specular colour, which also tints the mirror branch; the brightness into eta and k.
    let brightest = material.color.max_element();
    let (eta, k) = conductor(f64::from(brightest), EDGE_TINT);
    material.specular_color = if brightest > 0.0 { material.color / brightest } else { Rgb::ONE };
    let fresnel = Fresnel::Conductor { eta: Rgb::splat(eta as f32), k: Rgb::splat(k as f32) };
    material.model = cook_torrance(roughness, fresnel);
    (material.k_d, material.k_s) = (0.0, 1.0);
    material.k_r = brightest * (1.0 - roughness) * (1.0 - roughness);
}

/// eta and k of a metal of reflectance `r` at normal incidence and edge tint `g`, both 0 to 1 (Gulbrandsen 2014, equations 14 and 15).
pub(super) fn conductor(r: f64, g: f64) -> (f64, f64) {
    let r = r.clamp(0.0, 0.999);
    let root = libm::sqrt(r);
    let n = g * (1.0 - r) / (1.0 + r) + (1.0 - g) * (1.0 + root) / (1.0 - root);
    let k2 = (r * (n + 1.0) * (n + 1.0) - (n - 1.0) * (n - 1.0)) / (1.0 - r);
    (n, libm::sqrt(k2.max(0.0)))
}

fn make_dielectric(material: &mut Material, roughness: f32, eta: f32) {
    let fresnel = Fresnel::Dielectric { eta: eta.max(1.0001) };
    material.model = cook_torrance(roughness, fresnel);
    (material.k_d, material.k_s) = (1.0 - SPECULAR_SHARE, SPECULAR_SHARE);
    material.color /= 1.0 - SPECULAR_SHARE;
    material.k_a = 1.0 - SPECULAR_SHARE;
    if roughness < MIRROR_ROUGHNESS {
        let f0 = (eta - 1.0) / (eta + 1.0);
        material.k_r = f0 * f0;
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

fn emission(
    source: &gltf::json::Material,
    textures: &mut Textures,
    place: &str,
    notes: &mut BTreeSet<String>,
) -> Result<Rgb, Failure> {
    let strength = source.extensions.as_ref().and_then(|e| e.emissive_strength.as_ref());
    let strength = strength.map_or(1.0, |s| s.emissive_strength.0);
    let strength = if strength > 0.0 { strength.min(1e6) } else { 0.0 };
    let mut emission = clamp_color(source.emissive_factor.0) * strength;
    if let (Some(info), true) = (&source.emissive_texture, emission != Rgb::ZERO) {
        notes.insert("emissive textures are replaced by their mean".to_owned());
        let mean = textures.mean(info, ColorSpace::Srgb, place)?;
        emission *= Vec3::new(mean[0] as f32, mean[1] as f32, mean[2] as f32);
    }
    Ok(emission)
}

fn note_ignored(source: &gltf::json::Material, notes: &mut BTreeSet<String>) {
    if source.normal_texture.is_some() {
        notes.insert("normal textures are ignored".to_owned());
    }
    if source.occlusion_texture.is_some() {
        notes.insert("occlusion textures are ignored".to_owned());
    }
}
