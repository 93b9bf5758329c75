// Texture coordinates: from the surface's to the texture's own (scaled, turned and moved), and round its edges.
#ifndef SHADING_COORDINATE_GLSL
#define SHADING_COORDINATE_GLSL

#include "layout/records.glsl"
#include "shading/math.glsl"

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

// The texture's own coordinates at the surface's `uv`, finite whatever `uv` is: 0 for what is not.
vec2 texture_uv(Texture texture_record, vec2 uv) {
    return vec2(
        finite_or_zero((uv.x * texture_record.scale_u + uv.y * texture_record.shear_u) + texture_record.offset_u),
        finite_or_zero((uv.y * texture_record.scale_v + uv.x * texture_record.shear_v) + texture_record.offset_v)
    );
}

// A difference of the surface's uvs as one of the texture's own coordinates.
vec2 texture_vector(Texture texture_record, vec2 uv) {
    return vec2(
        uv.x * texture_record.scale_u + uv.y * texture_record.shear_u,
        uv.y * texture_record.scale_v + uv.x * texture_record.shear_v
    );
}

#endif
