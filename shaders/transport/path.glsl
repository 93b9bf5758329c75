// Path tracing with next-event estimation and multiple importance sampling.
//
// Source: Kajiya 1986, "The Rendering Equation"; Veach 1997, "Robust Monte Carlo Methods for Light Transport Simulation",
// chapters 8 to 10. At each surface one emitter is sampled and one direction of the surface; what both could have found is
// weighted by the power heuristic. A path goes on as one ray. `direct` is the case of one scattering event.
//
// Panes (k_t, opacity) are a choice at random between the surface and what lies behind; passing is no scattering event.
// Shadow rays do not pass a pane, so what is seen through one has weight 1 however it is lit; filtered shadow rays do
// (`transport/shadow`), and a ray that passes one stays a sample of the direction it was drawn with.
#ifndef TRANSPORT_PATH_GLSL
#define TRANSPORT_PATH_GLSL

#include "shading/closure.glsl"
#include "layout/features.glsl"
#include "shading/bsdf.glsl"
#include "shading/environment.glsl"
#include "shading/frame.glsl"
#include "shading/material.glsl"
#include "shading/math.glsl"
#include "shading/sampling.glsl"
#include "shading/spectrum.glsl"
#include "trace/spawn.glsl"
#include "trace/surface.glsl"
#include "transport/blend.glsl"
#include "transport/emitter.glsl"
#include "transport/limit.glsl"
#include "transport/local.glsl"
#include "transport/mis.glsl"
#include "transport/nested.glsl"
#include "transport/mod.glsl"
#include "transport/weight.glsl"

// Below this density a weight would mean nothing.
const float PDF_LEAST = 1.0e-12;

// Where a path has met a surface.
struct Meeting {
    Hit hit;
    // The surface with its normal map, and as it is without one.
    Surface surface;
    Surface bare;
    // What a unit of radiance that the surface scatters adds to the sample: the path's throughput, or of a blend what it was
    // before one of its materials was drawn.
    Spectrum arriving;
    // The path looks through what glows.
    bool hidden;
};

// Adds what a ray that leaves the scene sees.
void shade_escape(PathState path, SampleKey key) {
    Spectrum radiance = background(path.ray.direction);
    if (spectrum_max(radiance) <= 0.0) {
        return;
    }
    float weight = 1.0;
    if (HAS_EMITTER(EMITTER_ENVIRONMENT) && path.pdf > 0.0) {
        float sampled = header.environment_density * pdf_environment(path.ray.direction);
        weight = met_weight(path, sampled);
    }
    Spectrum seen = path.throughput * (radiance * weight);
    add_limited(path.slot, path.depth, seen, 0.0, dither_hash(key, DITHER_BACKGROUND));
}

// Adds what a scattered ray would see of the environment if `surface`, the first that it meets and that casts no shadow, were
// not there: light samples see it, too, so both are weighed as ever.
void shade_beyond(PathState path, SampleKey key, Surface surface) {
    bool casts = (load_instance(surface.instance).flags & INSTANCE_NO_SHADOW) == 0u;
    if (casts || path.pdf <= 0.0 || (path.flags & PATH_BEHIND_SHADOWLESS) != 0u) {
        return;
    }
    vec3 direction = path.ray.direction;
    Spectrum radiance = background(direction);
    float sampled = header.environment_density * pdf_environment(direction);
    if (sampled <= 0.0 || spectrum_max(radiance) <= 0.0) {
        return;
    }
    Spectrum seen = path.throughput * radiance;
    vec4 contribution = vec4(seen.x, seen.y, seen.z, 0.0);
    Ray ray = spawn_through(surface, direction, T_INFINITE);
    uint dither = dither_hash(key, DITHER_BACKGROUND);
    float weight = power_heuristic(path.pdf, sampled);
    push_shadow(ShadowRay(ray, contribution, path.slot, dither, 0u, weight));
}

