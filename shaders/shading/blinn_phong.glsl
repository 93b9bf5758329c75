// Blinn's form of Phong's model (row 3): (N.H)^n with H = (L + V) / |L + V|; as printed, without a cosine.
// Source: Blinn 1977, "Models of Light Reflection for Computer Synthesized Pictures".
#ifndef SHADING_BLINN_PHONG_GLSL
#define SHADING_BLINN_PHONG_GLSL

#include "layout/records.glsl"
#include "shading/closure.glsl"
#include "shading/lobe.glsl"
#include "shading/math.glsl"
#include "shading/spectrum.glsl"
#include "shading/warp.glsl"

// (k_d O_d (N.L) + k_s O_s (N.H)^n) / pi, per steradian. Local frame; zero unless both directions are on the upper side.
// The specular term is symmetric in the two directions, so divided by the cosine it is not reciprocal.
Spectrum eval_blinn_phong(Closure closure, vec3 wo, vec3 wi) {
    if (!on_upper_side(wo, wi)) {
        return spectrum_zero();
    }
    vec3 h = wo + wi;
    float lobe = cos_power(h.z * rsqrt(dot3(h, h)), closure.exponent);
    vec3 diffuse = closure.color * ((closure.k_d * INV_PI) * wi.z);
    vec3 specular = closure.specular_color * ((closure.k_s * INV_PI) * lobe);
    return spectrum_from_rgb(diffuse + specular);
}

// Density of `sample_blinn_phong`; its integral over the upper side is below 1 by what falls under the horizon.
float pdf_blinn_phong(Closure closure, vec3 wo, vec3 wi) {
    if (!on_upper_side(wo, wi)) {
        return 0.0;
    }
    float p = specular_probability(closure);
    vec3 h = wo + wi;
    float h2 = dot3(h, h);
    float inv_h = rsqrt(h2);
    // V.H = |V + L| / 2, and d omega_i = 4 (V.H) d omega_h.
    float v_h = (0.5 * h2) * inv_h;
    float specular = div(pdf_cos_power(h.z * inv_h, closure.exponent), 4.0 * v_h);
    return (1.0 - p) * (wi.z * INV_PI) + p * specular;
}

// Cosine-weighted, or `wo` mirrored about an H of density (n + 1) / (2 pi) cos^n; what falls below the horizon is dropped.
// `u`: 0..1 each, excluding 1. `u_lobe`: 0..1, chooses the lobe.
DirectionSample sample_blinn_phong(Closure closure, vec3 wo, vec2 u, float u_lobe) {
    vec3 wi;
    if (u_lobe < specular_probability(closure)) {
        wi = reflect_about(wo, sample_cos_power(u, closure.exponent));
    } else {
        wi = square_to_cosine_hemisphere(u);
    }
    if (!on_upper_side(wo, wi)) {
        return no_direction();
    }
    return DirectionSample(wi, pdf_blinn_phong(closure, wo, wi));
}

#endif
