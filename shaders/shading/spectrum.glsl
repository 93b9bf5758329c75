// Light as four lanes. In RGB mode lanes 0-2 are linear Rec. 709 and lane 3 is 0.
#ifndef SHADING_SPECTRUM_GLSL
#define SHADING_SPECTRUM_GLSL

#include "shading/math.glsl"

#define Spectrum vec4

Spectrum spectrum_zero() {
    return vec4(0.0, 0.0, 0.0, 0.0);
}

// Linear Rec. 709 in lanes 0-2; lane 3 is 0.
Spectrum spectrum_from_rgb(vec3 rgb) {
    return vec4(rgb.x, rgb.y, rgb.z, 0.0);
}

// Lanes 0-2.
vec3 spectrum_to_rgb(Spectrum s) {
    return vec3(s.x, s.y, s.z);
}

// The largest |lane|.
float spectrum_max(Spectrum s) {
    return max_(max_(abs(s.x), abs(s.y)), max_(abs(s.z), abs(s.w)));
}

// Relative luminance Y of lanes 0-2 (ITU-R BT.709-6, item 3.2).
float spectrum_luminance(Spectrum s) {
    return (s.x * 0.2126 + s.y * 0.7152) + s.z * 0.0722;
}

// x, or 0 where |x| < `TINY` and for NaN.
float flush_lane(float x) {
    return abs(x) >= TINY ? x : 0.0;
}

// The spectrum with lanes below `TINY` (and NaN) set to zero, so that products of throughputs end at zero and never
// among the subnormal numbers, which some devices keep and others do not.
Spectrum spectrum_flush(Spectrum s) {
    return vec4(flush_lane(s.x), flush_lane(s.y), flush_lane(s.z), flush_lane(s.w));
}

#endif
