// What `path` samples light from.
#ifndef LAYOUT_EMITTER_GLSL
#define LAYOUT_EMITTER_GLSL

const uint EMITTER_TRIANGLE = 0u;
// The unit sphere under the instance's transform.
const uint EMITTER_SPHERE = 1u;
// A light of no size: `instance` is its index.
const uint EMITTER_LIGHT = 2u;
// Whatever a ray that leaves the scene sees.
const uint EMITTER_ENVIRONMENT = 3u;

// Emitter flag: it shines from the outside only.
const uint EMITTER_ONE_SIDED = 1u;
// Emitter flag: `radiance` does not hold everywhere, the material's textures have to be asked.
const uint EMITTER_TEXTURED = 2u;

// One emitter. 80 bytes. World space.
struct Emitter {
    // First corner of a triangle.
    vec3 corner;
    // `EMITTER_*`.
    uint kind;
    // From the first corner to the others.
    vec3 edge1;
    uint instance;
    vec3 edge2;
    uint primitive;
    // Unit, leaves the outside of a triangle.
    vec3 normal;
    // Probability of choosing this emitter; of a triangle per unit of its area.
    float density;
    // Of every point in every direction (triangles and spheres).
    vec3 radiance;
    // `EMITTER_ONE_SIDED`, `EMITTER_TEXTURED`.
    uint flags;
};
const uint EMITTER_WORDS = 5u;

#ifdef GONIO_FETCH
Emitter load_emitter(uint index) {
    uint at = header.first_emitter + index * EMITTER_WORDS;
    Emitter r;
    uvec4 w0 = fetch_data(at);
    r.corner = uintBitsToFloat(w0.xyz);
    r.kind = w0.w;
    uvec4 w1 = fetch_data(at + 1u);
    r.edge1 = uintBitsToFloat(w1.xyz);
    r.instance = w1.w;
    uvec4 w2 = fetch_data(at + 2u);
    r.edge2 = uintBitsToFloat(w2.xyz);
    r.primitive = w2.w;
    uvec4 w3 = fetch_data(at + 3u);
    r.normal = uintBitsToFloat(w3.xyz);
    r.density = uintBitsToFloat(w3.w);
    uvec4 w4 = fetch_data(at + 4u);
    r.radiance = uintBitsToFloat(w4.xyz);
    r.flags = w4.w;
    return r;
}
#endif

// An equirectangular image around the scene and what is needed to draw directions from it. 80 bytes.
// The image's top row is +y, its centre +z, a quarter from the left +x, all in the environment's own space.
struct EnvironmentMap {
    // Rotation from world space; the fourth column is 0.
    vec4 to_local[3];
    // Factor on the image.
    vec3 scale;
    // Index of the image.
    uint texture;
    // Size of the image, texels.
    uint width;
    uint height;
    // First float in the table array: density at each vertex of the grid, (height + 2) rows of width, then the CDFs of
    // its cells within each of (height + 1) rows (width + 1 floats each), then the CDF of rows (height + 2 floats).
    uint first_table;
    uint pad0;
};
const uint ENVIRONMENT_MAP_WORDS = 5u;

#ifdef GONIO_FETCH
EnvironmentMap load_environment_map(uint index) {
    uint at = header.first_environment_map + index * ENVIRONMENT_MAP_WORDS;
    EnvironmentMap r;
    uvec4 w0 = fetch_data(at);
    r.to_local[0] = uintBitsToFloat(w0);
    uvec4 w1 = fetch_data(at + 1u);
    r.to_local[1] = uintBitsToFloat(w1);
    uvec4 w2 = fetch_data(at + 2u);
    r.to_local[2] = uintBitsToFloat(w2);
    uvec4 w3 = fetch_data(at + 3u);
    r.scale = uintBitsToFloat(w3.xyz);
    r.texture = w3.w;
    uvec4 w4 = fetch_data(at + 4u);
    r.width = w4.x;
    r.height = w4.y;
    r.first_table = w4.z;
    r.pad0 = w4.w;
    return r;
}
#endif

#endif
