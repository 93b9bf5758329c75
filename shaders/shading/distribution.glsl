// Distributions of microfacets along two axes: how many face a way, how many of those are seen, and one at random.
//
// Directions are in the local frame; alpha_u is the roughness along x, alpha_v along y. `kind`: `DISTRIBUTION_*`; the
// Gaussian and Phong's are isotropic and take alpha_u. `scale`: the Gaussian's constant c, from bake; the others know theirs.
#ifndef SHADING_DISTRIBUTION_GLSL
#define SHADING_DISTRIBUTION_GLSL

#include "layout/records.glsl"
#include "shading/lobe.glsl"
#include "shading/math.glsl"
#include "shading/microfacet.glsl"

// 1 / sqrt(pi), and half of it.
const float INV_SQRT_PI = 0.564189584;
const float INV_TWO_SQRT_PI = 0.282094792;
// Visible slopes of a Beckmann surface of unit roughness end here: e^-16 of the density is left.
const float SLOPE_MAX = 4.0;
// Steps of the search for a visible slope; each halves the interval at least.
const uint SLOPE_STEPS = 16u;

// The error function within 3e-7. Source: Abramowitz and Stegun 1964, equation 7.1.26.
float erf_(float x) {
    float size = min_(abs(x), 9.0);
    float t = rcp(1.0 + 0.3275911 * size);
    float p = t * (0.254829592 + t * (-0.284496736 + t * (1.42141374 + t * (-1.45315203 + t * 1.06140543))));
    float value = 1.0 - p * exp_(-(size * size));
    return x < 0.0 ? -value : value;
}

// The inverse of the error function for |x| < 1 (clamped to .999999), relative error 4e-7.
// Source: Giles 2010, "Approximating the erfinv function", table 5 (single precision).
float erf_inverse(float x) {
    float inside = clamp_(x, -0.999999, 0.999999);
    float w = -log_((1.0 - inside) * (1.0 + inside));
    if (w < 5.0) {
        float s = w - 2.5;
        float p = 3.43273939e-07 + s * 2.81022636e-08;
        float q = -4.39150654e-06 + s * (-3.5233877e-06 + s * p);
        float r = -0.00125372503 + s * (0.00021858087 + s * q);
        return inside * (1.50140941 + s * (0.246640727 + s * (-0.00417768164 + s * r)));
    }
    float s = sqrt_(w) - 3.0;
    float p = 0.00134934322 + s * (0.000100950558 + s * -0.000200214257);
    float q = -0.0076224613 + s * (0.00573950773 + s * (-0.00367342844 + s * p));
    return inside * (2.83297682 + s * (1.00167406 + s * (0.00943887047 + s * q)));
}

// Blinn's exponent of a roughness: 2 / alpha^2 - 2, at least 0 (Walter et al. 2007, section 5.2: equal at small angles).
float phong_exponent(float alpha) {
    float a = max_(alpha, M_MIN);
    return max_(div(2.0, a * a) - 2.0, 0.0);
}

// The density D of facet normals, per steradian: the integral of D cos over the hemisphere is 1. `wm`: unit, z > 0.
// Sources: Cook and Torrance 1982 (Beckmann); Torrance and Sparrow 1967 (Gaussian in the angle itself); Trowbridge and
// Reitz 1975, as Walter et al. 2007; Blinn 1977 (Phong's); along two axes: Heitz 2014, appendix A.
float facet_d(uint kind, float alpha_u, float alpha_v, float scale, vec3 wm) {
    float a_u = max_(alpha_u, M_MIN);
    float a_v = max_(alpha_v, M_MIN);
    float z2 = wm.z * wm.z;
    if (wm.z <= COS_MIN) {
        return 0.0;
    }
    if (kind == DISTRIBUTION_PHONG) {
        float n = phong_exponent(a_u);
        return ((n + 2.0) * INV_TWO_PI) * cos_power(wm.z, n);
    }
    if (kind == DISTRIBUTION_GAUSSIAN) {
        float angle = atan2_(sqrt_(wm.x * wm.x + wm.y * wm.y), wm.z);
        float x = div(angle, a_u);
        return x * x > EXPONENT_MAX ? 0.0 : scale * exp_(-(x * x));
    }
    float x = div(wm.x, a_u);
    float y = div(wm.y, a_v);
    float slope2 = x * x + y * y;
    float area = PI * (a_u * a_v);
    if (kind == DISTRIBUTION_TROWBRIDGE_REITZ) {
        float s = slope2 + z2;
        return div(1.0, (area * s) * s);
    }
    float t = div(slope2, z2);
    return t > EXPONENT_MAX ? 0.0 : div(exp_(-t), (area * z2) * z2);
}

