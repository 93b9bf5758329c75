// Cook and Torrance's model (rows 14 to 18): f = k_d O_d / pi + k_s O_s D G F / (4 (N.L)(N.V)), k_d + k_s = 1.
//
// D is Beckmann's, normalised, one lobe or two; G the V-cavity's; F exact. The 1982 paper writes
// D G F / (pi (N.L)(N.V)) with D = e^-(tan a / m)^2 / (m^2 cos^4 a): with the normalised D that is
// D G F / ((N.L)(N.V)), four times the above; `MATERIAL_D_1982` draws it so.
// Source: Cook and Torrance 1982, "A Reflectance Model for Computer Graphics".
#ifndef SHADING_COOK_TORRANCE_GLSL
#define SHADING_COOK_TORRANCE_GLSL

#include "layout/mod.glsl"
#include "shading/fresnel.glsl"
#include "shading/lobe.glsl"
#include "shading/math.glsl"
#include "shading/microfacet.glsl"
#include "shading/spectrum.glsl"
#include "shading/warp.glsl"

// Diffuse and specular reflection times cosine, per steradian. Local frame; zero unless both are on the upper side.
// Finite everywhere; the V-cavity's G lets the grazing mirror direction grow as 1 / (N.V).
Spectrum eval_cook_torrance(Material material, vec3 wo, vec3 wi) {
    if (!on_upper_side(wo, wi)) {
        return spectrum_zero();
    }
    vec3 h = wo + wi;
    float h2 = dot3(h, h);
    float inv_h = rsqrt(h2);
    float n_h = min_(h.z * inv_h, 1.0);
    // V.H = L.H = |V + L| / 2
    float v_h = min_((0.5 * h2) * inv_h, 1.0);
    float d = beckmann_lobes_d_slope(tan2_theta(h), material.m0, material.m1, material.w0, material.w1);
    float g = v_cavity_g(n_h, wo.z, v_h, wi.z);
    vec3 f = fresnel_material(material, v_h);
    // N.L of the cosine cancels the one below.
    float quarter = (material.flags & MATERIAL_D_1982) != 0u ? 1.0 : 0.25;
    float facets = (material.k_s * quarter) * div(d * g, wo.z);
    vec3 diffuse = material.color * ((material.k_d * INV_PI) * wi.z);
    vec3 specular = (material.specular_color * f) * facets;
    return spectrum_from_rgb(diffuse + specular);
}

// Share of lobe 0 in w0 + w1; 1 if there is none.
float first_lobe_share(Material material) {
    float sum = material.w0 + material.w1;
    return sum > 1.0e-20 ? div(material.w0, sum) : 1.0;
}

// Density of `sample_cook_torrance`; its integral over the upper side is below 1 by what falls under the horizon.
float pdf_cook_torrance(Material material, vec3 wo, vec3 wi) {
    if (!on_upper_side(wo, wi)) {
        return 0.0;
    }
    float p = specular_probability(material);
    float share = first_lobe_share(material);
    vec3 h = wo + wi;
    float h2 = dot3(h, h);
    float inv_h = rsqrt(h2);
    float v_h = (0.5 * h2) * inv_h;
    // Density of H is D (N.H); d omega_i = 4 (V.H) d omega_h.
    float d = beckmann_lobes_d_slope(tan2_theta(h), material.m0, material.m1, share, 1.0 - share);
    float specular = div(d * (h.z * inv_h), 4.0 * v_h);
    return (1.0 - p) * (wi.z * INV_PI) + p * specular;
}

// Cosine-weighted, or `wo` mirrored about a Beckmann facet of either lobe; what falls below the horizon is dropped.
// `u`: 0..1 each, excluding 1. `u_lobe`: 0..1, chooses diffuse, lobe 0 or lobe 1.
DirectionSample sample_cook_torrance(Material material, vec3 wo, vec2 u, float u_lobe) {
    float p = specular_probability(material);
    vec3 wi;
    if (u_lobe < p * first_lobe_share(material)) {
        wi = reflect_about(wo, sample_beckmann(u, material.m0));
    } else if (u_lobe < p) {
        wi = reflect_about(wo, sample_beckmann(u, material.m1));
    } else {
        wi = square_to_cosine_hemisphere(u);
    }
    if (!on_upper_side(wo, wi)) {
        return no_direction();
    }
    return DirectionSample(wi, pdf_cook_torrance(material, wo, wi));
}

#endif
