// Image textures.
#ifndef LAYOUT_TEXTURE_GLSL
#define LAYOUT_TEXTURE_GLSL

// One u32 a texel, 8 bits a channel (R lowest), colour channels sRGB-encoded.
const uint TEXEL_SRGB8 = 0u;
// One u32 a texel, 8 bits a channel, linear.
const uint TEXEL_LINEAR8 = 1u;
// Four f32 a texel, linear.
const uint TEXEL_FLOAT = 2u;

const uint WRAP_REPEAT = 0u;
const uint WRAP_CLAMP = 1u;
const uint WRAP_MIRROR = 2u;

const uint MAGNIFY_NEAREST = 0u;
const uint MAGNIFY_BILINEAR = 1u;

// One texture: where its texels lie and how they are read. 48 bytes.
// v = 0 is the bottom row; texels are stored from the top row down.
struct Texture {
    // In texels, 1 to 65,535.
    uint width;
    uint height;
    // First 32-bit word of the image in the texel array.
    uint first_word;
    // `TEXEL_*`.
    uint format;
    // `WRAP_*`.
    uint wrap_u;
    uint wrap_v;
    // `MAGNIFY_*`.
    uint magnify;
    uint pad0;
    // uv' = uv * scale + offset.
    float scale_u;
    float scale_v;
    float offset_u;
    float offset_v;
};
const uint TEXTURE_WORDS = 3u;

#ifdef GONIO_FETCH
Texture load_texture(uint index) {
    uint at = header.first_texture + index * TEXTURE_WORDS;
    Texture r;
    uvec4 w0 = fetch_data(at);
    r.width = w0.x;
    r.height = w0.y;
    r.first_word = w0.z;
    r.format = w0.w;
    uvec4 w1 = fetch_data(at + 1u);
    r.wrap_u = w1.x;
    r.wrap_v = w1.y;
    r.magnify = w1.z;
    r.pad0 = w1.w;
    uvec4 w2 = fetch_data(at + 2u);
    r.scale_u = uintBitsToFloat(w2.x);
    r.scale_v = uintBitsToFloat(w2.y);
    r.offset_u = uintBitsToFloat(w2.z);
    r.offset_v = uintBitsToFloat(w2.w);
    return r;
}
#endif

#endif
