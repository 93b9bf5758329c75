//! `shading/math` against the `libm` crate in f64: the stated error bounds over dense samples, and the stated results
//! outside each domain. `GONIO_PRINT_ERRORS=1` prints the largest errors found.

use glam::{Vec2, Vec3};
use gonio::shading::math::*;
use proptest::prelude::*;

/// What no function may turn into NaN.
const WILD: [f32; 17] = [
    0.0,
    -0.0,
    1e-45,
    -1e-45,
    1.1754942e-38,
    f32::MIN_POSITIVE,
    -f32::MIN_POSITIVE,
    7.888608e-31,
    TINY,
    HUGE,
    1.2676508e30,
    -HUGE,
    f32::MAX,
    f32::MIN,
    f32::INFINITY,
    f32::NEG_INFINITY,
    f32::NAN,
];

/// |got - want| in units of the last place that a float near `want` has.
fn ulps(got: f32, want: f64) -> f64 {
    let (_, exponent) = libm::frexp(want);
    (got as f64 - want).abs() / libm::ldexp(1.0, exponent.max(-125) - 24)
}

/// Every `step`-th float from `low` to `high`, both positive, both included.
fn floats(low: f32, high: f32, step: usize) -> impl Iterator<Item = f32> {
    (low.to_bits()..=high.to_bits()).step_by(step).map(f32::from_bits).chain([high])
}

/// `count` + 1 values from `low` to `high`.
fn steps(low: f32, high: f32, count: u32) -> impl Iterator<Item = f32> {
    let (low, size) = (low as f64, high as f64 - low as f64);
    (0..=count).map(move |i| (low + size * i as f64 / count as f64) as f32)
}

/// Asserts that no input has an error above `bound` or NaN.
#[track_caller]
fn assert_within<I: std::fmt::Debug>(bound: f64, inputs: impl Iterator<Item = I>, error: impl Fn(&I) -> f64) {
    let mut worst = (0.0, None);
    for input in inputs {
        let error = error(&input);
        assert!(!error.is_nan(), "not a number at {input:?}");
        if error > worst.0 {
            worst = (error, Some(input));
        }
    }
    let (error, input) = worst;
    let line = std::panic::Location::caller().line();
    if std::env::var_os("GONIO_PRINT_ERRORS").is_some() {
        println!("line {line}: {error:.4e} of {bound:.4e} at {input:?}");
    }
    assert!(error <= bound, "{error:.4e} exceeds {bound:.4e} at {input:?}");
}

#[test]
fn reciprocals_are_within_their_bound() {
    assert_within(0.51, floats(1.0, 2.0, 5), |x| ulps(rcp(*x), 1.0 / *x as f64));
    assert_within(0.51, floats(TINY, HUGE, 1499), |x| ulps(rcp(-*x), -1.0 / *x as f64));
}

#[test]
fn reciprocals_of_three_numbers_are_those_of_each() {
    let bits = |v: [f32; 3]| v.map(f32::to_bits);
    for x in floats(TINY, HUGE, 9973).chain(WILD) {
        let v = Vec3::new(x, -1.5 * x, 3.0 - x);
        assert_eq!(bits(rcp_each(v).to_array()), bits(v.to_array().map(rcp)), "{v}");
    }
}

#[test]
fn quotients_are_within_their_bound() {
    let pairs = floats(1e-18, 1e18, 600_011).flat_map(|a| floats(1e-10, 1e10, 500_057).map(move |b| (a, -b)));
    assert_within(0.51, pairs, |(a, b)| ulps(div(*a, -*b), *a as f64 / -*b as f64));
    let large = floats(1e30, f32::MAX, 1009).map(|a| (a, 1e20));
    assert_within(0.51, large, |(a, b)| ulps(div(*a, *b), *a as f64 / *b as f64));
    let small = floats(TINY, 1e-29, 1009).flat_map(|a| [(a, 0.7), (a, 1e-15), (a, TINY)]);
    let small = small.filter(|(a, b)| *a as f64 / *b as f64 > 8e-31);
    assert_within(0.51, small, |(a, b)| ulps(div(*a, *b), *a as f64 / *b as f64));
}

