//! The film: sums that do not care about order, merging, the hash; `gfilm_file` has the `.gfilm` file.

mod gfilm_file;

use gonio::film::{
    AovSums, Film, FilmSpec, MAX_SAMPLES, MergeError, Rect, SUM_BITS, SampleRanges, sum_lanes, sum_record,
};
use gonio::layout::{AovPixel, FilmSum, INVALID, T_INFINITE};
use gonio::scene::ToneMap;
use proptest::prelude::*;
use std::ops::Range;

const WIDTH: u32 = 3;
const HEIGHT: u32 = 2;
const PIXELS: usize = (WIDTH * HEIGHT) as usize;

fn spec() -> FilmSpec {
    FilmSpec {
        width: 8,
        height: 5,
        crop: Rect { x: 4, y: 1, width: WIDTH, height: HEIGHT },
        unit_exponent: 0,
        seed: 7,
        scene_digest: [3; 32],
        scene_name: "spheres.toml".into(),
        integrator: "whitted".into(),
        version: "0.1.0".into(),
        transparent: false,
        aovs: true,
        tonemap: ToneMap::Reinhard,
        exposure: -0.3,
        gamma: Some(1.8),
    }
}

/// A value that depends on everything: any sample's sum, up to the limits.
fn sample_sum(sample: u32, pixel: usize, lane: usize) -> i64 {
    let bits = blake3::hash(format!("{sample} {pixel} {lane}").as_bytes());
    let bits = i64::from_le_bytes(bits.as_bytes()[..8].try_into().unwrap());
    bits >> (63 - SUM_BITS)
}

/// Adds one sample as a backend does.
fn add_sample(film: &mut Film, sample: u32) {
    let lanes = |pixel: usize, first: usize| sum_record(std::array::from_fn(|i| sample_sum(sample, pixel, first + i)));
    let sums: Vec<FilmSum> = (0..PIXELS).map(|pixel| lanes(pixel, 0)).collect();
    let aovs: Vec<AovPixel> = (0..PIXELS)
        .map(|pixel| AovPixel {
            normal: lanes(pixel, 4),
            albedo: lanes(pixel, 8),
            depth: sample as f32 + 0.5,
            object: pixel as u32,
            material: sample,
            _pad0: 0,
        })
        .collect();
    film.add_sums(film.crop(), &sums);
    film.add_aovs(film.crop(), &aovs, sample == 0);
    film.record(sample..sample + 1, u64::from(sample % 3), u64::from(sample % 2));
}

fn film_of(samples: impl IntoIterator<Item = u32>) -> Film {
    let mut film = Film::new(spec());
    samples.into_iter().for_each(|sample| add_sample(&mut film, sample));
    film
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(64) })]

    #[test]
    fn any_split_of_the_samples_merged_in_any_order_is_the_whole(
        owners in prop::collection::vec(0usize..4, 1..24),
        order in Just([0usize, 1, 2, 3]).prop_shuffle(),
    ) {
        let whole = film_of(0..owners.len() as u32);
        let part = |owner: usize| film_of((0..owners.len() as u32).filter(|s| owners[*s as usize] == owner));
        let mut merged = Film::new(spec());
        for owner in order {
            merged.merge(&part(owner)).unwrap();
        }
        prop_assert_eq!(merged.hash(), whole.hash());
        prop_assert_eq!(&merged, &whole);
    }

    #[test]
    fn sample_ranges_are_the_set_of_what_was_inserted(
        pieces in prop::collection::vec((0u32..200, 0u32..20), 0..20),
    ) {
        let mut ranges = SampleRanges::default();
        let mut set = std::collections::BTreeSet::new();
        for (start, length) in pieces {
            let piece = start..start + length;
            let free = piece.clone().all(|s| !set.contains(&s));
            prop_assert_eq!(ranges.insert(piece.clone()).is_ok(), free);
            if free {
                set.extend(piece);
            }
        }
        prop_assert_eq!(ranges.total(), set.len() as u64);
        prop_assert!((0..220).all(|s| ranges.contains(s) == set.contains(&s)));
        prop_assert!(ranges.as_slice().windows(2).all(|pair| pair[0].end < pair[1].start));
    }

    #[test]
    fn sums_survive_their_two_words(lanes in any::<[i64; 4]>()) {
        prop_assert_eq!(sum_lanes(&sum_record(lanes)), lanes);
    }
}

