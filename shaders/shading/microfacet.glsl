// Distributions and shadowing of microfacets.
//
// Directions are in the local frame; wm is a facet's normal. Slopes: tan^2 of the angle between wm and N.
#ifndef SHADING_MICROFACET_GLSL
#define SHADING_MICROFACET_GLSL

#include "shading/math.glsl"

// The smallest rms slope; smaller values are taken as this. Below it one ULP of a half vector moves D visibly, and
// D(0) = 1 / (pi m^2) = 3.2e5 would outgrow the film; a mirror is `MODEL_MIRROR`.
const float M_MIN = 1.0e-3;

// Beyond e^-60 a distribution counts as zero, so that no subnormal appears further on.
const float EXPONENT_MAX = 60.0;

// tan^2 of the angle between w (any length) and z. `w.z` > 0.
float tan2_theta(vec3 w) {
    return div(w.x * w.x + w.y * w.y, w.z * w.z);
}

// Beckmann's distribution from the squared slope, per steradian:
// e^(-tan^2 a / m^2) / (pi m^2 cos^4 a), so that the integral of D cos a over the hemisphere is 1.
// `tan2`: >= 0. `m`: rms slope, >= `M_MIN` (clamped).
// Source: Cook and Torrance 1982, equation for D, with the pi of Walter et al. 2007, equation 25.
// Relative error below 2e-5, for the slope as given.
float beckmann_d_slope(float tan2, float m) {
    float m_clamped = max_(m, M_MIN);
    float inv_m2 = div(1.0, m_clamped * m_clamped);
    float x = tan2 * inv_m2;
    if (x > EXPONENT_MAX) {
        return 0.0;
    }
    // 1 / cos^2 a = 1 + tan^2 a
    float inv_c2 = 1.0 + tan2;
    return ((exp_(-x) * INV_PI) * inv_m2) * (inv_c2 * inv_c2);
}

// Beckmann's distribution from cos a = N.H; zero below the horizon. `cos_h`: -1..1. See `beckmann_d_slope`.
float beckmann_d(float cos_h, float m) {
    if (cos_h <= 1.0e-6) {
        return 0.0;
    }
    float s2 = max_((1.0 - cos_h) * (1.0 + cos_h), 0.0);
    return beckmann_d_slope(div(s2, cos_h * cos_h), m);
}

// Weighted sum of two Beckmann lobes (Cook and Torrance 1982, section "facet slope distribution").
// Normalised if w0 + w1 = 1; a lobe of weight 0 costs nothing.
float beckmann_lobes_d_slope(float tan2, float m0, float m1, float w0, float w1) {
    float d = 0.0;
    if (w0 > 0.0) {
        d += w0 * beckmann_d_slope(tan2, m0);
    }
    if (w1 > 0.0) {
        d += w1 * beckmann_d_slope(tan2, m1);
    }
    return d;
}

// Masking and shadowing in a V-shaped groove: min(1, 2 (N.H)(N.V)/(V.H), 2 (N.H)(N.L)/(V.H)), 0..1.
// Arguments are those cosines, 0..1. Source: Torrance and Sparrow 1967; Cook and Torrance 1982.
float v_cavity_g(float n_h, float n_v, float v_h, float n_l) {
    float groove = (2.0 * n_h) * min_(n_v, n_l);
    return max_(min_(div(groove, max_(v_h, 1.0e-7)), 1.0), 0.0);
}

// A facet normal with density `pdf_beckmann`. `u`: 0..1 each, excluding 1.
// Source: Walter et al. 2007, "Microfacet Models for Refraction", equations 28 and 29.
vec3 sample_beckmann(vec2 u, float m) {
    float m_clamped = max_(m, M_MIN);
    // 1 - u is in (0, 1], where the logarithm is finite.
    float tan2 = (m_clamped * m_clamped) * max_(-log_(1.0 - u.x), 0.0);
    float cos_h = rsqrt(1.0 + tan2);
    float sin_h = sqrt_(tan2) * cos_h;
    return vec3(sin_h * cos_turns(u.y), sin_h * sin_turns(u.y), cos_h);
}

// Density of `sample_beckmann` per solid angle of the facet normal: D(wm) cos a. Zero below the horizon.
float pdf_beckmann(vec3 wm, float m) {
    if (wm.z <= 1.0e-6) {
        return 0.0;
    }
    return beckmann_d_slope(tan2_theta(wm), m) * wm.z;
}

#endif
