#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Shades every path of the chunk with its hit.
#include "kernels/bindings.glsl"
#include "kernels/queues.glsl"
#include "transport/shade.glsl"

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= control.chunk_count) return;
    shade(load_path_state(i), load_hit(i));
}
