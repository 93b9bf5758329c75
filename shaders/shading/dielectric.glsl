// Refraction and absorption of clear bodies (row 23).
#ifndef SHADING_DIELECTRIC_GLSL
#define SHADING_DIELECTRIC_GLSL

#include "shading/fresnel.glsl"
#include "shading/lobe.glsl"
#include "shading/math.glsl"
#include "shading/spectrum.glsl"

// What `refract_local` returns.
struct Refraction {
    // Unit, local frame, leaving the surface on the other side (z < 0); the mirror direction on total reflection.
    vec3 wt;
    // Cosine between wt and -N, 0..1; 0 on total reflection.
    float cos_t;
    // Total internal reflection: nothing is transmitted.
    bool total;
};

// The refracted direction: T = (eta_i/eta_t cos theta_i - cos theta_t) N - eta_i/eta_t L.
// `wo`: unit, local frame, z > 0: where the light comes from (or the viewer, for a ray traced backwards).
// `eta`: index on the transmitted side over index on the incident side, > 0.
// Source: Snell's law; Whitted 1980, "An Improved Illumination Model for Shaded Display".
Refraction refract_local(vec3 wo, float eta) {
    float root = refraction_root(wo.z, eta);
    if (root <= 0.0) {
        return Refraction(reflect_local(wo), 0.0, true);
    }
    float ratio = rcp(eta);
    // cos^2 theta_t = 1 - ratio^2 (1 - cos^2 theta_i) = root / eta^2
    float cos_t = sqrt_(root) * ratio;
    // N is z, so T's normal part, ratio cos_i - cos_t - ratio wo.z, is -cos_t.
    // Normalised, so that errors do not add up over many surfaces.
    vec3 wt = normalize3(vec3(-(ratio * wo.x), -(ratio * wo.y), -cos_t));
    return Refraction(wt, -wt.z, false);
}

// One channel of `transmittance`.
float transmittance1(float absorption, float distance) {
    float depth = absorption * distance;
    return depth > 60.0 ? 0.0 : exp_(-depth);
}

// Beer's law: e^(-absorption distance) per channel, 0..1; below e^-60 it is 0.
// `absorption`: per scene unit, >= 0. `distance`: scene units, >= 0, up to `T_INFINITE`.
Spectrum transmittance(vec3 absorption, float distance) {
    return spectrum_from_rgb(vec3(
        transmittance1(absorption.x, distance),
        transmittance1(absorption.y, distance),
        transmittance1(absorption.z, distance)
    ));
}

#endif
