// The scene's limit on light that has been scattered (`clamp`).
#ifndef TRANSPORT_LIMIT_GLSL
#define TRANSPORT_LIMIT_GLSL

#include "layout/features.glsl"
#include "layout/records.glsl"
#include "shading/math.glsl"
#include "shading/spectrum.glsl"
#include "transport/mod.glsl"

// Adds light that has been scattered `depth` times to the sample in `slot`, within the scene's limit; how often that bites is
// counted. `coverage`: what it adds to alpha.
void add_limited(uint slot, uint depth, Spectrum value, float coverage, uint dither) {
    float largest = spectrum_max(value);
    float factor = 1.0;
    if (HAS_CLAMP && depth != 0u && largest > header.clamp) {
        factor = div(header.clamp, largest);
        count_limited();
    }
    Spectrum seen = value * factor;
    add_contribution(header.film_scale, slot, vec4(seen.x, seen.y, seen.z, coverage), dither);
}

// Adds the light of a shadow ray whose way is free. It has been scattered once at least.
void add_light(ShadowRay shadow) {
    add_limited(shadow.slot, 1u, shadow.contribution * shadow.weight, 0.0, shadow.dither);
}

#endif
