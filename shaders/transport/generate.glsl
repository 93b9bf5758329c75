// The camera ray of a sample.
#ifndef TRANSPORT_GENERATE_GLSL
#define TRANSPORT_GENERATE_GLSL

#include "layout/features.glsl"
#include "shading/camera.glsl"
#include "shading/filter.glsl"
#include "shading/sampling.glsl"
#include "shading/spectrum.glsl"
#include "shading/warp.glsl"
#include "transport/mod.glsl"

// The key of a path's random numbers: they depend on nothing else.
SampleKey sample_key(uint pixel, uint sample_index, uint path_id) {
    return SampleKey(SAMPLER, header.strata, header.seed, pixel, sample_index, path_id);
}

// Pixel of a slot, counted row by row in the crop.
uint slot_pixel(Batch batch, uint slot) {
    return batch.first_pixel + slot / batch.sample_count;
}

// The state of the sample in `slot` before its first ray is traced: filter importance sampling (Ernst, Stamminger
// and Greiner 2006, "Filter Importance Sampling") places the ray, so one sample touches one pixel.
PathState generate(Batch batch, uint slot) {
    uint index = slot_pixel(batch, slot);
    uint x = batch.crop_x + index % batch.crop_width;
    uint y = batch.crop_y + index / batch.crop_width;
    uint pixel = x | (y << 16);
    uint sample_index = batch.first_sample + slot % batch.sample_count;
    SampleKey key = sample_key(pixel, sample_index, 0u);
    FilterSample pixel_filter = sample_filter(sample_2d(key, DIMENSION_FILTER));
    float film_x = float(x) + 0.5 + pixel_filter.offset.x;
    float film_y = float(y) + 0.5 + pixel_filter.offset.y;
    CameraRay camera = camera_ray(header.camera, film_x, film_y);
    if (HAS_LENS) camera = through_lens(header.camera, camera, square_to_disk(sample_2d(key, DIMENSION_LENS)));
    PathState path;
    path.ray.origin = camera.origin;
    path.ray.t_max = T_INFINITE;
    path.ray.direction = camera.direction;
    path.ray.skip_instance = INVALID;
    path.ray.skip_primitive = INVALID;
    path.ray.skip_inward = 0u;
    path.ray.cone_width = camera.cone_width;
    path.ray.cone_spread = camera.cone_spread;
    path.throughput = spectrum_from_rgb(vec3(pixel_filter.weight));
    path.slot = slot;
    path.pixel = pixel;
    path.sample_index = sample_index;
    path.path_id = 0u;
    path.depth = 0u;
    path.coverage = pixel_filter.weight;
    path.eta = 1.0;
    path.pdf = 0.0;
    path.absorption = vec3(0.0);
    path.interior = 0u;
    path.passed = 0.0;
    path.flags = 0u;
    path.pad0 = 0u;
    path.pad1 = 0u;
    return path;
}

#endif
