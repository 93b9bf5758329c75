// Division, roots and the elementary functions from `+ - *` and bit operations alone.
//
// Vulkan rounds `+ - *` and conversions correctly and promises little about the rest, so the rest is here, once a
// language (ARCHITECTURE.md, "Strict arithmetic"). The functions are total: outside its domain each returns the stated
// value, and none makes a NaN. Errors are bounds over the whole domain, in ULP of the true result or as stated,
// proved by `tests/math.rs`.
//
// Devices may flush subnormal numbers to zero, also those inside a formula. Division and roots therefore work on
// magnitudes from `TINY` to `HUGE` only, where none occurs; sines take what is smaller than `TINY` for zero, and no
// function of this file makes a subnormal but sums, products and choices, which give what they are given.
#ifndef SHADING_MATH_GLSL
#define SHADING_MATH_GLSL

const float PI = 3.14159274;
const float TWO_PI = 6.28318548;
const float HALF_PI = 1.57079637;
const float QUARTER_PI = 0.785398185;
const float INV_PI = 0.318309873;
const float INV_TWO_PI = 0.159154937;
const float INV_FOUR_PI = 0.0795774683;
const float LOG2_E = 1.44269502;
// 2^-100. Division and roots take anything smaller for zero.
const float TINY = 7.88860905e-31;
// 2^100. Division and roots refuse anything larger.
const float HUGE = 1.2676506e30;
// 2^127, where exponentials stop growing.
const float LARGEST_POWER = 1.70141183e38;

// The smaller; b if either is NaN.
float min_(float a, float b) {
    return a < b ? a : b;
}

// The larger; b if either is NaN.
float max_(float a, float b) {
    return a > b ? a : b;
}

// x limited to low..high; low if x is NaN.
float clamp_(float x, float low, float high) {
    return min_(max_(x, low), high);
}

// The first 12 significant bits of x; products of two such numbers are exact.
float leading(float x) {
    return uintBitsToFloat(floatBitsToUint(x) & 0xfffff000u);
}

// 1 / x to 2.4e-6, a little too small, for |x| in TINY..HUGE.
// A start from the bits (Blinn 1997, "Floating-point tricks"; 5 %), then two Newton steps, the first with its
// constant shifted so that the error has both signs.
float rcp_start(float x) {
    float y = uintBitsToFloat(0x7ef22b00u - floatBitsToUint(x));
    y = y * (2.0015 - x * y);
    return y * (2.0 - x * y);
}

// 1 / x within 0.51 ULP for |x| in TINY..HUGE; else 0.
float rcp(float x) {
    float y = rcp_start(x);
    // The residual 1 - x y_high without rounding error: products of halves are exact.
    float y_high = leading(y);
    float x_high = leading(x);
    float residual = (1.0 - y_high * x_high) - y_high * (x - x_high);
    float refined = y_high + residual * y;
    return abs(x) >= TINY && abs(x) <= HUGE ? refined : 0.0;
}

// a / b within 0.51 ULP for |b| in TINY..HUGE; exact where the quotient is a float.
// 0 if |b| is outside TINY..HUGE, or |a| or the quotient below TINY; quotients above HUGE are within 5e-6, and +-infinity on overflow.
float div(float a, float b) {
    float y = rcp_start(b);
    float quotient = a * y;
    // The residual a - b q_high without rounding error, as in `rcp`.
    float q_high = leading(quotient);
    float b_high = leading(b);
    float residual = (a - q_high * b_high) - q_high * (b - b_high);
    float refined = q_high + residual * y;
    bool valid = abs(b) >= TINY && abs(b) <= HUGE && abs(a) >= TINY && abs(quotient) >= TINY;
    float result = abs(quotient) <= HUGE ? refined : quotient;
    return valid ? result : 0.0;
}

