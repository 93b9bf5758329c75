//! `shading/warp` and `shading/filter`: densities by chi-square, inverses, and how near tables come to their filters.

use std::f64::consts::PI;

use glam::{Vec2, Vec3};
use gonio::bake::filter::{filter_table, filter_value};
use gonio::bake::{SceneArrays, SceneData};
use gonio::layout::{FILTER_BOX, FILTER_KNOTS, FILTER_TABLE, FILTER_TENT, SAMPLER_INDEPENDENT};
use gonio::scene::settings::Filter;
use gonio::shading::filter::{sample_filter, sample_tent};
use gonio::shading::sampling::{SampleKey, sample_2d};
use gonio::shading::warp::*;
use proptest::prelude::*;

/// Random points, then the grid's corners and centre lines, where warps have their seams.
fn points() -> impl Iterator<Item = Vec2> {
    let random = (0..65_536).map(|sample_index| {
        sample_2d(SampleKey { sampling: SAMPLER_INDEPENDENT, sample_index, ..SampleKey::default() }, 0)
    });
    let seams = [0.0, 5.9604645e-8, 0.25, 0.5, 0.75, 0.99999994];
    random.chain(seams.into_iter().flat_map(move |x| seams.map(|y| Vec2::new(x, y))))
}

/// Asserts that pairs, which should be uniform in the unit square, are so by chi-square in 16 x 16 cells.
#[track_caller]
fn assert_uniform(pairs: impl Iterator<Item = (f64, f64)>) {
    let mut counts = [0u32; 256];
    for (x, y) in pairs {
        assert!((-1e-6..=1.000001).contains(&x) && (-1e-6..=1.000001).contains(&y), "({x}, {y})");
        let cell = |u: f64| (u.clamp(0.0, 0.999999) * 16.0) as usize;
        counts[cell(y) * 16 + cell(x)] += 1;
    }
    let mean = counts.iter().sum::<u32>() as f64 / 256.0;
    let chi2: f64 = counts.iter().map(|&count| (count as f64 - mean).powi(2) / mean).sum();
    assert!((chi2 - 255.0).abs() < 5.0 * 510f64.sqrt(), "chi-square {chi2} at 255 degrees of freedom");
}

/// 0..1
fn azimuth(x: f32, y: f32) -> f64 {
    (libm::atan2(y as f64, x as f64) / (2.0 * PI)).rem_euclid(1.0)
}

#[test]
fn disks_are_filled_uniformly() {
    assert_uniform(points().map(square_to_disk).map(|p| (p.as_dvec2().length_squared(), azimuth(p.x, p.y))));
}

#[test]
fn disks_equal_the_paper() {
    // Shirley and Chiu 1997, figure 6, with angles from the x axis.
    for u in points() {
        let (a, b) = (2.0 * u.x as f64 - 1.0, 2.0 * u.y as f64 - 1.0);
        let (radius, eighths) = match (a > -b, a > b) {
            (true, true) => (a, b / a),
            (true, false) => (b, 2.0 - a / b),
            (false, false) => (-a, 4.0 + b / a),
            (false, true) => (-b, 6.0 - a / b),
        };
        let angle = if radius == 0.0 { 0.0 } else { PI / 4.0 * eighths };
        let p = square_to_disk(u).as_dvec2();
        let (x, y) = (radius * libm::cos(angle), radius * libm::sin(angle));
        assert!((p.x - x).abs() < 3e-7 && (p.y - y).abs() < 3e-7, "{u}: {p} instead of ({x}, {y})");
    }
}

/// Asserts unit length and no direction below the horizon if `hemisphere`.
#[track_caller]
fn assert_direction(w: Vec3, hemisphere: bool) {
    assert!((w.as_dvec3().length() - 1.0).abs() < 4e-7, "{w}");
    assert!(!hemisphere || w.z >= 0.0, "{w}");
}

/// The probability of a height of at most z under a density of the cosine, by the midpoint rule.
fn heights_below(z: f64, pdf: impl Fn(f32) -> f32) -> f64 {
    let steps = 512;
    let each = (z + 1.0) / steps as f64;
    (0..steps).map(|i| 2.0 * PI * pdf((-1.0 + (i as f64 + 0.5) * each) as f32) as f64 * each).sum()
}

#[test]
fn cosine_hemispheres_have_the_stated_density() {
    points().for_each(|u| assert_direction(square_to_cosine_hemisphere(u), true));
    let heights = |w: Vec3| heights_below(w.z as f64, cosine_hemisphere_pdf);
    assert_uniform(points().map(square_to_cosine_hemisphere).map(|w| (heights(w), azimuth(w.x, w.y))));
    assert!((heights_below(1.0, cosine_hemisphere_pdf) - 1.0).abs() < 1e-5);
    assert_eq!(cosine_hemisphere_pdf(-0.5), 0.0);
}

