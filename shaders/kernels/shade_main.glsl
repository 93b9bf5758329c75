// Shades every path of the chunk with its hit: the body of the `shade` kernels, which differ in what they leave out.
#ifndef KERNELS_SHADE_MAIN_GLSL
#define KERNELS_SHADE_MAIN_GLSL

#include "kernels/bindings.glsl"
#include "kernels/queues.glsl"
#include "transport/shade.glsl"

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= control.chunk_count) return;
    shade(load_path_state(i), load_hit(i));
}

#endif
