// Surfaces that send light into single directions: mirror, smooth metal, smooth glass, a thin pane, nothing at all.
//
// All return samples with `SAMPLE_DELTA`; eval and pdf of these models are zero. Local frame; z leaves the outside of a
// glass. Radiance is carried, so that what enters a denser medium is scaled by 1 / eta^2 (Veach 1997, section 5.2).
#ifndef SHADING_DELTA_GLSL
#define SHADING_DELTA_GLSL

#include "layout/records.glsl"
#include "shading/closure.glsl"
#include "shading/bsdf.glsl"
#include "shading/dielectric.glsl"
#include "shading/fresnel.glsl"
#include "shading/lobe.glsl"
#include "shading/math.glsl"
#include "shading/spectrum.glsl"

// Whole reflection of the material's colour.
BsdfSample sample_mirror(Closure closure, vec3 wo) {
    if (wo.z <= COS_MIN) {
        return no_sample();
    }
    return make_sample(reflect_local(wo), 1.0, spectrum_from_rgb(closure.color), 1.0, SAMPLE_DELTA);
}

// A smooth metal: Fresnel's reflectance times O_s.
BsdfSample sample_conductor(Closure closure, vec3 wo) {
    if (wo.z <= COS_MIN) {
        return no_sample();
    }
    vec3 weight = closure.specular_color * fresnel_closure(closure, wo.z);
    return make_sample(reflect_local(wo), 1.0, spectrum_from_rgb(weight), 1.0, SAMPLE_DELTA);
}

// A smooth dielectric: reflected with Fresnel's probability, else refracted. `color` and `specular_color` are factors on
// the two; `u_lobe`: 0..1, chooses.
BsdfSample sample_dielectric(Closure closure, vec3 wo, float u_lobe) {
    bool inside = wo.z < 0.0;
    float eta = inside ? rcp(closure.eta) : closure.eta;
    vec3 upper = vec3(wo.x, wo.y, abs(wo.z));
    if (upper.z <= COS_MIN) {
        return no_sample();
    }
    float reflectance = fresnel_dielectric(upper.z, eta);
    if (u_lobe < reflectance) {
        Spectrum tint = spectrum_from_rgb(closure.color);
        return make_sample(reflect_local(wo), reflectance, tint, 1.0, SAMPLE_DELTA);
    }
    Refraction refraction = refract_local(upper, eta);
    if (refraction.total) {
        return no_sample();
    }
    vec3 below = refraction.wt;
    vec3 wi = vec3(below.x, below.y, inside ? -below.z : below.z);
    float inv_eta = rcp(eta);
    Spectrum weight = spectrum_from_rgb(closure.specular_color * (inv_eta * inv_eta));
    return make_sample(wi, 1.0 - reflectance, weight, eta, SAMPLE_DELTA | SAMPLE_TRANSMIT);
}

// Reflectance of a pane of both its faces and all reflections between them: R + T^2 R / (1 - R^2) = 2 R / (1 + R).
// `cos_o`: cosine of the viewer's angle, either sign. `eta`: relative index.
float thin_reflectance(float cos_o, float eta) {
    float r = fresnel_dielectric(abs(cos_o), eta);
    return div(2.0 * r, 1.0 + r);
}

// A pane without thickness: reflected, or straight on. Factors as of `sample_dielectric`.
BsdfSample sample_thin_dielectric(Closure closure, vec3 wo, float u_lobe) {
    if (abs(wo.z) <= COS_MIN) {
        return no_sample();
    }
    float reflectance = thin_reflectance(wo.z, closure.eta);
    if (u_lobe < reflectance) {
        Spectrum tint = spectrum_from_rgb(closure.color);
        return make_sample(reflect_local(wo), reflectance, tint, 1.0, SAMPLE_DELTA);
    }
    Spectrum tint = spectrum_from_rgb(closure.specular_color);
    return make_sample(-wo, 1.0 - reflectance, tint, 1.0, SAMPLE_DELTA | SAMPLE_TRANSMIT);
}

// Straight through a surface that is not there.
BsdfSample sample_null(vec3 wo) {
    return make_sample(-wo, 1.0, spectrum_from_rgb(vec3(1.0)), 1.0, SAMPLE_DELTA | SAMPLE_TRANSMIT);
}

#endif
