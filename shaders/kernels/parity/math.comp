#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Twins of shading/math; numbers as in `src/verify/twins/math.rs`.
#include "kernels/parity/harness.glsl"
#include "shading/math.glsl"

void main() {
    if (gl_GlobalInvocationID.x >= count) return;
    float a = argument(0u);
    float b = argument(1u);
    vec3 v = argument3(0u);
    switch (function) {
    case 0u: result(0u, rcp(a)); break;
    case 1u: result(0u, div(a, b)); break;
    case 2u: result(0u, rsqrt(a)); break;
    case 3u: result(0u, sqrt_(a)); break;
    case 4u: result(0u, sin_turns(a)); break;
    case 5u: result(0u, cos_turns(a)); break;
    case 6u: result(0u, sin_(a)); break;
    case 7u: result(0u, cos_(a)); break;
    case 8u: result(0u, exp2_(a)); break;
    case 9u: result(0u, exp_(a)); break;
    case 10u: result(0u, log2_(a)); break;
    case 11u: result(0u, log_(a)); break;
    case 12u: result(0u, pow_(a, b)); break;
    case 13u: result(0u, atan2_(a, b)); break;
    case 14u: result(0u, acos_(a)); break;
    case 15u: result(0u, asin_(a)); break;
    case 16u: result_u(0u, uint(exponent_(a))); break;
    case 17u: result(0u, ldexp_(a, int(argument_u(1u)))); break;
    case 18u: result(0u, min_(a, b)); result(1u, max_(a, b)); break;
    case 19u: result(0u, clamp_(a, b, argument(2u))); break;
    case 20u: result(0u, mix_(a, b, argument(2u))); break;
    case 21u: result3(0u, mix3_(v, argument3(3u), argument(6u))); break;
    case 22u: result(0u, dot2(argument2(0u), argument2(2u))); break;
    case 23u: result(0u, dot3(v, argument3(3u))); break;
    case 24u: result3(0u, cross3(v, argument3(3u))); break;
    case 25u: result(0u, max3_(v)); result(1u, min3_(v)); break;
    case 26u: result(0u, length3(v)); break;
    case 27u: result3(0u, normalize3(v)); break;
    }
}
