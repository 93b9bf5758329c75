// From radiance to the film's integers, whose sums do not care about order (strict rule 8).
#ifndef TRANSPORT_FILM_GLSL
#define TRANSPORT_FILM_GLSL

#include "shading/sampling.glsl"

// Scale of the sums that have no unit: alpha, normal, albedo; 2^`FRACTION_BITS`.
const float AOV_SCALE = 4194304.0;
// One contribution is clamped to +-2^39 fixed-point units, twice what a sample may hold.
const float FIXED_LIMIT = 549755813888.0;
// A sample's sum is clamped to +-2^38 units: 2^C with C = 16, times 2^k with k = 22. High word of that limit.
const uint SAMPLE_LIMIT_HIGH = 64u;
// Below this a contribution is nothing; above it no step of the conversion meets a subnormal.
const float VALUE_MIN = 1.0e-30;

// A signed 64-bit integer in two's complement.
struct Fixed {
    uint low;
    uint high;
};

// Dither of one lane in 0..1, from a contribution's hash.
float dither_lane(uint dither, uint lane) {
    return unit_float(hash_u32(dither + lane * 0x9e3779b9u));
}

// Scale of a lane of the film: `scale` for light, 2^22 for alpha, which has no unit.
float lane_scale(float scale, uint lane) {
    return lane == 3u ? AOV_SCALE : scale;
}

// Whether `value` is not a number, told by its bits: no device need keep what compares as such.
bool is_nan(float value) {
    return (floatBitsToUint(value) & 0x7fffffffu) > 0x7f800000u;
}

// floor(value * scale + u) as a 64-bit integer. `scale` is a power of two, u in 0..1 dithers, so that light dimmer
// than one unit is kept on average. Not-a-number gives 0; beyond +-2^39 the value is clamped.
Fixed to_fixed(float value, float scale, float u) {
    if (is_nan(value) || abs(value) < VALUE_MIN) {
        return Fixed(0u, 0u);
    }
    float scaled = value * scale;
    float bounded = scaled > FIXED_LIMIT ? FIXED_LIMIT : scaled < -FIXED_LIMIT ? -FIXED_LIMIT : scaled;
    float units = floor(bounded + u);
    float magnitude = abs(units);
    // Two parts below 2^24, so that each conversion is exact on every device.
    float upper = floor(magnitude * 5.9604645e-8);
    float lower = magnitude - upper * 16777216.0;
    uint upper_bits = uint(upper);
    uint low = (upper_bits << 24) | uint(lower);
    uint high = upper_bits >> 8;
    if (units < 0.0) {
        // Two's complement.
        uint negated = ~low + 1u;
        uint carry = negated == 0u ? 1u : 0u;
        return Fixed(negated, ~high + carry);
    }
    return Fixed(low, high);
}

// Adds to one lane of a sum, with carry.
void add_fixed(inout FilmSum sum, uint lane, Fixed value) {
    uint before = sum.low[lane];
    sum.low[lane] = before + value.low;
    uint carry = sum.low[lane] < before ? 1u : 0u;
    sum.high[lane] = sum.high[lane] + value.high + carry;
}

// A sample's lane as its pixel takes it: clamped to +-2^38 units.
Fixed clamp_sample(Fixed units) {
    bool negative = (units.high & 0x80000000u) != 0u;
    if (!negative && units.high >= SAMPLE_LIMIT_HIGH && (units.high > SAMPLE_LIMIT_HIGH || units.low > 0u)) {
        return Fixed(0u, SAMPLE_LIMIT_HIGH);
    }
    // -2^38 has the high word 2^32 - 64 and the low word 0.
    if (negative && units.high < 0xffffffc0u) {
        return Fixed(0u, 0xffffffc0u);
    }
    return units;
}

// Adds the sum of a finished sample to that of its pixel; the result is 1 if a lane of it was clamped, else 0.
uint resolve_sample(inout FilmSum pixel, FilmSum finished) {
    uint clamped = 0u;
    for (uint lane = 0u; lane < 4u; lane++) {
        Fixed units = Fixed(finished.low[lane], finished.high[lane]);
        Fixed taken = clamp_sample(units);
        add_fixed(pixel, lane, taken);
        if (taken.low != units.low || taken.high != units.high) {
            clamped = 1u;
        }
    }
    return clamped;
}

#endif
