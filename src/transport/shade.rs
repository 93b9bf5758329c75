//! What becomes of a ray once its hit is known.

use super::faceted::{faceted, shading_point, shading_points};
use super::generate::sample_key;
use super::local::{shade_local, shade_through};
use super::nested::meet_interface;
use super::path::{shade_beyond, shade_escape, shade_path};
use super::resolve::resolve_material;
use super::whitted::shade_whitted;
use super::{DIMENSION_LEAF, DITHER_BACKGROUND, Queues, add_aov, add_contribution};
use crate::layout::{
    Hit, INTEGRATOR_LOCAL, INTEGRATOR_PATH, INTEGRATOR_WHITTED, INVALID, PathState, SceneView, load_instance,
};
use crate::shading::dielectric::transmittance;
use crate::shading::environment::background;
use crate::shading::material::albedo_closure;
use crate::shading::sampling::dither_hash;
use crate::shading::spectrum::spectrum_max;
use crate::trace::surface::surface_at;
use glam::{Vec3, Vec4};

/// Throughput below this is nothing, on every device alike (strict rule 4).
const THROUGHPUT_MIN: f32 = 1.0e-30;

/// Shades one path: adds what it sees, appends shadow rays and the rays that go on.
pub fn shade(scene: &SceneView, incoming: &PathState, hit: &Hit, queues: &mut Queues) {
    let mut path = *incoming;
    let straight = path.depth == 0;
    let key = sample_key(scene, path.pixel, path.sample_index, path.path_id);
    if hit.instance == INVALID {
        if !(straight && scene.features.hides_background) {
            if scene.features.integrator == INTEGRATOR_PATH {
                shade_escape(scene, &path, key, queues);
                return;
            }
            let seen = path.throughput * background(scene, path.ray.direction);
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
    let mut surface = surface_at(scene, &path.ray, hit);
    let bare = surface;
    let mut closure = resolve_material(scene, path.ray.direction, hit, key, DIMENSION_LEAF, &mut surface);
    if scene.features.has_shadowless && scene.header.environment_density > 0.0 {
        shade_beyond(scene, &path, key, &surface, queues);
    }
    if scene.features.has_ranks && !meet_interface(scene, &path, &surface, hit.t, &mut closure, queues) {
        return;
    }
    if scene.features.has_aovs && path.path_id == 0 {
        let albedo = albedo_closure(&closure);
        let albedo_rgb = Vec3::new(albedo.x, albedo.y, albedo.z);
        add_aov(queues, &path, hit.t, surface.normal, albedo_rgb, surface.object, bare.material);
    }
    if scene.features.integrator == INTEGRATOR_PATH {
        shade_path(scene, &path, key, hit, &bare, &surface, &closure, queues);
        return;
    }
    let local = scene.features.integrator == INTEGRATOR_LOCAL;
    let flags = if local { load_instance(scene, hit.instance).flags } else { 0 };
    for index in 0..shading_points(flags) {
        let mut point = shading_point(scene, &path.ray, hit, &surface, flags, index);
        let mut closure_there = closure;
        if faceted(flags) {
            closure_there = resolve_material(scene, -point.wo, &point.hit, key, DIMENSION_LEAF, &mut point.surface);
        }
        shade_local(scene, &path, key, &point, &closure_there, queues);
    }
    shade_through(scene, &path, &surface, &closure, queues);
    if scene.features.integrator == INTEGRATOR_WHITTED && path.depth < scene.header.max_depth {
        shade_whitted(scene, &path, &surface, &closure, queues);
    }
}