// Light of one emitter, chosen at random, that the surface sends on towards `wo`; its shadow ray is appended.
void shade_emitter(PathState path, SampleKey key, Meeting meeting, Closure closure, Frame frame, vec3 wo) {
    Surface surface = meeting.surface;
    uint chosen = 0u;
    if (header.emitter_count > 1u) {
        chosen = choose_emitter(sample_2d(key, DIMENSION_LIGHT_CHOICE));
    }
    Emitter emitter = load_emitter(chosen);
    vec2 u = vec2(0.0);
    if (emitter.kind != EMITTER_LIGHT) {
        u = sample_2d(key, DIMENSION_LIGHT);
    }
    LightSample lit = sample_emitter(emitter, key, surface, u);
    vec3 wo_local = to_local(frame, wo);
    vec3 wi_local = to_local(frame, lit.wi);
    bool blended = HAS_MODEL(MODEL_BLEND) && closure.share < 1.0;
    if (spectrum_max(lit.radiance) <= 0.0 || (!blended && !consistent(surface, wo, lit.wi, wo_local, wi_local))) {
        return;
    }
    Scattering scattering = no_scattering();
    if (HAS_MODEL(MODEL_BLEND) && blended) {
        scattering = eval_blend(meeting.hit, meeting.bare, wo, lit.wi, meeting.hidden);
    } else {
        scattering.value = eval_closure(closure, wo_local, wi_local);
    }
    Spectrum reflected = meeting.arriving * scattering.value * lit.radiance;
    if (spectrum_max(reflected) <= 0.0) {
        return;
    }
    float weight = 1.0;
    if (lit.pdf_solid_angle > 0.0) {
        if (!blended) {
            scattering.pdf = pdf_closure(closure, wo_local, wi_local);
        }
        weight = power_heuristic(lit.pdf_solid_angle, scattering.pdf);
    }
    vec4 contribution = vec4(reflected.x, reflected.y, reflected.z, 0.0);
    Ray ray = spawn_ray(surface, lit.wi, lit.distance * SHADOW_END);
    ShadowRay shadow = ShadowRay(ray, contribution, path.slot, dither_hash(key, DITHER_LIGHT), 0u, weight);
    if (casts_shadow(emitter)) {
        push_shadow(shadow);
    } else {
        add_light(shadow);
    }
}

// Lets the path go on into a direction of the surface.
void scatter(PathState path, SampleKey key, Meeting meeting, Closure closure, Frame frame, vec3 wo) {
    Surface surface = meeting.surface;
    // The last ray can only meet what glows.
    if (!HAS_GLOW && path.depth + 1u >= header.max_depth) {
        return;
    }
    vec3 wo_local = to_local(frame, wo);
    float u_lobe = sample_1d(key, DIMENSION_LOBE);
    BsdfSample bsdf = sample_closure(closure, wo_local, sample_2d(key, DIMENSION_BSDF), u_lobe);
    vec3 wi = to_world(frame, bsdf.wi);
    if (bsdf.pdf <= 0.0 || !consistent(surface, wo, wi, wo_local, bsdf.wi)) {
        return;
    }
    PathState next = path;
    next.throughput = path.throughput * bsdf.weight;
    next.depth = path.depth + 1u;
    next.path_id = hash_combine(path.path_id, LOBE_SCATTER);
    next.coverage = 0.0;
    next.passed = 0.0;
    next.flags = 0u;
    next.pdf = (bsdf.flags & SAMPLE_DELTA) != 0u ? 0.0 : bsdf.pdf;
    if (HAS_MODEL(MODEL_BLEND) && closure.share < 1.0 && next.pdf > 0.0) {
        Scattering all = eval_blend(meeting.hit, meeting.bare, wo, wi, meeting.hidden);
        if (all.pdf <= PDF_LEAST) {
            return;
        }
        next.throughput = meeting.arriving * (all.value * rcp(all.pdf));
        next.pdf = all.pdf;
    }
    next.throughput = spectrum_flush(next.throughput);
    if ((bsdf.flags & SAMPLE_TRANSMIT) != 0u && closure.model != MODEL_THIN_DIELECTRIC) {
        next.eta = path.eta * bsdf.eta;
        next.absorption = bsdf.wi.z < 0.0 ? closure.absorption : vec3(0.0);
        if (HAS_RANKS) {
            next.interior = cross_interface(path.interior, closure.rank, bsdf.wi.z < 0.0);
            next.absorption = medium_absorption(next.interior);
        }
    }
    if (next.depth >= header.rr_depth) {
        float survives = survival(next.throughput, next.eta);
        if (sample_1d(key, DIMENSION_ROULETTE) >= survives) {
            return;
        }
        next.throughput *= rcp(survives);
    }
    if (spectrum_max(next.throughput) <= 0.0) {
        return;
    }
    next.ray = spawn_ray(surface, wi, T_INFINITE);
    push_path(next);
}

