// Cook and Torrance's model (rows 14 to 18): f = k_d O_d / pi + k_s O_s D G F / (4 (N.L)(N.V)), k_d + k_s = 1.
//
// D is normalised, of one lobe or two: Beckmann's unless the flags name another; G the V-cavity's, or with `MATERIAL_SMITH`
// Smith's of each lobe, correlated by height; F exact, or Schlick's. The 1982 paper writes D G F / (pi (N.L)(N.V)) with
// D = e^-(tan a / m)^2 / (m^2 cos^4 a): with the normalised D that is D G F / ((N.L)(N.V)), four times the above;
// `MATERIAL_D_1982` draws it so. Source: Cook and Torrance 1982, "A Reflectance Model for Computer Graphics".
#ifndef SHADING_COOK_TORRANCE_GLSL
#define SHADING_COOK_TORRANCE_GLSL

#include "layout/records.glsl"
#include "shading/closure.glsl"
#include "shading/distribution.glsl"
#include "shading/fresnel.glsl"
#include "shading/lobe.glsl"
#include "shading/math.glsl"
#include "shading/microfacet.glsl"
#include "shading/spectrum.glsl"
#include "shading/warp.glsl"

// `DISTRIBUTION_*` of a lobe, 0 or 1.
uint lobe_distribution(Closure closure, uint lobe) {
    return lobe == 0u ? closure.distribution : closure.second_distribution;
}

// D of a lobe for a unit facet normal, per steradian.
float lobe_d(Closure closure, uint lobe, vec3 wm) {
    uint kind = lobe_distribution(closure, lobe);
    // Of the tables only the Gaussian's constant is asked for.
    float scale = 1.0;
    if (kind == DISTRIBUTION_GAUSSIAN) {
        scale = load_table(closure.table + lobe);
    }
    if (lobe == 0u) {
        return facet_d(kind, closure.alpha_u, closure.alpha_v, scale, wm);
    }
    return facet_d(kind, closure.second_alpha_u, closure.second_alpha_v, scale, wm);
}

// Smith's G of a lobe.
float lobe_g(Closure closure, uint lobe, vec3 wo, vec3 wi) {
    uint kind = lobe_distribution(closure, lobe);
    if (lobe == 0u) {
        return smith_g_correlated(kind, closure.alpha_u, closure.alpha_v, wo, wi);
    }
    return smith_g_correlated(kind, closure.second_alpha_u, closure.second_alpha_v, wo, wi);
}

// D of both lobes by their weights. `h`: any multiple of the facet normal.
float both_lobes_d(Closure closure, vec3 h, float w0, float w1) {
    if ((closure.flags & MATERIAL_GENERAL_LOBES) == 0u) {
        return beckmann_lobes_d_slope(tan2_theta(h), closure.alpha_u, closure.second_alpha_u, w0, w1);
    }
    vec3 wm = normalize3(h);
    float d = 0.0;
    if (w0 > 0.0) {
        d += w0 * lobe_d(closure, 0u, wm);
    }
    if (w1 > 0.0) {
        d += w1 * lobe_d(closure, 1u, wm);
    }
    return d;
}

// D G of both lobes by their weights. `h`: wo + wi; `n_h`, `v_h`: its cosines.
float both_lobes(Closure closure, vec3 wo, vec3 wi, vec3 h, float n_h, float v_h) {
    if ((closure.flags & MATERIAL_SMITH) == 0u) {
        return both_lobes_d(closure, h, closure.weight, closure.second_weight) * v_cavity_g(n_h, wo.z, v_h, wi.z);
    }
    vec3 wm = normalize3(h);
    float first = closure.weight * (lobe_d(closure, 0u, wm) * lobe_g(closure, 0u, wo, wi));
    if (closure.second_weight <= 0.0) {
        return first;
    }
    return first + closure.second_weight * (lobe_d(closure, 1u, wm) * lobe_g(closure, 1u, wo, wi));
}

