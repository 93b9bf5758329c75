// What the device keeps for the film.
#ifndef LAYOUT_FILM_GLSL
#define LAYOUT_FILM_GLSL

// Four signed 64-bit fixed-point sums (r, g, b, alpha), each as two u32 (low, high) in two's complement. 32 bytes.
// Kept once per sample slot of a batch and once per pixel of the crop.
struct FilmSum {
    uvec4 low;
    uvec4 high;
};

// Binary digits after the point of a film's sums.
const uint FRACTION_BITS = 22u;

// Auxiliary values of one pixel. 80 bytes.
struct AovPixel {
    // Sums of the first hit's shading normal (world) in lanes 0-2; lane 3 unused. Scale 2^22.
    FilmSum normal;
    // Sums of the first hit's albedo in lanes 0-2; lane 3 unused. Scale 2^22.
    FilmSum albedo;
    // From sample 0: distance along the camera ray (`T_INFINITE` on a miss), object, material (`INVALID` on a miss).
    float depth;
    uint object;
    uint material;
    uint pad0;
};

#endif
