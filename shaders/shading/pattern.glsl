// Patterns: textures without an image, between two colours. Each gives the share of the second colour, 0 to 1.
#ifndef SHADING_PATTERN_GLSL
#define SHADING_PATTERN_GLSL

#include "layout/features.glsl"
#include "layout/records.glsl"
#include "shading/coordinate.glsl"
#include "shading/math.glsl"
#include "shading/sampling.glsl"

// Octaves of noise at most.
const uint OCTAVES_MOST = 16u;
// Farther out than this (2^22) floats have no fraction left to make a pattern of.
const float REACH = 4194304.0;
// Noise along one lattice of unit gradients stays within sqrt(1/2) (Perlin noise in two dimensions).
const float NOISE_NORM = 1.41421354;

// `x`, or 0 where its fraction is lost.
float within_pattern(float x) {
    return abs(x) > REACH ? 0.0 : x;
}

// Mean over `width` around `x` of the square wave that is 1 in the first half of each unit and -1 in the second.
float square_mean(float x, float width) {
    float f = x - floor(x);
    // Distance to the nearest edge, on the side of 1; at most a quarter.
    float inside = f < 0.5 ? 0.25 - abs(f - 0.25) : abs(f - 0.75) - 0.25;
    if (width <= 0.5) {
        float sharp = f < 0.5 ? 1.0 : -1.0;
        // A window narrower than half a unit sees one edge at most.
        float half_width = 0.5 * width;
        return abs(inside) >= half_width ? sharp : div(inside, half_width);
    }
    // The integral of the wave is a triangle between 0 and a half.
    float a = wrap_coordinate(f - 0.5 * width, WRAP_REPEAT);
    float b = wrap_coordinate(f + 0.5 * width, WRAP_REPEAT);
    float below = a < 0.5 ? a : 1.0 - a;
    float above = b < 0.5 ? b : 1.0 - b;
    return div(above - below, width);
}

// Two by two fields a unit; the first colour at the lower left. The mean over a square of `width`.
float checker(vec2 uv, float width) {
    return 0.5 - (0.5 * square_mean(uv.x, width)) * square_mean(uv.y, width);
}

// Gradient noise of one lattice, -1..1: unit gradients at whole coordinates, quintic weights.
// `uv`: within 2^22. Source: Perlin 2002, "Improving Noise", with directions from a hash.
float gradient_noise(vec2 uv, uint seed) {
    float left = floor(uv.x);
    float below = floor(uv.y);
    float x = uv.x - left;
    float y = uv.y - below;
    float weight_x = ((x * x) * x) * (x * (x * 6.0 - 15.0) + 10.0);
    float weight_y = ((y * y) * y) * (y * (y * 6.0 - 15.0) + 10.0);
    float row = 0.0;
    float noise = 0.0;
    for (int corner = 0; corner < 4; corner++) {
        int dx = corner & 1;
        int dy = corner >> 1;
        uint column_hash = hash_combine(seed, uint(int(left) + dx));
        float turn = unit_float(hash_combine(column_hash, uint(int(below) + dy)));
        vec2 direction = vec2(cos_turns(turn), sin_turns(turn));
        float value = dot2(direction, vec2(x - float(dx), y - float(dy)));
        row = dx == 0 ? value : mix_(row, value, weight_x);
        noise = dy == 0 ? row : noise;
    }
    return mix_(noise, row, weight_y) * NOISE_NORM;
}

// Sum of `octaves` of noise, each twice as fine and `gain` as strong as the last, over the sum of their strengths;
// -1..1. Octaves too fine for `width` fade out.
float fractal_noise(vec2 uv, uint octaves, float gain, uint seed, float width) {
    vec2 place = uv;
    float strength = 1.0;
    float covered_width = width;
    float sum = 0.0;
    float total = 0.0;
    uint count = octaves == 0u ? 1u : (octaves < OCTAVES_MOST ? octaves : OCTAVES_MOST);
    for (uint octave = 0u; octave < OCTAVES_MOST; octave++) {
        // From a quarter of the wavelength on, nothing is left at a half (Nyquist's limit).
        float kept = clamp_(2.0 - 4.0 * covered_width, 0.0, 1.0);
        vec2 inside = vec2(within_pattern(place.x), within_pattern(place.y));
        if (kept > 0.0) {
            sum += (strength * kept) * gradient_noise(inside, hash_combine(seed, octave));
        }
        total += strength;
        strength *= gain;
        place = place * 2.0;
        covered_width *= 2.0;
        if (octave + 1u == count) {
            break;
        }
    }
    return div(sum, total);
}

// Rings around the origin, whose frequency at the distance r is r cycles a unit: what a filter lets through is seen at
// one look. Not smoothed: it is there to show aliasing.
float zone_plate(vec2 uv) {
    return 0.5 + 0.5 * cos_turns(0.5 * dot2(uv, uv));
}

// The share of the second colour at the texture's own coordinates `uv` (finite); `width` is covered, in their units.
// `pattern`: `PATTERN_*`. `octaves`, `gain` and `seed` count for noise alone.
float pattern_share(uint pattern, vec2 uv, uint octaves, float gain, uint seed, float width) {
    vec2 place = vec2(within_pattern(uv.x), within_pattern(uv.y));
    if (HAS_FORMAT(PATTERN_CHECKER) && pattern == PATTERN_CHECKER) {
        return checker(place, width);
    }
    if (HAS_FORMAT(PATTERN_NOISE) && pattern == PATTERN_NOISE) {
        return clamp_(0.5 + 0.5 * fractal_noise(place, octaves, gain, seed, width), 0.0, 1.0);
    }
    if (HAS_FORMAT(PATTERN_GRADIENT) && pattern == PATTERN_GRADIENT) {
        return wrap_coordinate(place.x, WRAP_MIRROR);
    }
    // PATTERN_ZONE_PLATE
    return zone_plate(place);
}

#ifdef GONIO_FETCH
// The pattern at the texture's own coordinates `uv` (finite), opaque; `width` is covered, in their units.
vec4 sample_pattern(Texture texture_record, vec2 uv, float width) {
    uint at = texture_record.first_word;
    uint octaves = load_texel(at + 6u);
    float gain = uintBitsToFloat(load_texel(at + 7u));
    uint seed = load_texel(at + 8u);
    float share = pattern_share(texture_record.format, uv, octaves, gain, seed, width);
    vec3 first = vec3(
        uintBitsToFloat(load_texel(at)),
        uintBitsToFloat(load_texel(at + 1u)),
        uintBitsToFloat(load_texel(at + 2u))
    );
    vec3 second = vec3(
        uintBitsToFloat(load_texel(at + 3u)),
        uintBitsToFloat(load_texel(at + 4u)),
        uintBitsToFloat(load_texel(at + 5u))
    );
    vec3 color = mix3_(first, second, share);
    return vec4(color.x, color.y, color.z, 1.0);
}
#endif

#endif
