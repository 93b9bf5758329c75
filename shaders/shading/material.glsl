// Every model behind one set of functions. `switch` here and `match` in Rust keep the order of `layout/material`.
//
// Directions are unit, in the local frame, leaving the surface. z leaves the outside of models that transmit
// (`MATERIAL_TRANSMISSIVE`), where wo.z < 0 is a viewer inside; of the others the caller turns it to the viewer's side, so that
// wo.z > 0. `eval` includes the cosine. Lobes of zero width (mirror, smooth glass and metal, a plastic's coat) exist for
// `sample_closure` only: their eval and pdf are zero, and `local` and `whitted` draw them as branches.
#ifndef SHADING_MATERIAL_GLSL
#define SHADING_MATERIAL_GLSL

#include "layout/features.glsl"
#include "layout/records.glsl"
#include "shading/closure.glsl"
#include "shading/ashikhmin.glsl"
#include "shading/blinn_phong.glsl"
#include "shading/bsdf.glsl"
#include "shading/cook_torrance.glsl"
#include "shading/delta.glsl"
#include "shading/eon.glsl"
#include "shading/fresnel.glsl"
#include "shading/kelemen.glsl"
#include "shading/lambert.glsl"
#include "shading/lobe.glsl"
#include "shading/math.glsl"
#include "shading/measured.glsl"
#include "shading/oren_nayar.glsl"
#include "shading/phong.glsl"
#include "shading/plastic.glsl"
#include "shading/principled.glsl"
#include "shading/rough_conductor.glsl"
#include "shading/rough_dielectric.glsl"
#include "shading/spectrum.glsl"
#include "shading/tabulated.glsl"
#include "shading/ward.glsl"

#define ARM(model, call) case model: if (HAS_MODEL(model)) return call; break;

// f |cos theta_i| (for the lecture's printed terms: the term over pi), per steradian, over the whole sphere.
// Lobes of zero width add nothing.
Spectrum eval_closure(Closure closure, vec3 wo, vec3 wi) {
    switch (closure.model) {
    ARM(MODEL_LAMBERT, eval_lambert(closure, wo, wi))
    ARM(MODEL_PHONG, eval_phong(closure, wo, wi))
    ARM(MODEL_BLINN_PHONG, eval_blinn_phong(closure, wo, wi))
    ARM(MODEL_COOK_TORRANCE, eval_cook_torrance(closure, wo, wi))
    ARM(MODEL_OREN_NAYAR, eval_oren_nayar(closure, wo, wi))
    ARM(MODEL_WARD, eval_ward(closure, wo, wi))
    ARM(MODEL_ASHIKHMIN_SHIRLEY, eval_ashikhmin(closure, wo, wi))
    ARM(MODEL_KELEMEN, eval_kelemen(closure, wo, wi))
    ARM(MODEL_ROUGH_CONDUCTOR, eval_rough_conductor(closure, wo, wi))
    ARM(MODEL_ROUGH_DIELECTRIC, eval_rough_dielectric(closure, wo, wi))
    ARM(MODEL_PLASTIC, eval_plastic(closure, wo, wi))
    ARM(MODEL_ROUGH_PLASTIC, eval_rough_plastic(closure, wo, wi))
    ARM(MODEL_PRINCIPLED, eval_principled(closure, wo, wi))
    ARM(MODEL_MEASURED, eval_measured(closure, wo, wi))
    ARM(MODEL_TABULATED, eval_tabulated(closure, wo, wi))
    ARM(MODEL_EON, eval_eon(closure, wo, wi))
    default: break;
    }
    return spectrum_zero();
}

