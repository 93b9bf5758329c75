#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Shading under direct and path, for every model.
#define ONLY_PATHS
#include "kernels/shade_main.glsl"
