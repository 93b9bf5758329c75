// Rough diffuse reflection that loses no energy: Fujii's form of Oren and Nayar's model, and what its cavities reflect among
// each other. `roughness` 0 is Lambert's model, 1 the roughest.
// Source: Portsmouth, Kutz and Hill 2025, "EON: A Practical Energy-Preserving Rough Diffuse BRDF", JCGT 14(1), listings 1 to 3;
// <https://jcgt.org/published/0014/01/06/>.
#ifndef SHADING_EON_GLSL
#define SHADING_EON_GLSL

#include "layout/records.glsl"
#include "shading/closure.glsl"
#include "shading/lobe.glsl"
#include "shading/math.glsl"
#include "shading/spectrum.glsl"
#include "shading/warp.glsl"

// 1/2 - 2 / (3 pi), and 2/3 - 28 / (15 pi).
const float FON_A = 0.287793398;
const float FON_B = 0.0724882111;

// Part of white light from one direction that cavities of a white surface reflect without interreflection, within .1 %.
float eon_albedo(float cos_theta, float roughness) {
    float x = 1.0 - cos_theta;
    float g = x * (0.0571085289 + x * (0.491881867 + x * (-0.332181442 + x * 0.0714429953)));
    return div(1.0 + roughness * g, 1.0 + FON_A * roughness);
}

// Reflectance of one channel: `single` times its colour, and `multiple` times what is left of it after reflection among cavities
// whose mean albedo is `mean`.
float eon_channel(float color, float single, float multiple, float mean) {
    float coupled = div((color * color) * mean, max_(1.0 - color * (1.0 - mean), 1.0e-6));
    return color * single + coupled * multiple;
}

// Reflection times cosine, per steradian. Local frame; zero unless both directions are on the upper side.
Spectrum eval_eon(Closure closure, vec3 wo, vec3 wi) {
    if (!on_upper_side(wo, wi)) {
        return spectrum_zero();
    }
    float r = closure.roughness;
    float s = wo.x * wi.x + wo.y * wi.y;
    float along = s > 0.0 ? div(s, max_(wo.z, wi.z)) : s;
    float a = rcp(1.0 + FON_A * r);
    float mean = a * (1.0 + FON_B * r);
    float scale = (closure.k_d * INV_PI) * wi.z;
    float single = (scale * a) * (1.0 + r * along);
    float lost = max_(1.0 - eon_albedo(wo.z, r), 1.0e-7) * max_(1.0 - eon_albedo(wi.z, r), 1.0e-7);
    float multiple = scale * div(lost, max_(1.0 - mean, 1.0e-7));
    return spectrum_from_rgb(vec3(
        eon_channel(closure.color.x, single, multiple, mean),
        eon_channel(closure.color.y, single, multiple, mean),
        eon_channel(closure.color.z, single, multiple, mean)
    ));
}

// The linear transform of cosines that the lobe seen from a cosine `mu` is like: a, b, c, d of ((a, 0, b), (0, c, 0), (d, 0, 1)).
vec4 eon_transform(float mu, float r) {
    float a = r * (0.303392 + (0.111709 * mu - 0.518982) * mu + (0.335918 * mu - 0.276266) * r) + 1.0;
    float b = div(r * ((1.15859 * mu - 1.16407) + (0.150815 - 0.150105 * mu) * r), (mu * mu) * mu - 1.43545);
    float c = (0.20013 + (0.261777 * mu - 0.506373) * mu) * r + 1.0;
    float d = div((0.540852 + (0.475392 * mu - 1.01625) * mu) * r, mu * (0.0725628 + mu) - 1.0743);
    return vec4(a, b, c, d);
}

// Area of the unit disk, over pi, that the transform leaves above the horizon. `d`: of `eon_transform`.
float eon_clip(float d) {
    return (rsqrt(d * d + 1.0) + 1.0) * 0.5;
}

// Unit vector across the normal towards `w`; x where that is the normal itself.
vec2 eon_azimuth(vec3 w) {
    float across2 = w.x * w.x + w.y * w.y;
    if (across2 <= 1.0e-14) {
        return vec2(1.0, 0.0);
    }
    return vec2(w.x, w.y) * rsqrt(across2);
}

// Probability of a direction that is uniform over the hemisphere.
float eon_uniform(float mu, float r) {
    if (r <= 0.0) {
        return 0.0;
    }
    return pow_(r, 0.1) * (0.162925 + mu * ((0.538233 - 0.290822 * mu) * mu - 0.372058));
}

// Density of `sample_eon`.
float pdf_eon(Closure closure, vec3 wo, vec3 wi) {
    if (!on_upper_side(wo, wi)) {
        return 0.0;
    }
    vec4 m = eon_transform(wo.z, closure.roughness);
    vec2 t = eon_azimuth(wo);
    float x = wi.x * t.x + wi.y * t.y;
    float y = wi.y * t.x - wi.x * t.y;
    float minor = m.x - m.y * m.w;
    vec3 h = vec3(m.z * (x - m.y * wi.z), minor * y, m.z * (m.x * wi.z - m.w * x));
    float determinant = m.z * minor;
    float length2 = (h.x * h.x + h.y * h.y) + h.z * h.z;
    float clipped = div((determinant * determinant) * max_(h.z, 0.0), ((length2 * length2) * PI) * eon_clip(m.w));
    float even = eon_uniform(wo.z, closure.roughness);
    return even * INV_TWO_PI + (1.0 - even) * clipped;
}

// Uniform over the hemisphere, or by a linearly transformed cosine of which what falls below the horizon is clipped away.
// `u`: 0..1 each, excluding 1. `u_lobe`: 0..1, chooses.
DirectionSample sample_eon(Closure closure, vec3 wo, vec2 u, float u_lobe) {
    if (wo.z <= COS_MIN) {
        return no_direction();
    }
    vec3 wi = square_to_uniform_hemisphere(u);
    if (u_lobe >= eon_uniform(wo.z, closure.roughness)) {
        vec4 m = eon_transform(wo.z, closure.roughness);
        float radius = sqrt_(u.x);
        float y = radius * sin_turns(u.y);
        // Half a disk, and the part of the other half that stays above the horizon.
        float edge = sqrt_(max_(1.0 - y * y, 0.0));
        float x = -mix_(edge, radius * cos_turns(u.y), eon_clip(m.w));
        float z = sqrt_(max_(1.0 - (x * x + y * y), 0.0));
        vec3 bent = normalize3(vec3(m.x * x + m.y * z, m.z * y, m.w * x + z));
        vec2 t = eon_azimuth(wo);
        wi = vec3(bent.x * t.x - bent.y * t.y, bent.x * t.y + bent.y * t.x, bent.z);
    }
    if (!on_upper_side(wo, wi)) {
        return no_direction();
    }
    return make_direction(wi, pdf_eon(closure, wo, wi));
}

#endif
