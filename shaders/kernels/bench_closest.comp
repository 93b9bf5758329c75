#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// The closest hits of an array of rays, for `gonio bench`. The rays lie in the shadow ray queue's records, so that they
// are fetched as the wavefront fetches its own. Of the batch, `first_pixel` is the first ray and `slot_count` how many.
#include "kernels/bindings.glsl"
#include "trace/traverse.glsl"

void main() {
    begin();
    uint i = gl_GlobalInvocationID.x;
    if (i >= batch.slot_count) return;
    uint at = batch.first_pixel + i;
    store_hit(at, trace_closest(load_shadow_ray(at).ray));
}
