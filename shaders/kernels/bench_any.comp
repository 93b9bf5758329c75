#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Whether each ray of an array meets anything, for `gonio bench`: `instance` of its hit becomes 0, or INVALID for a miss.
// Rays and batch are as in bench_closest.comp.
#include "kernels/bindings.glsl"
#include "trace/traverse.glsl"

void main() {
    begin();
    uint i = gl_GlobalInvocationID.x;
    if (i >= batch.slot_count) return;
    uint at = batch.first_pixel + i;
    hits[HIT_WORDS * at].w = trace_any(load_shadow_ray(at).ray) ? 0u : INVALID;
}
