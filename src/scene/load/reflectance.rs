//! How bright the surfaces of a model are on the whole.

use crate::scene::{Channel, Geometry, Material, MaterialId, Model, Parameter, Scene, Texture, TextureData};
use glam::DVec3;

/// Texels of an image that are looked at, at most.
const TEXELS: usize = 4096;
/// Triangles of a scene that are looked at, at most about.
const TRIANGLES: usize = 1 << 20;

/// The mean luminance of what the scene's surfaces reflect, weighed by area, 0 to 1; 0.5 where there are none. Vertex colours
/// count; clear bodies count as 0.5, since one sees through them.
pub(super) fn mean_reflectance(scene: &Scene) -> f64 {
    let of_material: Vec<f64> = scene.materials.iter().map(|material| material_luminance(scene, material, 0)).collect();
    let luminance = |id: Option<MaterialId>| id.map_or(0.7, |id| of_material[id.0 as usize]);
    let total: usize = scene.meshes.iter().map(|mesh| mesh.triangles.len()).sum();
    let step = total.div_ceil(TRIANGLES).max(1);
    let (mut sum, mut area) = (0.0, 0.0);
    for object in &scene.objects {
        let linear = object.transform.0.matrix3;
        let Geometry::Mesh(id) = object.geometry else {
            let size = libm::pow(linear.determinant().abs(), 2.0 / 3.0) * 4.0 * std::f64::consts::PI;
            (sum, area) = (sum + size * luminance(object.material), area + size);
            continue;
        };
        let mesh = &scene.meshes[id.0 as usize];
        for (face, corners) in mesh.triangles.iter().enumerate().step_by(step) {
            let [a, b, c] = corners.map(|i| mesh.positions[i as usize].as_dvec3());
            let size = (linear * (b - a)).cross(linear * (c - a)).length();
            if !size.is_finite() {
                continue;
            }
            let material = object.material.or_else(|| mesh.face_materials.get(face).copied());
            let tint = mesh.colors.get(corners[0] as usize).map_or(1.0, |color| of_color(color.as_dvec3()));
            (sum, area) = (sum + size * luminance(material) * tint, area + size);
        }
    }
    if area > 0.0 { sum / area } else { 0.5 }
}

/// Rec. 709 luminance, 0 to 1.
fn of_color(color: DVec3) -> f64 {
    (0.2126 * color.x + 0.7152 * color.y + 0.0722 * color.z).clamp(0.0, 1.0)
}

/// `depth`: of blends within blends.
fn material_luminance(scene: &Scene, material: &Material, depth: u32) -> f64 {
    let of = |id: MaterialId| match scene.materials.get(id.0 as usize) {
        Some(material) if depth < 8 => material_luminance(scene, material, depth + 1),
        _ => 0.5,
    };
    match &material.model {
        Model::Dielectric { .. } | Model::RoughDielectric { .. } | Model::ThinDielectric { .. } | Model::Null => 0.5,
        Model::Conductor { .. } | Model::RoughConductor { .. } => of_color(material.specular_color.as_dvec3()) * 0.7,
        Model::Blend { weight, a, b } => {
            let weight = f64::from(*weight);
            of(*a) * (1.0 - weight) + of(*b) * weight
        }
        Model::Sides { front, .. } => of(*front),
        _ => {
            let textured = material.textures.iter().find(|binding| binding.parameter == Parameter::Color);
            let texture = textured.filter(|binding| binding.channel == Channel::Rgb);
            let image = texture.map_or(DVec3::ONE, |binding| mean_color(&scene.textures[binding.texture.0 as usize]));
            of_color(material.color.as_dvec3() * image)
        }
    }
}

/// The mean of some texels, spread evenly, as linear light.
fn mean_color(texture: &Texture) -> DVec3 {
    let mean = |count: usize, texel: &dyn Fn(usize) -> DVec3| {
        let step = count.div_ceil(TEXELS).max(1);
        let picked = (0..count).step_by(step);
        let number = picked.len().max(1) as f64;
        picked.map(texel).sum::<DVec3>() / number
    };
    let byte = |v: u8| f64::from(v) / 255.0;
    match &texture.data {
        TextureData::Srgb8(texels) => mean(texels.len(), &|i| {
            let [r, g, b, _] = texels[i];
            DVec3::from_array([r, g, b].map(|v| super::image::srgb_to_linear(byte(v))))
        }),
        TextureData::Linear8(texels) => mean(texels.len(), &|i| {
            let [r, g, b, _] = texels[i];
            DVec3::from_array([r, g, b].map(byte))
        }),
        TextureData::Float(texels) => mean(texels.len(), &|i| {
            let [r, g, b, _] = texels[i];
            DVec3::from_array([r, g, b].map(f64::from)).clamp(DVec3::ZERO, DVec3::ONE)
        }),
        TextureData::Pattern(pattern) => (pattern.colors[0] + pattern.colors[1]).as_dvec3() * 0.5,
    }
}