#[test]
fn tiles_of_a_crop_add_up_to_the_crop() {
    let record = |i: i64| sum_record([i, -i, i << 36, 1]);
    let all: Vec<FilmSum> = (0..PIXELS as i64).map(record).collect();
    let mut whole = Film::new(spec());
    whole.add_sums(whole.crop(), &all);
    let mut tiled = Film::new(spec());
    for y in 0..HEIGHT {
        for (x, width) in [(0, 1), (1, 2)] {
            let first = (y * WIDTH + x) as usize;
            let rect = Rect { x: 4 + x, y: 1 + y, width, height: 1 };
            tiled.add_sums(rect, &all[first..first + width as usize]);
        }
    }
    assert_eq!(tiled.sums(), whole.sums());
    assert_eq!(tiled.sums()[4], [4, -4, 4 << 36, 1]);
}

#[test]
fn a_film_refuses_another_picture_and_names_both_values() {
    type Change = fn(&mut FilmSpec);
    let cases: [(&str, &str, &str, Change); 9] = [
        ("frame", "8x5", "9x5", |s| s.width = 9),
        ("crop", "3x2+4+1", "3x2+4+2", |s| s.crop.y = 2),
        ("seed", "7", "8", |s| s.seed = 8),
        ("integrator", "whitted", "local", |s| s.integrator = "local".into()),
        ("unit", "2^0", "2^-3", |s| s.unit_exponent = -3),
        ("transparency", "false", "true", |s| s.transparent = true),
        ("auxiliary values", "kept", "not kept", |s| s.aovs = false),
        ("scene", "spheres.toml (0303", "spheres.toml (0404", |s| s.scene_digest = [4; 32]),
        // Where the digest follows from another difference, that one is named.
        ("seed", "7", "9", |s| (s.seed, s.scene_digest) = (9, [4; 32])),
    ];
    for (what, left, right, change) in cases {
        let mut other = spec();
        change(&mut other);
        let mut film = film_of(0..2);
        let before = film.clone();
        let error = film.merge(&Film::new(other)).unwrap_err();
        let message = error.to_string();
        let MergeError::Differs { what: named, left: l, right: r } = error else { panic!("{message}") };
        assert_eq!(named, what);
        assert!(l.starts_with(left) && r.starts_with(right), "{message}");
        assert!(message.contains(&l) && message.contains(&r), "{message}");
        assert_eq!(film, before);
    }
}

#[test]
fn names_versions_and_display_do_not_keep_films_apart() {
    let mut other = spec();
    (other.scene_name, other.version) = ("copy.toml".into(), "0.2.0".into());
    (other.tonemap, other.exposure) = (ToneMap::Clamp, 4.0);
    let mut film = film_of(0..2);
    film.merge(&Film::new(other)).unwrap();
    assert_eq!(film, film_of(0..2));
}

#[test]
fn overlapping_samples_are_refused_and_nothing_is_added() {
    let mut film = film_of([0, 1, 2, 5]);
    let before = film.clone();
    let error = film.merge(&film_of([4, 5, 6])).unwrap_err();
    assert_eq!(error.to_string(), "both films hold the samples 5..6 (they hold 0..3, 5..6 and 4..7)");
    assert_eq!(film, before);
}

#[test]
fn more_samples_than_the_sums_can_hold_are_refused() {
    let recorded = |range: Range<u32>| {
        let mut film = Film::new(spec());
        film.record(range, 0, 0);
        film
    };
    let mut film = recorded(0..MAX_SAMPLES - 1);
    film.merge(&recorded(MAX_SAMPLES - 1..MAX_SAMPLES)).unwrap();
    assert_eq!(film.samples().total(), u64::from(MAX_SAMPLES));

    let mut ranges = SampleRanges::new(std::iter::once(0..MAX_SAMPLES)).unwrap();
    let error = ranges.insert(MAX_SAMPLES..MAX_SAMPLES + 1).unwrap_err();
    assert_eq!(error, MergeError::TooMany { total: u64::from(MAX_SAMPLES) + 1 });
}

#[test]
fn the_largest_sums_of_all_samples_do_not_overflow() {
    let largest = i64::from(MAX_SAMPLES) << SUM_BITS;
    let mut film = Film::new(spec());
    for sign in [1, -1] {
        let half = sum_record([sign * largest / 2; 4]);
        film.add_sums(film.crop(), &[half; PIXELS]);
        film.add_sums(film.crop(), &[half; PIXELS]);
        assert_eq!(film.sums()[0], [sign * largest; 4]);
        film.add_sums(film.crop(), &[sum_record([-sign * largest; 4]); PIXELS]);
    }
}

