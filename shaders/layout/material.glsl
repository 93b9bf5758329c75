// Surface materials.
#ifndef LAYOUT_MATERIAL_GLSL
#define LAYOUT_MATERIAL_GLSL

// The order of models here, in `match` and in `switch` is the same everywhere.
const uint MODEL_LAMBERT = 0u;
const uint MODEL_PHONG = 1u;
const uint MODEL_BLINN_PHONG = 2u;
const uint MODEL_COOK_TORRANCE = 3u;
const uint MODEL_MIRROR = 4u;
const uint MODEL_DIELECTRIC = 5u;
// Shown as its base colour, unlit.
const uint MODEL_EMISSIVE = 6u;

// Material flag: the filtered form of non-refractive transparency, I_1 + k_t O_t I_2.
const uint MATERIAL_FILTERED = 1u;
// Material flag: Fresnel by complex index (eta + i k); else by eta alone.
const uint MATERIAL_CONDUCTOR = 2u;
// Material flag: Phong's lobe normalised by (n + 2) / 2 pi (Lafortune and Willems 1994); else as printed.
const uint MATERIAL_LAFORTUNE = 4u;
// Material flag: Cook-Torrance's D as the 1982 paper prints it, four times the normalised one.
const uint MATERIAL_D_1982 = 8u;

// One material. 144 bytes. Colours are linear Rec. 709.
struct Material {
    // O_d; for a mirror its reflectance; multiplied by its textures and the vertex colour.
    vec3 color;
    // `MODEL_*`.
    uint model;
    // O_s; for a dielectric the factor on refracted light.
    vec3 specular_color;
    // Phong's and Blinn's n, >= 0.
    float exponent;
    // Weights of ambient, diffuse, specular and of the mirror branch, each >= 0.
    float k_a;
    float k_d;
    float k_s;
    float k_r;
    // Index of refraction relative to the outside, per channel (a dielectric uses channel 0, at 587.6 nm).
    vec3 eta;
    // Beckmann slope of lobe 0.
    float m0;
    // Extinction coefficient of a conductor, per channel.
    vec3 k;
    float m1;
    // Weights of the two Beckmann lobes; w1 = 0 for a single lobe.
    float w0;
    float w1;
    // k_t of non-refractive transparency, 0 (opaque) to 1.
    float k_t;
    // `MATERIAL_*` bits.
    uint flags;
    // O_t of filtered transparency.
    vec3 transmit_color;
    // Index of the first record in the texture array that belongs to the material.
    uint first_texture;
    // Beer coefficient inside a dielectric, per scene unit.
    vec3 absorption;
    // How many of them there are.
    uint texture_count;
    // Radiance the surface adds by itself (no other surface is lit by it under local and whitted).
    vec3 emission;
    uint pad1;
};
const uint MATERIAL_WORDS = 9u;

#ifdef GONIO_FETCH
Material load_material(uint index) {
    uint at = header.first_material + index * MATERIAL_WORDS;
    Material r;
    uvec4 w0 = fetch_data(at);
    r.color = uintBitsToFloat(w0.xyz);
    r.model = w0.w;
    uvec4 w1 = fetch_data(at + 1u);
    r.specular_color = uintBitsToFloat(w1.xyz);
    r.exponent = uintBitsToFloat(w1.w);
    uvec4 w2 = fetch_data(at + 2u);
    r.k_a = uintBitsToFloat(w2.x);
    r.k_d = uintBitsToFloat(w2.y);
    r.k_s = uintBitsToFloat(w2.z);
    r.k_r = uintBitsToFloat(w2.w);
    uvec4 w3 = fetch_data(at + 3u);
    r.eta = uintBitsToFloat(w3.xyz);
    r.m0 = uintBitsToFloat(w3.w);
    uvec4 w4 = fetch_data(at + 4u);
    r.k = uintBitsToFloat(w4.xyz);
    r.m1 = uintBitsToFloat(w4.w);
    uvec4 w5 = fetch_data(at + 5u);
    r.w0 = uintBitsToFloat(w5.x);
    r.w1 = uintBitsToFloat(w5.y);
    r.k_t = uintBitsToFloat(w5.z);
    r.flags = w5.w;
    uvec4 w6 = fetch_data(at + 6u);
    r.transmit_color = uintBitsToFloat(w6.xyz);
    r.first_texture = w6.w;
    uvec4 w7 = fetch_data(at + 7u);
    r.absorption = uintBitsToFloat(w7.xyz);
    r.texture_count = w7.w;
    uvec4 w8 = fetch_data(at + 8u);
    r.emission = uintBitsToFloat(w8.xyz);
    r.pad1 = w8.w;
    return r;
}
#endif

#endif
