// What becomes of a shadow ray.
#ifndef TRANSPORT_SHADOW_GLSL
#define TRANSPORT_SHADOW_GLSL

#include "layout/features.glsl"
#include "layout/records.glsl"
#include "shading/material.glsl"
#include "shading/spectrum.glsl"
#include "trace/spawn.glsl"
#include "trace/surface.glsl"
#include "trace/traverse.glsl"
#include "transport/generate.glsl"
#include "transport/limit.glsl"
#include "transport/local.glsl"
#include "transport/resolve.glsl"

// A shadow ray that is longer leads out of the scene.
const float FAR = 1.0e29;

// The weight of a shadow ray over the free way from its origin to `t`. Where an object that casts no shadow is in the way, no
// ray that a surface scatters could have found the light: it counts in full. Light from outside the scene is looked for behind
// such objects, too (`shade_beyond`).
float way_weight(ShadowRay shadow, float t) {
    if (!HAS_SHADOWLESS || shadow.weight >= 1.0 || shadow.ray.t_max > FAR) {
        return shadow.weight;
    }
    Ray way = shadow.ray;
    way.t_max = t;
    return trace_barrier(way) ? 1.0 : shadow.weight;
}

// Lets a shadow ray go on behind `hit`, the nearest thing in its way, with what that lets through: tints are multiplied in the
// order of distance, whatever the order in which rays are traced (row 22 without the lecture's assumption). A blend's material
// is drawn anew for each pane and light.
void filter_shadow(ShadowRay shadow, Hit hit) {
    // Every layer has a sequence of its own: indices of one sequence are strata of each other.
    SampleKey key = sample_key(shadow.dither, 0u, shadow.layer);
    Surface surface = surface_at(shadow.ray, hit);
    Closure closure = resolve_material(shadow.ray.direction, hit, key, DIMENSION_LEAF, surface);
    ShadowRay beyond = shadow;
    beyond.contribution = spectrum_flush(shadow.contribution * pane_tint(closure));
    if (spectrum_max(beyond.contribution) <= 0.0) {
        return;
    }
    beyond.ray = spawn_through(surface, shadow.ray.direction, shadow.ray.t_max - hit.t);
    beyond.layer = shadow.layer + 1u;
    push_shadow(beyond);
}

// Traces a shadow ray: adds its light where nothing is in the way; with filtered shadows it may go on behind a pane.
void trace_shadow(ShadowRay shadow) {
    ShadowRay seen = shadow;
    if (SHADOWS == SHADOWS_FILTERED) {
        Hit hit = trace_occluder(shadow.ray);
        if (hit.instance != INVALID) {
            seen.weight = way_weight(shadow, hit.t * SHADOW_END);
            filter_shadow(seen, hit);
            return;
        }
    } else if (trace_any(shadow.ray)) {
        return;
    }
    seen.weight = way_weight(shadow, shadow.ray.t_max);
    add_light(seen);
}

#endif
