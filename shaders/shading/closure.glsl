// What a material is at one point: the parameters of its model under their own names, textures applied.
//
// A closure never crosses the bus. What its model does not use means nothing. `build.rs` writes the struct from the Rust.
#ifndef SHADING_CLOSURE_GLSL
#define SHADING_CLOSURE_GLSL

#include "layout/closure.glsl"
#include "layout/features.glsl"
#include "layout/records.glsl"

#ifdef GONIO_FETCH
#include "layout/blocks.glsl"

// The closure of a material's constants, without its textures.
Closure closure_of(Material material) {
    Closure closure = no_closure();
    closure.model = material.model;
    closure.flags = material.flags;
    closure.emission = material.emission;
    closure.k_t = material.k_t;
    closure.transmit_color = material.transmit_color;
    closure.absorption = material.absorption;
    closure.rank = material.rank;
    closure.share = 1.0;
    unpack_block(material.block, closure);
    return closure;
}
#endif

#endif
