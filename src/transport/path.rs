//! Path tracing with next-event estimation and multiple importance sampling.
//!
//! Source: Kajiya 1986, "The Rendering Equation"; Veach 1997, "Robust Monte Carlo Methods for Light Transport Simulation",
//! chapters 8 to 10. At each surface one emitter is sampled and one direction of the surface; what both could have found is
//! weighted by the power heuristic. A path goes on as one ray. `direct` is the case of one scattering event.
//!
//! Panes (k_t, opacity) are a choice at random between the surface and what lies behind; passing is no scattering event.
//! Shadow rays do not pass a pane, so what is seen through one has weight 1 however it is lit; filtered shadow rays do
//! (`transport/shadow`), and a ray that passes one stays a sample of the direction it was drawn with.

use super::blend::{eval_blend, no_scattering, pass_probability};
use super::emitter::{casts_shadow, choose_emitter, pdf_emitter, sample_emitter};
use super::limit::{add_light, add_limited};
use super::local::{SHADOW_END, emitted, is_hidden_back, shading_frame};
use super::mis::{met_weight, pass_surface};
use super::nested::medium_absorption;
use super::weight::{consistent, power_heuristic, survival};
use super::{
    DIMENSION_BSDF, DIMENSION_LIGHT, DIMENSION_LIGHT_CHOICE, DIMENSION_LOBE, DIMENSION_PANE, DIMENSION_ROULETTE,
    DITHER_BACKGROUND, DITHER_LIGHT, DITHER_SURFACE, LOBE_SCATTER, LOBE_THROUGH, Queues, push_path, push_shadow,
};
use crate::layout::{
    EMITTER_LIGHT, Hit, INSTANCE_NO_SHADOW, MODEL_THIN_DIELECTRIC, PATH_BEHIND_SHADOWLESS, PathState, SHADOWS_FILTERED,
    SceneView, ShadowRay, T_INFINITE, load_emitter, load_instance,
};
use crate::shading::bsdf::{SAMPLE_DELTA, SAMPLE_TRANSMIT};
use crate::shading::closure::Closure;
use crate::shading::environment::{background, pdf_environment};
use crate::shading::frame::{Frame, to_local, to_world};
use crate::shading::interior::cross_interface;
use crate::shading::material::{eval_closure, is_delta, own_weight, pane_tint, pdf_closure, sample_closure};
use crate::shading::math::rcp;
use crate::shading::sampling::{SampleKey, dither_hash, hash_combine, sample_1d, sample_2d};
use crate::shading::spectrum::{Spectrum, spectrum_flush, spectrum_from_rgb, spectrum_max};
use crate::trace::spawn::{spawn_ray, spawn_through};
use crate::trace::surface::Surface;
use glam::{Vec2, Vec3, Vec4};

/// Below this density a weight would mean nothing.
const PDF_LEAST: f32 = 1.0e-12;

/// Where a path has met a surface.
#[derive(Clone, Copy, Debug)]
pub struct Meeting<'a> {
    pub hit: &'a Hit,
    /// The surface with its normal map, and as it is without one.
    pub surface: &'a Surface,
    pub bare: &'a Surface,
    /// What a unit of radiance that the surface scatters adds to the sample: the path's throughput, or of a blend what it was
    /// before one of its materials was drawn.
    pub arriving: Spectrum,
    /// The path looks through what glows.
    pub hidden: bool,
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
        weight = met_weight(scene, path, sampled);
    }
    let seen = path.throughput * (radiance * weight);
    add_limited(scene, path.slot, path.depth, seen, 0.0, dither_hash(key, DITHER_BACKGROUND), queues);
}

