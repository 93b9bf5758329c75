//! Arguments for comparing twins: random ones in a function's domain, and the edges where devices differ.

use crate::shading::sampling::hash_u32;

/// Words of arguments one evaluation takes, as in `shaders/kernels/parity/harness.glsl`.
pub const ARGUMENTS: usize = 16;

/// What one or more argument words may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Domain {
    /// Any float at all: every bit pattern, NaN and subnormals included. For functions that say what they make of those.
    Bits,
    /// Any float that is not subnormal.
    Normal,
    /// Uniform in min..max; 0, but nothing else smaller than `DUST`.
    Range(f32, f32),
    /// Either sign, magnitude 2^min..2^max with uniform exponent.
    Exponent(i32, i32),
    /// Any integer below this, or any u32 for 0.
    Below(u32),
    /// Three words: a unit vector, to rounding.
    Direction,
    /// Three words: a unit vector with z >= 0, to rounding.
    Upper,
}

impl Domain {
    /// Argument words it fills.
    pub fn words(self) -> usize {
        match self {
            Self::Direction | Self::Upper => 3,
            _ => 1,
        }
    }
}

/// 2^-60. The product of two numbers that are not smaller, and of what they are made into, is far from subnormal.
const DUST: f32 = 8.6736174e-19;
/// The sign bit of a float.
const SIGN: u32 = 0x8000_0000;

/// Floats at which rounding, range checks and special cases change.
const EDGES: [u32; 24] = [
    0x0000_0000, // 0
    0x8000_0000, // -0
    0x3f80_0000, // 1
    0xbf80_0000, // -1
    0x3f7f_ffff, // just below 1
    0x3f80_0001, // just above 1
    0x3f00_0000, // 0.5
    0x0000_0001, // least subnormal
    0x8000_0001, // its negative
    0x007f_ffff, // greatest subnormal
    0x0080_0000, // least normal
    0x8080_0000, // its negative
    0x0d80_0000, // 2^-100
    0x7180_0000, // 2^100
    0x7f7f_ffff, // greatest
    0xff7f_ffff, // its negative
    0x7f80_0000, // infinity
    0xff80_0000, // -infinity
    0x4b80_0000, // 2^24
    0x4f00_0000, // 2^31
    0x3e22_f983, // 1 / 2 pi
    0x4049_0fdb, // pi
    0x33d6_bf95, // 1e-7
    0x7149_f2ca, // 1e30
];

/// Directions that graze, coincide with an axis or nearly do.
const EDGE_DIRECTIONS: [[f32; 3]; 8] = [
    [0.0, 0.0, 1.0],
    [1.0, 0.0, 0.0],
    [0.0, -1.0, 0.0],
    [1.0, 0.0, 1.0e-7],
    [-0.70710677, 0.0, 0.70710677],
    [0.70710677, 0.0, 0.70710677],
    [0.0, 1.0, DUST],
    [0.0006, 0.0, 0.99999982],
];

/// A stream of words, the same on every machine.
struct Words {
    state: u32,
}

impl Words {
    fn next(&mut self) -> u32 {
        self.state = self.state.wrapping_add(0x9e37_79b9);
        hash_u32(self.state)
    }

    fn unit(&mut self) -> f64 {
        f64::from(self.next()) / 4_294_967_296.0
    }
}

fn direction(words: &mut Words, upper: bool) -> [f32; 3] {
    let z = if upper { words.unit() } else { 2.0 * words.unit() - 1.0 };
    let radius = libm::sqrt((1.0 - z * z).max(0.0));
    let angle = core::f64::consts::TAU * words.unit();
    [(radius * libm::cos(angle)) as f32, (radius * libm::sin(angle)) as f32, z as f32]
}

