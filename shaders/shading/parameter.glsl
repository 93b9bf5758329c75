// What a texture's value does to a material (row 27).
#ifndef SHADING_PARAMETER_GLSL
#define SHADING_PARAMETER_GLSL

#include "layout/features.glsl"
#include "layout/records.glsl"
#include "shading/math.glsl"

#define PRINCIPLED(parameter, kept, constant) \
    case parameter: if (HAS_MODEL(MODEL_PRINCIPLED)) kept = clamp_(constant * value.x, 0.0, 1.0); break;

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

// `material` with one parameter multiplied by `texel` times `scale`. `parameter`: `PARAMETER_*` but for normal and bump
// maps; scalars take the first component. A mask covers all where `texel` reaches `scale`, and nothing elsewhere.
Material apply_parameter(Material material, uint parameter, vec3 texel, float scale) {
    Material result = material;
    vec3 value = texel * scale;
    // k_t is what is not covered.
    float covered = 1.0 - material.k_t;
    switch (parameter) {
    case PARAMETER_COLOR: result.color *= value; break;
    case PARAMETER_SPECULAR_COLOR: result.specular_color *= value; break;
    case PARAMETER_EMISSION: result.emission *= value; break;
    case PARAMETER_ROUGHNESS:
    case PARAMETER_ROUGHNESS_U:
    case PARAMETER_ROUGHNESS_V:
        if (parameter != PARAMETER_ROUGHNESS_V) {
            result.m0 = max_(material.m0 * value.x, ALPHA_LEAST);
            result.m1 = max_(material.m1 * value.x, ALPHA_LEAST);
        }
        if (parameter != PARAMETER_ROUGHNESS_U) {
            result.m0_v = max_(material.m0_v * value.x, ALPHA_LEAST);
            result.m1_v = max_(material.m1_v * value.x, ALPHA_LEAST);
        }
        break;
    case PARAMETER_METALLIC:
    case PARAMETER_WEIGHT: result.extra = clamp_(material.extra * value.x, 0.0, 1.0); break;
    case PARAMETER_OPACITY: result.k_t = 1.0 - covered * clamp_(value.x, 0.0, 1.0); break;
    case PARAMETER_MASK: result.k_t = covered * texel.x >= scale ? 0.0 : 1.0; break;
    // Where a principled material keeps them (`shading/principled`).
    PRINCIPLED(PARAMETER_ANISOTROPIC, result.k.x, material.k.x)
    PRINCIPLED(PARAMETER_SPEC_TRANS, result.k.y, material.k.y)
    PRINCIPLED(PARAMETER_SPEC_TINT, result.k.z, material.k.z)
    PRINCIPLED(PARAMETER_SHEEN, result.w0, material.w0)
    PRINCIPLED(PARAMETER_SHEEN_TINT, result.w1, material.w1)
    PRINCIPLED(PARAMETER_FLATNESS, result.k_d, material.k_d)
    PRINCIPLED(PARAMETER_CLEARCOAT, result.k_s, material.k_s)
    PRINCIPLED(PARAMETER_CLEARCOAT_GLOSS, result.exponent, material.exponent)
    // Normal and bump maps.
    default: break;
    }
    return result;
}

#undef PRINCIPLED

#endif
