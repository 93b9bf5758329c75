//! The samplers of `shading/sampling`: nets, strata, uniformity, independence, and an implementation with loops.

use glam::Vec2;
use gonio::layout::{SAMPLER_INDEPENDENT, SAMPLER_SOBOL, SAMPLER_STRATIFIED};
use gonio::shading::sampling::*;

const SAMPLERS: [u32; 3] = [SAMPLER_SOBOL, SAMPLER_STRATIFIED, SAMPLER_INDEPENDENT];

fn key(sampling: u32, pixel: u32, sample_index: u32) -> SampleKey {
    SampleKey { sampling, strata: 4, seed: 7, pixel, sample_index, path_id: 3 }
}

/// Chi-square of counts that should be equal, minus degrees of freedom, in standard deviations.
fn deviation(counts: &[u32]) -> f64 {
    let mean = counts.iter().sum::<u32>() as f64 / counts.len() as f64;
    let chi2: f64 = counts.iter().map(|&count| (count as f64 - mean).powi(2) / mean).sum();
    let freedom = (counts.len() - 1) as f64;
    (chi2 - freedom) / (2.0 * freedom).sqrt()
}

/// Counts of `values` in a grid of `side` x `side` cells.
fn grid(values: impl Iterator<Item = (f32, f32)>, side: usize) -> Vec<u32> {
    let mut counts = vec![0; side * side];
    for (x, y) in values {
        counts[(y * side as f32) as usize * side + (x * side as f32) as usize] += 1;
    }
    counts
}

#[test]
fn unit_floats_are_below_one_and_exact() {
    assert_eq!((unit_float(0), unit_float(255), unit_float(256)), (0.0, 0.0, 1.0 / 16777216.0));
    assert_eq!(unit_float(u32::MAX), 1.0 - 1.0 / 16777216.0);
    assert_eq!(unit_float(0x80000000), 0.5);
}

#[test]
fn hashes_have_avalanche() {
    let seeded: fn(u32) -> u32 = |x| hash_combine(x, 12345);
    let valued: fn(u32) -> u32 = |x| hash_combine(12345, x);
    for (hash, inputs) in [(hash_u32 as fn(u32) -> u32, 1 << 16), (seeded, 1 << 14), (valued, 1 << 14)] {
        for bit in 0..32 {
            let mut flips = [0u32; 32];
            for i in 0..inputs {
                let x = (i as u32).wrapping_mul(2654435769);
                let changed = hash(x) ^ hash(x ^ (1 << bit));
                (0..32).for_each(|j| flips[j] += (changed >> j) & 1);
            }
            for (j, &count) in flips.iter().enumerate() {
                let share = count as f64 / inputs as f64;
                let noise = 5.0 * (0.25 / inputs as f64).sqrt();
                assert!((share - 0.5).abs() < 0.01 + noise, "bit {bit} flips bit {j} in {share}");
            }
        }
    }
}

#[test]
fn hash_combine_knows_seed_from_value() {
    for (a, b) in [(0, 1), (1, 2), (17, 4), (0, 0x7f4a7c15)] {
        assert_ne!(hash_combine(a, b), hash_combine(b, a));
    }
    assert_ne!(hash_combine(0, 0), 0);
}

#[test]
fn every_aligned_block_of_sobol_samples_fills_every_elementary_interval() {
    for (pixel, dimension) in [(0, 0), (0, 1), (5, 0), (123_456_789, 77)] {
        for k in 0..=8u32 {
            for block in [0, 1, 2, 3, 1000, (1 << 24 >> k) - 1] {
                let samples: Vec<Vec2> = (block << k..(block + 1) << k)
                    .map(|i| sample_2d(key(SAMPLER_SOBOL, pixel, i), dimension))
                    .collect();
                for x_bits in 0..=k {
                    let mut hit = vec![0u32; 1 << k];
                    for p in &samples {
                        let column = (p.x * (1 << x_bits) as f32) as usize;
                        let row = (p.y * (1 << (k - x_bits)) as f32) as usize;
                        hit[(row << x_bits) + column] += 1;
                    }
                    assert!(hit.iter().all(|&hit| hit == 1), "block {block} of 2^{k}, 2^{x_bits} columns");
                }
            }
        }
    }
}

#[test]
fn every_aligned_block_of_sobol_samples_in_one_dimension_fills_every_cell() {
    for k in 0..=10u32 {
        for block in [0, 1, 6, 999] {
            let mut hit = vec![0u32; 1 << k];
            for i in block << k..(block + 1) << k {
                hit[(sample_1d(key(SAMPLER_SOBOL, 9, i), 4) * (1 << k) as f32) as usize] += 1;
            }
            assert!(hit.iter().all(|&hit| hit == 1), "block {block} of 2^{k}");
        }
    }
}

