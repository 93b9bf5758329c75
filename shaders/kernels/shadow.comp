#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Traces the last round's shadow rays; what is unoccluded adds its light. With filtered shadows they are traced to the
// nearest thing in their way, and what panes let through goes on in the next round.
#include "kernels/bindings.glsl"
#include "kernels/queues.glsl"
#include "trace/traverse.glsl"
#include "transport/shadow.glsl"

void main() {
    begin_round();
    uint i = gl_GlobalInvocationID.x;
    if (i >= control.shadow_pending) return;
    if (SCENE_SHADOWS == SHADOWS_FILTERED) {
        ShadowRay shadow = load_shadow_ray(round_.shadow_first + i);
        shade_shadow(shadow, trace_occluder(shadow.ray));
        return;
    }
    ShadowRay shadow = load_shadow_ray(i);
    if (!trace_any(shadow.ray)) {
        if (SCENE_HAS_CLAMP && shadow.limited != 0u) count_limited();
        add_contribution(header.film_scale, shadow.slot, shadow.contribution, shadow.dither);
    }
}