// 1 / sqrt(x) to 1.7e-6, a little too small, for x in TINY..HUGE.
// A start from the bits (Lomont 2003, "Fast inverse square root"; 3.5 %), then two Newton steps as in `rcp_start`.
float rsqrt_start(float x) {
    float h = 0.5 * x;
    float y = uintBitsToFloat(0x5f36da00u - (floatBitsToUint(x) >> 1u));
    y = y * (1.501 - (h * y) * y);
    return y * (1.5 - (h * y) * y);
}

// 1 / sqrt(x) within 1.25 ULP for x in TINY..HUGE; else 0.
float rsqrt(float x) {
    float y = rsqrt_start(x);
    float refined = y + y * (0.5 - (0.5 * x) * (y * y));
    return x >= TINY && x <= HUGE ? refined : 0.0;
}

// sqrt(x) within 0.86 ULP for x in TINY..HUGE, exact for squares of whole numbers below 4096; else 0.
float sqrt_(float x) {
    float y = rsqrt_start(x);
    float root = x * y;
    float refined = root + (x - root * root) * (0.5 * y);
    return x >= TINY && x <= HUGE ? refined : 0.0;
}

// sin(2 pi u) for |u| <= 0.25: minimax polynomial of degree 9, relative error 2.9e-8 before rounding; at most 1.
float sin_quarter(float u) {
    float z = u * u;
    float sine = u * (6.28318548 + z * (-41.3417664 + z * (81.6086349 + z * (-76.7279816 + z * 40.8759079))));
    return sine < 1.0 ? sine : 1.0;
}

// The part of x turns that remains without whole turns, -0.5..0.5; 0 if |x| < TINY or |x| > 2^22.
float turn_fraction(float x) {
    float inside = abs(x) >= TINY && abs(x) <= 4194304.0 ? x : 0.0;
    return inside - floor(inside + 0.5);
}

// x radians in turns without whole turns, -0.5..0.5; 0 if |x| < TINY or |x| > 8192.
// 2 pi is subtracted in two parts, the first of nine bits (Cody and Waite 1980).
float radians_fraction(float x) {
    float inside = abs(x) >= TINY && abs(x) <= 8192.0 ? x : 0.0;
    float turns = floor(inside * INV_TWO_PI + 0.5);
    return ((inside - turns * 6.28125) - turns * 0.00193530717) * INV_TWO_PI;
}

// sin(2 pi r), r from the two functions above.
float sin_fraction(float r) {
    float size = abs(r);
    float folded = sin_quarter(size > 0.25 ? 0.5 - size : size);
    return r < 0.0 ? -folded : folded;
}

// sin(2 pi x), -1..1, within 2e-7 for |x| <= 2^22 turns; beyond, and for |x| < TINY, as for 0.
float sin_turns(float x) {
    return sin_fraction(turn_fraction(x));
}

// cos(2 pi x), -1..1, within 2e-7 for |x| <= 2^22 turns; beyond as for 0.
float cos_turns(float x) {
    return sin_quarter(0.25 - abs(turn_fraction(x)));
}

// sin(x), x in radians, within 5e-7 for |x| <= 8192; beyond, and for |x| < TINY, as for 0.
float sin_(float x) {
    return sin_fraction(radians_fraction(x));
}

// cos(x), x in radians, within 5e-7 for |x| <= 8192; beyond as for 0.
float cos_(float x) {
    return sin_quarter(0.25 - abs(radians_fraction(x)));
}

// 2^n for whole n in -126..127.
float power_of_two(int n) {
    return uintBitsToFloat(uint(n + 127) << 23u);
}

// 2^f for |f| <= 0.5: polynomial of degree 6, relative error 1e-8 before rounding.
float exp2_fraction(float f) {
    return 1.0 + f
        * (0.693147182
            + f * (0.240226507 + f * (0.0555035695 + f * (0.00961802714 + f * (0.00133909017 + f * 0.00015471119)))));
}

// 2^x within 1.5 ULP for x in -126..127; 0 below (and for NaN), 2^127 above.
float exp2_(float x) {
    float inside = clamp_(x, -126.0, 127.0);
    float whole = floor(inside + 0.5);
    float power = exp2_fraction(inside - whole) * power_of_two(int(whole));
    return x >= -126.0 ? power : 0.0;
}