// Diffuse and specular reflection times cosine, per steradian. Local frame; zero unless both are on the upper side.
// Finite everywhere; the V-cavity's G lets the grazing mirror direction grow as 1 / (N.V).
Spectrum eval_cook_torrance(Closure closure, vec3 wo, vec3 wi) {
    if (!on_upper_side(wo, wi)) {
        return spectrum_zero();
    }
    vec3 h = wo + wi;
    float h2 = dot3(h, h);
    float inv_h = rsqrt(h2);
    float n_h = min_(h.z * inv_h, 1.0);
    // V.H = L.H = |V + L| / 2
    float v_h = min_((0.5 * h2) * inv_h, 1.0);
    float dg = both_lobes(closure, wo, wi, h, n_h, v_h);
    vec3 f = fresnel_closure(closure, v_h);
    // N.L of the cosine cancels the one below.
    float quarter = (closure.flags & MATERIAL_D_1982) != 0u ? 1.0 : 0.25;
    float facets = (closure.k_s * quarter) * div(dg, wo.z);
    vec3 diffuse = closure.color * ((closure.k_d * INV_PI) * wi.z);
    vec3 specular = (closure.specular_color * f) * facets;
    return spectrum_from_rgb(diffuse + specular);
}

// Share of lobe 0 in w0 + w1; 1 if there is none.
float first_lobe_share(Closure closure) {
    float sum = closure.weight + closure.second_weight;
    return sum > 1.0e-20 ? div(closure.weight, sum) : 1.0;
}

// Density of the facets that both lobes sample, per steradian of H. `h`: wo + wi; `inv_h`: one over its length.
float pdf_lobes(Closure closure, vec3 wo, vec3 h, float inv_h) {
    float share = first_lobe_share(closure);
    if ((closure.flags & MATERIAL_GENERAL_LOBES) == 0u) {
        return both_lobes_d(closure, h, share, 1.0 - share) * (h.z * inv_h);
    }
    vec3 wm = h * inv_h;
    float first = pdf_reflecting(lobe_distribution(closure, 0u), closure.alpha_u, closure.alpha_v, wo, wm);
    float second = pdf_reflecting(lobe_distribution(closure, 1u), closure.second_alpha_u, closure.second_alpha_v, wo, wm);
    return share * first + (1.0 - share) * second;
}

// Density of `sample_cook_torrance`; its integral over the upper side is below 1 by what falls under the horizon.
float pdf_cook_torrance(Closure closure, vec3 wo, vec3 wi) {
    if (!on_upper_side(wo, wi)) {
        return 0.0;
    }
    float p = specular_probability(closure);
    vec3 h = wo + wi;
    float h2 = dot3(h, h);
    float inv_h = rsqrt(h2);
    float v_h = (0.5 * h2) * inv_h;
    // d omega_i = 4 (V.H) d omega_h
    float facets = pdf_lobes(closure, wo, h, inv_h);
    float specular = div(facets, 4.0 * v_h);
    return (1.0 - p) * (wi.z * INV_PI) + p * specular;
}

// Cosine-weighted, or `wo` mirrored about a facet of either lobe; what falls below the horizon is dropped.
// `u`: 0..1 each, excluding 1. `u_lobe`: 0..1, chooses diffuse, lobe 0 or lobe 1.
DirectionSample sample_cook_torrance(Closure closure, vec3 wo, vec2 u, float u_lobe) {
    float p = specular_probability(closure);
    bool first = u_lobe < p * first_lobe_share(closure);
    float m = first ? closure.alpha_u : closure.second_alpha_u;
    vec3 wi = square_to_cosine_hemisphere(u);
    if (u_lobe < p) {
        vec3 wm = sample_beckmann(u, m);
        if ((closure.flags & MATERIAL_GENERAL_LOBES) != 0u) {
            uint kind = lobe_distribution(closure, first ? 0u : 1u);
            wm = sample_reflecting(kind, m, first ? closure.alpha_v : closure.second_alpha_v, wo, u);
        }
        wi = reflect_about(wo, wm);
    }
    if (!on_upper_side(wo, wi)) {
        return no_direction();
    }
    return make_direction(wi, pdf_cook_torrance(closure, wo, wi));
}

#endif
