// Kelemen and Szirmay-Kalos's coupled matte and specular reflection (row 19): what the specular part does not reflect
// reaches the base, so that the two share the light at every angle.
//
// Specular: D F / (4 (V.H)^2), D Beckmann's; matte: O_d (1 - E(o)) (1 - E(i)) / (pi (1 - E_mean)), E the specular part's albedo
// (a table at `table`). `specular_color` is a factor on the specular part.
// Source: Kelemen and Szirmay-Kalos 2001, "A Microfacet Based Coupled Specular-Matte BRDF Model".
#ifndef SHADING_KELEMEN_GLSL
#define SHADING_KELEMEN_GLSL

#include "layout/records.glsl"
#include "shading/closure.glsl"
#include "shading/albedo.glsl"
#include "shading/fresnel.glsl"
#include "shading/lobe.glsl"
#include "shading/math.glsl"
#include "shading/microfacet.glsl"
#include "shading/spectrum.glsl"
#include "shading/warp.glsl"

// Both parts times cosine, per steradian. Local frame; zero unless both directions are on the upper side.
Spectrum eval_kelemen(Closure closure, vec3 wo, vec3 wi) {
    if (!on_upper_side(wo, wi)) {
        return spectrum_zero();
    }
    vec3 h = wo + wi;
    // |h|^2 = 2 (1 + L.V) = 4 (V.H)^2
    float h2 = dot3(h, h);
    float v_h = min_(0.5 * sqrt_(h2), 1.0);
    float d = beckmann_d_slope(tan2_theta(h), closure.alpha_u);
    vec3 specular = (closure.specular_color * fresnel_closure(closure, v_h)) * (div(d, h2) * wi.z);
    float entered = (1.0 - albedo_at(closure.table, wo.z)) * (1.0 - albedo_at(closure.table, wi.z));
    float mean = load_table(closure.table + 2u);
    vec3 matte = closure.color * div(entered * wi.z, PI * max_(1.0 - mean, 1.0e-6));
    return spectrum_from_rgb(specular + matte);
}

// Probability of sampling the specular part: its share of the light.
float kelemen_probability(Closure closure, float cos_o) {
    float e = clamp_(albedo_at(closure.table, cos_o), 0.0, 1.0);
    float specular = e * max3_(closure.specular_color);
    float sum = specular + (1.0 - e) * max3_(closure.color);
    return sum > 1.0e-20 ? div(specular, sum) : 0.0;
}

// Density of `sample_kelemen`; its integral over the upper side is below 1 by what falls under the horizon.
float pdf_kelemen(Closure closure, vec3 wo, vec3 wi) {
    if (!on_upper_side(wo, wi)) {
        return 0.0;
    }
    float p = kelemen_probability(closure, wo.z);
    vec3 wm = normalize3(wo + wi);
    float specular = div(pdf_beckmann(wm, closure.alpha_u), 4.0 * max_(dot3(wo, wm), 1.0e-7));
    return (1.0 - p) * (wi.z * INV_PI) + p * specular;
}

// Cosine-weighted, or `wo` mirrored about a Beckmann facet; what falls below the horizon is dropped.
// `u`: 0..1 each, excluding 1. `u_lobe`: 0..1, chooses.
DirectionSample sample_kelemen(Closure closure, vec3 wo, vec2 u, float u_lobe) {
    if (wo.z <= COS_MIN) {
        return no_direction();
    }
    vec3 wi = square_to_cosine_hemisphere(u);
    if (u_lobe < kelemen_probability(closure, wo.z)) {
        wi = reflect_about(wo, sample_beckmann(u, closure.alpha_u));
    }
    if (!on_upper_side(wo, wi)) {
        return no_direction();
    }
    return make_direction(wi, pdf_kelemen(closure, wo, wi));
}

#endif
