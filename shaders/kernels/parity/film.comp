#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Twins of the film's conversions and of sampling; numbers as in `src/verify/twins/film.rs`.
#include "kernels/parity/harness.glsl"
#include "layout/records.glsl"
#include "shading/sampling.glsl"
#include "shading/spectrum.glsl"
#include "transport/film.glsl"

void result_fixed(uint k, Fixed units) {
    result_u(k, units.low);
    result_u(k + 1u, units.high);
}

void main() {
    if (gl_GlobalInvocationID.x >= count) return;
    uint a = argument_u(0u);
    uint b = argument_u(1u);
    SampleKey key = SampleKey(a, b, argument_u(2u), argument_u(3u), argument_u(4u), argument_u(5u));
    uint dimension = argument_u(6u);
    FilmSum sum;
    Spectrum s;
    switch (function) {
    case 0u: result_u(0u, hash_u32(a)); break;
    case 1u: result_u(0u, hash_combine(a, b)); break;
    case 2u: result(0u, unit_float(a)); break;
    case 3u: result(0u, sample_1d(key, dimension)); break;
    case 4u: result2(0u, sample_2d(key, dimension)); break;
    case 5u: result_u(0u, dither_hash(key, dimension)); break;
    case 6u: result(0u, dither_lane(a, b)); break;
    case 7u:
        result_fixed(0u, to_fixed(argument(0u), uintBitsToFloat(b & 0x7f800000u), argument(2u)));
        result_u(2u, is_nan(argument(0u)) ? 1u : 0u);
        break;
    case 8u:
        sum.low = uvec4(a);
        sum.high = uvec4(b);
        add_fixed(sum, argument_u(4u), Fixed(argument_u(2u), argument_u(3u)));
        result_u(0u, sum.low[argument_u(4u)]);
        result_u(1u, sum.high[argument_u(4u)]);
        break;
    case 9u:
        result_fixed(0u, clamp_sample(Fixed(a, b)));
        sum = FilmSum(uvec4(b), uvec4(a));
        result_u(4u, resolve_sample(sum, FilmSum(uvec4(a), uvec4(argument_u(2u) - 100u))));
        result_u(2u, sum.low[2]);
        result_u(3u, sum.high[2]);
        break;
    case 10u:
        s = spectrum_from_rgb(argument3(0u));
        result(0u, spectrum_max(s));
        result(1u, spectrum_luminance(s));
        result4(2u, s);
        break;
    case 11u:
        s = spectrum_flush(vec4(argument3(0u), argument(3u)));
        result4(0u, s);
        result3(4u, spectrum_to_rgb(s) + spectrum_to_rgb(spectrum_zero()));
        break;
    }
}
