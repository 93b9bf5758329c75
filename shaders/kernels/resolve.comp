#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Adds every finished sample of the batch to its pixel.
#include "kernels/bindings.glsl"
#include "kernels/queues.glsl"
#include "transport/generate.glsl"

void main() {
    uint slot = gl_GlobalInvocationID.x;
    if (slot >= batch.slot_count) return;
    uint index = slot_pixel(batch, slot);
    uint clamped = 0u;
    for (uint lane = 0u; lane < 4u; lane++) {
        Fixed units = clamp_sample(slots[slot].low[lane], slots[slot].high[lane]);
        ATOMIC_ADD_FIXED(film[index], lane, units)
        clamped |= units.nan;
    }
    if (clamped != 0u) atomicAdd(control.clamped_count, 1u);
}