// e^x within 2 ULP for x in -87.33..88.02; 0 below (and for NaN), 2^127 above.
float exp_(float x) {
    float inside = clamp_(x, -87.33, 88.02);
    float whole = floor(inside * LOG2_E + 0.5);
    // ln 2 in two parts, the first of nine bits (Cody and Waite 1980).
    float rest = (inside - whole * 0.693359375) - whole * -0.000212194442;
    float power = exp2_fraction(rest * LOG2_E) * power_of_two(int(whole));
    return x >= -87.33 ? (x <= 88.02 ? power : LARGEST_POWER) : 0.0;
}

// x = 2^exponent (1 + f) with f in sqrt(0.5) - 1 .. sqrt(2) - 1.
struct LogParts {
    float exponent;
    float f;
    // log(1 + f) - f
    float rest;
};

// What `log2_` and `log_` have in common; x is first clamped to 2^-126..largest float.
// log(1 + f) = f - f^2 / 2 + f^3 P(f), P of degree 7, relative error 1e-8 before rounding.
LogParts log_parts(float x) {
    int signed_bits = floatBitsToInt(x);
    int positive = signed_bits > 0x00800000 ? signed_bits : 0x00800000;
    int bits = positive < 0x7f7fffff ? positive : 0x7f7fffff;
    int exponent = (bits - 0x3f3504f3) >> 23;
    float f = intBitsToFloat(bits - (exponent << 23)) - 1.0;
    float p = 0.333333164
        + f * (-0.250007451
            + f * (0.200022519
                + f * (-0.166265175 + f * (0.141824901 + f * (-0.131124794 + f * (0.128690496 + f * -0.0788623393))))));
    float square = f * f;
    return LogParts(float(exponent), f, (square * f) * p - 0.5 * square);
}

// Binary logarithm within 2.5 ULP for x >= 2^-126; -126 below, 128 for infinity; one of them for NaN.
float log2_(float x) {
    LogParts parts = log_parts(x);
    return parts.exponent + (parts.f + parts.rest) * LOG2_E;
}

// Natural logarithm within 1.5 ULP for x >= 2^-126; as for 2^-126 below, as for the largest float above.
float log_(float x) {
    LogParts parts = log_parts(x);
    return ((parts.exponent * -0.000212194442 + parts.rest) + parts.f) + parts.exponent * 0.693359375;
}

// x^y for x >= 0 and finite y, within 2 ULP + |y log2 x| 2.5e-7 relative. 1 if |y| < TINY; x below 2^-126 counts as 0,
// whose power is 0 for y > 0 and 2^127 for y < 0. Results lie in 2^-126..2^127 or are 0.
float pow_(float x, float y) {
    float power = exp2_(y * log2_(x));
    float zeroth = y > 0.0 ? 0.0 : LARGEST_POWER;
    float result = x >= 1.17549435e-38 ? power : zeroth;
    return abs(y) < TINY ? 1.0 : result;
}

// The angle of (x, y) from the x axis, -pi..pi, within 4e-7, where max(|x|, |y|) is in 2^-75..2^99.
// Coordinates below TINY count as zero; 0 for the origin; pi on the negative x axis.
float atan2_(float y, float x) {
    float width = abs(x) >= TINY ? abs(x) : 0.0;
    float height = abs(y) >= TINY ? abs(y) : 0.0;
    bool steep = height > width;
    float long_ = steep ? height : width;
    float short_ = steep ? width : height;
    // Above tan(pi / 8) turn by pi / 4: atan(a) = pi / 4 + atan((a - 1) / (a + 1)).
    bool turned = short_ > long_ * 0.414213568;
    float t = div(turned ? short_ - long_ : short_, turned ? short_ + long_ : long_);
    float z = t * t;
    float p = -0.333333254 + z * (0.199989811 + z * (-0.142518088 + z * (0.106480621 + z * -0.0620259345)));
    float octant = (turned ? QUARTER_PI : 0.0) + (t + t * (z * p));
    float quadrant = steep ? HALF_PI - octant : octant;
    float half_plane = x <= -TINY ? PI - quadrant : quadrant;
    return y <= -TINY ? -half_plane : half_plane;
}

