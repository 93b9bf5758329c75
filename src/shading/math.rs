//! Division, roots and the elementary functions from `+ - *` and bit operations alone.
//!
//! Vulkan rounds `+ - *` and conversions correctly and promises little about the rest, so the rest is here, once a
//! language (ARCHITECTURE.md, "Strict arithmetic"). The functions are total: outside its domain each returns the stated
//! value, and none makes a NaN. Errors are bounds over the whole domain, in ULP of the true result or as stated,
//! proved by `tests/math.rs`.
//!
//! Devices may flush subnormal numbers to zero, also those inside a formula. Division and roots therefore work on
//! magnitudes from `TINY` to `HUGE` only, where none occurs; sines take what is smaller than `TINY` for zero, and no
//! function of this file makes a subnormal but sums, products and choices, which give what they are given.

use glam::{Vec2, Vec3};
use wide::{f32x4, u32x4};

pub const PI: f32 = 3.14159274;
pub const TWO_PI: f32 = 6.28318548;
pub const HALF_PI: f32 = 1.57079637;
pub const QUARTER_PI: f32 = 0.785398185;
pub const INV_PI: f32 = 0.318309873;
pub const INV_TWO_PI: f32 = 0.159154937;
pub const INV_FOUR_PI: f32 = 0.0795774683;
pub const LOG2_E: f32 = 1.44269502;
/// 2^-100. Division and roots take anything smaller for zero.
pub const TINY: f32 = 7.88860905e-31;
/// 2^100. Division and roots refuse anything larger.
pub const HUGE: f32 = 1.2676506e30;
/// 2^127, where exponentials stop growing.
pub const LARGEST_POWER: f32 = 1.70141183e38;

