//! From radiance to the film's integers, whose sums do not care about order (strict rule 8).

use crate::layout::{FRACTION_BITS, FilmSum};
use crate::shading::sampling::{hash_u32, unit_float};

/// Scale of the sums that have no unit: alpha, normal, albedo; 2^`FRACTION_BITS`.
pub const AOV_SCALE: f32 = 4194304.0;
const _: () = assert!(AOV_SCALE == (1 << FRACTION_BITS) as f32);
/// One contribution is clamped to +-2^39 fixed-point units, twice what a sample may hold.
const FIXED_LIMIT: f32 = 549755813888.0;
/// A sample's sum is clamped to +-2^38 units: 2^C with C = 16, times 2^k with k = 22. High word of that limit.
const SAMPLE_LIMIT_HIGH: u32 = 64;
/// Below this a contribution is nothing; above it no step of the conversion meets a subnormal.
const VALUE_MIN: f32 = 1.0e-30;

/// A signed 64-bit integer in two's complement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fixed {
    pub low: u32,
    pub high: u32,
}

/// Dither of one lane in 0..1, from a contribution's hash.
pub fn dither_lane(dither: u32, lane: u32) -> f32 {
    unit_float(hash_u32(dither.wrapping_add(lane.wrapping_mul(0x9e37_79b9))))
}

/// Scale of a lane of the film: `scale` for light, 2^22 for alpha, which has no unit.
pub fn lane_scale(scale: f32, lane: u32) -> f32 {
    if lane == 3 { AOV_SCALE } else { scale }
}

/// Whether `value` is not a number, told by its bits: no device need keep what compares as such.
pub fn is_nan(value: f32) -> bool {
    (value.to_bits() & 0x7fff_ffff) > 0x7f80_0000
}

/// floor(value * scale + u) as a 64-bit integer. `scale` is a power of two, u in 0..1 dithers, so that light dimmer
/// than one unit is kept on average. Not-a-number gives 0; beyond +-2^39 the value is clamped.
pub fn to_fixed(value: f32, scale: f32, u: f32) -> Fixed {
    if is_nan(value) || value.abs() < VALUE_MIN {
        return Fixed { low: 0, high: 0 };
    }
    let scaled = value * scale;
    let bounded = if scaled > FIXED_LIMIT {
        FIXED_LIMIT
    } else if scaled < -FIXED_LIMIT {
        -FIXED_LIMIT
    } else {
        scaled
    };
    let units = (bounded + u).floor();
    let magnitude = units.abs();
    // Two parts below 2^24, so that each conversion is exact on every device.
    let upper = (magnitude * 5.9604645e-8).floor();
    let lower = magnitude - upper * 16777216.0;
    let upper_bits = upper as u32;
    let low = (upper_bits << 24) | (lower as u32);
    let high = upper_bits >> 8;
    if units < 0.0 {
        // Two's complement.
        let negated = (!low).wrapping_add(1);
        let carry = if negated == 0 { 1 } else { 0 };
        return Fixed { low: negated, high: (!high).wrapping_add(carry) };
    }
    Fixed { low, high }
}

/// Adds to one lane of a sum, with carry.
pub fn add_fixed(sum: &mut FilmSum, lane: u32, value: Fixed) {
    let i = lane as usize;
    let before = sum.low[i];
    sum.low[i] = before.wrapping_add(value.low);
    let carry = if sum.low[i] < before { 1 } else { 0 };
    sum.high[i] = sum.high[i].wrapping_add(value.high).wrapping_add(carry);
}

/// A sample's lane as its pixel takes it: clamped to +-2^38 units.
pub fn clamp_sample(units: Fixed) -> Fixed {
    let negative = (units.high & 0x8000_0000) != 0;
    if !negative && units.high >= SAMPLE_LIMIT_HIGH && (units.high > SAMPLE_LIMIT_HIGH || units.low > 0) {
        return Fixed { low: 0, high: SAMPLE_LIMIT_HIGH };
    }
    // -2^38 has the high word 2^32 - 64 and the low word 0.
    if negative && units.high < 0xffff_ffc0 {
        return Fixed { low: 0, high: 0xffff_ffc0 };
    }
    units
}

/// Adds the sum of a finished sample to that of its pixel; the result is 1 if a lane of it was clamped, else 0.
pub fn resolve_sample(pixel: &mut FilmSum, finished: &FilmSum) -> u32 {
    let mut clamped = 0;
    for lane in 0..4 {
        let units = Fixed { low: finished.low[lane as usize], high: finished.high[lane as usize] };
        let taken = clamp_sample(units);
        add_fixed(pixel, lane, taken);
        if taken.low != units.low || taken.high != units.high {
            clamped = 1;
        }
    }
    clamped
}
