//! Path tracing with next-event estimation and multiple importance sampling.
//!
//! Source: Kajiya 1986, "The Rendering Equation"; Veach 1997, "Robust Monte Carlo Methods for Light Transport Simulation",
//! chapters 8 to 10. At each surface one emitter is sampled and one direction of the surface; what both could have found is
//! weighted by the power heuristic. A path goes on as one ray. `direct` is the case of one scattering event.
//!
//! Panes (k_t, opacity) are a choice at random between the surface and what lies behind; passing is no scattering event.
//! Shadow rays do not pass a pane, so what is seen through one has weight 1 however it is lit; filtered shadow rays do
//! (`transport/shadow`), and a ray that passes one stays a sample of the direction it was drawn with.

use super::emitter::{casts_shadow, choose_emitter, pdf_emitter, sample_emitter};
use super::local::{SHADOW_END, emitted, is_hidden_back, shading_frame};
use super::nested::medium_absorption;
use super::weight::{consistent, power_heuristic, survival};
use super::{
    DIMENSION_BSDF, DIMENSION_LIGHT, DIMENSION_LIGHT_CHOICE, DIMENSION_LOBE, DIMENSION_PANE, DIMENSION_ROULETTE,
    DITHER_BACKGROUND, DITHER_LIGHT, DITHER_SURFACE, LOBE_SCATTER, LOBE_THROUGH, Queues, add_contribution,
    count_limited, push_path, push_shadow,
};
use crate::layout::{
    EMITTER_LIGHT, Hit, INSTANCE_NO_SHADOW, MODEL_THIN_DIELECTRIC, Material, PathState, SHADOWS_FILTERED, SceneView,
    ShadowRay, T_INFINITE, load_emitter, load_instance,
};
use crate::shading::bsdf::{SAMPLE_DELTA, SAMPLE_TRANSMIT};
use crate::shading::environment::{background, pdf_environment};
use crate::shading::frame::{Frame, to_local, to_world};
use crate::shading::interior::cross_interface;
use crate::shading::material::{
    emission_material, eval_material, is_delta, own_weight, pane_tint, pdf_material, sample_material,
};
use crate::shading::math::{div, rcp};
use crate::shading::sampling::{SampleKey, dither_hash, hash_combine, sample_1d, sample_2d};
use crate::shading::spectrum::{Spectrum, spectrum_flush, spectrum_from_rgb, spectrum_max};
use crate::trace::spawn::{spawn_ray, spawn_through};
use crate::trace::surface::Surface;
use glam::{Vec2, Vec3, Vec4};

/// Factor that keeps a contribution of light that has been scattered within the scene's limit; below 1 where that bites.
pub fn limit(scene: &SceneView, depth: u32, value: Spectrum) -> f32 {
    let largest = spectrum_max(value);
    if scene.header.clamp <= 0.0 || depth == 0 || largest <= scene.header.clamp {
        return 1.0;
    }
    div(scene.header.clamp, largest)
}

/// Adds light that a path has met, within the scene's limit; how often that bites is counted.
/// `coverage`: what it adds to alpha.
fn add_limited(scene: &SceneView, path: &PathState, value: Spectrum, coverage: f32, dither: u32, queues: &mut Queues) {
    let factor = limit(scene, path.depth, value);
    if factor < 1.0 {
        count_limited(queues);
    }
    let seen = value * factor;
    let contribution = Vec4::new(seen.x, seen.y, seen.z, coverage);
    add_contribution(queues, scene.header.film_scale, path.slot, contribution, dither);
}

/// Weight of light that a ray of density `own` has met where light samples would have had density `sampled`. An object that
/// casts no shadow is in the way of the one and not of the other, so in its scene light samples count in full.
pub fn met_weight(scene: &SceneView, own: f32, sampled: f32) -> f32 {
    if scene.header.shadowless != 0 && sampled > 0.0 {
        return 0.0;
    }
    power_heuristic(own, sampled)
}

