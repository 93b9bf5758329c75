#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Traces the last round's shadow rays to the nearest thing in their way; what panes let through goes on in the next round.
#include "kernels/bindings.glsl"
#include "kernels/queues.glsl"
#include "trace/traverse.glsl"
#include "transport/shadow.glsl"

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= control.shadow_pending) return;
    ShadowRay shadow = load_shadow_ray(control.shadow_first + i);
    shade_shadow(shadow, trace_occluder(shadow.ray));
}