// asin(t) for t in 0..0.5, given z = t^2.
float asin_half(float t, float z) {
    return t + t * (z * (0.166667044 + z * (0.0749690682 + z * (0.0452950709 + z * (0.0249514263 + z * 0.040976204)))));
}

// acos(x), 0..pi, within 4e-7; x is clamped to -1..1.
float acos_(float x) {
    float size = min_(abs(x), 1.0);
    // Above 0.5 through the half angle: acos(a) = 2 asin(sqrt((1 - a) / 2)).
    bool steep = size > 0.5;
    float z = steep ? (1.0 - size) * 0.5 : size * size;
    float angle = asin_half(steep ? sqrt_(z) : size, z);
    float positive = steep ? 2.0 * angle : HALF_PI - angle;
    return x < 0.0 ? PI - positive : positive;
}

// asin(x), -pi/2..pi/2, within 3e-7; x is clamped to -1..1. 0 if |x| < TINY.
float asin_(float x) {
    float size = min_(abs(x), 1.0);
    bool steep = size > 0.5;
    float z = steep ? (1.0 - size) * 0.5 : size * size;
    float angle = asin_half(steep ? sqrt_(z) : size, z);
    float small = size >= TINY ? angle : 0.0;
    float positive = steep ? HALF_PI - 2.0 * angle : small;
    return x < 0.0 ? -positive : positive;
}

// floor(log2 |x|) for normal x; -127 for zero and subnormals, 128 for infinity and NaN.
int exponent_(float x) {
    return int((floatBitsToUint(x) >> 23u) & 0xffu) - 127;
}

// x 2^n for n in -126..127 (clamped); exact while the result is a normal float, 0 where it would be subnormal.
float ldexp_(float x, int n) {
    int low = n > -126 ? n : -126;
    int inside = low < 127 ? low : 127;
    float scaled = x * power_of_two(inside);
    // By the exponents, since devices differ in whether they round or flush first.
    return exponent_(x) + inside >= -126 ? scaled : 0.0;
}

// a (1 - t) + b t: a at t = 0, b at t = 1.
float mix_(float a, float b, float t) {
    return a * (1.0 - t) + b * t;
}

// `mix_` of each component.
vec3 mix3_(vec3 a, vec3 b, float t) {
    return a * (1.0 - t) + b * t;
}

float dot2(vec2 a, vec2 b) {
    return a.x * b.x + a.y * b.y;
}

float dot3(vec3 a, vec3 b) {
    return (a.x * b.x + a.y * b.y) + a.z * b.z;
}

vec3 cross3(vec3 a, vec3 b) {
    return vec3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}

// The largest component, with its sign.
float max3_(vec3 v) {
    return max_(max_(v.x, v.y), v.z);
}

// The smallest component, with its sign.
float min3_(vec3 v) {
    return min_(min_(v.x, v.y), v.z);
}

// |v| within 2.5 ULP for lengths in 2^-50..2^50; else 0.
float length3(vec3 v) {
    return sqrt_(dot3(v, v));
}

// v / |v|, each component within 3e-7 and the length within 2e-7 of 1, if the largest |component| is in TINY..HUGE;
// else the zero vector.
vec3 normalize3(vec3 v) {
    float largest = max3_(vec3(abs(v.x), abs(v.y), abs(v.z)));
    bool valid = largest >= TINY && largest <= HUGE;
    // A power of two that brings the largest component to 1..2, so that squares neither overflow nor vanish.
    vec3 scaled = v * uintBitsToFloat(0x7f000000u - (floatBitsToUint(largest) & 0x7f800000u));
    float square = dot3(scaled, scaled);
    return valid && square <= 12.0 ? scaled * rsqrt(square) : vec3(0.0);
}

#endif
