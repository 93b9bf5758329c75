// Filter importance sampling: each camera sample is placed within its pixel's filter and touches that pixel only
// (Ernst, Stamminger and Greiner 2006, "Filter Importance Sampling").
#ifndef SHADING_FILTER_GLSL
#define SHADING_FILTER_GLSL

#include "layout/features.glsl"
#include "layout/records.glsl"
#include "shading/math.glsl"

// Where in the pixel's filter a sample lies, and what it counts.
struct FilterSample {
    // Pixels, from the pixel's centre.
    vec2 offset;
    // filter / density: 1 on average, negative in negative lobes.
    float weight;
};

// A number in -1..1 with density 1 - |x|, for u in [0, 1).
float sample_tent(float u) {
    if (u < 0.5) {
        return sqrt_(2.0 * u) - 1.0;
    }
    return 1.0 - sqrt_(2.0 - 2.0 * u);
}

#ifdef GONIO_FETCH

// One axis of a tabulated filter, u in [0, 1): x = offset in pixels, y = sign. A uniformly chosen interval of the
// inverse CDF, a uniform place within: the density is constant in each interval. The sign is that of the filter, and
// between -1 and 1 where the filter changes its sign within the interval.
vec2 sample_filter_table(float u) {
    float place = clamp_(u, 0.0, 0.99999994) * 256.0;
    float whole = floor(place);
    uint interval = header.filter_table + uint(whole);
    float low = load_table(interval);
    float high = load_table(interval + 1u);
    float sign_ = load_table(interval + (FILTER_KNOTS + 1u));
    return vec2(low + (high - low) * (place - whole), sign_);
}

// A sample of the scene's pixel filter for u in [0, 1)^2. Box and tent are exact; the error of tables is stated in
// `bake/filter`.
FilterSample sample_filter(vec2 u) {
    float radius = header.filter_radius;
    if (FILTER == FILTER_BOX) {
        return FilterSample(vec2((2.0 * u.x - 1.0) * radius, (2.0 * u.y - 1.0) * radius), 1.0);
    }
    if (FILTER == FILTER_TENT) {
        return FilterSample(vec2(sample_tent(u.x) * radius, sample_tent(u.y) * radius), 1.0);
    }
    vec2 x = sample_filter_table(u.x);
    vec2 y = sample_filter_table(u.y);
    return FilterSample(vec2(x.x, y.x), (x.y * y.y) * header.filter_norm);
}

#endif

#endif
