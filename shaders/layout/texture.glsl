// Textures.
#ifndef LAYOUT_TEXTURE_GLSL
#define LAYOUT_TEXTURE_GLSL

// One u32 a texel, 8 bits a channel (R lowest), colour channels sRGB-encoded.
const uint TEXEL_SRGB8 = 0u;
// One u32 a texel, 8 bits a channel, linear.
const uint TEXEL_LINEAR8 = 1u;
// Four f32 a texel, linear.
const uint TEXEL_FLOAT = 2u;
// No image: `PATTERN_WORDS` f32 in the texel array say which colours, octaves and so on (`shading/pattern`).
const uint PATTERN_CHECKER = 3u;
const uint PATTERN_NOISE = 4u;
const uint PATTERN_GRADIENT = 5u;
const uint PATTERN_ZONE_PLATE = 6u;

const uint WRAP_REPEAT = 0u;
const uint WRAP_CLAMP = 1u;
const uint WRAP_MIRROR = 2u;

const uint MAGNIFY_NEAREST = 0u;
const uint MAGNIFY_BILINEAR = 1u;

// What of a material a texture varies. It multiplies the constant; a normal or bump map turns the normal instead.
const uint PARAMETER_COLOR = 0u;
const uint PARAMETER_SPECULAR_COLOR = 1u;
const uint PARAMETER_EMISSION = 2u;
const uint PARAMETER_ROUGHNESS = 3u;
const uint PARAMETER_ROUGHNESS_U = 4u;
const uint PARAMETER_ROUGHNESS_V = 5u;
const uint PARAMETER_METALLIC = 6u;
const uint PARAMETER_OPACITY = 7u;
// Opacity 0 below `scale` and 1 from there on, instead of a factor.
const uint PARAMETER_MASK = 8u;
const uint PARAMETER_WEIGHT = 9u;
const uint PARAMETER_NORMAL = 10u;
const uint PARAMETER_BUMP = 11u;
// Of a principled material.
const uint PARAMETER_ANISOTROPIC = 12u;
const uint PARAMETER_SPEC_TRANS = 13u;
const uint PARAMETER_SPEC_TINT = 14u;
const uint PARAMETER_SHEEN = 15u;
const uint PARAMETER_SHEEN_TINT = 16u;
const uint PARAMETER_FLATNESS = 17u;
const uint PARAMETER_CLEARCOAT = 18u;
const uint PARAMETER_CLEARCOAT_GLOSS = 19u;

// Which channel of the texel counts; a single one stands for all three.
const uint CHANNEL_R = 0u;
const uint CHANNEL_G = 1u;
const uint CHANNEL_B = 2u;
const uint CHANNEL_A = 3u;
const uint CHANNEL_RGB = 4u;

// Texture records of a material at most; bake refuses more.
const uint TEXTURES_MOST = 16u;

// One texture, or one level of its mip chain: where its texels lie, how they are read, and what a material does with
// them. 80 bytes. v = 0 is the bottom row; texels are stored from the top row down.
struct Texture {
    // In texels, 1 to 65,535. Of a pattern: its finest step is taken for 1 / width and 1 / height.
    uint width;
    uint height;
    // First 32-bit word of the image in the texel array.
    uint first_word;
    // `TEXEL_*` or `PATTERN_*`.
    uint format;
    // `WRAP_*`.
    uint wrap_u;
    uint wrap_v;
    // `MAGNIFY_*`.
    uint magnify;
    // Levels of the mip chain, this one included; 0: read at the point alone, whatever the pixel covers.
    uint level_count;
    // uv' = (u scale_u + v shear_u + offset_u, v scale_v + u shear_v + offset_v).
    float scale_u;
    float scale_v;
    float offset_u;
    float offset_v;
    float shear_u;
    float shear_v;
    // Index of the record of level 1; the others follow it.
    uint first_level;
    // `PARAMETER_*` of the material that has this record.
    uint parameter;
    // `CHANNEL_*`.
    uint channel;
    // Factor on what is read; of a normal map its strength, of a bump map the height of 1 in scene units.
    float scale;
    uint pad0;
    uint pad1;
};
const uint TEXTURE_WORDS = 5u;

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
    r.level_count = w1.w;
    uvec4 w2 = fetch_data(at + 2u);
    r.scale_u = uintBitsToFloat(w2.x);
    r.scale_v = uintBitsToFloat(w2.y);
    r.offset_u = uintBitsToFloat(w2.z);
    r.offset_v = uintBitsToFloat(w2.w);
    uvec4 w3 = fetch_data(at + 3u);
    r.shear_u = uintBitsToFloat(w3.x);
    r.shear_v = uintBitsToFloat(w3.y);
    r.first_level = w3.z;
    r.parameter = w3.w;
    uvec4 w4 = fetch_data(at + 4u);
    r.channel = w4.x;
    r.scale = uintBitsToFloat(w4.y);
    r.pad0 = w4.z;
    r.pad1 = w4.w;
    return r;
}
#endif

#endif
