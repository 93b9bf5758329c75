#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Shading under local and whitted, for every model.
#include "kernels/shade_main.glsl"
