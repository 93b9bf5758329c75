#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Shades every path of the chunk, or of one group of it, with its hit.
#include "kernels/bindings.glsl"
#include "kernels/queues.glsl"
#include "transport/shade.glsl"

void main() {
    begin_round();
    uint at = gl_GlobalInvocationID.x;
    if (at >= control.shade_count[SHADE_GROUP]) return;
    uint i = at;
    if (SHADE_GROUPED) i = order[SHADE_GROUP * round_.chunk_count + at];
    shade(load_path_state(i), load_hit(i));
}
