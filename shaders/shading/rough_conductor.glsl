// Rough metal: f = O_s D G F / (4 (N.L)(N.V)), G Smith's of independent masking and shadowing.
//
// With `MATERIAL_COMPENSATE` what the facets reflect among each other is added as a lobe of its own, so that a surface
// that absorbs nothing reflects everything; its albedo table is at `table`.
// Sources: Walter et al. 2007, "Microfacet Models for Refraction through Rough Surfaces"; Kulla and Conty 2017,
// "Revisiting Physically Based Shading at Imageworks" (compensation).
#ifndef SHADING_ROUGH_CONDUCTOR_GLSL
#define SHADING_ROUGH_CONDUCTOR_GLSL

#include "layout/records.glsl"
#include "shading/closure.glsl"
#include "shading/albedo.glsl"
#include "shading/distribution.glsl"
#include "shading/fresnel.glsl"
#include "shading/lobe.glsl"
#include "shading/math.glsl"
#include "shading/spectrum.glsl"
#include "shading/warp.glsl"

// The Gaussian's constant of lobe 0; 1 for the other distributions, which know theirs.
float first_scale(Closure closure) {
    if (closure.distribution != DISTRIBUTION_GAUSSIAN) {
        return 1.0;
    }
    return load_table(closure.table);
}

// Light that leaves after several reflections between facets, times cosine, per steradian and colour channel:
// (1 - E(o)) (1 - E(i)) / (pi (1 - E_mean)) F_mean^2 E_mean / (1 - F_mean (1 - E_mean)).
vec3 multiple_scattering(Closure closure, float cos_o, float cos_i) {
    float mean = load_table(closure.table + 2u);
    float lost = (1.0 - albedo_at(closure.table, cos_o)) * (1.0 - albedo_at(closure.table, cos_i));
    float share = div(lost * cos_i, PI * max_(1.0 - mean, 1.0e-6));
    float f_r = load_table(closure.table + 3u);
    float f_g = load_table(closure.table + 4u);
    float f_b = load_table(closure.table + 5u);
    float rest = 1.0 - mean;
    vec3 f = vec3(
        div((f_r * f_r) * mean, 1.0 - f_r * rest),
        div((f_g * f_g) * mean, 1.0 - f_g * rest),
        div((f_b * f_b) * mean, 1.0 - f_b * rest)
    );
    return f * share;
}

// Reflection times cosine, per steradian. Local frame; zero unless both directions are on the upper side.
Spectrum eval_rough_conductor(Closure closure, vec3 wo, vec3 wi) {
    if (!on_upper_side(wo, wi)) {
        return spectrum_zero();
    }
    uint kind = closure.distribution;
    vec3 wm = normalize3(wo + wi);
    float d = facet_d(kind, closure.alpha_u, closure.alpha_v, first_scale(closure), wm);
    float g = smith_g_separable(kind, closure.alpha_u, closure.alpha_v, wo, wi);
    vec3 f = fresnel_closure(closure, min_(dot3(wo, wm), 1.0));
    vec3 reflected = f * div(d * g, 4.0 * wo.z);
    if ((closure.flags & MATERIAL_COMPENSATE) != 0u) {
        reflected += multiple_scattering(closure, wo.z, wi.z);
    }
    return spectrum_from_rgb(closure.specular_color * reflected);
}

// Probability of sampling what scatters more than once: its share of the light, if nothing is absorbed.
float multiple_probability(Closure closure, float cos_o) {
    if ((closure.flags & MATERIAL_COMPENSATE) == 0u) {
        return 0.0;
    }
    return clamp_(1.0 - albedo_at(closure.table, cos_o), 0.0, 1.0);
}

// Density of `sample_rough_conductor`; its integral over the upper side is below 1 by what falls under the horizon.
float pdf_rough_conductor(Closure closure, vec3 wo, vec3 wi) {
    if (!on_upper_side(wo, wi)) {
        return 0.0;
    }
    float p = multiple_probability(closure, wo.z);
    vec3 wm = normalize3(wo + wi);
    float facets = pdf_reflecting(closure.distribution, closure.alpha_u, closure.alpha_v, wo, wm);
    // d omega_i = 4 (V.H) d omega_h
    float single = div(facets, 4.0 * max_(dot3(wo, wm), 1.0e-7));
    return p * (wi.z * INV_PI) + (1.0 - p) * single;
}

// `wo` mirrored about a visible facet, or cosine-weighted for what scatters more than once; what falls below the horizon
// is dropped. `u`: 0..1 each, excluding 1. `u_lobe`: 0..1, chooses.
DirectionSample sample_rough_conductor(Closure closure, vec3 wo, vec2 u, float u_lobe) {
    if (wo.z <= COS_MIN) {
        return no_direction();
    }
    vec3 wi = square_to_cosine_hemisphere(u);
    if (u_lobe >= multiple_probability(closure, wo.z)) {
        wi = reflect_about(wo, sample_reflecting(closure.distribution, closure.alpha_u, closure.alpha_v, wo, u));
    }
    if (!on_upper_side(wo, wi)) {
        return no_direction();
    }
    return make_direction(wi, pdf_rough_conductor(closure, wo, wi));
}

#endif
