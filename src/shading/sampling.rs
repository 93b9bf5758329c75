//! Sample points as a function of (seed, pixel, path, dimension, sample index) and of nothing else: no running state,
//! so any sample can be computed anywhere, in any order.
//!
//! Every call takes its own `dimension` (any number unique within the path), and dimensions are independent of one
//! another: high-dimensional samples are padded from points in one and two dimensions (Kollig and Keller 2002).

use glam::Vec2;

use crate::layout::{SAMPLER_SOBOL, SAMPLER_STRATIFIED};

/// What a sample depends on besides its dimension.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SampleKey {
    /// `SAMPLER_*`.
    pub sampling: u32,
    /// For the stratified sampler: strata per axis, taken as 1..255.
    pub strata: u32,
    /// Of the whole picture.
    pub seed: u32,
    /// A number unique to the pixel within the full frame.
    pub pixel: u32,
    /// Within the pixel.
    pub sample_index: u32,
    /// Tells branches of one sample apart.
    pub path_id: u32,
}

/// A bijection of 32-bit numbers in which every bit of `x` flips every bit of the result with probability 1/2 within
/// 1 % (form: Wellons 2018, "Prospecting for hash functions"; constants found by his program).
#[inline(always)]
pub fn hash_u32(x: u32) -> u32 {
    let x = (x ^ (x >> 16)).wrapping_mul(0x21f0aaad);
    let x = (x ^ (x >> 15)).wrapping_mul(0xd35a2d97);
    x ^ (x >> 15)
}

/// A hash of two numbers where order matters: for a fixed seed a bijection of `value`, for a fixed value of `seed`.
#[inline(always)]
pub fn hash_combine(seed: u32, value: u32) -> u32 {
    hash_u32(seed.wrapping_mul(0x9e3779b9).wrapping_add(0x7f4a7c15) ^ value)
}

/// The upper 24 bits as a fraction in [0, 1), exactly.
#[inline(always)]
pub fn unit_float(x: u32) -> f32 {
    (x >> 8) as f32 * 5.9604644775390625e-8
}

/// The randomness of one dimension of one path: equal for all samples of a pixel.
#[inline(always)]
fn dimension_seed(key: SampleKey, dimension: u32) -> u32 {
    hash_combine(hash_combine(hash_combine(key.seed, key.pixel), key.path_id), dimension)
}

/// A random permutation of the numbers in which bit i of the result depends on bits 0..i of `x` only: Owen scrambling
/// of a number whose bits are reversed (Laine and Karras 2011; constants: Vegdahl 2021, "Building a better LK hash").
#[inline(always)]
fn scramble_reversed(x: u32, seed: u32) -> u32 {
    let x = x ^ x.wrapping_mul(0x3d20adea);
    let x = x.wrapping_add(seed).wrapping_mul((seed >> 16) | 1);
    let x = x ^ x.wrapping_mul(0x05526c56);
    x ^ x.wrapping_mul(0x53a22864)
}

/// The second dimension of the Sobol' sequence with its bits reversed: `x` times Pascal's triangle modulo 2, as a
/// matrix of five Kronecker factors (1 1; 0 1), one step each.
#[inline(always)]
fn sobol_second_reversed(x: u32) -> u32 {
    let x = x ^ ((x >> 1) & 0x55555555);
    let x = x ^ ((x >> 2) & 0x33333333);
    let x = x ^ ((x >> 4) & 0x0f0f0f0f);
    let x = x ^ ((x >> 8) & 0x00ff00ff);
    x ^ (x >> 16)
}

/// The place of a sample in its dimension's order: Owen scrambling of the index keeps aligned blocks of 2^k samples
/// together and makes the orders of two dimensions independent (Burley 2020, "Practical Hash-based Owen Scrambling").
#[inline(always)]
fn shuffled_index(index: u32, seed: u32) -> u32 {
    scramble_reversed(index.reverse_bits(), seed).reverse_bits()
}

/// Numbers 0..count in random order, for index < count <= 65025: a bijection of the smallest range 0..2^k that holds
/// them, repeated until the result is among them (Black and Rogaway 2002, "Ciphers with arbitrary finite domains").
#[inline]
fn permute(index: u32, count: u32, seed: u32) -> u32 {
    let mut mask = count - 1;
    mask |= mask >> 1;
    mask |= mask >> 2;
    mask |= mask >> 4;
    mask |= mask >> 8;
    let shift = (mask.count_ones() + 1) >> 1;
    let mut x = index;
    // Fewer than two steps on average, and never more than `count`: fewer than that many numbers lie outside.
    for _ in 0..count {
        let mut random = seed;
        // Six rounds, the fewest after which even four numbers come in all orders equally often.
        for _ in 0..6 {
            random = hash_u32(random.wrapping_add(0x9e3779b9));
            // Bijections of 0..=mask each: xor, multiplying by an odd number, xor with higher bits, adding.
            x = (x ^ (random >> 16)).wrapping_mul(random | 1) & mask;
            x ^= x >> shift;
            x = x.wrapping_add(random >> 8) & mask;
        }
        if x < count {
            break;
        }
    }
    x
}

