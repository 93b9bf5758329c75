// Image textures: wrapping, nearest and bilinear reading with exact weights (row 27).
//
// Texel centres are at half-integers; v = 0 is the bottom edge. No mip levels in this version.
#ifndef SHADING_TEXTURE_GLSL
#define SHADING_TEXTURE_GLSL

#include "layout/mod.glsl"
#include "shading/math.glsl"

// The f32 nearest to 1 / 255; 255 times it is exactly 1.
const float INV_255 = 0.003921569;

// `x`, or 0 if it is infinite or not a number. By its bits: no result may depend on comparing a NaN.
float finite_or_zero(float x) {
    return (floatBitsToUint(x) & 0x7f800000u) == 0x7f800000u ? 0.0 : x;
}

// A texture coordinate brought into 0..1, both ends included. `x`: finite. `wrap`: `WRAP_*`.
float wrap_coordinate(float x, uint wrap) {
    switch (wrap) {
    // Subtracting the floor first is exact but for tiny negative x, which become 1.
    case WRAP_REPEAT: return x - floor(x);
    case WRAP_CLAMP: return clamp_(x, 0.0, 1.0);
    // WRAP_MIRROR: period 2, there and back.
    default: {
        float half_x = 0.5 * x;
        float period = 2.0 * (half_x - floor(half_x));
        return period <= 1.0 ? period : 2.0 - period;
    }
    }
}

// Texel index -1..size brought into 0..size-1: round the corner for repeat; at the edge itself for clamp and mirror.
int wrap_texel(int i, int size, uint wrap) {
    if (i < 0) {
        return wrap == WRAP_REPEAT ? size - 1 : 0;
    }
    if (i >= size) {
        return wrap == WRAP_REPEAT ? 0 : size - 1;
    }
    return i;
}

// Channel `shift` / 8 of a packed texel, 0..255.
uint texel_byte(uint word, uint shift) {
    return (word >> shift) & 255u;
}

#ifdef GONIO_FETCH
// One texel, linear. `column` from the left, `row` from the bottom, both inside the image.
vec4 read_texel(Texture texture_record, int column, int row) {
    // Stored from the top row down.
    uint index = (texture_record.height - 1u - uint(row)) * texture_record.width + uint(column);
    switch (texture_record.format) {
    case TEXEL_SRGB8: {
        uint word = load_texel(texture_record.first_word + index);
        // The decoding table is the first of the table array.
        return vec4(
            load_table(texel_byte(word, 0u)),
            load_table(texel_byte(word, 8u)),
            load_table(texel_byte(word, 16u)),
            float(texel_byte(word, 24u)) * INV_255
        );
    }
    case TEXEL_LINEAR8: {
        uint word = load_texel(texture_record.first_word + index);
        return vec4(
            float(texel_byte(word, 0u)) * INV_255,
            float(texel_byte(word, 8u)) * INV_255,
            float(texel_byte(word, 16u)) * INV_255,
            float(texel_byte(word, 24u)) * INV_255
        );
    }
    // TEXEL_FLOAT
    default: {
        uint word = texture_record.first_word + 4u * index;
        return vec4(
            uintBitsToFloat(load_texel(word)),
            uintBitsToFloat(load_texel(word + 1u)),
            uintBitsToFloat(load_texel(word + 2u)),
            uintBitsToFloat(load_texel(word + 3u))
        );
    }
    }
}

// The texture at `uv` (before its own scale and offset), linear; alpha in lane 3. Any uv is safe: a coordinate that is
// infinite or not a number reads as 0.
vec4 sample_texture(Texture texture_record, vec2 uv) {
    float u = wrap_coordinate(finite_or_zero(uv.x * texture_record.scale_u + texture_record.offset_u), texture_record.wrap_u);
    float v = wrap_coordinate(finite_or_zero(uv.y * texture_record.scale_v + texture_record.offset_v), texture_record.wrap_v);
    int width = int(texture_record.width);
    int height = int(texture_record.height);
    // 0..size: at most 65,535, so the conversions below are in range.
    float x = u * float(texture_record.width);
    float y = v * float(texture_record.height);
    if (texture_record.magnify == MAGNIFY_BILINEAR) {
        float left = floor(x - 0.5);
        float below = floor(y - 0.5);
        float weight_x = (x - 0.5) - left;
        float weight_y = (y - 0.5) - below;
        int x0 = wrap_texel(int(left), width, texture_record.wrap_u);
        int x1 = wrap_texel(int(left) + 1, width, texture_record.wrap_u);
        int y0 = wrap_texel(int(below), height, texture_record.wrap_v);
        int y1 = wrap_texel(int(below) + 1, height, texture_record.wrap_v);
        vec4 t00 = read_texel(texture_record, x0, y0);
        vec4 t10 = read_texel(texture_record, x1, y0);
        vec4 t01 = read_texel(texture_record, x0, y1);
        vec4 t11 = read_texel(texture_record, x1, y1);
        // a + (b - a) t leaves equal neighbours exactly as they are.
        vec4 bottom = t00 + (t10 - t00) * weight_x;
        vec4 top = t01 + (t11 - t01) * weight_x;
        return bottom + (top - bottom) * weight_y;
    }
    // MAGNIFY_NEAREST; the far edge itself belongs to the last texel.
    int column = int(floor(x));
    int row = int(floor(y));
    int last_column = column >= width ? width - 1 : column;
    int last_row = row >= height ? height - 1 : row;
    return read_texel(texture_record, last_column, last_row);
}
#endif

#endif
