#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Camera rays: one invocation per sample slot of the batch.
#include "kernels/bindings.glsl"
#include "transport/generate.glsl"

void main() {
    uint slot = gl_GlobalInvocationID.x;
    if (slot >= batch.slot_count) return;
    slots[slot].low = uvec4(0u);
    slots[slot].high = uvec4(0u);
    PathState path = generate(batch, slot);
    levels[slot] = path;
    if (SCENE_HAS_AOVS && path.sample_index == 0u) {
        uint index = slot_pixel(batch, slot);
        aovs[index].depth = T_INFINITE;
        aovs[index].object = INVALID;
        aovs[index].material = INVALID;
    }
}