// Shades one hit: adds what glows, samples an emitter, and lets the path go on.
// `key`: of the path. `bare`: the surface before `closure` was found there, with its normal map in `surface`.
void shade_path(PathState incoming, SampleKey key, Hit hit, Surface bare, Surface surface, Closure closure) {
    PathState path = incoming;
    vec3 direction = path.ray.direction;
    const bool filtered = SHADOWS == SHADOWS_FILTERED;
    bool hidden = HIDES_EMITTERS && path.depth == 0u;
    if (HIDES_EMITTERS && hidden && closure.emission != vec3(0.0)) {
        path.path_id = hash_combine(path.path_id, LOBE_THROUGH);
        path.ray = spawn_through(surface, direction, path.ray.t_max);
        push_path(path);
        return;
    }
    if (HAS_PANES && closure.k_t > 0.0) {
        float own = own_weight(closure.flags, closure.k_t);
        float through = pass_probability(closure);
        if (sample_1d(key, DIMENSION_PANE) < through) {
            path.throughput *= pane_tint(closure) * rcp(through);
            path.coverage *= closure.k_t * rcp(through);
            path.path_id = hash_combine(path.path_id, LOBE_THROUGH);
            pass_surface(surface, hit.t, filtered, path);
            path.ray = spawn_through(surface, direction, path.ray.t_max);
            push_path(path);
            return;
        }
        path.throughput *= own * rcp(1.0 - through);
        path.coverage *= (1.0 - closure.k_t) * rcp(1.0 - through);
    }

    vec3 wo = -direction;
    Spectrum own_light = spectrum_from_rgb(emitted(surface, closure, wo));
    bool glows = spectrum_max(own_light) > 0.0;
    if (glows || path.coverage != 0.0) {
        float weight = 1.0;
        if (glows && path.pdf > 0.0) {
            vec3 from = path.ray.origin - direction * path.passed;
            float sampled = pdf_emitter(from, direction, path.passed + hit.t, surface, bare.material);
            weight = met_weight(path, sampled);
        }
        Spectrum seen = path.throughput * (own_light * weight);
        add_limited(path.slot, path.depth, seen, path.coverage, dither_hash(key, DITHER_SURFACE));
    }
    if (path.depth >= header.max_depth) {
        return;
    }
    bool blended = HAS_MODEL(MODEL_BLEND) && closure.share < 1.0;
    bool dark = is_hidden_back(surface, closure, wo);
    if (dark && !blended) {
        return;
    }
    Frame frame = shading_frame(surface, closure, wo);
    Meeting meeting = Meeting(hit, surface, bare, path.throughput, hidden);
    if (HAS_MODEL(MODEL_BLEND) && blended) meeting.arriving = incoming.throughput;
    // Light samples are scattered by all materials of a blend, whichever was drawn.
    if (header.emitter_count > 0u && (blended || !is_delta(closure))) {
        shade_emitter(path, key, meeting, closure, frame, wo);
    }
    if (!dark) {
        scatter(path, key, meeting, closure, frame, wo);
    }
}

#endif
