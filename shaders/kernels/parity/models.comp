#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Twins of the reflection models; numbers as in `src/verify/twins/models.rs`: 3 * MODEL_* + {eval and pdf, sample, rest}.
#include "kernels/parity/harness.glsl"
#include "layout/records.glsl"
#include "shading/sampling.glsl"

// Where the head of a table for directions of light begins: counts, then knots, light angles and view angles rising, cosines falling.
const uint TABULATED_AT = 16u;
const float COUNTS[5] = float[](5.0, 6.0, 7.0, 8.0, 2.0);

// That head, and a hash of the index everywhere else.
float load_table(uint index) {
    uint at = index - TABULATED_AT;
    if (at < 5u) return COUNTS[at];
    if (at < 17u) return float(at - 5u) * 0.13;
    if (at < 24u) return 1.0 - float(at - 17u) * 0.14;
    return unit_float(hash_u32(index));
}

#include "shading/material.glsl"

Material material(uint model) {
    // A principled material keeps shares in some of them.
    bool share = model == MODEL_PRINCIPLED;
    Material m;
    m.color = vec3(0.75, 0.5, 0.1);
    m.model = model;
    m.specular_color = vec3(1.0, 0.9, 0.8);
    m.exponent = share ? argument(6u) * 0.0005 : argument(6u);
    m.k_a = 0.5;
    m.k_d = 1.0 - argument(7u);
    m.k_s = argument(7u);
    m.k_r = 0.25;
    m.eta = vec3(argument(8u), argument(8u) * 0.75, argument(8u) * 1.25);
    m.m0 = argument(10u);
    m.k = vec3(argument(9u), argument(9u) * 0.5, argument(9u) * 0.25) * (share ? 0.125 : 1.0);
    m.m1 = argument(11u);
    m.w0 = 0.625;
    m.w1 = 0.375;
    m.k_t = 0.0;
    m.flags = argument_u(12u);
    m.transmit_color = vec3(0.0);
    m.first_texture = 0u;
    m.texture_count = 0u;
    m.absorption = vec3(0.0);
    m.emission = vec3(0.0);
    m.table = model == MODEL_TABULATED ? TABULATED_AT : 64u;
    m.m0_v = argument(13u);
    m.m1_v = 0.25;
    m.k_t = 0.375;
    m.transmit_color = vec3(0.5, 0.25, 0.75);
    m.exponent_v = argument(14u);
    m.extra = argument(15u);
    return m;
}

void main() {
    if (gl_GlobalInvocationID.x >= count) return;
    vec3 wo = argument3(0u);
    vec3 wi = argument3(3u);
    Material m = material(function / 3u);
    switch (function % 3u) {
    case 0u:
        result4(0u, eval_material(m, wo, wi));
        result(4u, pdf_material(m, wo, wi));
        break;
    case 1u:
        BsdfSample s = sample_material(m, wo, abs(argument2(3u)), abs(argument(5u)));
        result4(0u, vec4(s.wi, s.pdf));
        result3(4u, s.weight.xyz);
        result_u(7u, floatBitsToUint(s.eta) ^ s.flags);
        break;
    default:
        result(0u, ambient_material(m).x);
        result(1u, albedo_material(m).y + pane_tint(m).y);
        result4(2u, mirror_weight(m, argument(5u)));
        result_u(6u, (is_delta(m) ? 1u : 0u) | (is_refracting(m) ? 2u : 0u));
        result(7u, emission_material(m).x + own_weight(m));
        break;
    }
}