/// Adds what a scattered ray would see of the environment if `surface`, the first that it meets and that casts no shadow, were
/// not there: light samples see it, too, so both are weighed as ever.
pub fn shade_beyond(scene: &SceneView, path: &PathState, key: SampleKey, surface: &Surface, queues: &mut Queues) {
    let casts = (load_instance(scene, surface.instance).flags & INSTANCE_NO_SHADOW) == 0;
    if casts || path.pdf <= 0.0 || (path.flags & PATH_BEHIND_SHADOWLESS) != 0 {
        return;
    }
    let direction = path.ray.direction;
    let radiance = background(scene, direction);
    let sampled = scene.header.environment_density * pdf_environment(scene, direction);
    if sampled <= 0.0 || spectrum_max(radiance) <= 0.0 {
        return;
    }
    let seen = path.throughput * radiance;
    let contribution = Vec4::new(seen.x, seen.y, seen.z, 0.0);
    let ray = spawn_through(surface, direction, T_INFINITE);
    let (dither, weight) = (dither_hash(key, DITHER_BACKGROUND), power_heuristic(path.pdf, sampled));
    push_shadow(queues, ShadowRay { ray, contribution, slot: path.slot, dither, layer: 0, weight });
}

/// Light of one emitter, chosen at random, that the surface sends on towards `wo`; its shadow ray is appended.
#[allow(clippy::too_many_arguments, reason = "to read like its twin")]
fn shade_emitter(
    scene: &SceneView,
    path: &PathState,
    key: SampleKey,
    meeting: &Meeting,
    closure: &Closure,
    frame: Frame,
    wo: Vec3,
    queues: &mut Queues,
) {
    let surface = meeting.surface;
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
    let blended = closure.share < 1.0;
    if spectrum_max(lit.radiance) <= 0.0 || (!blended && !consistent(surface, wo, lit.wi, wo_local, wi_local)) {
        return;
    }
    let mut scattering = no_scattering();
    if blended {
        scattering = eval_blend(scene, meeting.hit, meeting.bare, wo, lit.wi, meeting.hidden);
    } else {
        scattering.value = eval_closure(scene, closure, wo_local, wi_local);
    }
    let reflected = meeting.arriving * scattering.value * lit.radiance;
    if spectrum_max(reflected) <= 0.0 {
        return;
    }
    let mut weight = 1.0;
    if lit.pdf_solid_angle > 0.0 {
        if !blended {
            scattering.pdf = pdf_closure(scene, closure, wo_local, wi_local);
        }
        weight = power_heuristic(lit.pdf_solid_angle, scattering.pdf);
    }
    let contribution = Vec4::new(reflected.x, reflected.y, reflected.z, 0.0);
    let ray = spawn_ray(surface, lit.wi, lit.distance * SHADOW_END);
    let shadow =
        ShadowRay { ray, contribution, slot: path.slot, dither: dither_hash(key, DITHER_LIGHT), layer: 0, weight };
    if casts_shadow(scene, &emitter) {
        push_shadow(queues, shadow);
    } else {
        add_light(scene, &shadow, queues);
    }
}

