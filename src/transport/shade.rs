//! What becomes of a ray once its hit is known.

use super::faceted::{faceted, shading_point, shading_points};
use super::generate::sample_key;
use super::local::{shade_local, shade_through};
use super::whitted::shade_whitted;
use super::{DITHER_BACKGROUND, Queues, add_aov, add_contribution};
use crate::layout::{
    Hit, INTEGRATOR_LOCAL, INTEGRATOR_WHITTED, INVALID, Material, PathState, SceneView, load_instance, load_material,
    load_texture,
};
use crate::shading::dielectric::transmittance;
use crate::shading::material::albedo_material;
use crate::shading::math::mix_;
use crate::shading::sampling::dither_hash;
use crate::shading::spectrum::{spectrum_from_rgb, spectrum_max};
use crate::shading::texture::sample_texture;
use crate::trace::surface::{Surface, surface_at};
use glam::{Vec3, Vec4};

/// Throughput below this is nothing, on every device alike (strict rule 4).
const THROUGHPUT_MIN: f32 = 1.0e-30;

/// Radiance where a ray leaves the scene: a gradient over the direction's height, -y to +y.
pub fn background(scene: &SceneView, direction: Vec3) -> Vec3 {
    let height = direction.y * 0.5 + 0.5;
    let bottom = scene.header.background_bottom;
    let top = scene.header.background_top;
    Vec3::new(mix_(bottom.x, top.x, height), mix_(bottom.y, top.y, height), mix_(bottom.z, top.z, height))
}

/// The surface's material with its texture and vertex colour applied.
pub fn material_at(scene: &SceneView, surface: &Surface) -> Material {
    let mut material = load_material(scene, surface.material);
    material.color *= surface.color;
    if material.color_texture != INVALID {
        let texel = sample_texture(scene, &load_texture(scene, material.color_texture), surface.uv);
        material.color *= Vec3::new(texel.x, texel.y, texel.z);
    }
    material
}

/// Shades one path: adds what it sees, appends shadow rays and the rays that go on.
pub fn shade(scene: &SceneView, incoming: &PathState, hit: &Hit, queues: &mut Queues) {
    let mut path = *incoming;
    let straight = path.depth == 0;
    let key = sample_key(scene.header, path.pixel, path.sample_index, path.path_id);
    if hit.instance == INVALID {
        if !(straight && scene.header.hide_background != 0) {
            let radiance = spectrum_from_rgb(background(scene, path.ray.direction));
            let seen = path.throughput * radiance;
            let dither = dither_hash(key, DITHER_BACKGROUND);
            add_contribution(
                queues,
                scene.header.film_scale,
                path.slot,
                Vec4::new(seen.x, seen.y, seen.z, 0.0),
                dither,
            );
        }
        return;
    }
    // Light through a medium: Beer's law over the way just travelled (the direction is unit).
    path.throughput *= transmittance(path.absorption, hit.t);
    if spectrum_max(path.throughput) < THROUGHPUT_MIN {
        return;
    }
    let surface = surface_at(scene, &path.ray, hit);
    let material = material_at(scene, &surface);
    if scene.header.aovs != 0 && path.path_id == 0 {
        let albedo = albedo_material(&material);
        let albedo_rgb = Vec3::new(albedo.x, albedo.y, albedo.z);
        add_aov(queues, &path, hit.t, surface.normal, albedo_rgb, surface.object, surface.material);
    }
    let local = scene.header.integrator == INTEGRATOR_LOCAL;
    let flags = if local { load_instance(scene, hit.instance).flags } else { 0 };
    for index in 0..shading_points(flags) {
        let point = shading_point(scene, &path.ray, hit, &surface, flags, index);
        let material_there = if faceted(flags) { material_at(scene, &point.surface) } else { material };
        shade_local(scene, &path, key, &point, &material_there, queues);
    }
    shade_through(scene, &path, &surface, &material, queues);
    if scene.header.integrator == INTEGRATOR_WHITTED && path.depth < scene.header.max_depth {
        shade_whitted(scene, &path, &surface, &material, queues);
    }
}
