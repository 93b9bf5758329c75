// How much light an interface reflects.
//
// Both functions are exact for unpolarised light. Source: Born and Wolf 1999, "Principles of Optics", section 1.5.2
// (dielectrics) and 14.2 (metals), written without complex numbers.
#ifndef SHADING_FRESNEL_GLSL
#define SHADING_FRESNEL_GLSL

#include "layout/records.glsl"
#include "shading/closure.glsl"
#include "shading/math.glsl"

// (eta cos theta_t)^2 = eta^2 - sin^2 theta_i; zero or less is total internal reflection.
// `cos_i`: 0..1. `eta`: transmitted over incident index. The one place that decides it, for reflection and refraction.
float refraction_root(float cos_i, float eta) {
    // (eta - 1)(eta + 1) instead of eta^2 - 1 keeps the digits of an index near 1.
    return (eta - 1.0) * (eta + 1.0) + cos_i * cos_i;
}

// Reflectance of a dielectric interface for unpolarised light, 0..1.
// `cos_i`: cosine between normal and incident direction, 0..1.
// `eta`: index on the transmitted side over index on the incident side, > 0.
// 1 on total internal reflection. Absolute error below 2e-6 (not within .5 degree of the critical angle,
// whose slope is infinite).
float fresnel_dielectric(float cos_i, float eta) {
    // No interface; at grazing incidence the formula would be 0 / 0.
    if (eta == 1.0) {
        return 0.0;
    }
    float c = clamp_(cos_i, 0.0, 1.0);
    float root = refraction_root(c, eta);
    if (root <= 0.0) {
        return 1.0;
    }
    float g = sqrt_(root);
    float r_s = div(c - g, c + g);
    float eta2_c = (eta * eta) * c;
    float r_p = div(eta2_c - g, eta2_c + g);
    return min_(0.5 * (r_s * r_s + r_p * r_p), 1.0);
}

// Reflectance of a conductor for unpolarised light, 0..1.
// `cos_i`: 0..1. `eta` + i `k`: complex index relative to the outside, eta > 0, k >= 0, both below 1000.
// With k = 0 it is `fresnel_dielectric`. Absolute error below 2e-5.
float fresnel_conductor(float cos_i, float eta, float k) {
    float c = clamp_(cos_i, 0.0, 1.0);
    float c2 = c * c;
    float s2 = (1.0 - c) * (1.0 + c);
    float eta_k = eta * k;
    float t0 = refraction_root(c, eta) - k * k;
    float a2_b2 = sqrt_(t0 * t0 + 4.0 * (eta_k * eta_k));
    // a^2 = (a2_b2 + t0) / 2; for t0 < 0 the sum cancels, so it is taken from a^2 b^2 = (eta k)^2.
    float a2 = t0 >= 0.0 ? 0.5 * (a2_b2 + t0) : div(2.0 * (eta_k * eta_k), a2_b2 - t0);
    float two_a_c = 2.0 * (sqrt_(max_(a2, 0.0)) * c);
    float r_s = div(max_((a2_b2 + c2) - two_a_c, 0.0), (a2_b2 + c2) + two_a_c);
    float p = c2 * a2_b2 + s2 * s2;
    float q = two_a_c * s2;
    float r_p = r_s * div(max_(p - q, 0.0), p + q);
    return min_(0.5 * (r_s + r_p), 1.0);
}

// `fresnel_conductor` for each colour channel.
vec3 fresnel_conductor3(float cos_i, vec3 eta, vec3 k) {
    return vec3(
        fresnel_conductor(cos_i, eta.x, k.x),
        fresnel_conductor(cos_i, eta.y, k.y),
        fresnel_conductor(cos_i, eta.z, k.z)
    );
}

// Schlick's approximation f0 + (1 - f0) (1 - cos)^5 for each colour channel. `cos_i`: 0..1. `f0`: at normal incidence.
// Source: Schlick 1994, "An Inexpensive BRDF Model for Physically-based Rendering", equation 15.
vec3 fresnel_schlick3(float cos_i, vec3 f0) {
    float c = 1.0 - clamp_(cos_i, 0.0, 1.0);
    float c2 = c * c;
    float c5 = (c2 * c2) * c;
    return f0 + (vec3(1.0) - f0) * c5;
}

// Fresnel reflectance of a material's interface seen from outside, linear Rec. 709: conductor, Schlick or dielectric by
// its flags. `cos_i`: cosine between the interface's or the facet's normal and the direction, 0..1.
vec3 fresnel_closure(Closure closure, float cos_i) {
    if ((closure.flags & MATERIAL_CONDUCTOR) != 0u) {
        return fresnel_conductor3(cos_i, closure.metal_eta, closure.metal_k);
    }
    if ((closure.flags & MATERIAL_SCHLICK) != 0u) {
        return fresnel_schlick3(cos_i, closure.f0);
    }
    return vec3(fresnel_dielectric(cos_i, closure.eta));
}

#endif
