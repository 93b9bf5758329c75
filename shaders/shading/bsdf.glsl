// What every model returns for a direction it has chosen.
#ifndef SHADING_BSDF_GLSL
#define SHADING_BSDF_GLSL

#include "layout/records.glsl"
#include "shading/lobe.glsl"
#include "shading/math.glsl"
#include "shading/spectrum.glsl"

// A direction of zero width: `pdf` is the probability of having chosen it, and no light can be sampled towards it.
const uint SAMPLE_DELTA = 1u;
// `wi` is on the other side of the surface.
const uint SAMPLE_TRANSMIT = 2u;

// A direction to the light, drawn with density `pdf`.
struct BsdfSample {
    // Unit, local frame, leaving the surface.
    vec3 wi;
    // Per solid angle, or a probability (`SAMPLE_DELTA`); 0 if the sample is to be dropped.
    float pdf;
    // f |cos theta_i| / pdf.
    Spectrum weight;
    // Index on the side of `wi` over the index on the side of `wo`: 1 unless `SAMPLE_TRANSMIT`.
    float eta;
    // `SAMPLE_*`.
    uint flags;
};

// A sample of all its parts.
BsdfSample make_sample(vec3 wi, float pdf, Spectrum weight, float eta, uint flags) {
    return BsdfSample(wi, pdf, weight, eta, flags);
}

// The sample that is to be dropped.
BsdfSample no_sample() {
    return make_sample(vec3(0.0, 0.0, 1.0), 0.0, spectrum_zero(), 1.0, 0u);
}

// The sample of a direction with what eval and pdf say of it. `value`: f |cos theta_i|.
BsdfSample finish_sample(vec3 wi, float pdf, Spectrum value, float eta, uint flags) {
    // Below this the weight would mean nothing.
    if (pdf <= 1.0e-12) {
        return no_sample();
    }
    return make_sample(wi, pdf, value * rcp(pdf), eta, flags);
}

#endif
