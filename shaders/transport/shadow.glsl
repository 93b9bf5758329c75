// What becomes of a shadow ray that panes colour on its way (row 22 without the lecture's assumption).
#ifndef TRANSPORT_SHADOW_GLSL
#define TRANSPORT_SHADOW_GLSL

#include "layout/mod.glsl"
#include "shading/material.glsl"
#include "shading/spectrum.glsl"
#include "trace/spawn.glsl"
#include "trace/surface.glsl"
#include "transport/generate.glsl"
#include "transport/textured.glsl"

// Adds the light of a shadow ray whose way is free. Where `hit`, the nearest thing in its way, is a pane, the ray goes on
// behind it with what the pane lets through: tints are multiplied in the order of distance, whatever the order in which
// rays are traced. A blend's material is drawn anew for each pane and light.
void shade_shadow(ShadowRay shadow, Hit hit) {
    if (hit.instance == INVALID) {
        if (SCENE_HAS_CLAMP && shadow.limited != 0u) count_limited();
        add_contribution(header.film_scale, shadow.slot, shadow.contribution, shadow.dither);
        return;
    }
    SampleKey key = sample_key(shadow.dither, shadow.layer, 0u);
    Surface surface = surface_at(shadow.ray, hit);
    Material material = material_at(shadow.ray.direction, hit, key, DIMENSION_LEAF, surface);
    ShadowRay beyond = shadow;
    beyond.contribution = spectrum_flush(shadow.contribution * pane_tint(material));
    if (spectrum_max(beyond.contribution) <= 0.0) {
        return;
    }
    beyond.ray = spawn_through(surface, shadow.ray.direction, shadow.ray.t_max - hit.t);
    beyond.layer = shadow.layer + 1u;
    push_shadow(beyond);
}

#endif
