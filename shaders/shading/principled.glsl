// Disney's material (Burley 2012 and 2015) with the parameters of Mitsuba 3's `principled`: diffuse with retro-reflection, sheen,
// GGX facets between metal and glass, a clear coat.
//
// The base colour is `color`; the other parameters have their own names. With spec_trans the frame's z leaves the outside.
// Sources: Burley 2012, "Physically Based Shading at Disney"; Burley 2015, "Extending the Disney BRDF to a BSDF"; Jakob et al. 2022,
// "Mitsuba 3", plugin `principled` (how the lobes are put together).
#ifndef SHADING_PRINCIPLED_GLSL
#define SHADING_PRINCIPLED_GLSL

#include "layout/records.glsl"
#include "shading/closure.glsl"
#include "shading/bsdf.glsl"
#include "shading/distribution.glsl"
#include "shading/fresnel.glsl"
#include "shading/lobe.glsl"
#include "shading/math.glsl"
#include "shading/rough_dielectric.glsl"
#include "shading/spectrum.glsl"
#include "shading/warp.glsl"

// Roughness of the clear coat's masking (Burley 2012, section 5.4).
const float CLEARCOAT_MASKING = 0.25;

// (1 - cos)^5 of a cosine, either sign.
float schlick_weight(float cos_theta) {
    float c = clamp_(1.0 - abs(cos_theta), 0.0, 1.0);
    float c2 = c * c;
    return (c2 * c2) * c;
}

// Roughness alpha along and across the tangent (Burley 2012, section 5.4).
vec2 principled_alpha(Closure closure) {
    float aspect = sqrt_(1.0 - 0.9 * closure.anisotropic);
    float r2 = closure.roughness * closure.roughness;
    return vec2(max_(div(r2, aspect), M_MIN), max_(r2 * aspect, M_MIN));
}

// The base colour with luminance 1; white for black.
vec3 principled_tint(Closure closure) {
    float luminance = spectrum_luminance(spectrum_from_rgb(closure.color));
    return luminance > 1.0e-6 ? closure.color * rcp(luminance) : vec3(1.0);
}

// What the facets reflect of light on the outside: glass, tinted glass and metal. `f`: the glass's exact reflectance;
// `o_h`: cosine to the facet.
vec3 principled_fresnel(Closure closure, float f, float o_h) {
    float tint = closure.spec_tint;
    float metallic = closure.metallic;
    float root = div(closure.eta - 1.0, closure.eta + 1.0);
    float weight = schlick_weight(o_h);
    vec3 metal = closure.color + (vec3(1.0) - closure.color) * weight;
    vec3 f0 = principled_tint(closure) * (root * root);
    vec3 tinted = f0 + (vec3(1.0) - f0) * weight;
    float glass = 1.0 - metallic;
    return (vec3(f * (1.0 - tint)) + tinted * tint) * glass + metal * metallic;
}

// The clear coat's distribution (generalised Trowbridge and Reitz with exponent 1), per steradian of the facet normal.
// `alpha`: 0.001 to 0.1. Source: Burley 2012, equation 4.
float clearcoat_d(float alpha, float cos_h) {
    float a2 = alpha * alpha;
    return div(a2 - 1.0, (PI * log_(a2)) * (1.0 + (a2 - 1.0) * (cos_h * cos_h)));
}

// Roughness alpha of the clear coat.
float clearcoat_alpha(Closure closure) {
    return mix_(0.1, 0.001, closure.clearcoat_gloss);
}

