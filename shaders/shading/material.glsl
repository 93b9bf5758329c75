// Every model behind one set of functions. `switch` here and `match` in Rust keep the order of `layout/material`.
//
// Directions are unit, in the local frame, leaving the surface. `eval` includes the cosine. Mirror and dielectric are
// directions of zero width, drawn as branches by the integrator: their eval and pdf are zero.
#ifndef SHADING_MATERIAL_GLSL
#define SHADING_MATERIAL_GLSL

#include "layout/mod.glsl"
#include "shading/blinn_phong.glsl"
#include "shading/cook_torrance.glsl"
#include "shading/lambert.glsl"
#include "shading/lobe.glsl"
#include "shading/math.glsl"
#include "shading/phong.glsl"
#include "shading/spectrum.glsl"

// BRDF times cosine (for the lecture's printed terms: the term over pi), per steradian.
// Zero unless both directions are on the upper side.
Spectrum eval_material(Material material, vec3 wo, vec3 wi) {
    switch (material.model) {
    case MODEL_LAMBERT: return eval_lambert(material, wo, wi);
    case MODEL_PHONG: return eval_phong(material, wo, wi);
    case MODEL_BLINN_PHONG: return eval_blinn_phong(material, wo, wi);
    case MODEL_COOK_TORRANCE: return eval_cook_torrance(material, wo, wi);
    // MODEL_MIRROR, MODEL_DIELECTRIC, MODEL_EMISSIVE
    default: return spectrum_zero();
    }
}

// A direction to the light with density `pdf_material`; pdf 0 if it is to be dropped.
// `u`: 0..1 each, excluding 1. `u_lobe`: 0..1, chooses among the model's lobes.
DirectionSample sample_material(Material material, vec3 wo, vec2 u, float u_lobe) {
    switch (material.model) {
    case MODEL_LAMBERT: return sample_lambert(material, wo, u, u_lobe);
    case MODEL_PHONG: return sample_phong(material, wo, u, u_lobe);
    case MODEL_BLINN_PHONG: return sample_blinn_phong(material, wo, u, u_lobe);
    case MODEL_COOK_TORRANCE: return sample_cook_torrance(material, wo, u, u_lobe);
    // MODEL_MIRROR, MODEL_DIELECTRIC, MODEL_EMISSIVE
    default: return no_direction();
    }
}

// Density of `sample_material`, per solid angle; its integral over the upper side is at most 1.
float pdf_material(Material material, vec3 wo, vec3 wi) {
    switch (material.model) {
    case MODEL_LAMBERT: return pdf_lambert(material, wo, wi);
    case MODEL_PHONG: return pdf_phong(material, wo, wi);
    case MODEL_BLINN_PHONG: return pdf_blinn_phong(material, wo, wi);
    case MODEL_COOK_TORRANCE: return pdf_cook_torrance(material, wo, wi);
    // MODEL_MIRROR, MODEL_DIELECTRIC, MODEL_EMISSIVE
    default: return 0.0;
    }
}

// What the ambient radiance I_a is multiplied by: k_a O_d (row 4); zero for mirror, dielectric and emissive.
Spectrum ambient_material(Material material) {
    switch (material.model) {
    case MODEL_LAMBERT:
    case MODEL_PHONG:
    case MODEL_BLINN_PHONG:
    case MODEL_COOK_TORRANCE: return spectrum_from_rgb(material.color * material.k_a);
    // MODEL_MIRROR, MODEL_DIELECTRIC, MODEL_EMISSIVE
    default: return spectrum_zero();
    }
}

// Weight of the branch that follows the mirror direction (row 24): a mirror's reflectance, else k_r O_s.
// Zero below the horizon, for a dielectric (its branches are weighted by Fresnel) and for an emissive surface.
// `cos_o`: cosine between normal and `wo`.
Spectrum mirror_weight(Material material, float cos_o) {
    if (cos_o <= COS_MIN) {
        return spectrum_zero();
    }
    switch (material.model) {
    case MODEL_LAMBERT:
    case MODEL_PHONG:
    case MODEL_BLINN_PHONG:
    case MODEL_COOK_TORRANCE: return spectrum_from_rgb(material.specular_color * material.k_r);
    case MODEL_MIRROR: return spectrum_from_rgb(material.color);
    // MODEL_DIELECTRIC, MODEL_EMISSIVE
    default: return spectrum_zero();
    }
}

// Radiance the surface sends out by itself, the same in every direction: its emission, and the colour of an emissive one.
Spectrum emission_material(Material material) {
    vec3 shown = material.model == MODEL_EMISSIVE ? material.color : vec3(0.0);
    return spectrum_from_rgb(material.emission + shown);
}

// Reflectance for the auxiliary image, 0..1 per channel: k_d O_d + k_s O_s, O_s times F(0) for Cook-Torrance.
Spectrum albedo_material(Material material) {
    vec3 diffuse = material.color * material.k_d;
    vec3 specular = material.specular_color * material.k_s;
    vec3 rgb = vec3(0.0);
    switch (material.model) {
    case MODEL_LAMBERT: rgb = diffuse; break;
    case MODEL_PHONG:
    case MODEL_BLINN_PHONG: rgb = diffuse + specular; break;
    case MODEL_COOK_TORRANCE: rgb = diffuse + specular * fresnel_cook_torrance(material, 1.0); break;
    case MODEL_MIRROR: rgb = material.color; break;
    case MODEL_DIELECTRIC: rgb = material.specular_color; break;
    case MODEL_EMISSIVE: rgb = material.color; break;
    }
    return spectrum_from_rgb(vec3(clamp_(rgb.x, 0.0, 1.0), clamp_(rgb.y, 0.0, 1.0), clamp_(rgb.z, 0.0, 1.0)));
}

// True if the model reflects and refracts into single directions only.
bool is_delta(Material material) {
    return material.model == MODEL_MIRROR || material.model == MODEL_DIELECTRIC;
}

#endif
