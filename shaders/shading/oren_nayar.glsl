// Rough diffuse reflection: V-cavities whose slope angle has the standard deviation `sigma` (radians), the
// qualitative form: f = k_d O_d / pi (A + B max(0, cos(phi_i - phi_o)) sin alpha tan beta), without interreflection.
// Source: Oren and Nayar 1994, "Generalization of Lambert's Reflectance Model", equation 30.
#ifndef SHADING_OREN_NAYAR_GLSL
#define SHADING_OREN_NAYAR_GLSL

#include "layout/records.glsl"
#include "shading/closure.glsl"
#include "shading/lobe.glsl"
#include "shading/math.glsl"
#include "shading/spectrum.glsl"
#include "shading/warp.glsl"

// Reflection times cosine, per steradian. Local frame; zero unless both directions are on the upper side.
Spectrum eval_oren_nayar(Closure closure, vec3 wo, vec3 wi) {
    if (!on_upper_side(wo, wi)) {
        return spectrum_zero();
    }
    float s2 = closure.sigma * closure.sigma;
    float a = 1.0 - 0.5 * div(s2, s2 + 0.33);
    float b = 0.45 * div(s2, s2 + 0.09);
    // cos(phi_i - phi_o) sin_i sin_o; sin alpha tan beta = sin_i sin_o / the larger cosine
    float along = max_(wo.x * wi.x + wo.y * wi.y, 0.0);
    float rough = a + b * div(along, max_(wo.z, wi.z));
    return spectrum_from_rgb(closure.color * ((closure.k_d * INV_PI) * (rough * wi.z)));
}

// Density of `sample_oren_nayar`: cos theta_i / pi.
float pdf_oren_nayar(Closure closure, vec3 wo, vec3 wi) {
    if (!on_upper_side(wo, wi)) {
        return 0.0;
    }
    return wi.z * INV_PI;
}

// Cosine-weighted over the hemisphere. `u`: 0..1 each, excluding 1; `u_lobe` is not used (one lobe).
DirectionSample sample_oren_nayar(Closure closure, vec3 wo, vec2 u, float u_lobe) {
    vec3 wi = square_to_cosine_hemisphere(u);
    if (!on_upper_side(wo, wi)) {
        return no_direction();
    }
    return make_direction(wi, wi.z * INV_PI);
}

#endif