// Density of `sample_closure` without its lobes of zero width, per solid angle; its integral is at most 1.
float pdf_closure(Closure closure, vec3 wo, vec3 wi) {
    switch (closure.model) {
    ARM(MODEL_LAMBERT, pdf_lambert(closure, wo, wi))
    ARM(MODEL_PHONG, pdf_phong(closure, wo, wi))
    ARM(MODEL_BLINN_PHONG, pdf_blinn_phong(closure, wo, wi))
    ARM(MODEL_COOK_TORRANCE, pdf_cook_torrance(closure, wo, wi))
    ARM(MODEL_OREN_NAYAR, pdf_oren_nayar(closure, wo, wi))
    ARM(MODEL_WARD, pdf_ward(closure, wo, wi))
    ARM(MODEL_ASHIKHMIN_SHIRLEY, pdf_ashikhmin(closure, wo, wi))
    ARM(MODEL_KELEMEN, pdf_kelemen(closure, wo, wi))
    ARM(MODEL_ROUGH_CONDUCTOR, pdf_rough_conductor(closure, wo, wi))
    ARM(MODEL_ROUGH_DIELECTRIC, pdf_rough_dielectric(closure, wo, wi))
    ARM(MODEL_PLASTIC, pdf_plastic(closure, wo, wi))
    ARM(MODEL_ROUGH_PLASTIC, pdf_rough_plastic(closure, wo, wi))
    ARM(MODEL_PRINCIPLED, pdf_principled(closure, wo, wi))
    ARM(MODEL_MEASURED, pdf_measured(closure, wo, wi))
    ARM(MODEL_TABULATED, pdf_tabulated(closure, wo, wi))
    ARM(MODEL_EON, pdf_eon(closure, wo, wi))
    default: break;
    }
    return 0.0;
}

// The direction that models of one side choose, with density `pdf_closure`; pdf 0 if it is to be dropped.
DirectionSample sample_direction(Closure closure, vec3 wo, vec2 u, float u_lobe) {
    switch (closure.model) {
    ARM(MODEL_LAMBERT, sample_lambert(closure, wo, u, u_lobe))
    ARM(MODEL_PHONG, sample_phong(closure, wo, u, u_lobe))
    ARM(MODEL_BLINN_PHONG, sample_blinn_phong(closure, wo, u, u_lobe))
    ARM(MODEL_COOK_TORRANCE, sample_cook_torrance(closure, wo, u, u_lobe))
    ARM(MODEL_OREN_NAYAR, sample_oren_nayar(closure, wo, u, u_lobe))
    ARM(MODEL_WARD, sample_ward(closure, wo, u, u_lobe))
    ARM(MODEL_ASHIKHMIN_SHIRLEY, sample_ashikhmin(closure, wo, u, u_lobe))
    ARM(MODEL_KELEMEN, sample_kelemen(closure, wo, u, u_lobe))
    ARM(MODEL_ROUGH_CONDUCTOR, sample_rough_conductor(closure, wo, u, u_lobe))
    ARM(MODEL_ROUGH_PLASTIC, sample_rough_plastic(closure, wo, u, u_lobe))
    ARM(MODEL_MEASURED, sample_measured(closure, wo, u, u_lobe))
    ARM(MODEL_TABULATED, sample_tabulated(closure, wo, u, u_lobe))
    ARM(MODEL_EON, sample_eon(closure, wo, u, u_lobe))
    default: break;
    }
    return no_direction();
}

// A direction to the light, lobes of zero width included; pdf 0 if it is to be dropped.
// `u`: 0..1 each, excluding 1. `u_lobe`: 0..1, excluding 1, chooses among the model's lobes.
BsdfSample sample_closure(Closure closure, vec3 wo, vec2 u, float u_lobe) {
    switch (closure.model) {
    ARM(MODEL_MIRROR, sample_mirror(closure, wo))
    ARM(MODEL_DIELECTRIC, sample_dielectric(closure, wo, u_lobe))
    ARM(MODEL_CONDUCTOR, sample_conductor(closure, wo))
    ARM(MODEL_ROUGH_DIELECTRIC, sample_rough_dielectric(closure, wo, u, u_lobe))
    ARM(MODEL_THIN_DIELECTRIC, sample_thin_dielectric(closure, wo, u_lobe))
    ARM(MODEL_PLASTIC, sample_plastic(closure, wo, u, u_lobe))
    ARM(MODEL_PRINCIPLED, sample_principled(closure, wo, u, u_lobe))
    ARM(MODEL_NULL, sample_null(wo))
    default: break;
    }
    DirectionSample direction = sample_direction(closure, wo, u, u_lobe);
    if (direction.pdf <= 0.0) {
        return no_sample();
    }
    return finish_sample(direction.wi, direction.pdf, eval_closure(closure, wo, direction.wi), 1.0, 0u);
}