/// Adds what a ray that leaves the scene sees.
pub fn shade_escape(scene: &SceneView, path: &PathState, key: SampleKey, queues: &mut Queues) {
    let radiance = background(scene, path.ray.direction);
    if spectrum_max(radiance) <= 0.0 {
        return;
    }
    let mut weight = 1.0;
    if path.pdf > 0.0 {
        let sampled = scene.header.environment_density * pdf_environment(scene, path.ray.direction);
        weight = met_weight(scene, path.pdf, sampled);
    }
    let seen = path.throughput * (radiance * weight);
    add_limited(scene, path, seen, 0.0, dither_hash(key, DITHER_BACKGROUND), queues);
}

/// Light of one emitter, chosen at random, that the surface sends on towards `wo`; its shadow ray is appended.
#[allow(clippy::too_many_arguments, reason = "to read like its twin")]
fn shade_emitter(
    scene: &SceneView,
    path: &PathState,
    key: SampleKey,
    surface: &Surface,
    material: &Material,
    frame: Frame,
    wo: Vec3,
    queues: &mut Queues,
) {
    let mut chosen = 0;
    if scene.header.emitter_count > 1 {
        chosen = choose_emitter(scene, sample_2d(key, DIMENSION_LIGHT_CHOICE));
    }
    let emitter = load_emitter(scene, chosen);
    let mut u = Vec2::ZERO;
    if emitter.kind != EMITTER_LIGHT {
        u = sample_2d(key, DIMENSION_LIGHT);
    }
    let lit = sample_emitter(scene, &emitter, key, surface, u);
    let wo_local = to_local(frame, wo);
    let wi_local = to_local(frame, lit.wi);
    if spectrum_max(lit.radiance) <= 0.0 || !consistent(surface, wo, lit.wi, wo_local, wi_local) {
        return;
    }
    let reflected = path.throughput * eval_material(scene, material, wo_local, wi_local) * lit.radiance;
    if spectrum_max(reflected) <= 0.0 {
        return;
    }
    let mut weight = 1.0;
    if lit.pdf_solid_angle > 0.0 && scene.header.shadowless == 0 {
        weight = power_heuristic(lit.pdf_solid_angle, pdf_material(scene, material, wo_local, wi_local));
    }
    let factor = limit(scene, path.depth + 1, reflected * weight);
    let seen = (reflected * weight) * factor;
    let limited = if factor < 1.0 { 1 } else { 0 };
    let contribution = Vec4::new(seen.x, seen.y, seen.z, 0.0);
    let dither = dither_hash(key, DITHER_LIGHT);
    if casts_shadow(scene, &emitter) {
        let ray = spawn_ray(surface, lit.wi, lit.distance * SHADOW_END);
        push_shadow(queues, ShadowRay { ray, contribution, slot: path.slot, dither, layer: 0, limited });
    } else {
        if limited != 0 {
            count_limited(queues);
        }
        add_contribution(queues, scene.header.film_scale, path.slot, contribution, dither);
    }
}

/// Lets the path go on into a direction of the surface.
#[allow(clippy::too_many_arguments, reason = "to read like its twin")]
fn scatter(
    scene: &SceneView,
    path: &PathState,
    key: SampleKey,
    surface: &Surface,
    material: &Material,
    frame: Frame,
    wo: Vec3,
    queues: &mut Queues,
) {
    // The last ray can only meet what glows.
    if scene.header.glows == 0 && path.depth + 1 >= scene.header.max_depth {
        return;
    }
    let wo_local = to_local(frame, wo);
    let u_lobe = sample_1d(key, DIMENSION_LOBE);
    let bsdf = sample_material(scene, material, wo_local, sample_2d(key, DIMENSION_BSDF), u_lobe);
    let wi = to_world(frame, bsdf.wi);
    if bsdf.pdf <= 0.0 || !consistent(surface, wo, wi, wo_local, bsdf.wi) {
        return;
    }
    let mut next = *path;
    next.throughput = spectrum_flush(path.throughput * bsdf.weight);
    next.depth = path.depth + 1;
    next.path_id = hash_combine(path.path_id, LOBE_SCATTER);
    next.coverage = 0.0;
    next.pdf = if (bsdf.flags & SAMPLE_DELTA) != 0 { 0.0 } else { bsdf.pdf };
    if (bsdf.flags & SAMPLE_TRANSMIT) != 0 && material.model != MODEL_THIN_DIELECTRIC {
        next.eta = path.eta * bsdf.eta;
        next.absorption = if bsdf.wi.z < 0.0 { material.absorption } else { Vec3::ZERO };
        if scene.header.nested != 0 {
            next.interior = cross_interface(path.interior, material, bsdf.wi.z < 0.0);
            next.absorption = medium_absorption(scene, next.interior);
        }
    }
    if next.depth >= scene.header.rr_depth {
        let survives = survival(next.throughput, next.eta);
        if sample_1d(key, DIMENSION_ROULETTE) >= survives {
            return;
        }
        next.throughput *= rcp(survives);
    }
    if spectrum_max(next.throughput) <= 0.0 {
        return;
    }
    next.ray = spawn_ray(surface, wi, T_INFINITE);
    push_path(queues, next);
}

