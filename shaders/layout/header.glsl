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
    // 1 if some object casts no shadow (path).
    uint shadowless;
    // 1 if the camera looks through what glows (path).
    uint hide_emitters;
};

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
    uint pad0;
    uint pad1;
    uint pad2;
};

#endif
