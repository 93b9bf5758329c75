#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Traces the last round's shadow rays. Filtered ones that pass a pane go on in the next round.
#include "kernels/bindings.glsl"
#include "kernels/queues.glsl"
#include "transport/shadow.glsl"

void main() {
    begin_round();
    uint i = gl_GlobalInvocationID.x;
    if (i >= control.shadow_pending) return;
    uint first = SHADOWS == SHADOWS_FILTERED ? round_.shadow_first : 0u;
    trace_shadow(load_shadow_ray(first + i));
}
