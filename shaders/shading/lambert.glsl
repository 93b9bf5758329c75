// Ideal diffuse reflection (row 1): radiance independent of the viewer.
// Source: Lambert 1760, "Photometria".
#ifndef SHADING_LAMBERT_GLSL
#define SHADING_LAMBERT_GLSL

#include "layout/records.glsl"
#include "shading/closure.glsl"
#include "shading/lobe.glsl"
#include "shading/math.glsl"
#include "shading/spectrum.glsl"
#include "shading/warp.glsl"

// k_d O_d / pi times cos theta_i, per steradian. Local frame.
Spectrum eval_lambert(Closure closure, vec3 wo, vec3 wi) {
    if (!on_upper_side(wo, wi)) {
        return spectrum_zero();
    }
    return spectrum_from_rgb(closure.color * ((closure.k_d * INV_PI) * wi.z));
}

// Density of `sample_lambert`: cos theta_i / pi.
float pdf_lambert(Closure closure, vec3 wo, vec3 wi) {
    if (!on_upper_side(wo, wi)) {
        return 0.0;
    }
    return wi.z * INV_PI;
}

// Cosine-weighted over the hemisphere. `u`: 0..1 each, excluding 1; `u_lobe` is not used (one lobe).
DirectionSample sample_lambert(Closure closure, vec3 wo, vec2 u, float u_lobe) {
    vec3 wi = square_to_cosine_hemisphere(u);
    if (!on_upper_side(wo, wi)) {
        return no_direction();
    }
    return DirectionSample(wi, wi.z * INV_PI);
}

#endif
