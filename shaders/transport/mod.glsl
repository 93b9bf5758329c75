// From a ray's birth to its sum: pure steps over one path record, scheduled by the kernels.
//
// What a step appends goes through `push_path`, `push_shadow`, `add_contribution`, `count_limited`, `miss_aov`
// and `add_aov` (`kernels/queues.glsl`). Twin: `src/transport/`.
#ifndef TRANSPORT_MOD_GLSL
#define TRANSPORT_MOD_GLSL

// Dimensions of a sample's random numbers: pairs drawn for the named purpose.
const uint DIMENSION_FILTER = 0u;
const uint DIMENSION_LENS = 1u;
const uint DIMENSION_LIGHT_CHOICE = 16u;
const uint DIMENSION_LIGHT = 17u;
const uint DIMENSION_BSDF = 18u;
const uint DIMENSION_LOBE = 19u;
const uint DIMENSION_ROULETTE = 20u;
const uint DIMENSION_PANE = 21u;
const uint DIMENSION_LIGHT_LEAF = 22u;
const uint DIMENSION_LEAF = 32u;
// Dither of contributions: emission and ambient, background, alpha; light i takes `DITHER_LIGHT + i`.
const uint DITHER_SURFACE = 0x10000000u;
const uint DITHER_BACKGROUND = 0x10000001u;
const uint DITHER_LIGHT = 0x20000000u;
// Added to both for each further point at which one hit is shaded.
const uint DITHER_CORNER = 0x04000000u;

// Branches of a path: hashed into the child's path id.
const uint LOBE_THROUGH = 1u;
const uint LOBE_MIRROR = 2u;
const uint LOBE_REFRACT = 3u;
// The one continuation of a traced path.
const uint LOBE_SCATTER = 4u;

#endif