/// The float clamped into a domain's range, for edges; None where the domain takes no such value.
fn edge(domain: Domain, bits: u32) -> Option<u32> {
    let value = f32::from_bits(bits);
    match domain {
        Domain::Bits => Some(bits),
        Domain::Normal => (!value.is_subnormal()).then_some(bits),
        Domain::Range(min, max) => {
            (value >= min && value <= max && (value == 0.0 || value.abs() >= DUST)).then_some(bits)
        }
        Domain::Exponent(min, max) => {
            let exponent = ((bits >> 23) & 0xff) as i32 - 127;
            (exponent >= min && exponent < max).then_some(bits)
        }
        Domain::Below(limit) => Some(if limit == 0 { bits } else { bits % limit }),
        Domain::Direction | Domain::Upper => None,
    }
}

fn random(domain: Domain, words: &mut Words, out: &mut Vec<u32>) {
    match domain {
        Domain::Bits => out.push(words.next()),
        Domain::Normal => {
            let word = words.next();
            out.push(if f32::from_bits(word).is_subnormal() { word & SIGN } else { word });
        }
        Domain::Range(min, max) => {
            out.push(((f64::from(min) + (f64::from(max) - f64::from(min)) * words.unit()) as f32).to_bits());
        }
        Domain::Exponent(min, max) => {
            let exponent = (127 + min + (words.next() % (max - min) as u32) as i32) as u32;
            out.push((words.next() & 0x807f_ffff) | (exponent << 23));
        }
        Domain::Below(limit) => {
            let word = words.next();
            out.push(if limit == 0 { word } else { word % limit });
        }
        Domain::Direction | Domain::Upper => {
            out.extend(direction(words, domain == Domain::Upper).map(f32::to_bits));
        }
    }
}

/// `count` sets of arguments, ARGUMENTS words each. One in eight takes an edge in each place with even odds.
pub fn arguments(domains: &[Domain], count: usize, seed: u32) -> Vec<u32> {
    let mut words = Words { state: hash_u32(seed) };
    let mut all = Vec::with_capacity(count * ARGUMENTS);
    for index in 0..count {
        let start = all.len();
        for &domain in domains {
            let edgy = index % 8 == 0 && words.next() & 1 == 0;
            let pick = words.next() as usize;
            match domain {
                Domain::Direction | Domain::Upper if edgy => {
                    all.extend(EDGE_DIRECTIONS[pick % EDGE_DIRECTIONS.len()].map(f32::to_bits));
                }
                _ => match edge(domain, EDGES[pick % EDGES.len()]).filter(|_| edgy) {
                    Some(bits) => all.push(bits),
                    None => random(domain, &mut words, &mut all),
                },
            }
        }
        debug_assert!(all.len() - start <= ARGUMENTS, "{domains:?} need more than {ARGUMENTS} words");
        all.resize(start + ARGUMENTS, 0);
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn subnormal_numbers_are_for_functions_that_take_any_bits_alone() {
        let domains = [Domain::Bits, Domain::Normal, Domain::Range(-1.0, 1.0), Domain::Exponent(-126, -120)];
        let mut subnormal = [0; 4];
        for set in arguments(&domains, 1 << 16, 1).chunks(ARGUMENTS) {
            for (count, word) in subnormal.iter_mut().zip(set) {
                *count += u32::from(f32::from_bits(*word).is_subnormal());
            }
        }
        assert!(subnormal[0] > 100 && subnormal[1..] == [0; 3], "{subnormal:?}");
    }

    #[test]
    fn arguments_lie_in_their_domain_and_reach_its_edges() {
        let domains = [Domain::Range(0.0, 1.0), Domain::Upper, Domain::Below(7)];
        let all = arguments(&domains, 4096, 1);
        assert_eq!(all.len(), 4096 * ARGUMENTS);
        let mut zero = false;
        for set in all.chunks(ARGUMENTS) {
            let u = f32::from_bits(set[0]);
            let z = f32::from_bits(set[3]);
            assert!((0.0..=1.0).contains(&u) && z >= 0.0 && set[4] < 7, "{set:?}");
            zero |= set[0] == 0;
        }
        assert!(zero, "no edge was taken");
    }
}
