// Lights.
#ifndef LAYOUT_LIGHT_GLSL
#define LAYOUT_LIGHT_GLSL

const uint LIGHT_POINT = 0u;
const uint LIGHT_DIRECTIONAL = 1u;
const uint LIGHT_SPOT = 2u;

// Physical 1 / d^2.
const uint ATTENUATION_INVERSE_SQUARE = 0u;
// min(1, 1 / (c1 + c2 d + c3 d^2)).
const uint ATTENUATION_POLYNOMIAL = 1u;
const uint ATTENUATION_NONE = 2u;

// Entries of the table array that describe a slide.
const uint SLIDE_ENTRIES = 10u;

// One light. 112 bytes.
struct Light {
    vec3 position;
    // `LIGHT_*`.
    uint kind;
    // Unit, the way the light travels (directional and spot).
    vec3 direction;
    // `ATTENUATION_*`.
    uint attenuation;
    // Radiant intensity (W/sr), or irradiance for a directional light; radiometric (lecture units are converted by bake).
    vec3 intensity;
    // Cosine of the half angle where a spot ends.
    float cos_outer;
    // c1, c2, c3 of the polynomial law.
    vec3 c;
    // Cosine of the half angle where a spot begins to fall off; equal to `cos_outer` for a hard edge.
    float cos_inner;
    // Warn's flaps: the box of the world that the light reaches, from -`T_INFINITE`
    vec3 flaps_min;
    // Warn's exponent p: intensity times cos^p of the angle off the axis; 0 for none.
    float exponent;
    // to `T_INFINITE` where there are none.
    vec3 flaps_max;
    // 1 if the light casts shadows.
    uint casts_shadow;
    // 1 if something stands in a spot's beam (`shading/slide`); `table` is then the first of its `SLIDE_ENTRIES`.
    uint slide;
    uint table;
    uint pad0;
    uint pad1;
};
const uint LIGHT_WORDS = 7u;

#ifdef GONIO_FETCH
Light load_light(uint index) {
    uint at = header.first_light + index * LIGHT_WORDS;
    Light r;
    uvec4 w0 = fetch_data(at);
    r.position = uintBitsToFloat(w0.xyz);
    r.kind = w0.w;
    uvec4 w1 = fetch_data(at + 1u);
    r.direction = uintBitsToFloat(w1.xyz);
    r.attenuation = w1.w;
    uvec4 w2 = fetch_data(at + 2u);
    r.intensity = uintBitsToFloat(w2.xyz);
    r.cos_outer = uintBitsToFloat(w2.w);
    uvec4 w3 = fetch_data(at + 3u);
    r.c = uintBitsToFloat(w3.xyz);
    r.cos_inner = uintBitsToFloat(w3.w);
    uvec4 w4 = fetch_data(at + 4u);
    r.flaps_min = uintBitsToFloat(w4.xyz);
    r.exponent = uintBitsToFloat(w4.w);
    uvec4 w5 = fetch_data(at + 5u);
    r.flaps_max = uintBitsToFloat(w5.xyz);
    r.casts_shadow = w5.w;
    uvec4 w6 = fetch_data(at + 6u);
    r.slide = w6.x;
    r.table = w6.y;
    r.pad0 = w6.z;
    r.pad1 = w6.w;
    return r;
}
#endif

#endif