#[test]
fn uniform_hemispheres_have_the_stated_density() {
    points().for_each(|u| assert_direction(square_to_uniform_hemisphere(u), true));
    let heights = |w: Vec3| w.z as f64 * 2.0 * PI * uniform_hemisphere_pdf(0.5) as f64;
    assert_uniform(points().map(square_to_uniform_hemisphere).map(|w| (heights(w), azimuth(w.x, w.y))));
    assert_eq!((uniform_hemisphere_pdf(0.0), uniform_hemisphere_pdf(-1.0)), (0.0, 0.0));
}

#[test]
fn uniform_spheres_have_the_stated_density() {
    points().for_each(|u| assert_direction(square_to_uniform_sphere(u), false));
    let heights = |w: Vec3| heights_below(w.z as f64, |_| uniform_sphere_pdf());
    assert_uniform(points().map(square_to_uniform_sphere).map(|w| (heights(w), azimuth(w.x, w.y))));
}

#[test]
fn triangles_are_filled_uniformly() {
    // The classic map's inverse: the square of the height over the first corner, and the place across.
    assert_uniform(points().map(square_to_uniform_triangle).map(|b| {
        assert!(b.x >= 0.0 && b.y >= 0.0 && b.x + b.y < 1.0, "{b}");
        let sum = b.x as f64 + b.y as f64;
        (sum * sum, if sum > 0.0 { b.x as f64 / sum } else { 0.0 })
    }));
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn inverses_lead_back(x in 0f32..1.0, y in 0f32..1.0) {
        let u = Vec2::new(x, y);
        let near = |back: Vec2, bound: f32| (back - u).abs().max_element() < bound;
        prop_assert!(near(disk_to_square(square_to_disk(u)), 1e-6));
        prop_assert!(near(cosine_hemisphere_to_square(square_to_cosine_hemisphere(u)), 1e-6));
        prop_assert!(near(uniform_triangle_to_square(square_to_uniform_triangle(u)), 2e-7));
        let w = square_to_uniform_sphere(u);
        prop_assume!(w.truncate().length() > 0.1);
        prop_assert!(near(uniform_sphere_to_square(w), 1e-6));
    }
}

fn scene(filter: &Filter) -> SceneData {
    let baked = filter_table(filter);
    let mut data = SceneArrays { tables: vec![f32::NAN; 5], ..SceneArrays::default() };
    data.features.filter = baked.kind;
    data.header.filter_radius = baked.radius;
    data.header.filter_norm = baked.norm;
    data.header.filter_table = 5;
    data.tables.extend(baked.table);
    data.into()
}

const FILTERS: [Filter; 11] = [
    Filter::Box { radius: 0.5 },
    Filter::Tent { radius: 1.0 },
    Filter::Gaussian { radius: 2.0, sigma: 0.5 },
    Filter::Gaussian { radius: 1.5, sigma: 0.5 },
    Filter::Gaussian { radius: 1.0, sigma: 5.0 },
    Filter::Mitchell { radius: 2.0, b: 0.33333334, c: 0.33333334 },
    Filter::Mitchell { radius: 2.0, b: 0.0, c: 0.5 },
    Filter::Mitchell { radius: 3.0, b: 1.0, c: 0.0 },
    Filter::BlackmanHarris { radius: 2.0 },
    Filter::Lanczos { radius: 3.0 },
    Filter::Lanczos { radius: 2.0 },
];

/// The largest difference of densities, as a part of the peak, and the area between them.
fn table_error(filter: &Filter) -> (f64, f64) {
    let data = scene(filter);
    let radius = data.header.filter_radius as f64;
    let area: f64 = (0..20_000).map(|i| filter_value(filter, (i as f64 + 0.5) / 20_000.0 * radius)).sum::<f64>()
        * radius
        / 10_000.0;
    let (positions, signs) = data.tables[5..].split_at(FILTER_KNOTS as usize + 1);
    let (mut highest, mut between) = (0f64, 0f64);
    for (ends, &sign) in positions.windows(2).zip(signs) {
        let (low, width) = (ends[0] as f64, ends[1] as f64 - ends[0] as f64);
        let density = sign as f64 * (data.header.filter_norm as f64).sqrt() / (FILTER_KNOTS as f64 * width);
        for i in 0..64 {
            let x = low + width * (i as f64 + 0.5) / 64.0;
            let error = (density - filter_value(filter, x) / area).abs();
            highest = highest.max(error);
            between += error * width / 64.0;
        }
    }
    (highest * area / filter_value(filter, 0.0), between)
}

