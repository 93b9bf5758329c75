#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Traces the last round's shadow rays; what is unoccluded adds its light.
#include "kernels/bindings.glsl"
#include "kernels/queues.glsl"
#include "trace/traverse.glsl"

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= control.shadow_pending) return;
    ShadowRay shadow = load_shadow_ray(i);
    if (!trace_any(shadow.ray)) {
        if (SCENE_HAS_CLAMP && shadow.limited != 0u) count_limited();
        add_contribution(header.film_scale, shadow.slot, shadow.contribution, shadow.dither);
    }
}