#[test]
fn quotients_that_are_floats_are_exact() {
    for x in floats(TINY, HUGE, 9973) {
        assert_eq!(div(x, x), 1.0);
    }
    for a in 1..700 {
        for b in 1..700 {
            assert_eq!(div((a * b) as f32, b as f32), a as f32, "{a} {b}");
        }
    }
}

#[test]
fn division_is_defined_for_every_pair_of_floats() {
    for a in WILD {
        for b in WILD {
            assert!(!div(a, b).is_nan(), "{a} / {b}");
            let divisor_outside = !(TINY..=HUGE).contains(&b.abs());
            if divisor_outside || a.is_nan() || a.abs() < TINY {
                assert_eq!(div(a, b), 0.0, "{a} / {b}");
            }
            assert_eq!(rcp(b) == 0.0, divisor_outside, "1 / {b}");
        }
    }
    assert_eq!(div(f32::MAX, -1e-3), f32::NEG_INFINITY);
    assert_eq!(div(1e-20, 1e20), 0.0);
    assert!((div(1e20, 1e-15) - 1e35).abs() < 5e29);
}

#[test]
fn roots_are_within_their_bounds() {
    for (low, high, step) in [(1.0, 4.0, 7), (TINY, HUGE, 1499)] {
        let root = |x: &f32| libm::sqrt(*x as f64);
        assert_within(0.86, floats(low, high, step), |x| ulps(sqrt_(*x), root(x)));
        assert_within(1.25, floats(low, high, step), |x| ulps(rsqrt(*x), 1.0 / root(x)));
    }
    for i in 0..4096 {
        assert_eq!(sqrt_((i * i) as f32), i as f32);
    }
}

#[test]
fn roots_of_everything_else_are_zero() {
    for x in WILD {
        let outside = !(TINY..=HUGE).contains(&x);
        assert_eq!((sqrt_(x) == 0.0, rsqrt(x) == 0.0), (outside, outside), "{x}");
        assert!(!sqrt_(x).is_nan() && !rsqrt(x).is_nan());
    }
}

#[test]
fn sines_are_within_their_bounds() {
    let radians = |x: f32| 2.0 * std::f64::consts::PI * (x as f64 - libm::floor(x as f64));
    for limit in [1.0, 1000.0, 4194304.0] {
        let inputs = || steps(-limit, limit, 500_000);
        assert_within(2e-7, inputs(), |x| (sin_turns(*x) as f64 - libm::sin(radians(*x))).abs());
        assert_within(2e-7, inputs(), |x| (cos_turns(*x) as f64 - libm::cos(radians(*x))).abs());
    }
    for limit in [7.0, 100.0, 8192.0] {
        let inputs = || steps(-limit, limit, 500_000);
        assert_within(5e-7, inputs(), |x| (sin_(*x) as f64 - libm::sin(*x as f64)).abs());
        assert_within(5e-7, inputs(), |x| (cos_(*x) as f64 - libm::cos(*x as f64)).abs());
    }
    // Small angles keep their relative precision.
    assert_within(3.0, floats(1e-30, 0.25, 1999), |x| ulps(sin_turns(*x), libm::sin(radians(*x))));
}

#[test]
fn sines_stay_in_range_and_hit_the_quarters() {
    for x in steps(-2.0, 2.0, 1_000_000) {
        assert!(sin_turns(x).abs() <= 1.0 && cos_turns(x).abs() <= 1.0, "{x}");
        assert!(sin_(x).abs() <= 1.0 && cos_(x).abs() <= 1.0, "{x}");
    }
    let quarters = [(0.0, 1.0), (1.0, 0.0), (0.0, -1.0), (-1.0, 0.0)];
    for i in -40..40 {
        let x = i as f32 * 0.25;
        assert_eq!((sin_turns(x), cos_turns(x)), quarters[(i & 3) as usize], "{x} turns");
    }
    for x in WILD {
        // All of these are tiny or beyond the domain.
        assert!(sin_turns(x).abs() < 1e-29 && cos_turns(x) == 1.0, "{x}");
        assert!(sin_(x).abs() < 1e-29 && cos_(x) == 1.0, "{x}");
    }
}

