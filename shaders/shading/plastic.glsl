// A diffuse base under a coat of index eta, smooth or rough.
//
// What enters is refracted in and out and scattered by the base any number of times: the diffuse part is
// O_d / (1 - O_d R) T(o) T(i) / (pi eta^2), R the coat's diffuse reflectance from inside, or without `MATERIAL_NONLINEAR`
// O_d / (1 - R) ..., which keeps the base's hue. A smooth coat's T is 1 - F and its reflection a lobe of zero width; a rough one
// has facets, and T and R are tables of its transmittance (bake). `specular_color` is a factor on the coat's reflection.
// Source: Jakob et al. 2022, "Mitsuba 3", plugins `plastic` and `roughplastic`, whose parameters these are; the coat after
// Walter et al. 2007.
#ifndef SHADING_PLASTIC_GLSL
#define SHADING_PLASTIC_GLSL

#include "layout/records.glsl"
#include "shading/closure.glsl"
#include "shading/albedo.glsl"
#include "shading/bsdf.glsl"
#include "shading/distribution.glsl"
#include "shading/fresnel.glsl"
#include "shading/lobe.glsl"
#include "shading/math.glsl"
#include "shading/rough_conductor.glsl"
#include "shading/spectrum.glsl"
#include "shading/warp.glsl"

// One channel of the base as seen through the coat, without T: `inner` is the coat's reflectance from inside.
float coated_channel(float color, float inner, bool nonlinear) {
    return div(color, max_(1.0 - (nonlinear ? color * inner : inner), 1.0e-6));
}

// The base's part times cosine, per steradian. `transmitted`: T(o) T(i). `inner`: the coat's reflectance from inside.
vec3 coated_diffuse(Closure closure, float transmitted, float inner, float cos_i) {
    bool nonlinear = (closure.flags & MATERIAL_NONLINEAR) != 0u;
    float inv_eta = rcp(closure.eta);
    float scale = ((INV_PI * cos_i) * (inv_eta * inv_eta)) * transmitted;
    return vec3(
        coated_channel(closure.color.x, inner, nonlinear),
        coated_channel(closure.color.y, inner, nonlinear),
        coated_channel(closure.color.z, inner, nonlinear)
    ) * scale;
}

// Probability of sampling the coat, which reflects the share `reflected` of what comes, rather than the base.
float coat_probability(Closure closure, float reflected) {
    float s = (closure.specular_color.x + closure.specular_color.y) + closure.specular_color.z;
    float d = (closure.color.x + closure.color.y) + closure.color.z;
    float coat = reflected * s;
    float base = (1.0 - reflected) * d;
    return coat + base > 1.0e-20 ? div(coat, coat + base) : 0.0;
}

// The base's part times cosine, per steradian; zero unless both directions are on the upper side.
Spectrum eval_plastic(Closure closure, vec3 wo, vec3 wi) {
    if (!on_upper_side(wo, wi)) {
        return spectrum_zero();
    }
    float t_o = 1.0 - fresnel_dielectric(wo.z, closure.eta);
    float t_i = 1.0 - fresnel_dielectric(wi.z, closure.eta);
    return spectrum_from_rgb(coated_diffuse(closure, t_o * t_i, closure.inner_reflectance, wi.z));
}

// Density of the base's part of `sample_plastic`.
float pdf_plastic(Closure closure, vec3 wo, vec3 wi) {
    if (!on_upper_side(wo, wi)) {
        return 0.0;
    }
    float p = coat_probability(closure, fresnel_dielectric(wo.z, closure.eta));
    return (1.0 - p) * (wi.z * INV_PI);
}

// Mirrored by the coat, or cosine-weighted. `u`: 0..1 each, excluding 1. `u_lobe`: 0..1, chooses.
BsdfSample sample_plastic(Closure closure, vec3 wo, vec2 u, float u_lobe) {
    if (wo.z <= COS_MIN) {
        return no_sample();
    }
    float f = fresnel_dielectric(wo.z, closure.eta);
    float p = coat_probability(closure, f);
    if (u_lobe < p) {
        Spectrum weight = spectrum_from_rgb(closure.specular_color * div(f, p));
        return make_sample(reflect_local(wo), p, weight, 1.0, SAMPLE_DELTA);
    }
    vec3 wi = square_to_cosine_hemisphere(u);
    return finish_sample(wi, pdf_plastic(closure, wo, wi), eval_plastic(closure, wo, wi), 1.0, 0u);
}

// Both parts times cosine, per steradian; zero unless both directions are on the upper side.
Spectrum eval_rough_plastic(Closure closure, vec3 wo, vec3 wi) {
    if (!on_upper_side(wo, wi)) {
        return spectrum_zero();
    }
    uint kind = closure.distribution;
    vec3 wm = normalize3(wo + wi);
    float d = facet_d(kind, closure.alpha_u, closure.alpha_u, first_scale(closure), wm);
    float g = smith_g_separable(kind, closure.alpha_u, closure.alpha_u, wo, wi);
    float f = fresnel_dielectric(min_(dot3(wo, wm), 1.0), closure.eta);
    vec3 coat = closure.specular_color * div((f * d) * g, 4.0 * wo.z);
    float through = albedo_at(closure.table, wo.z) * albedo_at(closure.table, wi.z);
    return spectrum_from_rgb(coat + coated_diffuse(closure, through, load_table(closure.table + 6u), wi.z));
}

// Density of `sample_rough_plastic`; its integral over the upper side is below 1 by what falls under the horizon.
float pdf_rough_plastic(Closure closure, vec3 wo, vec3 wi) {
    if (!on_upper_side(wo, wi)) {
        return 0.0;
    }
    float p = coat_probability(closure, 1.0 - albedo_at(closure.table, wo.z));
    vec3 wm = normalize3(wo + wi);
    float facets = pdf_reflecting(closure.distribution, closure.alpha_u, closure.alpha_u, wo, wm);
    float coat = div(facets, 4.0 * max_(dot3(wo, wm), 1.0e-7));
    return p * coat + (1.0 - p) * (wi.z * INV_PI);
}

// `wo` mirrored about a visible facet of the coat, or cosine-weighted. `u`: 0..1 each, excluding 1. `u_lobe`: chooses.
DirectionSample sample_rough_plastic(Closure closure, vec3 wo, vec2 u, float u_lobe) {
    if (wo.z <= COS_MIN) {
        return no_direction();
    }
    vec3 wi = square_to_cosine_hemisphere(u);
    if (u_lobe < coat_probability(closure, 1.0 - albedo_at(closure.table, wo.z))) {
        wi = reflect_about(wo, sample_reflecting(closure.distribution, closure.alpha_u, closure.alpha_u, wo, u));
    }
    if (!on_upper_side(wo, wi)) {
        return no_direction();
    }
    return make_direction(wi, pdf_rough_plastic(closure, wo, wi));
}

#endif