#[test]
fn depth_and_ids_are_those_of_sample_0_or_a_miss() {
    let late = film_of([3, 4]);
    let miss = AovSums {
        normal: late.aovs().unwrap()[1].normal,
        albedo: late.aovs().unwrap()[1].albedo,
        ..AovSums::default()
    };
    assert_eq!(late.aovs().unwrap()[1], miss);
    assert_eq!((miss.depth, miss.object, miss.material), (T_INFINITE, INVALID, INVALID));
    let mut film = late.clone();
    film.merge(&film_of([0])).unwrap();
    let aov = film.aovs().unwrap()[1];
    assert_eq!((aov.depth, aov.object, aov.material), (0.5, 1, 0));
}

#[test]
fn resolve_divides_by_the_samples_and_scales_by_the_unit() {
    let resolved = |exponent: i32, samples: u32, sums: [i64; 4]| {
        let mut film = Film::new(FilmSpec { unit_exponent: exponent, ..spec() });
        film.add_sums(Rect { x: 4, y: 1, width: 1, height: 1 }, &[sum_record(sums)]);
        film.record(0..samples, 0, 0);
        film.resolve().pixels[0]
    };
    let one = 1i64 << 22;
    assert_eq!(resolved(0, 2, [3 * one, -one, 0, 2 * one]), [1.5, -0.5, 0.0, 1.0]);
    assert_eq!(resolved(3, 1, [one, 1, 0, 0]), [8.0, 8.0 / one as f32, 0.0, 0.0]);
    assert_eq!(resolved(-100, 1, [one, 0, 0, 0])[0], f32::from_bits((127 - 100) << 23));
    assert_eq!(resolved(100, 1, [65_536 * one, 0, 0, 0])[0], f32::from_bits((127 + 116) << 23));
    assert_eq!(resolved(0, 3, [one, 2 * one, 0, 0]), [1.0 / 3.0, 2.0 / 3.0, 0.0, 0.0]);
    assert_eq!(resolved(0, 0, [one; 4]), [0.0; 4]);
    // Auxiliary values keep their own scale whatever the unit.
    let mut film = Film::new(FilmSpec { unit_exponent: 5, ..spec() });
    let up = AovPixel { normal: sum_record([0, 2 * one, 0, 0]), depth: 4.0, ..AovPixel::default() };
    film.add_aovs(film.crop(), &[up; PIXELS], true);
    film.record(0..2, 0, 0);
    let aovs = film.resolve_aovs().unwrap();
    assert_eq!((aovs.normal[3], aovs.depth[3]), ([0.0, 1.0, 0.0], 4.0));
}

#[test]
fn the_hash_is_blake3_of_the_documented_bytes() {
    let film = film_of([0, 1, 5]);
    let mut bytes = b"gonio film 1".to_vec();
    [8u32, 5, 4, 1, 3, 2].iter().for_each(|v| bytes.extend(v.to_le_bytes()));
    bytes.extend(0i32.to_le_bytes());
    [2u32, 0, 2, 5, 6].iter().for_each(|v| bytes.extend(v.to_le_bytes()));
    // nan: 0 % 3 + 1 % 3 + 5 % 3; clamped: 0 % 2 + 1 % 2 + 5 % 2
    [3u64, 2].iter().for_each(|v| bytes.extend(v.to_le_bytes()));
    for pixel in 0..PIXELS {
        for lane in 0..4 {
            let sum: i64 = [0, 1, 5].iter().map(|s| sample_sum(*s, pixel, lane)).sum();
            bytes.extend(sum.to_le_bytes());
        }
    }
    assert_eq!(film.hash(), blake3::hash(&bytes));
}

#[test]
fn the_hash_sees_every_sum_count_and_scale_and_nothing_else() {
    let film = film_of(0..2);
    let mut one_more = film.clone();
    let mut unit = [FilmSum::default(); PIXELS];
    unit[PIXELS - 1] = sum_record([0, 0, 0, 1]);
    one_more.add_sums(film.crop(), &unit);
    assert_ne!(one_more.hash(), film.hash());
    let mut counted = film.clone();
    counted.count(1, 0);
    assert_ne!(counted.hash(), film.hash());

    let empty = |change: fn(&mut FilmSpec)| {
        let mut spec = spec();
        change(&mut spec);
        Film::new(spec).hash()
    };
    let plain = empty(|_| {});
    assert_ne!(empty(|s| s.unit_exponent = 1), plain);
    assert_ne!(empty(|s| (s.crop.width, s.crop.height) = (2, 3)), plain);
    assert_ne!(empty(|s| s.crop.x = 0), plain);
    assert_eq!(empty(|s| (s.seed, s.scene_digest, s.exposure, s.aovs) = (1, [0; 32], 1.0, false)), plain);
}