#[test]
fn every_aligned_block_of_stratified_samples_fills_every_stratum() {
    for strata in [0u32, 1, 2, 3, 4, 5, 7, 16, 31, 255, 1000] {
        let side = strata.clamp(1, 255);
        let count = side * side;
        for block in [0, 1, 5] {
            let (mut flat, mut line) = (vec![0u32; count as usize], vec![0u32; count as usize]);
            for i in block * count..(block + 1) * count {
                let key = SampleKey { strata, ..key(SAMPLER_STRATIFIED, block, i) };
                let p = sample_2d(key, 3);
                let cell = |u: f32, cells: u32| (u as f64 * cells as f64) as u32;
                flat[(cell(p.y, side) * side + cell(p.x, side)) as usize] += 1;
                line[cell(sample_1d(key, 3), count) as usize] += 1;
            }
            assert!(flat.iter().all(|&hit| hit == 1), "{strata} x {strata} strata, block {block}");
            assert!(line.iter().all(|&hit| hit == 1), "{count} strata, block {block}");
        }
    }
}

#[test]
fn samples_lie_in_the_unit_square() {
    for sampling in SAMPLERS {
        for i in 0..20_000 {
            let p = sample_2d(key(sampling, 1, i), 2);
            let u = sample_1d(key(sampling, 1, i), 2);
            assert!([p.x, p.y, u].iter().all(|u| (0.0..1.0).contains(u)));
        }
    }
}

/// Each sample index by itself must be uniform over pixels, paths, dimensions and seeds; otherwise blocks would
/// be stratified but biased.
#[test]
fn each_sample_is_uniform_over_pixels_paths_dimensions_and_seeds() {
    for sampling in SAMPLERS {
        for index in [0, 1, 2, 3, 15, 16, 17, 1_000_003] {
            type Vary = fn(SampleKey, u32) -> (SampleKey, u32);
            let keys: [Vary; 4] = [
                |key, i| (SampleKey { pixel: i, ..key }, 0),
                |key, i| (SampleKey { path_id: i, ..key }, 0),
                |key, i| (key, i),
                |key, i| (SampleKey { seed: i, ..key }, 0),
            ];
            for (what, vary) in keys.iter().enumerate() {
                let each = |i| vary(key(sampling, 5, index), i);
                let flat = (0..16_384).map(&each).map(|(key, dimension)| sample_2d(key, dimension).into());
                let line = (0..16_384).map(&each).map(|(key, dimension)| (sample_1d(key, dimension), 0.0));
                let (flat, line) = (grid(flat, 16), grid(line, 16));
                assert!(deviation(&flat).abs() < 5.0, "sampler {sampling}, index {index}, variation {what}");
                assert!(deviation(&line[..16]).abs() < 5.0, "sampler {sampling}, index {index}, variation {what}");
            }
        }
    }
}

/// Pairs of values that must not know of each other fill a square uniformly.
#[test]
fn samples_of_different_pixels_paths_and_dimensions_are_independent() {
    for sampling in SAMPLERS {
        let here = |i: u32| key(sampling, 100 + (i >> 6), i & 63);
        let others: [fn(SampleKey) -> (SampleKey, u32); 5] = [
            |key| (SampleKey { pixel: key.pixel ^ 65_536, ..key }, 0),
            |key| (SampleKey { path_id: key.path_id + 1, ..key }, 0),
            |key| (key, 1),
            |key| (key, 0x10000),
            |key| (SampleKey { seed: key.seed + 1, ..key }, 0),
        ];
        for (what, other) in others.iter().enumerate() {
            let pair = |i: u32| {
                let (there, dimension) = other(here(i));
                (sample_2d(here(i), 0).x, sample_2d(there, dimension).x)
            };
            let off = deviation(&grid((0..65_536).map(pair), 16));
            assert!(off.abs() < 5.0, "sampler {sampling}, pair {what}: {off} deviations");
            let pair = |i: u32| {
                let (there, dimension) = other(here(i));
                (sample_1d(here(i), 0), sample_2d(there, dimension).y)
            };
            let off = deviation(&grid((0..65_536).map(pair), 16));
            assert!(off.abs() < 5.0, "sampler {sampling}, pair {what}: {off} deviations");
        }
    }
}

