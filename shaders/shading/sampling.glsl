// Sample points as a function of (seed, pixel, path, dimension, sample index) and of nothing else: no running state,
// so any sample can be computed anywhere, in any order.
//
// Every call takes its own `dimension` (any number unique within the path), and dimensions are independent of one
// another: high-dimensional samples are padded from points in one and two dimensions (Kollig and Keller 2002).
#ifndef SHADING_SAMPLING_GLSL
#define SHADING_SAMPLING_GLSL

#include "layout/records.glsl"

// What a sample depends on besides its dimension.
struct SampleKey {
    // `SAMPLER_*`.
    uint sampling;
    // For the stratified sampler: strata per axis, taken as 1..255.
    uint strata;
    // Of the whole picture.
    uint seed;
    // A number unique to the pixel within the full frame.
    uint pixel;
    // Within the pixel.
    uint sample_index;
    // Tells branches of one sample apart.
    uint path_id;
};

// A bijection of 32-bit numbers in which every bit of `x` flips every bit of the result with probability 1/2 within
// 1 % (form: Wellons 2018, "Prospecting for hash functions"; constants found by his program).
uint hash_u32(uint x) {
    x = (x ^ (x >> 16u)) * 0x21f0aaadu;
    x = (x ^ (x >> 15u)) * 0xd35a2d97u;
    return x ^ (x >> 15u);
}

// A hash of two numbers where order matters: for a fixed seed a bijection of `value`, for a fixed value of `seed`.
uint hash_combine(uint seed, uint value) {
    return hash_u32((seed * 0x9e3779b9u + 0x7f4a7c15u) ^ value);
}

// The upper 24 bits as a fraction in [0, 1), exactly.
float unit_float(uint x) {
    return float(x >> 8u) * 5.9604644775390625e-8;
}

// The randomness of one dimension of one path: equal for all samples of a pixel.
uint dimension_seed(SampleKey key, uint dimension) {
    return hash_combine(hash_combine(hash_combine(key.seed, key.pixel), key.path_id), dimension);
}

// A random permutation of the numbers in which bit i of the result depends on bits 0..i of `x` only: Owen scrambling
// of a number whose bits are reversed (Laine and Karras 2011; constants: Vegdahl 2021, "Building a better LK hash").
uint scramble_reversed(uint x, uint seed) {
    x = x ^ (x * 0x3d20adeau);
    x = (x + seed) * ((seed >> 16u) | 1u);
    x = x ^ (x * 0x05526c56u);
    return x ^ (x * 0x53a22864u);
}

// The second dimension of the Sobol' sequence with its bits reversed: `x` times Pascal's triangle modulo 2, as a
// matrix of five Kronecker factors (1 1; 0 1), one step each.
uint sobol_second_reversed(uint x) {
    x = x ^ ((x >> 1u) & 0x55555555u);
    x = x ^ ((x >> 2u) & 0x33333333u);
    x = x ^ ((x >> 4u) & 0x0f0f0f0fu);
    x = x ^ ((x >> 8u) & 0x00ff00ffu);
    return x ^ (x >> 16u);
}

// The place of a sample in its dimension's order: Owen scrambling of the index keeps aligned blocks of 2^k samples
// together and makes the orders of two dimensions independent (Burley 2020, "Practical Hash-based Owen Scrambling").
uint shuffled_index(uint index, uint seed) {
    return bitfieldReverse(scramble_reversed(bitfieldReverse(index), seed));
}

// Numbers 0..count in random order, for index < count <= 65025: a bijection of the smallest range 0..2^k that holds
// them, repeated until the result is among them (Black and Rogaway 2002, "Ciphers with arbitrary finite domains").
uint permute(uint index, uint count, uint seed) {
    uint mask = count - 1u;
    mask |= mask >> 1u;
    mask |= mask >> 2u;
    mask |= mask >> 4u;
    mask |= mask >> 8u;
    uint shift = (uint(bitCount(mask)) + 1u) >> 1u;
    uint x = index;
    // Fewer than two steps on average, and never more than `count`: fewer than that many numbers lie outside.
    for (uint i = 0u; i < count; ++i) {
        uint random = seed;
        // Six rounds, the fewest after which even four numbers come in all orders equally often.
        for (uint round_ = 0u; round_ < 6u; ++round_) {
            random = hash_u32(random + 0x9e3779b9u);
            // Bijections of 0..=mask each: xor, multiplying by an odd number, xor with higher bits, adding.
            x = ((x ^ (random >> 16u)) * (random | 1u)) & mask;
            x ^= x >> shift;
            x = (x + (random >> 8u)) & mask;
        }
        if (x < count) {
            break;
        }
    }
    return x;
}

