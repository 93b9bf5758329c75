// The scene's limit on light that has been scattered (`clamp`).
#ifndef TRANSPORT_LIMIT_GLSL
#define TRANSPORT_LIMIT_GLSL

#include "layout/mod.glsl"
#include "shading/math.glsl"
#include "shading/spectrum.glsl"
#include "transport/mod.glsl"

// Factor that keeps a contribution of light that has been scattered within the scene's limit; below 1 where that bites.
float limit(uint depth, Spectrum value) {
    float largest = spectrum_max(value);
    if (!SCENE_HAS_CLAMP || depth == 0u || largest <= header.clamp) {
        return 1.0;
    }
    return div(header.clamp, largest);
}

// Adds light that has been scattered `depth` times to the sample in `slot`, within the scene's limit; how often that bites is
// counted. `coverage`: what it adds to alpha.
void add_limited(uint slot, uint depth, Spectrum value, float coverage, uint dither) {
    float factor = limit(depth, value);
    if (SCENE_HAS_CLAMP && factor < 1.0) count_limited();
    Spectrum seen = value * factor;
    add_contribution(header.film_scale, slot, vec4(seen.x, seen.y, seen.z, coverage), dither);
}

// Adds the light of a shadow ray whose way is free. It has been scattered once at least.
void add_light(ShadowRay shadow) {
    add_limited(shadow.slot, 1u, shadow.contribution * shadow.weight, 0.0, shadow.dither);
}

#endif