/// A multiple of 2^-24 in cell `cell` of `count` equal cells of [0, 1), placed by the random number `random`.
/// Whole numbers throughout, so that no rounding leads out of the cell. cell < count <= 65025.
#[inline]
fn jittered(cell: u32, count: u32, random: u32) -> f32 {
    // low = ceil(cell 2^24 / count), without overflow.
    let width = 16777216 / count;
    let rest = 16777216 - width * count;
    let low = cell * width + (cell * rest + count - 1) / count; // integer
    let high = (cell + 1) * width + ((cell + 1) * rest + count - 1) / count; // integer
    // A fraction below 1 times the size is rounded to less than the size, always.
    let offset = (unit_float(random) * (high - low) as f32) as u32;
    (low + offset) as f32 * 5.9604644775390625e-8
}

/// Strata per axis in use.
#[inline(always)]
fn strata_in_range(strata: u32) -> u32 {
    let low = if strata > 1 { strata } else { 1 };
    if low < 255 { low } else { 255 }
}

/// One number in [0, 1), a multiple of 2^-24.
/// Sobol': every aligned block of 2^k sample indices has one sample in each of 2^k equal cells. Stratified: every
/// aligned block of strata^2 has one in each of strata^2 cells. Independent: nothing.
#[inline]
pub fn sample_1d(key: SampleKey, dimension: u32) -> f32 {
    let seed = dimension_seed(key, dimension);
    if key.sampling == SAMPLER_SOBOL {
        let index = shuffled_index(key.sample_index, seed);
        return unit_float(scramble_reversed(index, hash_u32(seed)).reverse_bits());
    }
    let random = hash_combine(seed, key.sample_index);
    if key.sampling == SAMPLER_STRATIFIED {
        let strata = strata_in_range(key.strata);
        let count = strata * strata;
        let block = key.sample_index / count; // integer
        let cell = permute(key.sample_index - block * count, count, hash_combine(hash_u32(seed), block));
        return jittered(cell, count, random);
    }
    unit_float(random)
}

/// A point in [0, 1)^2 whose coordinates are multiples of 2^-24.
/// Sobol': every aligned block of 2^k sample indices has one sample in each elementary interval of area 2^-k (a
/// (0, 2)-sequence, Owen-scrambled). Stratified: every aligned block of strata^2 has one in each of strata x strata
/// cells. Independent: nothing.
#[inline]
pub fn sample_2d(key: SampleKey, dimension: u32) -> Vec2 {
    let seed = dimension_seed(key, dimension);
    if key.sampling == SAMPLER_SOBOL {
        let index = shuffled_index(key.sample_index, seed);
        let seed_x = hash_u32(seed);
        let seed_y = hash_u32(seed_x);
        let x = scramble_reversed(index, seed_x).reverse_bits();
        let y = scramble_reversed(sobol_second_reversed(index), seed_y).reverse_bits();
        return Vec2::new(unit_float(x), unit_float(y));
    }
    let random_x = hash_combine(seed, key.sample_index);
    let random_y = hash_u32(random_x ^ 0x5bd1e995);
    if key.sampling == SAMPLER_STRATIFIED {
        let strata = strata_in_range(key.strata);
        let count = strata * strata;
        let block = key.sample_index / count; // integer
        let cell = permute(key.sample_index - block * count, count, hash_combine(hash_u32(seed), block));
        let row = cell / strata; // integer
        return Vec2::new(jittered(cell - row * strata, strata, random_x), jittered(row, strata, random_y));
    }
    Vec2::new(unit_float(random_x), unit_float(random_y))
}

/// 32 random bits for the film's dithering, independent of all samples.
#[inline]
pub fn dither_hash(key: SampleKey, dimension: u32) -> u32 {
    hash_combine(dimension_seed(key, dimension) ^ 0xd1774e52, key.sample_index)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn jitter_never_leaves_its_cell() {
        for count in (1..=300).chain([1023, 4096, 65_024, 65_025]) {
            for cell in (0..count).step_by(1 + count as usize / 200).chain([count - 1]) {
                for random in [0, 0x80000000, u32::MAX] {
                    let u = jittered(cell, count, random) as f64 * count as f64;
                    assert_eq!(u.floor(), cell as f64, "{random:#x} in cell {cell} of {count}");
                }
            }
        }
    }

    #[test]
    fn permutations_hit_every_number_once() {
        for count in (1..=70).chain([255, 256, 257, 65_025]) {
            let mut hit = vec![false; count as usize];
            for index in 0..count {
                let place = permute(index, count, count ^ 0x1234567) as usize;
                assert!(!hit[place], "{place} of {count} comes twice");
                hit[place] = true;
            }
        }
    }
}
