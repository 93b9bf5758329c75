// What a texture's value does to a material (row 27).
#ifndef SHADING_PARAMETER_GLSL
#define SHADING_PARAMETER_GLSL

#include "layout/mod.glsl"
#include "shading/math.glsl"

// No texture makes a lobe narrower: below, distributions overflow.
const float ALPHA_LEAST = 1.0e-3;

// The channel of a texel as all three components, or its colour. `channel`: `CHANNEL_*`.
vec3 channel_value(vec4 texel, uint channel) {
    switch (channel) {
    case CHANNEL_R: return vec3(texel.x);
    case CHANNEL_G: return vec3(texel.y);
    case CHANNEL_B: return vec3(texel.z);
    case CHANNEL_A: return vec3(texel.w);
    // CHANNEL_RGB
    default: return vec3(texel.x, texel.y, texel.z);
    }
}

// `material` with one parameter multiplied by `value`. `parameter`: `PARAMETER_*` but for normal and bump maps; scalars
// take the first component.
Material apply_parameter(Material material, uint parameter, vec3 value) {
    Material result = material;
    switch (parameter) {
    case PARAMETER_COLOR: result.color *= value; break;
    case PARAMETER_SPECULAR_COLOR: result.specular_color *= value; break;
    case PARAMETER_EMISSION: result.emission *= value; break;
    case PARAMETER_ROUGHNESS:
        result.m0 = max_(material.m0 * value.x, ALPHA_LEAST);
        result.m1 = max_(material.m1 * value.x, ALPHA_LEAST);
        break;
    default: break;
    }
    return result;
}

#endif
