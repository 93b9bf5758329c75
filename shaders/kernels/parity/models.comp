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

Closure make_closure(uint model) {
    Closure c;
    c.model = model;
    c.flags = argument_u(12u);
    c.color = vec3(0.75, 0.5, 0.1);
    c.specular_color = vec3(1.0, 0.9, 0.8);
    c.k_a = 0.5;
    c.k_d = 1.0 - argument(7u);
    c.k_s = argument(7u);
    c.k_r = 0.25;
    c.exponent = argument(6u);
    c.exponent_v = argument(14u);
    c.sigma = argument(15u);
    c.distribution = (argument_u(12u) >> 16u) & 3u;
    c.second_distribution = (argument_u(12u) >> 18u) & 3u;
    c.alpha_u = argument(10u);
    c.alpha_v = argument(13u);
    c.second_alpha_u = argument(11u);
    c.second_alpha_v = 0.25;
    c.weight = 0.625;
    c.second_weight = 0.375;
    c.eta = argument(8u);
    c.metal_eta = vec3(argument(8u), argument(8u) * 0.75, argument(8u) * 1.25);
    c.metal_k = vec3(argument(9u), argument(9u) * 0.5, argument(9u) * 0.25);
    c.f0 = vec3(argument(8u), argument(8u) * 0.75, argument(8u) * 1.25);
    c.table = model == MODEL_TABULATED ? TABULATED_AT : 64u;
    c.inner_reflectance = argument(15u);
    c.roughness = argument(10u);
    c.metallic = argument(15u);
    c.anisotropic = argument(9u) * 0.125;
    c.spec_trans = argument(9u) * 0.0625;
    c.spec_tint = argument(9u) * 0.03125;
    c.sheen = 0.625;
    c.sheen_tint = 0.375;
    c.flatness = 1.0 - argument(7u);
    c.clearcoat = argument(7u);
    c.clearcoat_gloss = argument(6u) * 0.0005;
    c.blend = argument(15u);
    c.first_part = 0u;
    c.first_leaves = 0u;
    c.leaf_count = 0u;
    c.share = 1.0;
    c.absorption = vec3(0.0);
    c.rank = 0u;
    c.emission = vec3(0.0);
    c.k_t = 0.375;
    c.transmit_color = vec3(0.5, 0.25, 0.75);
    return c;
}

void main() {
    if (gl_GlobalInvocationID.x >= count) return;
    vec3 wo = argument3(0u);
    vec3 wi = argument3(3u);
    Closure c = make_closure(function / 3u);
    switch (function % 3u) {
    case 0u:
        result4(0u, eval_closure(c, wo, wi));
        result(4u, pdf_closure(c, wo, wi));
        break;
    case 1u:
        BsdfSample s = sample_closure(c, wo, abs(argument2(3u)), abs(argument(5u)));
        result4(0u, vec4(s.wi, s.pdf));
        result3(4u, s.weight.xyz);
        result_u(7u, floatBitsToUint(s.eta) ^ s.flags);
        break;
    default:
        result(0u, ambient_closure(c).x);
        result(1u, albedo_closure(c).y + pane_tint(c).y);
        result4(2u, mirror_weight(c, argument(5u)));
        result_u(6u, (is_delta(c) ? 1u : 0u) | (is_refracting(c.model) ? 2u : 0u));
        result(7u, c.emission.x + own_weight(c.flags, c.k_t));
        break;
    }
}