// Diffuse part, retro-reflection and sheen times cosine, for light and viewer outside.
vec3 principled_diffuse(Closure closure, vec3 wo, vec3 wi, float i_h) {
    float brdf = (1.0 - closure.metallic) * (1.0 - closure.spec_trans);
    float f_o = schlick_weight(wo.z);
    float f_i = schlick_weight(wi.z);
    float smooth_part = (1.0 - 0.5 * f_o) * (1.0 - 0.5 * f_i);
    float retro = (2.0 * closure.roughness) * (i_h * i_h);
    float retro_part = retro * ((f_o + f_i) + (f_o * f_i) * (retro - 1.0));
    // Hanrahan and Krueger's flat look, Burley 2012, section 5.3
    float flatness = closure.flatness;
    float f_ss = mix_(1.0, 0.5 * retro, f_o) * mix_(1.0, 0.5 * retro, f_i);
    float flat_part = 1.25 * (f_ss * (rcp(wo.z + wi.z) - 0.5) + 0.5);
    vec3 base = closure.color * ((brdf * INV_PI) * mix_(smooth_part + retro_part, flat_part, flatness));
    float sheen_tint = closure.sheen_tint;
    vec3 sheen_color = vec3(1.0 - sheen_tint) + principled_tint(closure) * sheen_tint;
    float sheen = (closure.sheen * (1.0 - closure.metallic)) * schlick_weight(i_h);
    return (base + sheen_color * sheen) * wi.z;
}

// All lobes times cosine, per steradian.
Spectrum eval_principled(Closure closure, vec3 wo, vec3 wi) {
    float eta = eta_across(closure, wo);
    bool outside = wo.z > 0.0;
    bool reflects = wo.z * wi.z > 0.0;
    float bsdf = (1.0 - closure.metallic) * closure.spec_trans;
    vec3 wm = half_vector(wo, wi, eta);
    if (wm.z <= COS_MIN) {
        return spectrum_zero();
    }
    float o_h = dot3(wo, wm);
    float i_h = dot3(wi, wm);
    float f = fresnel_dielectric(min_(abs(o_h), 1.0), eta);
    vec2 alpha = principled_alpha(closure);
    float d = facet_d(DISTRIBUTION_TROWBRIDGE_REITZ, alpha.x, alpha.y, 1.0, wm);
    float g = smith_g_separable(DISTRIBUTION_TROWBRIDGE_REITZ, alpha.x, alpha.y, wo, wi);
    if (!reflects) {
        float root = o_h + eta * i_h;
        float through = div(((1.0 - f) * d) * (g * abs(o_h * i_h)), abs(wo.z) * max_(root * root, 1.0e-12));
        vec3 tint = vec3(sqrt_(closure.color.x), sqrt_(closure.color.y), sqrt_(closure.color.z));
        return spectrum_from_rgb(tint * (bsdf * through));
    }
    float facets = div(d * g, 4.0 * abs(wo.z));
    if (!outside) {
        return spectrum_from_rgb(vec3((bsdf * f) * facets));
    }
    vec3 value = principled_fresnel(closure, f, o_h) * facets + principled_diffuse(closure, wo, wi, i_h);
    float clearcoat = closure.clearcoat;
    if (clearcoat > 0.0) {
        float coat_f = mix_(0.04, 1.0, schlick_weight(o_h));
        float coat_d = clearcoat_d(clearcoat_alpha(closure), wm.z);
        float coat_g = smith_g_separable(DISTRIBUTION_TROWBRIDGE_REITZ, CLEARCOAT_MASKING, CLEARCOAT_MASKING, wo, wi);
        value += vec3(((0.25 * clearcoat) * (coat_f * coat_d)) * (coat_g * wi.z));
    }
    return spectrum_from_rgb(value);
}

// Probabilities of the diffuse part (x) and of the clear coat (y); the rest is the facets'.
vec2 principled_choice(Closure closure, vec3 wo) {
    if (wo.z <= 0.0) {
        return vec2(0.0, 0.0);
    }
    float diffuse = (1.0 - closure.metallic) * (1.0 - closure.spec_trans);
    float coat = 0.25 * closure.clearcoat;
    float inv = rcp((1.0 + diffuse) + coat);
    return vec2(diffuse * inv, coat * inv);
}

// Probability that a facet reflects rather than refracts. `f`: its exact reflectance.
float principled_reflection(Closure closure, float f, bool outside) {
    float bsdf = (1.0 - closure.metallic) * closure.spec_trans;
    return outside ? 1.0 - bsdf * (1.0 - f) : f;
}