#[test]
fn exponentials_are_within_their_bounds() {
    for (low, high) in [(-126.0, 126.999), (-1.0, 1.0)] {
        let inputs = steps(low, high, 1_000_000);
        assert_within(1.5, inputs, |x| ulps(exp2_(*x), libm::exp2(*x as f64)));
    }
    for (low, high) in [(-87.33, 88.02), (-1.0, 1.0)] {
        let inputs = steps(low, high, 1_000_000);
        assert_within(2.0, inputs, |x| ulps(exp_(*x), libm::exp(*x as f64)));
    }
    for n in -126..=127 {
        assert_eq!(exp2_(n as f32) as f64, libm::ldexp(1.0, n));
    }
    assert_eq!(exp_(0.0), 1.0);
}

#[test]
fn exponentials_saturate() {
    for x in WILD {
        let want = if x.abs() < 1e-20 {
            1.0
        } else if x > 0.0 {
            LARGEST_POWER
        } else {
            0.0
        };
        assert_eq!((exp2_(x), exp_(x)), (want, want), "{x}");
    }
    assert_eq!((exp2_(-126.00001), exp_(-87.34)), (0.0, 0.0));
}

#[test]
fn logarithms_are_within_their_bounds() {
    for (low, high, step) in [(0.5, 2.0, 13), (f32::MIN_POSITIVE, f32::MAX, 2003)] {
        let inputs = || floats(low, high, step);
        assert_within(2.5, inputs(), |x| ulps(log2_(*x), libm::log2(*x as f64)));
        assert_within(1.5, inputs(), |x| ulps(log_(*x), libm::log(*x as f64)));
    }
    for n in -126..128 {
        assert_eq!(log2_(libm::ldexp(1.0, n) as f32), n as f32);
    }
    assert_eq!(log_(1.0), 0.0);
}

#[test]
fn logarithms_of_everything_else_are_those_of_the_border() {
    for x in WILD {
        if x > 3e38 {
            assert_eq!((log2_(x), log_(x)), (128.0, log_(f32::MAX)), "{x}");
        } else if x <= f32::MIN_POSITIVE {
            assert_eq!((log2_(x), log_(x)), (-126.0, log_(f32::MIN_POSITIVE)), "{x}");
        }
        assert!(log2_(x).abs() <= 128.0 && log_(x).abs() <= 89.0, "{x}");
    }
}

#[test]
fn powers_are_within_their_bound() {
    let pairs = floats(1e-6, 1e3, 70_001)
        .flat_map(|x| floats(0.01, 2000.0, 900_001).map(move |y| (x, y)))
        .filter(|(x, y)| (*y as f64 * libm::log2(*x as f64)).abs() < 125.0);
    assert_within(1.0, pairs, |(x, y)| {
        let want = libm::pow(*x as f64, *y as f64);
        let bound = (*y as f64 * libm::log2(*x as f64)).abs() * 2.5e-7 + 2.4e-7;
        (pow_(*x, *y) as f64 - want).abs() / want / bound
    });
}

#[test]
fn powers_at_the_edges_are_as_stated() {
    for x in WILD.into_iter().chain([0.3, 1.0, 7.0]) {
        assert_eq!(pow_(x, 0.0), 1.0, "{x}");
        for y in [1e-3, 0.5, 1.0, 2.0, 1e3, 1e30] {
            if x < f32::MIN_POSITIVE {
                assert_eq!((pow_(x, y), pow_(x, -y)), (0.0, LARGEST_POWER), "{x} {y}");
            }
            assert!(!pow_(x, y).is_nan() && !pow_(x, -y).is_nan(), "{x} {y}");
        }
    }
    for y in [1e-3, 0.5, 1.0, 2.0, 1e3, 1e30, -3.0] {
        assert_eq!(pow_(1.0, y), 1.0);
    }
    assert_eq!((pow_(2.0, 10.0), pow_(4.0, -0.5), pow_(0.5, 200.0)), (1024.0, 0.5, 0.0));
}