// sqrt((alpha_u x)^2 + (alpha_v y)^2): the roughness in the direction of `w` times its sine.
float stretched_sine(float alpha_u, float alpha_v, vec3 w) {
    float x = max_(alpha_u, M_MIN) * w.x;
    float y = max_(alpha_v, M_MIN) * w.y;
    return sqrt_(x * x + y * y);
}

// Smith's Lambda of a direction, >= 0: 1 / (1 + Lambda) of the facets that face `w` are seen from there. |w.z| > 0.
// Exact for Trowbridge and Reitz; for Beckmann (and the Gaussian, whose own has no closed form) the rational fit, within .35 %.
// Phong's slopes are Student's (Ribardiere et al. 2017) with Lambda = C (tan sin^(n+1) / (n+1) - the integral of sin^(n+1) up
// to theta), C its inverse over 0..pi: Trowbridge and Reitz's at n = 0, Beckmann's for n without bound, and between the two
// their mean by 1 / (n + 1), whose 1 / (1 + Lambda) is within 1 %.
// Source: Walter et al. 2007, equations 15 and 34; Heitz 2014.
float smith_lambda(uint kind, float alpha_u, float alpha_v, vec3 w) {
    float cos_w = abs(w.z);
    float a_u = kind == DISTRIBUTION_PHONG ? min_(alpha_u, 1.0) : alpha_u;
    bool along_both = kind == DISTRIBUTION_BECKMANN || kind == DISTRIBUTION_TROWBRIDGE_REITZ;
    float across = stretched_sine(a_u, along_both ? alpha_v : a_u, w);
    float t = div(across, max_(cos_w, COS_MIN));
    float long_tailed = 0.5 * (sqrt_(1.0 + t * t) - 1.0);
    if (kind == DISTRIBUTION_TROWBRIDGE_REITZ) {
        return long_tailed;
    }
    float short_tailed = 0.0;
    if (cos_w < 1.6 * across) {
        float a = div(max_(cos_w, COS_MIN), across);
        short_tailed = div(1.0 + a * (-1.259 + a * 0.396), a * (3.535 + a * 2.181));
    }
    if (kind != DISTRIBUTION_PHONG) {
        return short_tailed;
    }
    return mix_(short_tailed, long_tailed, rcp(1.0 + phong_exponent(a_u)));
}

// Smith's masking of one direction, 0..1.
float smith_g1(uint kind, float alpha_u, float alpha_v, vec3 w) {
    return rcp(1.0 + smith_lambda(kind, alpha_u, alpha_v, w));
}

// Masking times shadowing as if they were independent (Walter et al. 2007, equation 23).
float smith_g_separable(uint kind, float alpha_u, float alpha_v, vec3 wo, vec3 wi) {
    return smith_g1(kind, alpha_u, alpha_v, wo) * smith_g1(kind, alpha_u, alpha_v, wi);
}

// Masking and shadowing correlated by the height of the facets (Heitz 2014, equation 99).
float smith_g_correlated(uint kind, float alpha_u, float alpha_v, vec3 wo, vec3 wi) {
    return rcp((1.0 + smith_lambda(kind, alpha_u, alpha_v, wo)) + smith_lambda(kind, alpha_u, alpha_v, wi));
}

// Area of the visible facets as seen along `w`: w.z (1 + Lambda), Beckmann's exact. `w.z` > 0.
float visible_area(uint kind, float alpha_u, float alpha_v, vec3 w) {
    float across = stretched_sine(alpha_u, alpha_v, w);
    if (kind == DISTRIBUTION_TROWBRIDGE_REITZ) {
        return 0.5 * (w.z + sqrt_(w.z * w.z + across * across));
    }
    if (w.z >= 6.0 * across) {
        return w.z;
    }
    float a = div(w.z, across);
    return 0.5 * (w.z * (1.0 + erf_(a))) + INV_TWO_SQRT_PI * (across * exp_(-(a * a)));
}