#[test]
fn tables_come_as_near_to_their_filters_as_stated() {
    for filter in &FILTERS[2..] {
        let (highest, between) = table_error(filter);
        println!("{filter:?}: {highest:.4} of the peak, area {between:.4}");
        let (high_bound, area_bound) = match filter {
            Filter::Gaussian { .. } => (0.075, 0.015),
            Filter::Lanczos { .. } => (0.06, 0.045),
            _ => (0.06, 0.025),
        };
        assert!(highest < high_bound && between < area_bound, "{filter:?}: {highest}, {between}");
    }
}

#[test]
fn tables_are_symmetric_ascending_and_reach_their_radius() {
    for filter in &FILTERS[2..] {
        let baked = filter_table(filter);
        let (positions, signs) = baked.table.split_at(FILTER_KNOTS as usize + 1);
        assert_eq!((baked.kind, signs.len()), (FILTER_TABLE, FILTER_KNOTS as usize));
        assert!(positions.windows(2).all(|ends| ends[0] < ends[1]), "{filter:?}");
        assert!(positions.iter().zip(positions.iter().rev()).all(|(a, b)| *a == -*b), "{filter:?}");
        assert!(signs.iter().zip(signs.iter().rev()).all(|(a, b)| a == b), "{filter:?}");
        assert_eq!(positions[FILTER_KNOTS as usize], baked.radius);
    }
    for (filter, kind) in [(&FILTERS[0], FILTER_BOX), (&FILTERS[1], FILTER_TENT)] {
        let baked = filter_table(filter);
        assert_eq!((baked.kind, baked.norm, baked.table.len()), (kind, 1.0, 0));
    }
}

#[test]
fn negative_lobes_have_negative_signs_and_raise_the_norm() {
    for (filter, norm) in [(&FILTERS[2], 1.0), (&FILTERS[7], 1.0), (&FILTERS[5], 1.1448), (&FILTERS[6], 1.3611)] {
        let baked = filter_table(filter);
        let signs = &baked.table[FILTER_KNOTS as usize + 1..];
        assert!((baked.norm - norm).abs() < 1e-3, "{filter:?}: {}", baked.norm);
        assert_eq!(signs[0], if norm > 1.0 { -1.0 } else { 1.0 }, "{filter:?}");
        assert_eq!(signs[FILTER_KNOTS as usize / 2], 1.0);
    }
}

/// Weighted histograms of a dense grid of samples, and the weights' mean.
#[test]
fn weighted_samples_reproduce_the_filter_in_both_axes() {
    for filter in &FILTERS {
        let data = scene(filter);
        let radius = data.header.filter_radius as f64;
        let (bins, side) = (32usize, 1024);
        let (mut columns, mut rows, mut mean) = (vec![0.0; bins], vec![0.0; bins], 0.0);
        for i in 0..side * side {
            let u = Vec2::new(((i % side) as f32 + 0.5) / side as f32, ((i / side) as f32 + 0.5) / side as f32);
            let sample = sample_filter(&data.view(), u);
            let weight = sample.weight as f64 / (side * side) as f64;
            let bin = |x: f32| ((x as f64 / radius + 1.0) * 0.5 * bins as f64) as usize;
            columns[bin(sample.offset.x)] += weight;
            rows[bin(sample.offset.y)] += weight;
            mean += weight;
        }
        assert!((mean - 1.0).abs() < 1e-6, "{filter:?}: mean weight {mean}");
        let steps = 1000;
        let mass = |bin: usize| {
            let at = |i: usize| -1.0 + 2.0 * (bin as f64 + (i as f64 + 0.5) / steps as f64) / bins as f64;
            (0..steps).map(|i| filter_value(filter, radius * at(i))).sum::<f64>()
        };
        let total: f64 = (0..bins).map(mass).sum();
        for bin in 0..bins {
            let want = mass(bin) / total;
            // A bin may cut an interval, of which each holds 1/256, in two.
            let bound = 0.003;
            assert!((columns[bin] - want).abs() < bound, "{filter:?} column {bin}: {} for {want}", columns[bin]);
            assert!((rows[bin] - want).abs() < bound, "{filter:?} row {bin}: {} for {want}", rows[bin]);
        }
    }
}

#[test]
fn filter_samples_stay_within_the_radius() {
    for filter in &FILTERS {
        let data = scene(filter);
        for u in points() {
            let offset = sample_filter(&data.view(), u).offset;
            assert!(offset.abs().max_element() <= data.header.filter_radius, "{filter:?}: {offset}");
        }
    }
    assert_eq!((sample_tent(0.0), sample_tent(0.5), sample_tent(0.125)), (-1.0, 0.0, -0.5));
}