#[test]
fn angles_of_vectors_are_within_their_bound() {
    for size in [2.7e-23, 1.0, 6e29] {
        let circle = steps(-3.2, 3.2, 300_000);
        let circle = circle.map(|angle| (libm::sin(angle as f64), libm::cos(angle as f64)));
        let vectors = circle.map(|(y, x)| ((y * size) as f32, (x * size) as f32));
        // Below TINY the sign of y is lost, and with it the half plane.
        let vectors = vectors.filter(|(y, _)| y.abs() >= TINY);
        assert_within(4e-7, vectors, |(y, x)| (atan2_(*y, *x) as f64 - libm::atan2(*y as f64, *x as f64)).abs());
    }
    assert_eq!((atan2_(0.0, 0.0), atan2_(0.0, 1.0)), (0.0, 0.0));
    assert_eq!((atan2_(1.0, 0.0), atan2_(-1.0, 0.0)), (HALF_PI, -HALF_PI));
    assert_eq!((atan2_(0.0, -1.0), atan2_(-0.0, -1.0)), (PI, PI));
    assert!((atan2_(1.0, 1.0) - QUARTER_PI).abs() < 1e-7);
}

#[test]
fn angles_of_wild_vectors_are_angles() {
    for y in WILD {
        for x in WILD {
            let angle = atan2_(y, x);
            assert!(angle.abs() <= PI, "atan2_({y}, {x}) = {angle}");
            // Neither the sign of zero nor a subnormal decides anything.
            let origin = y.abs() < TINY && x.abs() < TINY;
            assert!(!origin || angle == 0.0, "atan2_({y}, {x}) = {angle}");
        }
    }
}

#[test]
fn arc_cosines_and_sines_are_within_their_bounds() {
    let inputs = || steps(-1.0, 1.0, 1_000_000);
    assert_within(4e-7, inputs(), |x| (acos_(*x) as f64 - libm::acos(*x as f64)).abs());
    assert_within(3e-7, inputs(), |x| (asin_(*x) as f64 - libm::asin(*x as f64)).abs());
    assert_eq!((acos_(1.0), acos_(-1.0), acos_(0.0)), (0.0, PI, HALF_PI));
    assert_eq!((acos_(1.5), acos_(f32::NEG_INFINITY)), (0.0, PI));
    assert_eq!((asin_(2.0), asin_(-2.0), asin_(0.0)), (HALF_PI, -HALF_PI, 0.0));
    for x in WILD {
        assert!((0.0..=PI).contains(&acos_(x)) && asin_(x).abs() <= HALF_PI, "{x}");
    }
}

#[test]
fn exponents_and_scalings_are_exact() {
    for n in -126..=127 {
        let power = libm::ldexp(1.0, n) as f32;
        assert_eq!((exponent_(power), exponent_(-1.75 * power)), (n, n));
        assert_eq!(ldexp_(1.0, n), power);
    }
    assert_eq!((exponent_(0.0), exponent_(1e-40), exponent_(f32::NAN)), (-127, -127, 128));
    assert_eq!((ldexp_(3.0, -1), ldexp_(1.0, 500)), (1.5, LARGEST_POWER));
    assert_eq!(ldexp_(1.0, -500), f32::MIN_POSITIVE);
}

/// Every magnitude that is subnormal in some step of a formula, of both signs: from the least float to above `TINY`.
fn dust() -> impl Iterator<Item = f32> {
    floats(f32::from_bits(1), 2.0 * TINY, 65_521).flat_map(|x| [x, -x])
}

type One = fn(f32) -> f32;
type Two = fn(f32, f32) -> f32;

#[test]
fn no_function_makes_a_subnormal_number_or_tells_one_from_zero() {
    let ones: [(&str, One); 14] = [
        ("rcp", rcp),
        ("rsqrt", rsqrt),
        ("sqrt_", sqrt_),
        ("sin_turns", sin_turns),
        ("cos_turns", cos_turns),
        ("sin_", sin_),
        ("cos_", cos_),
        ("exp2_", exp2_),
        ("exp_", exp_),
        ("log2_", log2_),
        ("log_", log_),
        ("acos_", acos_),
        ("asin_", asin_),
        ("length3", |x| length3(Vec3::new(x, 0.0, 0.0))),
    ];
    for (name, function) in ones {
        for x in dust().chain(WILD) {
            let result = function(x);
            assert!(!result.is_subnormal(), "{name}({x:e}) is {result:e}");
            assert!(!x.is_subnormal() || result == function(0.0), "{name}({x:e}) is {result:e}, not as for 0");
        }
    }
    let twos: [(&str, Two); 3] = [("div", div), ("pow_", pow_), ("atan2_", atan2_)];
    for (name, function) in twos {
        for x in dust().chain(WILD) {
            for other in [1e-38, 1e-20, 0.3, 1.0, 7.0, 1e20, -2.0] {
                for (result, flushed) in
                    [(function(x, other), function(0.0, other)), (function(other, x), function(other, 0.0))]
                {
                    assert!(!result.is_subnormal(), "{name} of {x:e} and {other:e} is {result:e}");
                    assert!(!x.is_subnormal() || result == flushed, "{name} of {x:e} and {other:e} is {result:e}");
                }
            }
        }
    }
    for x in dust().chain(floats(1e-8, 1e8, 99_991)) {
        for n in -160..0 {
            assert!(!ldexp_(x, n).is_subnormal(), "{x:e} 2^{n} is {:e}", ldexp_(x, n));
        }
    }
}

