// What every kernel knows of the scene and of the batch in hand.
#ifndef LAYOUT_HEADER_GLSL
#define LAYOUT_HEADER_GLSL

#include "layout/camera.glsl"

const uint INTEGRATOR_LOCAL = 0u;
const uint INTEGRATOR_WHITTED = 1u;
// Path tracing; `direct` is its case of one scattering event.
const uint INTEGRATOR_PATH = 2u;

const uint SAMPLER_SOBOL = 0u;
const uint SAMPLER_STRATIFIED = 1u;
const uint SAMPLER_INDEPENDENT = 2u;

const uint SHADOWS_OFF = 0u;
const uint SHADOWS_OPAQUE = 1u;
const uint SHADOWS_FILTERED = 2u;

const uint FILTER_BOX = 0u;
const uint FILTER_TENT = 1u;
// Gaussian, Mitchell and other tabulated filters: piecewise constant, sampled through their inverse CDF.
const uint FILTER_TABLE = 2u;

// Scene-wide values. 288 bytes. `first_*` are offsets into the data heap in 16-byte words.
struct SceneHeader {
    Camera camera;
    // I_a of the ambient term (radiance).
    vec3 ambient;
    // `INTEGRATOR_*`.
    uint integrator;
    // Radiance where a ray leaves the scene, towards -up and +up of the world (equal for a flat background).
    vec3 background_bottom;
    uint max_depth;
    vec3 background_top;
    // Branches whose largest |throughput| falls below this are cut.
    float min_weight;
    uint seed;
    // `SAMPLER_*`.
    uint sampling;
    // For the stratified sampler: strata per axis, >= 1.
    uint strata;
    // `SHADOWS_*`: what becomes of shadow rays.
    uint shadows;
    // `FILTER_*`.
    uint filter_kind;
    // Half width in pixels.
    float filter_radius;
    // Integral of |filter| over integral of filter, both axes: the weight of every sample before its sign.
    float filter_norm;
    // First float of the filter's inverse CDF in the table array; FILTER_KNOTS + 1 positions, then FILTER_KNOTS signs.
    uint filter_table;
    // Root of the top-level BVH, or INVALID for an empty scene.
    uint top_root;
    uint instance_count;
    uint light_count;
    uint material_count;
    uint first_instance;
    uint first_top_instance;
    uint first_face;
    uint first_vertex;
    uint first_material;
    uint first_light;
    uint first_texture;
    uint first_texel;
    uint first_table;
    // 2^film scale: k + e of the fixed-point film (strict rule 8), as a float power of two.
    float film_scale;
    // 1 if the camera does not see the background (it still lights mirrors and glass).
    uint hide_background;
    // 1 if auxiliary values are recorded.
    uint aovs;
    // Relative widening of the top level's box test (`approx_intersect_node`): covers the rounding of rays in object space.
    float top_margin;
    uint emitter_count;
    uint first_emitter;
    // 1 if an image surrounds the scene, at `first_environment_map`; else the gradient does.
    uint environment_maps;
    uint first_environment_map;
    // First float in the table array of the emitters' alias table: threshold and other emitter's index of each.
    uint emitter_table;
    // Probability of choosing the environment among the emitters; 0 if it is none.
    float environment_density;
    // Rays that have scattered this often or more take part in Russian roulette (path).
    uint rr_depth;
    // Largest |lane| of light that has been scattered, per contribution; 0 for no limit (path).
    float clamp;
    // Levels of pending rays: one per depth where rays branch, else one.
    uint level_count;
    // 1 if a ray that has left a surface can meet light: something glows or surrounds the scene (path).
    uint glows;
    // Shadow rays that one shaded ray sends, at most.
    uint shadow_rays;
    // First float in the table array of the media that have a rank: index and Beer coefficient of each, from rank 1 on.
    uint media_table;
    // 1 if media are nested by rank.
    uint nested;
    // 1 if some object casts no shadow.
    uint shadowless;
    // 1 if the camera looks through what glows (path).
    uint hide_emitters;
};
const uint SCENE_HEADER_WORDS = 18u;

