// The records that travel through the wavefront's queues.
#ifndef LAYOUT_PATH_GLSL
#define LAYOUT_PATH_GLSL

// A ray to trace, world space, and the cone around it that a pixel sees (Akenine-Moeller et al. 2021, "Improved Shader
// and Texture Level of Detail Using Ray Cones"). 48 bytes.
struct Ray {
    vec3 origin;
    // Hits at t > t_max do not count; `T_INFINITE` for none. In units of `direction`.
    float t_max;
    // Unit for camera and scattered rays.
    vec3 direction;
    // The flat triangle (or sphere) the ray leaves: it is not tested again. `INVALID` for none.
    uint skip_instance;
    uint skip_primitive;
    // For a sphere that is left: 1 if the ray goes inward (only the far root counts), 0 outward (no root counts).
    uint skip_inward;
    // Width of the cone at the origin, world units, and what it grows by per unit of distance.
    float cone_width;
    float cone_spread;
};

// Farther than any scene; finite so that no arithmetic meets an infinity.
const float T_INFINITE = 1.0e30;

// The closest hit of a ray. 32 bytes. A miss has `instance == INVALID`.
struct Hit {
    // In units of the ray's direction.
    float t;
    // Barycentric weights of corners 1 and 2 (0 on a sphere).
    float b1;
    float b2;
    uint instance;
    // Index of the triangle in its mesh as written; 0 on a sphere.
    uint primitive;
    uint pad0;
    uint pad1;
    uint pad2;
};
const uint HIT_WORDS = 2u;

#ifdef GONIO_FETCH
Hit load_hit(uint index) {
    uint at = index * HIT_WORDS;
    Hit r;
    uvec4 w0 = fetch_hit(at);
    r.t = uintBitsToFloat(w0.x);
    r.b1 = uintBitsToFloat(w0.y);
    r.b2 = uintBitsToFloat(w0.z);
    r.instance = w0.w;
    uvec4 w1 = fetch_hit(at + 1u);
    r.primitive = w1.x;
    r.pad0 = w1.y;
    r.pad1 = w1.z;
    r.pad2 = w1.w;
    return r;
}

void store_hit(uint index, Hit r) {
    uint at = index * HIT_WORDS;
    put_hit(at, uvec4(floatBitsToUint(r.t), floatBitsToUint(r.b1), floatBitsToUint(r.b2), r.instance));
    put_hit(at + 1u, uvec4(r.primitive, r.pad0, r.pad1, r.pad2));
}
#endif

// A pending ray and all that its shading will need to know. 128 bytes.
// The last word is kept only in scenes in which rays pass something (`SCENE_HAS_PASSING` of the kernels).
struct PathState {
    Ray ray;
    // What a unit of radiance arriving along the ray adds to the sample; signed (negative filter lobes).
    vec4 throughput;
    // Where the sample's sum is kept in the batch.
    uint slot;
    // x | y << 16, in the full frame.
    uint pixel;
    uint sample_index;
    // Hash of the branch history: `hash(parent, lobe)`; 0 for the camera ray.
    uint path_id;
    // Scattering events so far (passing straight through a pane is none).
    uint depth;
    // What is still uncovered in front of this ray, for alpha; 0 off the camera's straight line (depth > 0).
    float coverage;
    // Relative index of the medium the ray travels in (1 outside everything).
    float eta;
    // Density per solid angle with which the ray's direction was drawn where it left a surface; 0 if no light sample there
    // could have had it: camera rays, directions of zero width, what has passed a pane that stops shadow rays (path).
    float pdf;
    // Beer coefficient of that medium, per scene unit.
    vec3 absorption;
    // Media that the ray is inside of, where they have ranks (`shading/interior`).
    uint interior;
    // How far before the ray's origin its direction was drawn: the way through what it has passed since (path).
    float passed;
    // `PATH_*`.
    uint flags;
    uint pad0;
    uint pad1;
};
const uint PATH_STATE_WORDS = 8u;

// Since its direction was drawn the ray has passed an object that casts no shadow: light samples found all light beyond it.
const uint PATH_BEHIND_SHADOWLESS = 1u;

#ifdef GONIO_FETCH
// The last word of a path, zeros where it is not kept.
uvec4 fetch_passing(uint at) {
    if (SCENE_HAS_PASSING) return fetch_path(at);
    return uvec4(0u);
}

