//! A fractal landscape that needs no file.

use super::height_field::HeightGrid;
use rayon::prelude::*;

/// Heights of fractional Brownian motion, about -1 to 1: octaves of gradient noise (Perlin 1985, with the quintic fade of
/// Perlin 2002 and gradients hashed from the lattice point), each twice as fine and `gain` times as high as the last.
/// `nodes`: along each side, 2 to `SEGMENTS_MAX` + 1; `features`: hills along a side of the first octave;
/// `octaves`: 1 to 16; `gain`: 0 to 1, 0.5 is a mountain range (Musgrave 1989: H = 1).
pub fn fractal_heights(nodes: u32, features: f64, octaves: u32, gain: f64, seed: u32) -> HeightGrid {
    debug_assert!((2..=super::SEGMENTS_MAX + 1).contains(&nodes) && (1..=16).contains(&octaves));
    let step = features / f64::from(nodes - 1);
    let height = |index: u32| {
        let (x, y) = (f64::from(index % nodes) * step, f64::from(index / nodes) * step);
        let (mut sum, mut weight, mut scale) = (0.0, 1.0, 1.0);
        for octave in 0..octaves {
            sum += weight * gradient_noise(x * scale, y * scale, seed.wrapping_add(octave.wrapping_mul(0x9e37_79b9)));
            weight *= gain;
            scale *= 2.0;
        }
        sum as f32
    };
    HeightGrid { columns: nodes, rows: nodes, heights: (0..nodes * nodes).into_par_iter().map(height).collect() }
}

/// About -1 to 1, zero at lattice points.
fn gradient_noise(x: f64, y: f64, seed: u32) -> f64 {
    let (x0, y0) = (libm::floor(x), libm::floor(y));
    let (fx, fy) = (x - x0, y - y0);
    let corner = |i: f64, j: f64| {
        // Lattice coordinates are below 2^28: `features` times 2^15.
        let hash = hash3((x0 + i) as i64 as u32, (y0 + j) as i64 as u32, seed);
        let direction = super::grid::angle_of_turn(f64::from(hash) / 4_294_967_296.0);
        direction.x * (fx - i) + direction.y * (fy - j)
    };
    let fade = |t: f64| t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
    let lerp = |a: f64, b: f64, t: f64| a + (b - a) * t;
    let (u, v) = (fade(fx), fade(fy));
    // Unit gradients reach sqrt(1/2) at most.
    lerp(lerp(corner(0.0, 0.0), corner(1.0, 0.0), u), lerp(corner(0.0, 1.0), corner(1.0, 1.0), u), v)
        * std::f64::consts::SQRT_2
}

/// Avalanche of three words: the finaliser of MurmurHash3 (Appleby 2008) over each in turn.
pub(super) fn hash3(x: u32, y: u32, seed: u32) -> u32 {
    let finalise = |h: u32| {
        let h = (h ^ (h >> 16)).wrapping_mul(0x85eb_ca6b);
        let h = (h ^ (h >> 13)).wrapping_mul(0xc2b2_ae35);
        h ^ (h >> 16)
    };
    finalise(finalise(finalise(seed ^ 0x9e37_79b9) ^ x) ^ y)
}