// A slope of a Beckmann surface of unit roughness seen at an angle, along the direction of sight.
// `cos_v`, `sin_v`: of that angle, both >= 0. `u`: 0..1. Density proportional to (cos_v - x sin_v) e^(-x^2): its integral
// is inverted by bisection and Newton's steps, within 1e-6. Source: Heitz and d'Eon 2014, supplemental 1.
float visible_slope(float cos_v, float sin_v, float u) {
    float cot = sin_v > 1.0e-6 ? div(cos_v, sin_v) : SLOPE_MAX;
    float high = min_(cot, SLOPE_MAX);
    float low = -SLOPE_MAX;
    float whole = 0.5 * (cos_v * (1.0 + erf_(high))) + INV_TWO_SQRT_PI * (sin_v * exp_(-(high * high)));
    float target = u * whole;
    float x = 0.0;
    if (x >= high) {
        x = 0.5 * (low + high);
    }
    for (uint step_ = 0u; step_ < SLOPE_STEPS; step_++) {
        float bell = exp_(-(x * x));
        float reached = 0.5 * (cos_v * (1.0 + erf_(x))) + INV_TWO_SQRT_PI * (sin_v * bell);
        if (reached < target) {
            low = x;
        } else {
            high = x;
        }
        float steepness = INV_SQRT_PI * ((cos_v - x * sin_v) * bell);
        float next = x + div(target - reached, max_(steepness, 1.0e-12));
        x = next > low && next < high ? next : 0.5 * (low + high);
    }
    return x;
}

// A facet normal of Beckmann or of Trowbridge and Reitz as seen from `wo`, with density `pdf_facet`. `wo.z` > 0.
// Source: Heitz 2018, "Sampling the GGX Distribution of Visible Normals", listing 1; Heitz and d'Eon 2014 (Beckmann).
vec3 sample_visible(uint kind, float alpha_u, float alpha_v, vec3 wo, vec2 u) {
    float a_u = max_(alpha_u, M_MIN);
    float a_v = max_(alpha_v, M_MIN);
    // section 3.2: stretch the view
    vec3 view = normalize3(vec3(a_u * wo.x, a_v * wo.y, wo.z));
    float across2 = view.x * view.x + view.y * view.y;
    float inv_across = rsqrt(max_(across2, 1.0e-20));
    bool upright = across2 <= 1.0e-14;
    float cos_a = upright ? 1.0 : view.x * inv_across;
    float sin_a = upright ? 0.0 : view.y * inv_across;
    if (kind == DISTRIBUTION_TROWBRIDGE_REITZ) {
        // section 4.2: half a disk and half an ellipse
        float radius = sqrt_(u.x);
        float t1 = radius * cos_turns(u.y);
        float t2 = radius * sin_turns(u.y);
        float s = view.z * 0.5 + 0.5;
        t2 = (1.0 - s) * sqrt_(max_(1.0 - t1 * t1, 0.0)) + s * t2;
        float t3 = sqrt_(max_((1.0 - t1 * t1) - t2 * t2, 0.0));
        // section 4.3: back onto the hemisphere, T1 = (-sin, cos, 0), T2 = view x T1
        float x = (t3 * view.x - t1 * sin_a) - (t2 * view.z) * cos_a;
        float y = (t3 * view.y + t1 * cos_a) - (t2 * view.z) * sin_a;
        float z = t3 * view.z + t2 * (view.x * cos_a + view.y * sin_a);
        // section 3.4: unstretch
        return normalize3(vec3(a_u * x, a_v * y, max_(z, 1.0e-6)));
    }
    float along = visible_slope(view.z, sqrt_(across2), u.x);
    float across = erf_inverse(2.0 * u.y - 1.0);
    float slope_x = along * cos_a - across * sin_a;
    float slope_y = along * sin_a + across * cos_a;
    return normalize3(vec3(-(a_u * slope_x), -(a_v * slope_y), 1.0));
}

// The Gaussian's e^(-(pi / 2 alpha)^2): what lies beyond the horizon.
float gaussian_rest(float alpha) {
    float x = div(HALF_PI, alpha);
    return x * x > EXPONENT_MAX ? 0.0 : exp_(-(x * x));
}

// A facet normal with density `pdf_facet`: of those seen from `wo` (Beckmann, Trowbridge and Reitz), else of all.
// `u`: 0..1 each, excluding 1.
vec3 sample_facet(uint kind, float alpha_u, float alpha_v, vec3 wo, vec2 u) {
    if (kind == DISTRIBUTION_PHONG) {
        return sample_cos_power(u, phong_exponent(alpha_u) + 1.0);
    }
    if (kind == DISTRIBUTION_GAUSSIAN) {
        float a = max_(alpha_u, M_MIN);
        float angle = min_(a * sqrt_(max_(-log_(1.0 - u.x * (1.0 - gaussian_rest(a))), 0.0)), HALF_PI);
        float sin_h = sin_(angle);
        return vec3(sin_h * cos_turns(u.y), sin_h * sin_turns(u.y), cos_(angle));
    }
    return sample_visible(kind, alpha_u, alpha_v, wo, u);
}