/// In which stratum sample i lies says nothing about the stratum of sample j but that it is another one.
#[test]
fn stratified_order_is_a_fair_shuffle() {
    for (i, j) in [(0, 1), (0, 15), (7, 8), (3, 12)] {
        let mut pairs = vec![0u32; 256];
        for pixel in 0..65_536 {
            let stratum = |index| (sample_1d(key(SAMPLER_STRATIFIED, pixel, index), 1) * 16.0) as usize;
            pairs[stratum(i) * 16 + stratum(j)] += 1;
        }
        let (same, different): (Vec<_>, Vec<_>) = (0..256).partition(|cell| cell / 16 == cell % 16);
        assert!(same.iter().all(|&cell: &usize| pairs[cell] == 0));
        let different: Vec<u32> = different.iter().map(|&cell: &usize| pairs[cell]).collect();
        assert!(deviation(&different) < 8.0, "samples {i} and {j}: {}", deviation(&different));
    }
}

#[test]
fn dithering_is_uniform_and_knows_every_part_of_its_key() {
    let base = key(SAMPLER_SOBOL, 1, 0);
    let hash = |key, dimension| unit_float(dither_hash(key, dimension));
    let pairs = (0..65_536)
        .map(|i| (hash(SampleKey { sample_index: i, ..base }, 0), hash(SampleKey { sample_index: i, ..base }, 1)));
    assert!(deviation(&grid(pairs, 16)).abs() < 5.0);
    let against = (0..65_536).map(|i| SampleKey { sampling: SAMPLER_INDEPENDENT, sample_index: i, ..base });
    let against = against.map(|key| (hash(key, 0), sample_1d(key, 0)));
    assert!(deviation(&grid(against, 16)).abs() < 5.0, "correlated with a sample");
    let others = [
        SampleKey { seed: 8, ..base },
        SampleKey { pixel: 2, ..base },
        SampleKey { path_id: 4, ..base },
        SampleKey { sample_index: 1, ..base },
    ];
    for other in others {
        assert_ne!(dither_hash(base, 0), dither_hash(other, 0));
    }
    assert_ne!(dither_hash(base, 0), dither_hash(base, 1));
}

/// Sobol' points by the book: direction numbers, bit by bit, scrambled in the natural order of bits.
mod by_the_book {
    pub fn reversed(x: u32) -> u32 {
        (0..32).fold(0, |sum, bit| sum | ((x >> bit) & 1) << (31 - bit))
    }

    /// Bratley and Fox 1988: the primitive polynomial of the first dimension is 1, of the second x + 1.
    pub fn sobol(index: u32, second: bool) -> u32 {
        let (mut direction, mut point) = (1u32 << 31, 0);
        for bit in 0..32 {
            if (index >> bit) & 1 == 1 {
                point ^= direction;
            }
            direction = if second { direction ^ (direction >> 1) } else { direction >> 1 };
        }
        point
    }

    /// Owen scrambling with the hash of Vegdahl 2021.
    pub fn owen(x: u32, seed: u32) -> u32 {
        let wide = |x: u64| x & 0xffff_ffff;
        let mut x = reversed(x) as u64;
        x ^= wide(x * 0x3d20adea);
        x = wide(x + seed as u64);
        x = wide(x * ((seed as u64 >> 16) | 1));
        x ^= wide(x * 0x05526c56);
        x ^= wide(x * 0x53a22864);
        reversed(x as u32)
    }
}

#[test]
fn sobol_samples_equal_those_of_an_implementation_with_loops() {
    let key_seed = hash_combine(hash_combine(hash_combine(7, 11), 3), 6);
    let (seed_x, seed_y) = (hash_u32(key_seed), hash_u32(hash_u32(key_seed)));
    for i in (0..4096).chain([(1 << 24) - 1, 123_456]) {
        let index = by_the_book::owen(i, key_seed);
        let x = by_the_book::owen(by_the_book::sobol(index, false), seed_x);
        let y = by_the_book::owen(by_the_book::sobol(index, true), seed_y);
        let p = sample_2d(key(SAMPLER_SOBOL, 11, i), 6);
        assert_eq!((p.x, p.y), (unit_float(x), unit_float(y)), "sample {i}");
        assert_eq!(sample_1d(key(SAMPLER_SOBOL, 11, i), 6), unit_float(x), "sample {i}");
    }
}

/// The first values, so that no change goes unnoticed: pictures and their hashes depend on them.
#[test]
fn the_first_values_stay_what_they_are() {
    let bits = |sampling| {
        let p = sample_2d(key(sampling, 0, 0), 0);
        [p.x, p.y, sample_1d(key(sampling, 0, 1), 1)].map(|u| (u * 16777216.0) as u32)
    };
    let got: Vec<[u32; 3]> = SAMPLERS.iter().map(|&sampling| bits(sampling)).collect();
    let want = [[1593857, 8325645, 4759881], [5609551, 7166238, 15599269], [5660989, 11887737, 14707291]];
    assert_eq!(got, want);
    assert_eq!((hash_u32(1), hash_combine(1, 2), dither_hash(key(0, 0, 0), 0)), (114555507, 3470671210, 1243672428));
}