#ifdef GONIO_FETCH
SceneHeader load_scene_header(uint index) {
    uint at = index * SCENE_HEADER_WORDS;
    SceneHeader r;
    uvec4 w0 = fetch_header(at);
    r.camera.eye = uintBitsToFloat(w0.xyz);
    r.camera.kind = w0.w;
    uvec4 w1 = fetch_header(at + 1u);
    r.camera.right = uintBitsToFloat(w1.xyz);
    r.camera.scale_x = uintBitsToFloat(w1.w);
    uvec4 w2 = fetch_header(at + 2u);
    r.camera.up = uintBitsToFloat(w2.xyz);
    r.camera.scale_y = uintBitsToFloat(w2.w);
    uvec4 w3 = fetch_header(at + 3u);
    r.camera.forward = uintBitsToFloat(w3.xyz);
    r.camera.pixel_size = uintBitsToFloat(w3.w);
    uvec4 w4 = fetch_header(at + 4u);
    r.camera.lens_radius = uintBitsToFloat(w4.x);
    r.camera.focus_distance = uintBitsToFloat(w4.y);
    r.camera.shift_x = uintBitsToFloat(w4.z);
    r.camera.shift_y = uintBitsToFloat(w4.w);
    uvec4 w5 = fetch_header(at + 5u);
    r.ambient = uintBitsToFloat(w5.xyz);
    r.integrator = w5.w;
    uvec4 w6 = fetch_header(at + 6u);
    r.background_bottom = uintBitsToFloat(w6.xyz);
    r.max_depth = w6.w;
    uvec4 w7 = fetch_header(at + 7u);
    r.background_top = uintBitsToFloat(w7.xyz);
    r.min_weight = uintBitsToFloat(w7.w);
    uvec4 w8 = fetch_header(at + 8u);
    r.seed = w8.x;
    r.sampling = w8.y;
    r.strata = w8.z;
    r.shadows = w8.w;
    uvec4 w9 = fetch_header(at + 9u);
    r.filter_kind = w9.x;
    r.filter_radius = uintBitsToFloat(w9.y);
    r.filter_norm = uintBitsToFloat(w9.z);
    r.filter_table = w9.w;
    uvec4 w10 = fetch_header(at + 10u);
    r.top_root = w10.x;
    r.instance_count = w10.y;
    r.light_count = w10.z;
    r.material_count = w10.w;
    uvec4 w11 = fetch_header(at + 11u);
    r.first_instance = w11.x;
    r.first_top_instance = w11.y;
    r.first_face = w11.z;
    r.first_vertex = w11.w;
    uvec4 w12 = fetch_header(at + 12u);
    r.first_material = w12.x;
    r.first_light = w12.y;
    r.first_texture = w12.z;
    r.first_texel = w12.w;
    uvec4 w13 = fetch_header(at + 13u);
    r.first_table = w13.x;
    r.film_scale = uintBitsToFloat(w13.y);
    r.hide_background = w13.z;
    r.aovs = w13.w;
    uvec4 w14 = fetch_header(at + 14u);
    r.top_margin = uintBitsToFloat(w14.x);
    r.emitter_count = w14.y;
    r.first_emitter = w14.z;
    r.environment_maps = w14.w;
    uvec4 w15 = fetch_header(at + 15u);
    r.first_environment_map = w15.x;
    r.emitter_table = w15.y;
    r.environment_density = uintBitsToFloat(w15.z);
    r.rr_depth = w15.w;
    uvec4 w16 = fetch_header(at + 16u);
    r.clamp = uintBitsToFloat(w16.x);
    r.level_count = w16.y;
    r.glows = w16.z;
    r.shadow_rays = w16.w;
    uvec4 w17 = fetch_header(at + 17u);
    r.media_table = w17.x;
    r.nested = w17.y;
    r.shadowless = w17.z;
    r.hide_emitters = w17.w;
    return r;
}
#endif

// Intervals in the tabulated filter's inverse CDF.
const uint FILTER_KNOTS = 256u;

// What one batch of samples covers. 48 bytes.
// Slot i is pixel `first_pixel + i / sample_count` of the crop (row by row) and sample `first_sample + i % sample_count`:
// what runs side by side looks the same way.
struct Batch {
    // Corner and size of the crop, pixels of the full frame.
    uint crop_x;
    uint crop_y;
    uint crop_width;
    uint crop_height;
    uint first_pixel;
    uint pixel_count;
    uint first_sample;
    uint sample_count;
    uint slot_count;
    // 1 if the film holds nothing yet of these pixels.
    uint is_first;
    uint pad0;
    uint pad1;
};
const uint BATCH_WORDS = 3u;

#ifdef GONIO_FETCH
Batch load_batch(uint index) {
    uint at = index * BATCH_WORDS;
    Batch r;
    uvec4 w0 = fetch_batch(at);
    r.crop_x = w0.x;
    r.crop_y = w0.y;
    r.crop_width = w0.z;
    r.crop_height = w0.w;
    uvec4 w1 = fetch_batch(at + 1u);
    r.first_pixel = w1.x;
    r.pixel_count = w1.y;
    r.first_sample = w1.z;
    r.sample_count = w1.w;
    uvec4 w2 = fetch_batch(at + 2u);
    r.slot_count = w2.x;
    r.is_first = w2.y;
    r.pad0 = w2.z;
    r.pad1 = w2.w;
    return r;
}
#endif

#endif