// Density of `sample_facet` per steradian of the facet normal. `wm`: unit. `wo.z` > 0.
float pdf_facet(uint kind, float alpha_u, float alpha_v, vec3 wo, vec3 wm) {
    if (wm.z <= COS_MIN) {
        return 0.0;
    }
    if (kind == DISTRIBUTION_PHONG) {
        return pdf_cos_power(wm.z, phong_exponent(alpha_u) + 1.0);
    }
    if (kind == DISTRIBUTION_GAUSSIAN) {
        float a = max_(alpha_u, M_MIN);
        float sin_h = sqrt_(wm.x * wm.x + wm.y * wm.y);
        float angle = atan2_(sin_h, wm.z);
        float x = div(angle, a);
        if (x * x > EXPONENT_MAX) {
            return 0.0;
        }
        // 2 t / a^2 e^(-t^2 / a^2) of the angle t, over 2 pi sin t
        float ring = sin_h > 1.0e-7 ? div(angle, sin_h) : 1.0;
        return div((INV_PI * ring) * exp_(-(x * x)), (a * a) * (1.0 - gaussian_rest(a)));
    }
    float d = facet_d(kind, alpha_u, alpha_v, 1.0, wm);
    return div(d * max_(dot3(wo, wm), 0.0), visible_area(kind, alpha_u, alpha_v, wo));
}

// Part of the sphere cap of visible facets that reflection needs, as a factor on the stretched view's cosine, 0..1: facets
// further down mirror `wo` below the horizon. `wo.z` > 0.
// Source: Eto and Tokuyoshi 2023, "Bounded VNDF Sampling for Smith-GGX Reflections", equation 5; Tokuyoshi and Eto 2024, "Bounded
// VNDF Sampling for the Smith-GGX BRDF" (two roughnesses).
float reflection_bound(float alpha_u, float alpha_v, vec3 wo) {
    float a = min_(min_(max_(alpha_u, M_MIN), max_(alpha_v, M_MIN)), 1.0);
    float a2 = a * a;
    float s = 1.0 + sqrt_(wo.x * wo.x + wo.y * wo.y);
    float s2 = s * s;
    return div((1.0 - a2) * s2, s2 + a2 * (wo.z * wo.z));
}

// A facet normal to mirror `wo` about, with density `pdf_reflecting`: of Trowbridge and Reitz only of those that are seen and may
// send it above the horizon, else as `sample_facet`. `wo.z` > 0. `u`: 0..1 each, excluding 1.
// Source: Dupuy and Benyoub 2023, "Sampling Visible GGX Normals with Spherical Caps", listing 3, and `reflection_bound`.
vec3 sample_reflecting(uint kind, float alpha_u, float alpha_v, vec3 wo, vec2 u) {
    if (kind != DISTRIBUTION_TROWBRIDGE_REITZ) {
        return sample_facet(kind, alpha_u, alpha_v, wo, u);
    }
    float a_u = max_(alpha_u, M_MIN);
    float a_v = max_(alpha_v, M_MIN);
    vec3 view = normalize3(vec3(a_u * wo.x, a_v * wo.y, wo.z));
    float lowest = reflection_bound(alpha_u, alpha_v, wo) * view.z;
    float z = (1.0 - u.x) * (1.0 + lowest) - lowest;
    float sin_c = sqrt_(max_((1.0 - z) * (1.0 + z), 0.0));
    vec3 h = vec3(sin_c * cos_turns(u.y), sin_c * sin_turns(u.y), z) + view;
    return normalize3(vec3(a_u * h.x, a_v * h.y, max_(h.z, 1.0e-6)));
}

// Density of `sample_reflecting` per steradian of the facet normal, for those that mirror `wo` above the horizon. `wm`: unit.
// `wo.z` > 0.
float pdf_reflecting(uint kind, float alpha_u, float alpha_v, vec3 wo, vec3 wm) {
    if (kind != DISTRIBUTION_TROWBRIDGE_REITZ) {
        return pdf_facet(kind, alpha_u, alpha_v, wo, wm);
    }
    float across = stretched_sine(alpha_u, alpha_v, wo);
    float seen = sqrt_(wo.z * wo.z + across * across);
    float area = 0.5 * (reflection_bound(alpha_u, alpha_v, wo) * wo.z + seen);
    return div(facet_d(kind, alpha_u, alpha_v, 1.0, wm) * max_(dot3(wo, wm), 0.0), area);
}

#endif
