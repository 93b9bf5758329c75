// What stands in a spot's beam: a picture that the light throws, and a linear edge.
//
// Table: `right`, `up` (3 entries each), the texture or -1, the angle at which a ramp ends, its slope per radian or 0, and
// 1 for a projector.
// Source: Jakob et al. 2022, "Mitsuba 3", plugins `spot` and `projector`, whose light this is.
#ifndef SHADING_SLIDE_GLSL
#define SHADING_SLIDE_GLSL

#include "layout/records.glsl"
#include "shading/lobe.glsl"
#include "shading/math.glsl"
#include "shading/spectrum.glsl"
#include "shading/texture.glsl"

#ifdef GONIO_FETCH

// Factor on the light that comes along `wi` (unit, to the light). The light has a slide.
Spectrum slide_factor(Light light, vec3 wi) {
    vec3 direction = -wi;
    float cos_axis = dot3(direction, light.direction);
    if (cos_axis <= COS_MIN) {
        return spectrum_zero();
    }
    uint at = light.table;
    float slope = load_table(at + 8u);
    float factor = 1.0;
    if (slope > 0.0) {
        factor = clamp_((load_table(at + 7u) - acos_(cos_axis)) * slope, 0.0, 1.0);
    }
    float picture = load_table(at + 6u);
    if (picture < 0.0) {
        return spectrum_from_rgb(vec3(factor));
    }
    vec3 right = vec3(load_table(at), load_table(at + 1u), load_table(at + 2u));
    vec3 up = vec3(load_table(at + 3u), load_table(at + 4u), load_table(at + 5u));
    float inverse = rcp(cos_axis);
    float u = 0.5 + dot3(direction, right) * inverse;
    float v = 0.5 + dot3(direction, up) * inverse;
    if (load_table(at + 9u) > 0.0) {
        if (u < 0.0 || u > 1.0 || v < 0.0 || v > 1.0) {
            return spectrum_zero();
        }
        factor *= (inverse * inverse) * inverse;
    }
    vec4 texel = sample_texture(load_texture(uint(picture)), vec2(u, v));
    return spectrum_from_rgb(texel.xyz * factor);
}

#endif

#endif
