// What becomes of a ray once its hit is known.
#ifndef TRANSPORT_SHADE_GLSL
#define TRANSPORT_SHADE_GLSL

#include "shading/closure.glsl"
#include "layout/features.glsl"
#include "shading/dielectric.glsl"
#include "shading/environment.glsl"
#include "shading/material.glsl"
#include "shading/sampling.glsl"
#include "shading/spectrum.glsl"
#include "trace/surface.glsl"
#include "transport/faceted.glsl"
#include "transport/generate.glsl"
#include "transport/local.glsl"
#include "transport/nested.glsl"
#include "transport/path.glsl"
#include "transport/resolve.glsl"
#include "transport/whitted.glsl"

// Throughput below this is nothing, on every device alike (strict rule 4).
const float THROUGHPUT_MIN = 1.0e-30;

// Shades one path: adds what it sees, appends shadow rays and the rays that go on.
void shade(PathState incoming, Hit hit) {
    PathState path = incoming;
    bool straight = path.depth == 0u;
    SampleKey key = sample_key(path.pixel, path.sample_index, path.path_id);
    // Where there are groups, what hit nothing has one of its own.
    if (!(SHADE_GROUPED && SHADE_GROUP != SHADE_GROUP_MISSED) && hit.instance == INVALID) {
        if (!(straight && HIDES_BACKGROUND)) {
            if (INTEGRATOR == INTEGRATOR_PATH) {
                shade_escape(path, key);
                return;
            }
            Spectrum seen = path.throughput * background(path.ray.direction);
            uint dither = dither_hash(key, DITHER_BACKGROUND);
            add_contribution(header.film_scale, path.slot, vec4(seen.x, seen.y, seen.z, 0.0), dither);
        }
        return;
    }
    if (SHADE_GROUPED && SHADE_GROUP == SHADE_GROUP_MISSED) {
        return;
    }
    // Light through a medium: Beer's law over the way just travelled (the direction is unit).
    if (HAS_ABSORPTION) {
        path.throughput *= transmittance(path.absorption, hit.t);
    }
    if (spectrum_max(path.throughput) < THROUGHPUT_MIN) {
        return;
    }
    Surface surface = surface_at(path.ray, hit);
    Surface bare = surface;
    Closure closure = resolve_material(path.ray.direction, hit, key, DIMENSION_LEAF, surface);
    if (HAS_SHADOWLESS && HAS_EMITTER(EMITTER_ENVIRONMENT)) {
        shade_beyond(path, key, surface);
    }
    if (HAS_RANKS) {
        if (!meet_interface(path, surface, hit.t, closure)) {
            return;
        }
    }
    if (HAS_AOVS && path.path_id == 0u) {
        Spectrum albedo = albedo_closure(closure);
        vec3 albedo_rgb = vec3(albedo.x, albedo.y, albedo.z);
        add_aov(path, hit.t, surface.normal, albedo_rgb, surface.object, bare.material);
    }
    if (INTEGRATOR == INTEGRATOR_PATH) {
        shade_path(path, key, hit, bare, surface, closure);
        return;
    }
    uint flags = HAS_FACETS && INTEGRATOR == INTEGRATOR_LOCAL ? load_instance(hit.instance).flags : 0u;
    for (uint index = 0u; index < 3u; index++) {
        ShadingPoint point = shading_point(path.ray, hit, surface, flags, index);
        Closure closure_there = closure;
        if (faceted(flags)) {
            closure_there = resolve_material(-point.wo, point.hit, key, DIMENSION_LEAF, point.surface);
        }
        shade_local(path, key, point, closure_there);
        if (!HAS_FACETS || index + 1u >= shading_points(flags)) {
            break;
        }
    }
    shade_through(path, surface, closure);
    if (INTEGRATOR == INTEGRATOR_WHITTED && path.depth < header.max_depth) {
        shade_whitted(path, surface, closure);
    }
}

#endif
