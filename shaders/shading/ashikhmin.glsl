// Ashikhmin and Shirley's anisotropic Phong lobe with its coupled diffuse part (row 19): R_s = k_s O_s, R_d = k_d O_d,
// exponents n_u (`exponent`) along the tangent and n_v (`exponent_v`) across.
// Source: Ashikhmin and Shirley 2000, "An Anisotropic Phong BRDF Model", equations 4 to 9.
#ifndef SHADING_ASHIKHMIN_GLSL
#define SHADING_ASHIKHMIN_GLSL

#include "layout/records.glsl"
#include "shading/closure.glsl"
#include "shading/fresnel.glsl"
#include "shading/lobe.glsl"
#include "shading/math.glsl"
#include "shading/spectrum.glsl"
#include "shading/warp.glsl"

// Density of the lobe's half vectors: sqrt((n_u + 1)(n_v + 1)) / (2 pi) (N.H)^(n_u cos^2 phi + n_v sin^2 phi).
float ashikhmin_lobe(Closure closure, vec3 wm) {
    float x2 = wm.x * wm.x;
    float y2 = wm.y * wm.y;
    float across = x2 + y2;
    float n = closure.exponent;
    if (across > 1.0e-12) {
        n = div(closure.exponent * x2 + closure.exponent_v * y2, across);
    }
    float norm = sqrt_((closure.exponent + 1.0) * (closure.exponent_v + 1.0));
    return (norm * INV_TWO_PI) * cos_power(wm.z, n);
}

// 1 - (1 - cos / 2)^5.
float ashikhmin_falloff(float cos_theta) {
    float c = 1.0 - 0.5 * cos_theta;
    float c2 = c * c;
    return 1.0 - (c2 * c2) * c;
}

// Diffuse and specular reflection times cosine, per steradian. Local frame; zero unless both are on the upper side.
Spectrum eval_ashikhmin(Closure closure, vec3 wo, vec3 wi) {
    if (!on_upper_side(wo, wi)) {
        return spectrum_zero();
    }
    vec3 wm = normalize3(wo + wi);
    float v_h = min_(dot3(wo, wm), 1.0);
    vec3 r_s = closure.specular_color * closure.k_s;
    // equation 4, whose 8 pi is 4 times the density's 2 pi
    float lobe = div(ashikhmin_lobe(closure, wm), (4.0 * max_(v_h, 1.0e-7)) * max_(wo.z, wi.z));
    vec3 specular = fresnel_schlick3(v_h, r_s) * (lobe * wi.z);
    // equation 5: 28 / (23 pi)
    float falloff = (0.387507647 * ashikhmin_falloff(wo.z)) * ashikhmin_falloff(wi.z);
    vec3 diffuse = (closure.color * (vec3(1.0) - r_s)) * ((closure.k_d * falloff) * wi.z);
    return spectrum_from_rgb(diffuse + specular);
}

// Probability of sampling the specular lobe: what Fresnel reflects at the viewer's angle against the rest.
float ashikhmin_probability(Closure closure, float cos_o) {
    float r_s = closure.k_s * max3_(closure.specular_color);
    float specular = max3_(fresnel_schlick3(cos_o, vec3(r_s)));
    float diffuse = (closure.k_d * max3_(closure.color)) * (1.0 - min_(r_s, 1.0));
    float sum = specular + diffuse;
    return sum > 1.0e-20 ? div(specular, sum) : 0.0;
}

// Density of `sample_ashikhmin`; its integral over the upper side is below 1 by what falls under the horizon.
float pdf_ashikhmin(Closure closure, vec3 wo, vec3 wi) {
    if (!on_upper_side(wo, wi)) {
        return 0.0;
    }
    float p = ashikhmin_probability(closure, wo.z);
    vec3 wm = normalize3(wo + wi);
    float specular = div(ashikhmin_lobe(closure, wm), 4.0 * max_(dot3(wo, wm), 1.0e-7));
    return (1.0 - p) * (wi.z * INV_PI) + p * specular;
}

// Cosine-weighted, or `wo` mirrored about a half vector of the lobe; what falls below the horizon is dropped.
// `u`: 0..1 each, excluding 1. `u_lobe`: 0..1, chooses the lobe.
DirectionSample sample_ashikhmin(Closure closure, vec3 wo, vec2 u, float u_lobe) {
    vec3 wi = square_to_cosine_hemisphere(u);
    if (u_lobe < ashikhmin_probability(closure, wo.z)) {
        // equation 9: tan phi = sqrt((n_u + 1) / (n_v + 1)) tan(2 pi u)
        float x = sqrt_(closure.exponent_v + 1.0) * cos_turns(u.y);
        float y = sqrt_(closure.exponent + 1.0) * sin_turns(u.y);
        float inv = rsqrt(max_(x * x + y * y, 1.0e-20));
        float cos_phi = x * inv;
        float sin_phi = y * inv;
        float n = closure.exponent * (cos_phi * cos_phi) + closure.exponent_v * (sin_phi * sin_phi);
        vec3 about = sample_cos_power(vec2(u.x, 0.0), n);
        wi = reflect_about(wo, vec3(about.x * cos_phi, about.x * sin_phi, about.z));
    }
    if (!on_upper_side(wo, wi)) {
        return no_direction();
    }
    return make_direction(wi, pdf_ashikhmin(closure, wo, wi));
}

#endif
