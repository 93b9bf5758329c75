// Phong's model (row 2). As printed: I = k_d I_p (N.L) + k_s I_p (V.R)^n with I_p = intensity / pi; the specular
// term has no cosine, so as a BRDF it is not reciprocal and its albedo has no bound.
// With `MATERIAL_LAFORTUNE` the lobe is f = k_s O_s (n + 2) / (2 pi) (V.R)^n: reciprocal, albedo at most k_s O_s.
// Source: Phong 1975, "Illumination for Computer Generated Pictures"; Lafortune and Willems 1994.
#ifndef SHADING_PHONG_GLSL
#define SHADING_PHONG_GLSL

#include "layout/records.glsl"
#include "shading/closure.glsl"
#include "shading/lobe.glsl"
#include "shading/math.glsl"
#include "shading/spectrum.glsl"
#include "shading/warp.glsl"

// Diffuse and specular reflection times cosine (as printed the specular part carries none), per steradian.
// Local frame; zero unless both directions are on the upper side.
Spectrum eval_phong(Closure closure, vec3 wo, vec3 wi) {
    if (!on_upper_side(wo, wi)) {
        return spectrum_zero();
    }
    float lobe = cos_power(dot3(wo, reflect_local(wi)), closure.exponent);
    float scale = (closure.flags & MATERIAL_LAFORTUNE) != 0u
        ? ((closure.exponent + 2.0) * INV_TWO_PI) * wi.z
        : INV_PI;
    vec3 diffuse = closure.color * ((closure.k_d * INV_PI) * wi.z);
    vec3 specular = closure.specular_color * ((closure.k_s * scale) * lobe);
    return spectrum_from_rgb(diffuse + specular);
}

// Density of `sample_phong`; its integral over the upper side is below 1 by the lobe's part under the horizon.
float pdf_phong(Closure closure, vec3 wo, vec3 wi) {
    if (!on_upper_side(wo, wi)) {
        return 0.0;
    }
    float p = specular_probability(closure);
    float specular = pdf_cos_power(dot3(wo, reflect_local(wi)), closure.exponent);
    return (1.0 - p) * (wi.z * INV_PI) + p * specular;
}

// Cosine-weighted, or cos^n about the mirror direction of `wo`; the part of the lobe below the horizon is dropped.
// `u`: 0..1 each, excluding 1. `u_lobe`: 0..1, chooses the lobe.
DirectionSample sample_phong(Closure closure, vec3 wo, vec2 u, float u_lobe) {
    vec3 wi;
    if (u_lobe < specular_probability(closure)) {
        wi = turn_to(reflect_local(wo), sample_cos_power(u, closure.exponent));
    } else {
        wi = square_to_cosine_hemisphere(u);
    }
    if (!on_upper_side(wo, wi)) {
        return no_direction();
    }
    return DirectionSample(wi, pdf_phong(closure, wo, wi));
}

#endif
