// What a texture's value does to a material (row 27).
#ifndef SHADING_PARAMETER_GLSL
#define SHADING_PARAMETER_GLSL

#include "layout/features.glsl"
#include "layout/records.glsl"
#include "shading/closure.glsl"
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

// Multiplies one parameter of `closure` by `texel` times `scale`. `parameter`: `PARAMETER_*` but for normal and bump
// maps; scalars take the first component. A mask covers all where `texel` reaches `scale`, and nothing elsewhere.
void apply_parameter(inout Closure closure, uint parameter, vec3 texel, float scale) {
    vec3 value = texel * scale;
    // k_t is what is not covered.
    float covered = 1.0 - closure.k_t;
    switch (parameter) {
    case PARAMETER_COLOR: closure.color *= value; break;
    case PARAMETER_SPECULAR_COLOR: closure.specular_color *= value; break;
    case PARAMETER_EMISSION: closure.emission *= value; break;
    case PARAMETER_ROUGHNESS:
    case PARAMETER_ROUGHNESS_U:
    case PARAMETER_ROUGHNESS_V:
        if (parameter != PARAMETER_ROUGHNESS_V) {
            closure.alpha_u = max_(closure.alpha_u * value.x, ALPHA_LEAST);
            closure.roughness = max_(closure.roughness * value.x, ALPHA_LEAST);
            closure.second_alpha_u = max_(closure.second_alpha_u * value.x, ALPHA_LEAST);
        }
        if (parameter != PARAMETER_ROUGHNESS_U) {
            closure.alpha_v = max_(closure.alpha_v * value.x, ALPHA_LEAST);
            closure.second_alpha_v = max_(closure.second_alpha_v * value.x, ALPHA_LEAST);
        }
        break;
    case PARAMETER_METALLIC: closure.metallic = clamp_(closure.metallic * value.x, 0.0, 1.0); break;
    case PARAMETER_WEIGHT: closure.blend = clamp_(closure.blend * value.x, 0.0, 1.0); break;
    case PARAMETER_OPACITY: closure.k_t = 1.0 - covered * clamp_(value.x, 0.0, 1.0); break;
    case PARAMETER_MASK: closure.k_t = covered * texel.x >= scale ? 0.0 : 1.0; break;
    PRINCIPLED(PARAMETER_ANISOTROPIC, closure.anisotropic, closure.anisotropic)
    PRINCIPLED(PARAMETER_SPEC_TRANS, closure.spec_trans, closure.spec_trans)
    PRINCIPLED(PARAMETER_SPEC_TINT, closure.spec_tint, closure.spec_tint)
    PRINCIPLED(PARAMETER_SHEEN, closure.sheen, closure.sheen)
    PRINCIPLED(PARAMETER_SHEEN_TINT, closure.sheen_tint, closure.sheen_tint)
    PRINCIPLED(PARAMETER_FLATNESS, closure.flatness, closure.flatness)
    PRINCIPLED(PARAMETER_CLEARCOAT, closure.clearcoat, closure.clearcoat)
    PRINCIPLED(PARAMETER_CLEARCOAT_GLOSS, closure.clearcoat_gloss, closure.clearcoat_gloss)
    // Normal and bump maps.
    default: break;
    }
}

#undef PRINCIPLED

#endif