PathState load_path_state(uint index) {
    uint at = index * PATH_STATE_WORDS;
    PathState r;
    uvec4 w0 = fetch_path(at);
    r.ray.origin = uintBitsToFloat(w0.xyz);
    r.ray.t_max = uintBitsToFloat(w0.w);
    uvec4 w1 = fetch_path(at + 1u);
    r.ray.direction = uintBitsToFloat(w1.xyz);
    r.ray.skip_instance = w1.w;
    uvec4 w2 = fetch_path(at + 2u);
    r.ray.skip_primitive = w2.x;
    r.ray.skip_inward = w2.y;
    r.ray.cone_width = uintBitsToFloat(w2.z);
    r.ray.cone_spread = uintBitsToFloat(w2.w);
    uvec4 w3 = fetch_path(at + 3u);
    r.throughput = uintBitsToFloat(w3);
    uvec4 w4 = fetch_path(at + 4u);
    r.slot = w4.x;
    r.pixel = w4.y;
    r.sample_index = w4.z;
    r.path_id = w4.w;
    uvec4 w5 = fetch_path(at + 5u);
    r.depth = w5.x;
    r.coverage = uintBitsToFloat(w5.y);
    r.eta = uintBitsToFloat(w5.z);
    r.pdf = uintBitsToFloat(w5.w);
    uvec4 w6 = fetch_path(at + 6u);
    r.absorption = uintBitsToFloat(w6.xyz);
    r.interior = w6.w;
    uvec4 w7 = fetch_passing(at + 7u);
    r.passed = uintBitsToFloat(w7.x);
    r.flags = w7.y;
    r.pad0 = w7.z;
    r.pad1 = w7.w;
    return r;
}

void store_path_state(uint index, PathState r) {
    uint at = index * PATH_STATE_WORDS;
    put_path(at, uvec4(floatBitsToUint(r.ray.origin), floatBitsToUint(r.ray.t_max)));
    put_path(at + 1u, uvec4(floatBitsToUint(r.ray.direction), r.ray.skip_instance));
    put_path(at + 2u, uvec4(r.ray.skip_primitive, r.ray.skip_inward, floatBitsToUint(r.ray.cone_width), floatBitsToUint(r.ray.cone_spread)));
    put_path(at + 3u, floatBitsToUint(r.throughput));
    put_path(at + 4u, uvec4(r.slot, r.pixel, r.sample_index, r.path_id));
    put_path(at + 5u, uvec4(r.depth, floatBitsToUint(r.coverage), floatBitsToUint(r.eta), floatBitsToUint(r.pdf)));
    put_path(at + 6u, uvec4(floatBitsToUint(r.absorption), r.interior));
    if (SCENE_HAS_PASSING) put_path(at + 7u, uvec4(floatBitsToUint(r.passed), r.flags, r.pad0, r.pad1));
}
#endif

// A shadow ray with the light it carries if nothing is in the way. 80 bytes.
struct ShadowRay {
    Ray ray;
    // Added to the sample, times `weight`, if nothing is in the way (throughput included).
    vec4 contribution;
    uint slot;
    // Hash that dithers the conversion to fixed point (`film` in transport).
    uint dither;
    // Panes passed so far.
    uint layer;
    // What multiple importance sampling leaves of the contribution, 0..1.
    float weight;
};
const uint SHADOW_RAY_WORDS = 5u;

#ifdef GONIO_FETCH
ShadowRay load_shadow_ray(uint index) {
    uint at = index * SHADOW_RAY_WORDS;
    ShadowRay r;
    uvec4 w0 = fetch_shadow(at);
    r.ray.origin = uintBitsToFloat(w0.xyz);
    r.ray.t_max = uintBitsToFloat(w0.w);
    uvec4 w1 = fetch_shadow(at + 1u);
    r.ray.direction = uintBitsToFloat(w1.xyz);
    r.ray.skip_instance = w1.w;
    uvec4 w2 = fetch_shadow(at + 2u);
    r.ray.skip_primitive = w2.x;
    r.ray.skip_inward = w2.y;
    r.ray.cone_width = uintBitsToFloat(w2.z);
    r.ray.cone_spread = uintBitsToFloat(w2.w);
    uvec4 w3 = fetch_shadow(at + 3u);
    r.contribution = uintBitsToFloat(w3);
    uvec4 w4 = fetch_shadow(at + 4u);
    r.slot = w4.x;
    r.dither = w4.y;
    r.layer = w4.z;
    r.weight = uintBitsToFloat(w4.w);
    return r;
}

void store_shadow_ray(uint index, ShadowRay r) {
    uint at = index * SHADOW_RAY_WORDS;
    put_shadow(at, uvec4(floatBitsToUint(r.ray.origin), floatBitsToUint(r.ray.t_max)));
    put_shadow(at + 1u, uvec4(floatBitsToUint(r.ray.direction), r.ray.skip_instance));
    put_shadow(at + 2u, uvec4(r.ray.skip_primitive, r.ray.skip_inward, floatBitsToUint(r.ray.cone_width), floatBitsToUint(r.ray.cone_spread)));
    put_shadow(at + 3u, floatBitsToUint(r.contribution));
    put_shadow(at + 4u, uvec4(r.slot, r.dither, r.layer, floatBitsToUint(r.weight)));
}
#endif

#endif
