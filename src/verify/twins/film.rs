//! Twins of the film's conversions and of sampling, in the order of `shaders/kernels/parity/film.comp`.

use super::{Family, In, Twin};
use crate::layout::FilmSum;
use crate::shading::sampling::{SampleKey, dither_hash, hash_combine, hash_u32, sample_1d, sample_2d, unit_float};
use crate::shading::spectrum::{
    spectrum_flush, spectrum_from_rgb, spectrum_luminance, spectrum_max, spectrum_to_rgb, spectrum_zero,
};
use crate::transport::film::{Fixed, add_fixed, clamp_sample, dither_lane, is_nan, resolve_sample, to_fixed};
use crate::verify::inputs::Domain::{self, Below, Bits, Exponent, Range};

/// sampling, strata, seed, pixel, sample, path id, dimension.
const KEY: [Domain; 7] = [Below(3), Below(20), Below(0), Below(0), Below(1 << 24), Below(0), Below(64)];

fn key(i: &In) -> SampleKey {
    SampleKey { sampling: i.u(0), strata: i.u(1), seed: i.u(2), pixel: i.u(3), sample_index: i.u(4), path_id: i.u(5) }
}

pub const FAMILY: Family = Family {
    kernel: "parity/film",
    twins: &[
        Twin {
            name: "hash_u32",
            domains: &[Below(0)],
            run: |i, o| {
                o.u(hash_u32(i.u(0)));
            },
        },
        Twin {
            name: "hash_combine",
            domains: &[Below(0), Below(0)],
            run: |i, o| {
                o.u(hash_combine(i.u(0), i.u(1)));
            },
        },
        Twin {
            name: "unit_float",
            domains: &[Below(0)],
            run: |i, o| {
                o.f(unit_float(i.u(0)));
            },
        },
        Twin {
            name: "sample_1d",
            domains: &KEY,
            run: |i, o| {
                o.f(sample_1d(key(i), i.u(6)));
            },
        },
        Twin {
            name: "sample_2d",
            domains: &KEY,
            run: |i, o| {
                o.v2(sample_2d(key(i), i.u(6)));
            },
        },
        Twin {
            name: "dither_hash",
            domains: &KEY,
            run: |i, o| {
                o.u(dither_hash(key(i), i.u(6)));
            },
        },
        Twin {
            name: "dither_lane",
            domains: &[Below(0), Below(4)],
            run: |i, o| {
                o.f(dither_lane(i.u(0), i.u(1)));
            },
        },
        Twin {
            name: "to_fixed is_nan",
            domains: &[Bits, Exponent(-40, 40), Range(0.0, 1.0)],
            run: |i, o| {
                let scale = f32::from_bits(i.u(1) & 0x7f80_0000);
                let fixed = to_fixed(i.f(0), scale, i.f(2));
                o.u(fixed.low).u(fixed.high).u(u32::from(is_nan(i.f(0))));
            },
        },
        Twin {
            name: "add_fixed",
            domains: &[Below(0), Below(0), Below(0), Below(0), Below(4)],
            run: |i, o| {
                let mut sum = FilmSum { low: [i.u(0); 4], high: [i.u(1); 4] };
                add_fixed(&mut sum, i.u(4), Fixed { low: i.u(2), high: i.u(3) });
                let lane = i.u(4) as usize;
                o.u(sum.low[lane]).u(sum.high[lane]);
            },
        },
        Twin {
            name: "clamp_sample resolve_sample",
            domains: &[Below(0), Below(0), Below(200)],
            run: |i, o| {
                let any = clamp_sample(Fixed { low: i.u(0), high: i.u(1) });
                // Near the limit.
                let finished = FilmSum { low: [i.u(0); 4], high: [i.u(2).wrapping_sub(100); 4] };
                let mut pixel = FilmSum { low: [i.u(1); 4], high: [i.u(0); 4] };
                let clamped = resolve_sample(&mut pixel, &finished);
                o.u(any.low).u(any.high).u(pixel.low[2]).u(pixel.high[2]).u(clamped);
            },
        },
        Twin {
            name: "spectrum_max spectrum_luminance spectrum_from_rgb",
            domains: &[Exponent(-60, 60); 3],
            run: |i, o| {
                let s = spectrum_from_rgb(i.v3(0));
                o.f(spectrum_max(s)).f(spectrum_luminance(s)).v4(s);
            },
        },
        Twin {
            name: "spectrum_flush spectrum_to_rgb spectrum_zero",
            domains: &[Bits; 4],
            run: |i, o| {
                let s = spectrum_flush(i.v4(0));
                o.v4(s).v3(spectrum_to_rgb(s) + spectrum_to_rgb(spectrum_zero()));
            },
        },
    ],
};
