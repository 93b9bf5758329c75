// What the reflection models share: samples, mirror directions, cosine powers, the choice between two lobes.
#ifndef SHADING_LOBE_GLSL
#define SHADING_LOBE_GLSL

#include "layout/records.glsl"
#include "shading/closure.glsl"
#include "shading/frame.glsl"
#include "shading/math.glsl"

// Directions closer to the horizon than this cosine count as below it, so that nothing divides by zero.
const float COS_MIN = 1.0e-6;

// What `sample_x` returns.
struct DirectionSample {
    // Unit, local frame, leaving the surface.
    vec3 wi;
    // Per solid angle; 0 if the sample is to be dropped.
    float pdf;
};

// A sample of both its parts.
DirectionSample make_direction(vec3 wi, float pdf) {
    return DirectionSample(wi, pdf);
}

// The sample that is to be dropped.
DirectionSample no_direction() {
    return DirectionSample(vec3(0.0, 0.0, 1.0), 0.0);
}

// True if both directions are above the horizon.
bool on_upper_side(vec3 wo, vec3 wi) {
    return wo.z > COS_MIN && wi.z > COS_MIN;
}

// Mirror direction about the normal, local frame: R = 2 N (N.L) - L.
vec3 reflect_local(vec3 w) {
    return vec3(-w.x, -w.y, w.z);
}

// Mirror direction of `w` about the unit vector `m`: 2 m (m.w) - w.
vec3 reflect_about(vec3 w, vec3 m) {
    return m * (2.0 * dot3(w, m)) - w;
}

// max(0, x)^n with 0^0 = 1. `x`: a cosine, at most 1. `n`: >= 0. Below 2^-100 it is 0.
float cos_power(float x, float n) {
    if (n == 0.0) {
        return 1.0;
    }
    if (x <= 0.0) {
        return 0.0;
    }
    // Rounded unit vectors have products a few ULP above 1, which a large n would amplify.
    if (x >= 1.0) {
        return 1.0;
    }
    float power = pow_(x, n);
    return power < TINY ? 0.0 : power;
}

// A direction about z with density `pdf_cos_power`. `u`: 0..1 each, excluding 1. `n`: >= 0.
// Source: Lafortune and Willems 1994, "Using the Modified Phong Reflectance Model for Physically Based Rendering".
vec3 sample_cos_power(vec2 u, float n) {
    // 1 - u is in (0, 1]: no power of zero.
    float cos_a = cos_power(1.0 - u.x, rcp(n + 1.0));
    float sin_a = sqrt_(max_((1.0 - cos_a) * (1.0 + cos_a), 0.0));
    return vec3(sin_a * cos_turns(u.y), sin_a * sin_turns(u.y), cos_a);
}

// Density (n + 1) / (2 pi) cos^n a of `sample_cos_power`, per solid angle of the hemisphere.
float pdf_cos_power(float cos_a, float n) {
    if (cos_a <= 0.0) {
        return 0.0;
    }
    return ((n + 1.0) * INV_TWO_PI) * cos_power(cos_a, n);
}

// `w`, given about z, turned so that z becomes the unit vector `axis`.
vec3 turn_to(vec3 axis, vec3 w) {
    return to_world(frame_from_normal(axis), w);
}

// Probability of sampling the specular lobe rather than the diffuse one, 0..1: by weight and brightest channel.
// Zero if the material reflects nothing.
float specular_probability(Closure closure) {
    float diffuse = closure.k_d * max3_(closure.color);
    float specular = closure.k_s * max3_(closure.specular_color);
    float sum = diffuse + specular;
    return sum > 1.0e-20 ? div(specular, sum) : 0.0;
}

#endif
