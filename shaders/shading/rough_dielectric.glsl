// Rough glass: facets that reflect and refract. Local frame; z leaves the outside.
//
// f_r = O_d D G F / (4 |N.L||N.V|), f_t = O_s |L.H||V.H| (1 - F) D G / (|N.L||N.V| (V.H + eta L.H)^2) with eta the index on
// the side of L over that of V: radiance is carried, so the eta^2 of the change of solid angle is cancelled.
// Source: Walter et al. 2007, "Microfacet Models for Refraction through Rough Surfaces", equations 20 and 21.
#ifndef SHADING_ROUGH_DIELECTRIC_GLSL
#define SHADING_ROUGH_DIELECTRIC_GLSL

#include "layout/records.glsl"
#include "shading/closure.glsl"
#include "shading/bsdf.glsl"
#include "shading/distribution.glsl"
#include "shading/fresnel.glsl"
#include "shading/lobe.glsl"
#include "shading/math.glsl"
#include "shading/rough_conductor.glsl"
#include "shading/spectrum.glsl"

// Index on the other side of `wo` over that on its own.
float eta_across(Closure closure, vec3 wo) {
    return wo.z >= 0.0 ? closure.eta : rcp(closure.eta);
}

// The facet that takes `wo` to `wi`, on the outside (z > 0); the zero vector if none does. `eta`: `eta_across`.
vec3 half_vector(vec3 wo, vec3 wi, float eta) {
    bool reflects = wo.z * wi.z > 0.0;
    vec3 h = normalize3(wo + wi * (reflects ? 1.0 : eta));
    vec3 wm = h.z < 0.0 ? -h : h;
    // Both see the facet from the side on which they are.
    bool seen = dot3(wo, wm) * wo.z > 0.0 && dot3(wi, wm) * wi.z > 0.0;
    return seen && abs(wo.z) > COS_MIN && abs(wi.z) > COS_MIN ? wm : vec3(0.0);
}

// |d omega_h / d omega_i| of refraction (equation 17). `o_h`, `i_h`: signed cosines of V and L to the facet.
float refraction_jacobian(float o_h, float i_h, float eta) {
    float root = o_h + eta * i_h;
    return div((eta * eta) * abs(i_h), max_(root * root, 1.0e-12));
}

// Reflection or transmission times cosine, per steradian.
Spectrum eval_rough_dielectric(Closure closure, vec3 wo, vec3 wi) {
    float eta = eta_across(closure, wo);
    vec3 wm = half_vector(wo, wi, eta);
    if (wm.z <= COS_MIN) {
        return spectrum_zero();
    }
    uint kind = closure.distribution;
    float o_h = dot3(wo, wm);
    float i_h = dot3(wi, wm);
    float d = facet_d(kind, closure.alpha_u, closure.alpha_v, 1.0, wm);
    float g = smith_g_separable(kind, closure.alpha_u, closure.alpha_v, wo, wi);
    float f = fresnel_dielectric(min_(abs(o_h), 1.0), eta);
    if (wo.z * wi.z > 0.0) {
        return spectrum_from_rgb(closure.color * div((f * d) * g, 4.0 * abs(wo.z)));
    }
    float root = o_h + eta * i_h;
    float through = div(((1.0 - f) * d) * (g * abs(o_h * i_h)), abs(wo.z) * max_(root * root, 1.0e-12));
    return spectrum_from_rgb(closure.specular_color * through);
}

// Density of `sample_rough_dielectric` over the sphere.
float pdf_rough_dielectric(Closure closure, vec3 wo, vec3 wi) {
    float eta = eta_across(closure, wo);
    vec3 wm = half_vector(wo, wi, eta);
    if (wm.z <= COS_MIN) {
        return 0.0;
    }
    float o_h = dot3(wo, wm);
    // Seen from inside: the view through the surface's mirror, whose facets are the same.
    vec3 view = vec3(wo.x, wo.y, abs(wo.z));
    vec3 facing = wo.z < 0.0 ? vec3(-wm.x, -wm.y, wm.z) : wm;
    float facets = pdf_facet(closure.distribution, closure.alpha_u, closure.alpha_v, view, facing);
    float f = fresnel_dielectric(min_(abs(o_h), 1.0), eta);
    if (wo.z * wi.z > 0.0) {
        return div(f * facets, 4.0 * abs(o_h));
    }
    return ((1.0 - f) * facets) * refraction_jacobian(o_h, dot3(wi, wm), eta);
}

// Reflected or refracted by a visible facet, by Fresnel's probability. `u`: 0..1 each, excluding 1. `u_lobe`: 0..1, chooses.
BsdfSample sample_rough_dielectric(Closure closure, vec3 wo, vec2 u, float u_lobe) {
    if (abs(wo.z) <= COS_MIN) {
        return no_sample();
    }
    float side = wo.z < 0.0 ? -1.0 : 1.0;
    float eta = eta_across(closure, wo);
    vec3 view = vec3(wo.x, wo.y, wo.z * side);
    vec3 wm = sample_facet(closure.distribution, closure.alpha_u, closure.alpha_v, view, u);
    float o_h = dot3(view, wm);
    if (o_h <= COS_MIN) {
        return no_sample();
    }
    float f = fresnel_dielectric(min_(o_h, 1.0), eta);
    vec3 upper = reflect_about(view, wm);
    uint flags = 0u;
    if (u_lobe >= f) {
        float root = refraction_root(min_(o_h, 1.0), eta);
        if (root <= 0.0) {
            return no_sample();
        }
        float ratio = rcp(eta);
        upper = normalize3(wm * (ratio * o_h - sqrt_(root) * ratio) - view * ratio);
        flags = SAMPLE_TRANSMIT;
    }
    bool kept = flags == 0u ? upper.z > COS_MIN : upper.z < -COS_MIN;
    if (!kept) {
        return no_sample();
    }
    vec3 wi = vec3(upper.x, upper.y, upper.z * side);
    float pdf = pdf_rough_dielectric(closure, wo, wi);
    return finish_sample(wi, pdf, eval_rough_dielectric(closure, wo, wi), flags == 0u ? 1.0 : eta, flags);
}

#endif