/// The smaller; b if either is NaN.
#[inline(always)]
pub fn min_(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

/// The larger; b if either is NaN.
#[inline(always)]
pub fn max_(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// x limited to low..high; low if x is NaN.
#[inline(always)]
pub fn clamp_(x: f32, low: f32, high: f32) -> f32 {
    min_(max_(x, low), high)
}

/// The first 12 significant bits of x; products of two such numbers are exact.
#[inline(always)]
fn leading(x: f32) -> f32 {
    f32::from_bits(x.to_bits() & 0xfffff000)
}

/// 1 / x to 2.4e-6, a little too small, for |x| in TINY..HUGE.
/// A start from the bits (Blinn 1997, "Floating-point tricks"; 5 %), then two Newton steps, the first with its
/// constant shifted so that the error has both signs.
#[inline(always)]
fn rcp_start(x: f32) -> f32 {
    let y = f32::from_bits(0x7ef22b00u32.wrapping_sub(x.to_bits()));
    let y = y * (2.0015 - x * y);
    y * (2.0 - x * y)
}

/// 1 / x within 0.51 ULP for |x| in TINY..HUGE; else 0.
#[inline(always)]
pub fn rcp(x: f32) -> f32 {
    let y = rcp_start(x);
    // The residual 1 - x y_high without rounding error: products of halves are exact.
    let y_high = leading(y);
    let x_high = leading(x);
    let residual = (1.0 - y_high * x_high) - y_high * (x - x_high);
    let refined = y_high + residual * y;
    if x.abs() >= TINY && x.abs() <= HUGE { refined } else { 0.0 }
}

/// `rcp` of each component, all at a time. Rust only: devices have lanes enough.
#[inline(always)]
pub fn rcp_each(v: Vec3) -> Vec3 {
    let splat = f32x4::splat;
    let high = |x: f32x4| x & splat(f32::from_bits(0xfffff000));
    let x = f32x4::new([v.x, v.y, v.z, 1.0]);
    let y: f32x4 = bytemuck::cast(u32x4::splat(0x7ef22b00) - bytemuck::cast::<_, u32x4>(x));
    let y = y * (splat(2.0015) - x * y);
    let y = y * (splat(2.0) - x * y);
    let (y_high, x_high) = (high(y), high(x));
    let residual = (splat(1.0) - y_high * x_high) - y_high * (x - x_high);
    let refined = y_high + residual * y;
    let size = x.abs();
    let [x, y, z, _] = (refined & size.simd_ge(splat(TINY)) & size.simd_le(splat(HUGE))).to_array();
    Vec3::new(x, y, z)
}

/// a / b within 0.51 ULP for |b| in TINY..HUGE; exact where the quotient is a float.
/// 0 if |b| is outside TINY..HUGE, or |a| or the quotient below TINY; quotients above HUGE are within 5e-6, and +-infinity on overflow.
#[inline]
pub fn div(a: f32, b: f32) -> f32 {
    let y = rcp_start(b);
    let quotient = a * y;
    // The residual a - b q_high without rounding error, as in `rcp`.
    let q_high = leading(quotient);
    let b_high = leading(b);
    let residual = (a - q_high * b_high) - q_high * (b - b_high);
    let refined = q_high + residual * y;
    let valid = b.abs() >= TINY && b.abs() <= HUGE && a.abs() >= TINY && quotient.abs() >= TINY;
    let result = if quotient.abs() <= HUGE { refined } else { quotient };
    if valid { result } else { 0.0 }
}

/// 1 / sqrt(x) to 1.7e-6, a little too small, for x in TINY..HUGE.
/// A start from the bits (Lomont 2003, "Fast inverse square root"; 3.5 %), then two Newton steps as in `rcp_start`.
#[inline(always)]
fn rsqrt_start(x: f32) -> f32 {
    let h = 0.5 * x;
    let y = f32::from_bits(0x5f36da00u32.wrapping_sub(x.to_bits() >> 1));
    let y = y * (1.501 - (h * y) * y);
    y * (1.5 - (h * y) * y)
}

/// 1 / sqrt(x) within 1.25 ULP for x in TINY..HUGE; else 0.
#[inline]
pub fn rsqrt(x: f32) -> f32 {
    let y = rsqrt_start(x);
    let refined = y + y * (0.5 - (0.5 * x) * (y * y));
    if x >= TINY && x <= HUGE { refined } else { 0.0 }
}

/// sqrt(x) within 0.86 ULP for x in TINY..HUGE, exact for squares of whole numbers below 4096; else 0.
#[inline]
pub fn sqrt_(x: f32) -> f32 {
    let y = rsqrt_start(x);
    let root = x * y;
    let refined = root + (x - root * root) * (0.5 * y);
    if x >= TINY && x <= HUGE { refined } else { 0.0 }
}

/// sin(2 pi u) for |u| <= 0.25: minimax polynomial of degree 9, relative error 2.9e-8 before rounding; at most 1.
#[inline(always)]
fn sin_quarter(u: f32) -> f32 {
    let z = u * u;
    let sine = u * (6.28318548 + z * (-41.3417664 + z * (81.6086349 + z * (-76.7279816 + z * 40.8759079))));
    if sine < 1.0 { sine } else { 1.0 }
}

/// The part of x turns that remains without whole turns, -0.5..0.5; 0 if |x| < TINY or |x| > 2^22.
#[inline(always)]
fn turn_fraction(x: f32) -> f32 {
    let inside = if x.abs() >= TINY && x.abs() <= 4194304.0 { x } else { 0.0 };
    inside - (inside + 0.5).floor()
}

/// x radians in turns without whole turns, -0.5..0.5; 0 if |x| < TINY or |x| > 8192.
/// 2 pi is subtracted in two parts, the first of nine bits (Cody and Waite 1980).
#[inline(always)]
fn radians_fraction(x: f32) -> f32 {
    let inside = if x.abs() >= TINY && x.abs() <= 8192.0 { x } else { 0.0 };
    let turns = (inside * INV_TWO_PI + 0.5).floor();
    ((inside - turns * 6.28125) - turns * 0.00193530717) * INV_TWO_PI
}

/// sin(2 pi r), r from the two functions above.
#[inline(always)]
fn sin_fraction(r: f32) -> f32 {
    let size = r.abs();
    let folded = sin_quarter(if size > 0.25 { 0.5 - size } else { size });
    if r < 0.0 { -folded } else { folded }
}

/// sin(2 pi x), -1..1, within 2e-7 for |x| <= 2^22 turns; beyond, and for |x| < TINY, as for 0.
#[inline]
pub fn sin_turns(x: f32) -> f32 {
    sin_fraction(turn_fraction(x))
}

/// cos(2 pi x), -1..1, within 2e-7 for |x| <= 2^22 turns; beyond as for 0.
#[inline]
pub fn cos_turns(x: f32) -> f32 {
    sin_quarter(0.25 - turn_fraction(x).abs())
}

/// sin(x), x in radians, within 5e-7 for |x| <= 8192; beyond, and for |x| < TINY, as for 0.
#[inline]
pub fn sin_(x: f32) -> f32 {
    sin_fraction(radians_fraction(x))
}

/// cos(x), x in radians, within 5e-7 for |x| <= 8192; beyond as for 0.
#[inline]
pub fn cos_(x: f32) -> f32 {
    sin_quarter(0.25 - radians_fraction(x).abs())
}

/// 2^n for whole n in -126..127.
#[inline(always)]
fn power_of_two(n: i32) -> f32 {
    f32::from_bits(((n + 127) as u32) << 23)
}

/// 2^f for |f| <= 0.5: polynomial of degree 6, relative error 1e-8 before rounding.
#[inline(always)]
fn exp2_fraction(f: f32) -> f32 {
    1.0 + f
        * (0.693147182
            + f * (0.240226507 + f * (0.0555035695 + f * (0.00961802714 + f * (0.00133909017 + f * 0.00015471119)))))
}

/// 2^x within 1.5 ULP for x in -126..127; 0 below (and for NaN), 2^127 above.
#[inline]
pub fn exp2_(x: f32) -> f32 {
    let inside = clamp_(x, -126.0, 127.0);
    let whole = (inside + 0.5).floor();
    let power = exp2_fraction(inside - whole) * power_of_two(whole as i32);
    if x >= -126.0 { power } else { 0.0 }
}

/// e^x within 2 ULP for x in -87.33..88.02; 0 below (and for NaN), 2^127 above.
#[inline]
pub fn exp_(x: f32) -> f32 {
    let inside = clamp_(x, -87.33, 88.02);
    let whole = (inside * LOG2_E + 0.5).floor();
    // ln 2 in two parts, the first of nine bits (Cody and Waite 1980).
    let rest = (inside - whole * 0.693359375) - whole * -0.000212194442;
    let power = exp2_fraction(rest * LOG2_E) * power_of_two(whole as i32);
    if x >= -87.33 { if x <= 88.02 { power } else { LARGEST_POWER } } else { 0.0 }
}

/// x = 2^exponent (1 + f) with f in sqrt(0.5) - 1 .. sqrt(2) - 1.
struct LogParts {
    exponent: f32,
    f: f32,
    /// log(1 + f) - f
    rest: f32,
}

/// What `log2_` and `log_` have in common; x is first clamped to 2^-126..largest float.
/// log(1 + f) = f - f^2 / 2 + f^3 P(f), P of degree 7, relative error 1e-8 before rounding.
#[inline(always)]
fn log_parts(x: f32) -> LogParts {
    let signed_bits = x.to_bits() as i32;
    let positive = if signed_bits > 0x00800000 { signed_bits } else { 0x00800000 };
    let bits = if positive < 0x7f7fffff { positive } else { 0x7f7fffff };
    let exponent = (bits - 0x3f3504f3) >> 23;
    let f = f32::from_bits((bits - (exponent << 23)) as u32) - 1.0;
    let p = 0.333333164
        + f * (-0.250007451
            + f * (0.200022519
                + f * (-0.166265175 + f * (0.141824901 + f * (-0.131124794 + f * (0.128690496 + f * -0.0788623393))))));
    let square = f * f;
    LogParts { exponent: exponent as f32, f, rest: (square * f) * p - 0.5 * square }
}

/// Binary logarithm within 2.5 ULP for x >= 2^-126; -126 below, 128 for infinity; one of them for NaN.
#[inline]
pub fn log2_(x: f32) -> f32 {
    let parts = log_parts(x);
    parts.exponent + (parts.f + parts.rest) * LOG2_E
}

/// Natural logarithm within 1.5 ULP for x >= 2^-126; as for 2^-126 below, as for the largest float above.
#[inline]
pub fn log_(x: f32) -> f32 {
    let parts = log_parts(x);
    ((parts.exponent * -0.000212194442 + parts.rest) + parts.f) + parts.exponent * 0.693359375
}

/// x^y for x >= 0 and finite y, within 2 ULP + |y log2 x| 2.5e-7 relative. 1 if |y| < TINY; x below 2^-126 counts as 0,
/// whose power is 0 for y > 0 and 2^127 for y < 0. Results lie in 2^-126..2^127 or are 0.
#[inline]
pub fn pow_(x: f32, y: f32) -> f32 {
    let power = exp2_(y * log2_(x));
    let zeroth = if y > 0.0 { 0.0 } else { LARGEST_POWER };
    let result = if x >= 1.17549435e-38 { power } else { zeroth };
    if y.abs() < TINY { 1.0 } else { result }
}

/// The angle of (x, y) from the x axis, -pi..pi, within 4e-7, where max(|x|, |y|) is in 2^-75..2^99.
/// Coordinates below TINY count as zero; 0 for the origin; pi on the negative x axis.
#[inline]
pub fn atan2_(y: f32, x: f32) -> f32 {
    let width = if x.abs() >= TINY { x.abs() } else { 0.0 };
    let height = if y.abs() >= TINY { y.abs() } else { 0.0 };
    let steep = height > width;
    let long_ = if steep { height } else { width };
    let short_ = if steep { width } else { height };
    // Above tan(pi / 8) turn by pi / 4: atan(a) = pi / 4 + atan((a - 1) / (a + 1)).
    let turned = short_ > long_ * 0.414213568;
    let t = div(if turned { short_ - long_ } else { short_ }, if turned { short_ + long_ } else { long_ });
    let z = t * t;
    let p = -0.333333254 + z * (0.199989811 + z * (-0.142518088 + z * (0.106480621 + z * -0.0620259345)));
    let octant = (if turned { QUARTER_PI } else { 0.0 }) + (t + t * (z * p));
    let quadrant = if steep { HALF_PI - octant } else { octant };
    let half_plane = if x <= -TINY { PI - quadrant } else { quadrant };
    if y <= -TINY { -half_plane } else { half_plane }
}

/// asin(t) for t in 0..0.5, given z = t^2.
#[inline(always)]
fn asin_half(t: f32, z: f32) -> f32 {
    t + t * (z * (0.166667044 + z * (0.0749690682 + z * (0.0452950709 + z * (0.0249514263 + z * 0.040976204)))))
}

/// acos(x), 0..pi, within 4e-7; x is clamped to -1..1.
#[inline]
pub fn acos_(x: f32) -> f32 {
    let size = min_(x.abs(), 1.0);
    // Above 0.5 through the half angle: acos(a) = 2 asin(sqrt((1 - a) / 2)).
    let steep = size > 0.5;
    let z = if steep { (1.0 - size) * 0.5 } else { size * size };
    let angle = asin_half(if steep { sqrt_(z) } else { size }, z);
    let positive = if steep { 2.0 * angle } else { HALF_PI - angle };
    if x < 0.0 { PI - positive } else { positive }
}

/// asin(x), -pi/2..pi/2, within 3e-7; x is clamped to -1..1. 0 if |x| < TINY.
#[inline]
pub fn asin_(x: f32) -> f32 {
    let size = min_(x.abs(), 1.0);
    let steep = size > 0.5;
    let z = if steep { (1.0 - size) * 0.5 } else { size * size };
    let angle = asin_half(if steep { sqrt_(z) } else { size }, z);
    let small = if size >= TINY { angle } else { 0.0 };
    let positive = if steep { HALF_PI - 2.0 * angle } else { small };
    if x < 0.0 { -positive } else { positive }
}

/// floor(log2 |x|) for normal x; -127 for zero and subnormals, 128 for infinity and NaN.
#[inline]
pub fn exponent_(x: f32) -> i32 {
    ((x.to_bits() >> 23) & 0xff) as i32 - 127
}

/// x 2^n for n in -126..127 (clamped); exact while the result is a normal float, 0 where it would be subnormal.
#[inline]
pub fn ldexp_(x: f32, n: i32) -> f32 {
    let low = if n > -126 { n } else { -126 };
    let inside = if low < 127 { low } else { 127 };
    let scaled = x * power_of_two(inside);
    // By the exponents, since devices differ in whether they round or flush first.
    if exponent_(x) + inside >= -126 { scaled } else { 0.0 }
}

/// a (1 - t) + b t: a at t = 0, b at t = 1.
#[inline(always)]
pub fn mix_(a: f32, b: f32, t: f32) -> f32 {
    a * (1.0 - t) + b * t
}

/// `mix_` of each component.
#[inline(always)]
pub fn mix3_(a: Vec3, b: Vec3, t: f32) -> Vec3 {
    a * (1.0 - t) + b * t
}

#[inline(always)]
pub fn dot2(a: Vec2, b: Vec2) -> f32 {
    a.x * b.x + a.y * b.y
}

#[inline(always)]
pub fn dot3(a: Vec3, b: Vec3) -> f32 {
    (a.x * b.x + a.y * b.y) + a.z * b.z
}

#[inline(always)]
pub fn cross3(a: Vec3, b: Vec3) -> Vec3 {
    Vec3::new(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x)
}

/// The largest component, with its sign.
#[inline(always)]
pub fn max3_(v: Vec3) -> f32 {
    max_(max_(v.x, v.y), v.z)
}

/// The smallest component, with its sign.
#[inline(always)]
pub fn min3_(v: Vec3) -> f32 {
    min_(min_(v.x, v.y), v.z)
}

/// |v| within 2.5 ULP for lengths in 2^-50..2^50; else 0.
#[inline]
pub fn length3(v: Vec3) -> f32 {
    sqrt_(dot3(v, v))
}

/// v / |v|, each component within 3e-7 and the length within 2e-7 of 1, if the largest |component| is in TINY..HUGE;
/// else the zero vector.
#[inline]
pub fn normalize3(v: Vec3) -> Vec3 {
    let largest = max3_(Vec3::new(v.x.abs(), v.y.abs(), v.z.abs()));
    let valid = largest >= TINY && largest <= HUGE;
    // A power of two that brings the largest component to 1..2, so that squares neither overflow nor vanish.
    let scaled = v * f32::from_bits(0x7f000000u32.wrapping_sub(largest.to_bits() & 0x7f800000));
    let square = dot3(scaled, scaled);
    if valid && square <= 12.0 { scaled * rsqrt(square) } else { Vec3::ZERO }
}