/// Lets the path go on into a direction of the surface.
#[allow(clippy::too_many_arguments, reason = "to read like its twin")]
fn scatter(
    scene: &SceneView,
    path: &PathState,
    key: SampleKey,
    meeting: &Meeting,
    closure: &Closure,
    frame: Frame,
    wo: Vec3,
    queues: &mut Queues,
) {
    let surface = meeting.surface;
    // The last ray can only meet what glows.
    if !scene.features.has_glow && path.depth + 1 >= scene.header.max_depth {
        return;
    }
    let wo_local = to_local(frame, wo);
    let u_lobe = sample_1d(key, DIMENSION_LOBE);
    let bsdf = sample_closure(scene, closure, wo_local, sample_2d(key, DIMENSION_BSDF), u_lobe);
    let wi = to_world(frame, bsdf.wi);
    if bsdf.pdf <= 0.0 || !consistent(surface, wo, wi, wo_local, bsdf.wi) {
        return;
    }
    let mut next = *path;
    next.throughput = path.throughput * bsdf.weight;
    next.depth = path.depth + 1;
    next.path_id = hash_combine(path.path_id, LOBE_SCATTER);
    next.coverage = 0.0;
    next.passed = 0.0;
    next.flags = 0;
    next.pdf = if (bsdf.flags & SAMPLE_DELTA) != 0 { 0.0 } else { bsdf.pdf };
    if closure.share < 1.0 && next.pdf > 0.0 {
        let all = eval_blend(scene, meeting.hit, meeting.bare, wo, wi, meeting.hidden);
        if all.pdf <= PDF_LEAST {
            return;
        }
        next.throughput = meeting.arriving * (all.value * rcp(all.pdf));
        next.pdf = all.pdf;
    }
    next.throughput = spectrum_flush(next.throughput);
    if (bsdf.flags & SAMPLE_TRANSMIT) != 0 && closure.model != MODEL_THIN_DIELECTRIC {
        next.eta = path.eta * bsdf.eta;
        next.absorption = if bsdf.wi.z < 0.0 { closure.absorption } else { Vec3::ZERO };
        if scene.features.has_ranks {
            next.interior = cross_interface(path.interior, closure.rank, bsdf.wi.z < 0.0);
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

/// Shades one hit: adds what glows, samples an emitter, and lets the path go on.
/// `key`: of the path. `bare`: the surface before `closure` was found there, with its normal map in `surface`.
#[allow(clippy::too_many_arguments, reason = "to read like its twin")]
pub fn shade_path(
    scene: &SceneView,
    incoming: &PathState,
    key: SampleKey,
    hit: &Hit,
    bare: &Surface,
    surface: &Surface,
    closure: &Closure,
    queues: &mut Queues,
) {
    let mut path = *incoming;
    let direction = path.ray.direction;
    let filtered = scene.features.shadows == SHADOWS_FILTERED;
    let hidden = scene.features.hides_emitters && path.depth == 0;
    if hidden && closure.emission != Vec3::ZERO {
        path.path_id = hash_combine(path.path_id, LOBE_THROUGH);
        path.ray = spawn_through(surface, direction, path.ray.t_max);
        push_path(queues, path);
        return;
    }
    if closure.k_t > 0.0 {
        let own = own_weight(closure.flags, closure.k_t);
        let through = pass_probability(closure);
        if sample_1d(key, DIMENSION_PANE) < through {
            path.throughput *= pane_tint(closure) * rcp(through);
            path.coverage *= closure.k_t * rcp(through);
            path.path_id = hash_combine(path.path_id, LOBE_THROUGH);
            pass_surface(scene, surface, hit.t, filtered, &mut path);
            path.ray = spawn_through(surface, direction, path.ray.t_max);
            push_path(queues, path);
            return;
        }
        path.throughput *= own * rcp(1.0 - through);
        path.coverage *= (1.0 - closure.k_t) * rcp(1.0 - through);
    }

    let wo = -direction;
    let own_light = spectrum_from_rgb(emitted(surface, closure, wo));
    let glows = spectrum_max(own_light) > 0.0;
    if glows || path.coverage != 0.0 {
        let mut weight = 1.0;
        if glows && path.pdf > 0.0 {
            let from = path.ray.origin - direction * path.passed;
            let sampled = pdf_emitter(scene, from, direction, path.passed + hit.t, surface, bare.material);
            weight = met_weight(scene, &path, sampled);
        }
        let seen = path.throughput * (own_light * weight);
        let dither = dither_hash(key, DITHER_SURFACE);
        add_limited(scene, path.slot, path.depth, seen, path.coverage, dither, queues);
    }
    if path.depth >= scene.header.max_depth {
        return;
    }
    let blended = closure.share < 1.0;
    let dark = is_hidden_back(surface, closure, wo);
    if dark && !blended {
        return;
    }
    let frame = shading_frame(scene, surface, closure, wo);
    let arriving = if blended { incoming.throughput } else { path.throughput };
    let meeting = Meeting { hit, surface, bare, arriving, hidden };
    // Light samples are scattered by all materials of a blend, whichever was drawn.
    if scene.header.emitter_count > 0 && (blended || !is_delta(closure)) {
        shade_emitter(scene, &path, key, &meeting, closure, frame, wo, queues);
    }
    if !dark {
        scatter(scene, &path, key, &meeting, closure, frame, wo, queues);
    }
}