// A multiple of 2^-24 in cell `cell` of `count` equal cells of [0, 1), placed by the random number `random`.
// Whole numbers throughout, so that no rounding leads out of the cell. cell < count <= 65025.
float jittered(uint cell, uint count, uint random) {
    // low = ceil(cell 2^24 / count), without overflow.
    uint width = 16777216u / count;
    uint rest = 16777216u - width * count;
    uint low = cell * width + (cell * rest + count - 1u) / count;
    uint high = (cell + 1u) * width + ((cell + 1u) * rest + count - 1u) / count;
    // A fraction below 1 times the size is rounded to less than the size, always.
    uint offset = uint(unit_float(random) * float(high - low));
    return float(low + offset) * 5.9604644775390625e-8;
}

// Strata per axis in use.
uint strata_in_range(uint strata) {
    uint low = strata > 1u ? strata : 1u;
    return low < 255u ? low : 255u;
}

// One number in [0, 1), a multiple of 2^-24.
// Sobol': every aligned block of 2^k sample indices has one sample in each of 2^k equal cells. Stratified: every
// aligned block of strata^2 has one in each of strata^2 cells. Independent: nothing.
float sample_1d(SampleKey key, uint dimension) {
    uint seed = dimension_seed(key, dimension);
    if (key.sampling == SAMPLER_SOBOL) {
        uint index = shuffled_index(key.sample_index, seed);
        return unit_float(bitfieldReverse(scramble_reversed(index, hash_u32(seed))));
    }
    uint random = hash_combine(seed, key.sample_index);
    if (key.sampling == SAMPLER_STRATIFIED) {
        uint strata = strata_in_range(key.strata);
        uint count = strata * strata;
        uint block = key.sample_index / count;
        uint cell = permute(key.sample_index - block * count, count, hash_combine(hash_u32(seed), block));
        return jittered(cell, count, random);
    }
    return unit_float(random);
}

// A point in [0, 1)^2 whose coordinates are multiples of 2^-24.
// Sobol': every aligned block of 2^k sample indices has one sample in each elementary interval of area 2^-k (a
// (0, 2)-sequence, Owen-scrambled). Stratified: every aligned block of strata^2 has one in each of strata x strata
// cells. Independent: nothing.
vec2 sample_2d(SampleKey key, uint dimension) {
    uint seed = dimension_seed(key, dimension);
    if (key.sampling == SAMPLER_SOBOL) {
        uint index = shuffled_index(key.sample_index, seed);
        uint seed_x = hash_u32(seed);
        uint seed_y = hash_u32(seed_x);
        uint x = bitfieldReverse(scramble_reversed(index, seed_x));
        uint y = bitfieldReverse(scramble_reversed(sobol_second_reversed(index), seed_y));
        return vec2(unit_float(x), unit_float(y));
    }
    uint random_x = hash_combine(seed, key.sample_index);
    uint random_y = hash_u32(random_x ^ 0x5bd1e995u);
    if (key.sampling == SAMPLER_STRATIFIED) {
        uint strata = strata_in_range(key.strata);
        uint count = strata * strata;
        uint block = key.sample_index / count;
        uint cell = permute(key.sample_index - block * count, count, hash_combine(hash_u32(seed), block));
        uint row = cell / strata;
        return vec2(jittered(cell - row * strata, strata, random_x), jittered(row, strata, random_y));
    }
    return vec2(unit_float(random_x), unit_float(random_y));
}

// 32 random bits for the film's dithering, independent of all samples.
uint dither_hash(SampleKey key, uint dimension) {
    return hash_combine(dimension_seed(key, dimension) ^ 0xd1774e52u, key.sample_index);
}

#endif
