// Lights of zero size: point, directional, spot (rows 5, 11, 21).
#ifndef SHADING_LIGHT_GLSL
#define SHADING_LIGHT_GLSL

#include "layout/features.glsl"
#include "layout/records.glsl"
#include "shading/lobe.glsl"
#include "shading/math.glsl"
#include "shading/spectrum.glsl"

// Squared distance below which a light is on the surface, where it has no direction.
const float DISTANCE2_MIN = 1.0e-24;
// Squared distance above which a light is taken as out of reach: keeps every product below finite.
const float DISTANCE2_MAX = 1.0e30;
// Penumbrae narrower than this difference of cosines are hard edges.
const float EDGE_MIN = 1.0e-6;

// One light as seen from a point.
struct LightSample {
    // Unit, world, to the light.
    vec3 wi;
    // World units; `T_INFINITE` for a directional light.
    float distance;
    // Outgoing radiance is `eval` times this: of a light of no size intensity (directional: irradiance) times attenuation
    // and cone; of another, and where the light was chosen at random, divided by the density of that choice.
    Spectrum radiance;
    // With which `wi` was drawn; 0 for a light of no size, which no other ray meets.
    float pdf_solid_angle;
};

// No light, from a valid direction.
LightSample no_light() {
    return LightSample(vec3(0.0, 0.0, 1.0), 0.0, spectrum_zero(), 0.0);
}

// Fall-off with distance, 0.. : 1/d^2, or the lecture's min(1, 1/(c1 + c2 d + c3 d^2)), or 1.
// `distance2`: its square, within `DISTANCE2_MIN` and `DISTANCE2_MAX`.
float attenuate(Light light, float distance, float distance2) {
    switch (light.attenuation) {
    case ATTENUATION_INVERSE_SQUARE: return rcp(distance2);
    case ATTENUATION_POLYNOMIAL: {
        float polynomial = (light.c.x + light.c.y * distance) + light.c.z * distance2;
        return polynomial <= 1.0 ? 1.0 : rcp(polynomial);
    }
    // ATTENUATION_NONE
    default: return 1.0;
    }
}

// A spot's factor, 0..1: cos^p of the angle off the axis (Warn 1983, "Lighting Controls for Synthetic Images"),
// zero beyond the cone, with a smooth step 3 t^2 - 2 t^3 in the cosine between its inner and outer edge.
// `cos_axis`: cosine between the axis and the direction from the light.
float spot_factor(Light light, float cos_axis) {
    if (cos_axis < light.cos_outer) {
        return 0.0;
    }
    float edge = light.cos_inner - light.cos_outer;
    float t = edge < EDGE_MIN ? 1.0 : clamp_(div(cos_axis - light.cos_outer, edge), 0.0, 1.0);
    return ((t * t) * (3.0 - 2.0 * t)) * cos_power(cos_axis, light.exponent);
}

// Whether Warn's flaps, planes of constant x, y or z of the world, let the light reach `position`: it is between them on
// every axis (Warn 1983, "Lighting Controls for Synthetic Images": barn doors).
bool within_flaps(Light light, vec3 position) {
    vec3 low = light.flaps_min;
    vec3 high = light.flaps_max;
    return (position.x >= low.x && position.x <= high.x) && (position.y >= low.y && position.y <= high.y) &&
        (position.z >= low.z && position.z <= high.z);
}

// The light as seen from `position` (world). Zero radiance, but a valid direction, if the two coincide or flaps are between.
LightSample sample_light(Light light, vec3 position) {
    if (HAS_FLAPS && !within_flaps(light, position)) {
        return no_light();
    }
    if (light.kind == LIGHT_DIRECTIONAL) {
        return LightSample(-light.direction, T_INFINITE, spectrum_from_rgb(light.intensity), 0.0);
    }
    vec3 to_light = light.position - position;
    float distance2 = dot3(to_light, to_light);
    if (distance2 < DISTANCE2_MIN || distance2 > DISTANCE2_MAX) {
        return no_light();
    }
    float inverse = rsqrt(distance2);
    vec3 wi = to_light * inverse;
    float distance = distance2 * inverse;
    float factor = attenuate(light, distance, distance2);
    if (light.kind == LIGHT_SPOT) {
        factor *= spot_factor(light, -dot3(wi, light.direction));
    }
    return LightSample(wi, distance, spectrum_from_rgb(light.intensity * factor), 0.0);
}

#endif