#[test]
fn choices_treat_nan_as_stated() {
    assert_eq!((min_(1.0, 2.0), max_(1.0, 2.0)), (1.0, 2.0));
    assert_eq!((min_(f32::NAN, 2.0), max_(f32::NAN, 2.0)), (2.0, 2.0));
    assert_eq!((clamp_(-1.0, 0.0, 1.0), clamp_(0.5, 0.0, 1.0)), (0.0, 0.5));
    assert_eq!((clamp_(9.0, 0.0, 1.0), clamp_(f32::NAN, 0.25, 1.0)), (1.0, 0.25));
    let v = Vec3::new(-7.0, 3.0, 5.0);
    assert_eq!((max3_(v), max3_(-v), min3_(v), min3_(-v)), (5.0, 7.0, -7.0, -5.0));
}

#[test]
fn mixtures_reach_both_ends() {
    let ends = (mix_(3.0, 0.1, 0.0), mix_(3.0, 0.1, 1.0), mix_(2.0, 4.0, 0.5));
    assert_eq!(ends, (3.0, 0.1, 3.0));
    assert_eq!(mix3_(Vec3::X, Vec3::Y, 0.25), Vec3::new(0.75, 0.25, 0.0));
}

#[test]
fn lengths_and_directions_outside_their_domain_are_zero() {
    let inf = f32::INFINITY;
    for v in [Vec3::ZERO, Vec3::splat(1e-31), Vec3::new(1e31, 0.0, 1.0), Vec3::splat(inf)] {
        assert_eq!((normalize3(v), length3(v)), (Vec3::ZERO, 0.0));
    }
    assert_eq!(normalize3(Vec3::new(TINY, 0.0, 0.0)), Vec3::X);
    assert_eq!(normalize3(Vec3::new(0.0, -HUGE, 1.0)), Vec3::new(0.0, -1.0, TINY));
    assert_eq!(length3(Vec3::new(3.0, 4.0, 12.0)), 13.0);
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn vectors_obey_algebra(
        a in prop::array::uniform3(-4f32..4.0),
        b in prop::array::uniform3(-4f32..4.0),
    ) {
        let (a, b) = (Vec3::from(a), Vec3::from(b));
        let (wide_a, wide_b) = (a.as_dvec3(), b.as_dvec3());
        let flat = wide_a.truncate().dot(wide_b.truncate());
        prop_assert!((dot3(a, b) as f64 - wide_a.dot(wide_b)).abs() < 1e-5);
        prop_assert!((dot2(Vec2::new(a.x, a.y), Vec2::new(b.x, b.y)) as f64 - flat).abs() < 1e-5);
        prop_assert!((cross3(a, b).as_dvec3() - wide_a.cross(wide_b)).length() < 1e-5);
        prop_assert!(ulps(length3(a), wide_a.length()) < 2.5);
    }

    #[test]
    fn directions_are_unit(v in prop::array::uniform3(-1f32..1.0), exponent in -99i32..100) {
        let v = Vec3::from(v) * ldexp_(1.0, exponent);
        prop_assume!(v.abs().max_element() >= TINY);
        let direction = normalize3(v).as_dvec3();
        prop_assert!((direction.length() - 1.0).abs() < 2e-7);
        let exact = v.as_dvec3().normalize();
        prop_assert!((direction - exact).abs().max_element() < 3e-7);
    }
}