/// Whether shadow rays pass the surface as if it were not there.
pub fn lets_shadow_rays_pass(scene: &SceneView, surface: &Surface) -> bool {
    scene.header.shadowless != 0 && (load_instance(scene, surface.instance).flags & INSTANCE_NO_SHADOW) != 0
}

/// Shades one hit: adds what glows, samples an emitter, and lets the path go on.
/// `key`: of the path. `named`: the surface's material, of which `material` is what is met here.
#[allow(clippy::too_many_arguments, reason = "to read like its twin")]
pub fn shade_path(
    scene: &SceneView,
    incoming: &PathState,
    key: SampleKey,
    hit: &Hit,
    surface: &Surface,
    named: u32,
    material: &Material,
    queues: &mut Queues,
) {
    let mut path = *incoming;
    let direction = path.ray.direction;
    let filtered = scene.header.shadows == SHADOWS_FILTERED;
    // How far before the ray's origin its direction was drawn.
    let mut passed = 0.0;
    if filtered && path.depth > 0 {
        passed = path.coverage;
        path.coverage = 0.0;
    }
    if scene.header.hide_emitters != 0 && path.depth == 0 && emission_material(material) != Vec3::ZERO {
        path.path_id = hash_combine(path.path_id, LOBE_THROUGH);
        path.ray = spawn_through(surface, direction, path.ray.t_max);
        push_path(queues, path);
        return;
    }
    if material.k_t > 0.0 {
        let own = own_weight(material);
        let tint = pane_tint(material);
        // Each side as often as it is bright.
        let share = spectrum_max(tint);
        let through = div(share, own + share);
        if sample_1d(key, DIMENSION_PANE) < through {
            path.throughput *= tint * rcp(through);
            path.coverage *= material.k_t * rcp(through);
            path.path_id = hash_combine(path.path_id, LOBE_THROUGH);
            if filtered && path.depth > 0 {
                path.coverage = passed + hit.t;
            }
            if !(filtered || lets_shadow_rays_pass(scene, surface)) {
                path.pdf = 0.0;
            }
            path.ray = spawn_through(surface, direction, path.ray.t_max);
            push_path(queues, path);
            return;
        }
        path.throughput *= own * rcp(1.0 - through);
        path.coverage *= (1.0 - material.k_t) * rcp(1.0 - through);
    }

    let wo = -direction;
    let own_light = spectrum_from_rgb(emitted(surface, material, wo));
    let glows = spectrum_max(own_light) > 0.0;
    if glows || path.coverage != 0.0 {
        let mut weight = 1.0;
        if glows && path.pdf > 0.0 {
            let from = path.ray.origin - direction * passed;
            let sampled = pdf_emitter(scene, from, direction, passed + hit.t, surface, named);
            weight = met_weight(scene, path.pdf, sampled);
        }
        let seen = path.throughput * (own_light * weight);
        add_limited(scene, &path, seen, path.coverage, dither_hash(key, DITHER_SURFACE), queues);
    }
    if path.depth >= scene.header.max_depth || is_hidden_back(surface, material, wo) {
        return;
    }
    let frame = shading_frame(scene, surface, material, wo);
    if scene.header.emitter_count > 0 && !is_delta(material) {
        shade_emitter(scene, &path, key, surface, material, frame, wo, queues);
    }
    scatter(scene, &path, key, surface, material, frame, wo, queues);
}