// Density of `sample_principled` over the sphere.
float pdf_principled(Closure closure, vec3 wo, vec3 wi) {
    float eta = eta_across(closure, wo);
    vec3 wm = half_vector(wo, wi, eta);
    if (wm.z <= COS_MIN) {
        return 0.0;
    }
    bool outside = wo.z > 0.0;
    float o_h = dot3(wo, wm);
    // Seen from inside: the view through the surface's mirror, whose facets are the same.
    vec3 view = vec3(wo.x, wo.y, abs(wo.z));
    vec3 facing = outside ? wm : vec3(-wm.x, -wm.y, wm.z);
    vec2 alpha = principled_alpha(closure);
    vec2 choice = principled_choice(closure, wo);
    float facets = pdf_facet(DISTRIBUTION_TROWBRIDGE_REITZ, alpha.x, alpha.y, view, facing);
    facets = facets * ((1.0 - choice.x) - choice.y);
    float reflection = principled_reflection(closure, fresnel_dielectric(min_(abs(o_h), 1.0), eta), outside);
    if (wo.z * wi.z <= 0.0) {
        return ((1.0 - reflection) * facets) * refraction_jacobian(o_h, dot3(wi, wm), eta);
    }
    float coat = choice.y > 0.0 ? choice.y * (clearcoat_d(clearcoat_alpha(closure), wm.z) * wm.z) : 0.0;
    return div(reflection * facets + coat, 4.0 * abs(o_h)) + choice.x * (max_(wi.z, 0.0) * INV_PI);
}

// Cosine-weighted, or about a facet of the clear coat or of the main lobe, there reflected or refracted.
// `u`: 0..1 each, excluding 1. `u_lobe`: 0..1, chooses.
BsdfSample sample_principled(Closure closure, vec3 wo, vec2 u, float u_lobe) {
    if (abs(wo.z) <= COS_MIN) {
        return no_sample();
    }
    bool outside = wo.z > 0.0;
    float side = outside ? 1.0 : -1.0;
    float eta = eta_across(closure, wo);
    vec3 view = vec3(wo.x, wo.y, wo.z * side);
    vec2 choice = principled_choice(closure, wo);
    vec3 upper = square_to_cosine_hemisphere(u);
    bool refracts = false;
    if (u_lobe >= choice.x && u_lobe < choice.x + choice.y) {
        float a2 = clearcoat_alpha(closure) * clearcoat_alpha(closure);
        // The inverse of the integral of D cos: 1 - cos^2 = (a2^(1 - u) - a2) / (1 - a2)
        float cos2 = clamp_(div(1.0 - pow_(a2, 1.0 - u.x), 1.0 - a2), 0.0, 1.0);
        float sin_h = sqrt_(1.0 - cos2);
        upper = reflect_about(view, vec3(sin_h * cos_turns(u.y), sin_h * sin_turns(u.y), sqrt_(cos2)));
    }
    if (u_lobe >= choice.x + choice.y) {
        vec2 alpha = principled_alpha(closure);
        vec3 wm = sample_facet(DISTRIBUTION_TROWBRIDGE_REITZ, alpha.x, alpha.y, view, u);
        float o_h = min_(dot3(view, wm), 1.0);
        if (o_h <= COS_MIN) {
            return no_sample();
        }
        float reflection = principled_reflection(closure, fresnel_dielectric(o_h, eta), outside);
        // What is left of u_lobe once the lobe is chosen, 0..1
        float rest = div(u_lobe - (choice.x + choice.y), max_((1.0 - choice.x) - choice.y, 1.0e-6));
        refracts = rest >= reflection;
        upper = reflect_about(view, wm);
        if (refracts) {
            float root = refraction_root(o_h, eta);
            if (root <= 0.0) {
                return no_sample();
            }
            float ratio = rcp(eta);
            upper = normalize3(wm * (ratio * o_h - sqrt_(root) * ratio) - view * ratio);
        }
    }
    bool kept = refracts ? upper.z < -COS_MIN : upper.z > COS_MIN;
    if (!kept) {
        return no_sample();
    }
    vec3 wi = vec3(upper.x, upper.y, upper.z * side);
    float pdf = pdf_principled(closure, wo, wi);
    uint flags = refracts ? SAMPLE_TRANSMIT : 0u;
    return finish_sample(wi, pdf, eval_principled(closure, wo, wi), refracts ? eta : 1.0, flags);
}

#endif