// What the ambient radiance I_a is multiplied by: k_a O_d (row 4); zero for what only mirrors or transmits.
Spectrum ambient_closure(Closure closure) {
    switch (closure.model) {
    case MODEL_MIRROR:
    case MODEL_DIELECTRIC:
    case MODEL_EMISSIVE:
    case MODEL_CONDUCTOR:
    case MODEL_ROUGH_DIELECTRIC:
    case MODEL_THIN_DIELECTRIC:
    case MODEL_NULL:
    case MODEL_BLEND: return spectrum_zero();
    default: return spectrum_from_rgb(closure.color * closure.k_a);
    }
}

// Weight of the branch that follows the mirror direction (row 24): what a mirror, a smooth metal or a plastic's coat
// reflects, else k_r O_s. Zero below the horizon, for glass (its branches are weighted by Fresnel), for what is not there
// and for an emissive surface. `cos_o`: cosine between normal and `wo`.
Spectrum mirror_weight(Closure closure, float cos_o) {
    if (cos_o <= COS_MIN) {
        return spectrum_zero();
    }
    switch (closure.model) {
    case MODEL_MIRROR: return spectrum_from_rgb(closure.color);
    case MODEL_CONDUCTOR:
    case MODEL_PLASTIC: return spectrum_from_rgb(closure.specular_color * fresnel_closure(closure, cos_o));
    case MODEL_DIELECTRIC:
    case MODEL_EMISSIVE:
    case MODEL_ROUGH_DIELECTRIC:
    case MODEL_THIN_DIELECTRIC:
    case MODEL_NULL:
    case MODEL_BLEND: return spectrum_zero();
    default: return spectrum_from_rgb(closure.specular_color * closure.k_r);
    }
}

// How much of the surface's own light a pane keeps: 1 - k_t if interpolated, all of it if filtered (row 22).
float own_weight(uint flags, float k_t) {
    return (flags & MATERIAL_FILTERED) != 0u ? 1.0 : 1.0 - k_t;
}

// What a pane multiplies the light by that passes it straight on: k_t, of a filter k_t O_t (row 22).
Spectrum pane_tint(Closure closure) {
    vec4 tint = vec4(closure.k_t);
    if ((closure.flags & MATERIAL_FILTERED) != 0u) {
        return tint * spectrum_from_rgb(closure.transmit_color);
    }
    return tint;
}

// Reflectance for the auxiliary image, 0..1 per channel: k_d O_d + k_s O_s, O_s times F(0) where there is an interface.
Spectrum albedo_closure(Closure closure) {
    vec3 diffuse = closure.color * closure.k_d;
    vec3 specular = closure.specular_color * closure.k_s;
    vec3 rgb = vec3(0.0);
    switch (closure.model) {
    case MODEL_LAMBERT:
    case MODEL_OREN_NAYAR:
    case MODEL_EON: rgb = diffuse; break;
    case MODEL_PHONG:
    case MODEL_BLINN_PHONG:
    case MODEL_WARD:
    case MODEL_ASHIKHMIN_SHIRLEY: rgb = diffuse + specular; break;
    case MODEL_COOK_TORRANCE: rgb = diffuse + specular * fresnel_closure(closure, 1.0); break;
    case MODEL_CONDUCTOR:
    case MODEL_ROUGH_CONDUCTOR: rgb = closure.specular_color * fresnel_closure(closure, 1.0); break;
    case MODEL_DIELECTRIC:
    case MODEL_ROUGH_DIELECTRIC:
    case MODEL_THIN_DIELECTRIC: rgb = closure.specular_color; break;
    case MODEL_EMISSIVE: rgb = closure.emission; break;
    case MODEL_NULL:
    case MODEL_BLEND: break;
    default: rgb = closure.color; break;
    }
    return spectrum_from_rgb(vec3(clamp_(rgb.x, 0.0, 1.0), clamp_(rgb.y, 0.0, 1.0), clamp_(rgb.z, 0.0, 1.0)));
}

// True if whitted follows what the material transmits: glass, drawn smooth even if it is rough, and thin panes.
bool is_refracting(uint model) {
    return model == MODEL_DIELECTRIC || model == MODEL_ROUGH_DIELECTRIC ||
        model == MODEL_THIN_DIELECTRIC;
}

// True if the model has lobes of zero width only: no light needs to be sampled for it.
bool is_delta(Closure closure) {
    switch (closure.model) {
    case MODEL_MIRROR:
    case MODEL_DIELECTRIC:
    case MODEL_CONDUCTOR:
    case MODEL_THIN_DIELECTRIC:
    case MODEL_NULL: return true;
    default: return false;
    }
}

#undef ARM
#endif
