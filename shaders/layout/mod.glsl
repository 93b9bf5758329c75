// Every record that crosses the bus between host and device.
//
// Each file has a twin of the same name in `src/layout/`, with the same struct
// and member names in the same order; buffers use the `scalar` layout. The
// `load_*` functions exist where `kernels/bindings.glsl` has been included.
#ifndef LAYOUT_MOD_GLSL
#define LAYOUT_MOD_GLSL

// "None" wherever a record holds an index.
const uint INVALID = 0xffffffffu;

#include "layout/camera.glsl"
#include "layout/control.glsl"
#include "layout/emitter.glsl"
#include "layout/film.glsl"
#include "layout/geometry.glsl"
#include "layout/header.glsl"
#include "layout/light.glsl"
#include "layout/material.glsl"
#include "layout/path.glsl"
#include "layout/texture.glsl"

#endif
