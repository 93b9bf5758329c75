#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Adds the finished samples of the batch to their pixel: one invocation a pixel, so nothing need be atomic.
#include "kernels/bindings.glsl"
#include "kernels/queues.glsl"
#include "transport/generate.glsl"

void main() {
    begin();
    uint pixel = gl_GlobalInvocationID.x;
    if (pixel >= batch.pixel_count) return;
    uint index = batch.first_pixel + pixel;
    FilmSum sum = FilmSum(uvec4(0u), uvec4(0u));
    if (batch.is_first == 0u) {
        sum = FilmSum(fetch_film(2u * index), fetch_film(2u * index + 1u));
    }
    uint clamped_count = 0u;
    for (uint s = 0u; s < batch.sample_count; s++) {
        uint at = 2u * (pixel * batch.sample_count + s);
        clamped_count += resolve_sample(sum, FilmSum(fetch_slot(at), fetch_slot(at + 1u)));
    }
    film[index] = sum;
    if (clamped_count != 0u) atomicAdd(control.clamped_count, clamped_count);
}
