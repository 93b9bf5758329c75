#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// The closest hit of every ray in the chunk. Copies the chunk out of its level, so that shade may append to that level.
#define PATHS_FROM_LEVELS
#include "kernels/bindings.glsl"
#include "kernels/queues.glsl"
#include "trace/traverse.glsl"

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= control.chunk_count) return;
    PathState path = load_path_state(level_first(control.chunk_level) + control.chunk_first + i);
    hits[i] = trace_closest(path.ray);
    chunk[i] = path;
}
