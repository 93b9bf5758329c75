// Decisions of a path that need no scene.
#ifndef TRANSPORT_WEIGHT_GLSL
#define TRANSPORT_WEIGHT_GLSL

#include "shading/math.glsl"
#include "shading/spectrum.glsl"
#include "trace/surface.glsl"

// The largest probability of surviving Russian roulette: no path is endless between perfect mirrors.
const float SURVIVAL_MOST = 0.95;

// Weight of the first of two ways to draw a direction, with densities `own` and `other`: the power heuristic with
// exponent 2 (Veach 1997, "Robust Monte Carlo Methods for Light Transport Simulation", section 9.2.4). `own` > 0.
float power_heuristic(float own, float other) {
    float ratio = div(other, own);
    return rcp(1.0 + ratio * ratio);
}

// Probability 0..1 that a path goes on after Russian roulette: its throughput, without the compression of light inside a
// medium of index `eta`.
float survival(Spectrum throughput, float eta) {
    return min_(spectrum_max(throughput) * (eta * eta), SURVIVAL_MOST);
}

// Whether light may go from `wo` to `wi` (world): on the shading frame and on the surface itself they must be on the same
// side for reflection, on different sides for transmission. Else light would leak through the surface. Neither, where a
// product of cosines is below TINY: devices may flush it to zero.
bool consistent(Surface surface, vec3 wo, vec3 wi, vec3 wo_local, vec3 wi_local) {
    float geometric = dot3(surface.normal_geometric, wo) * dot3(surface.normal_geometric, wi);
    float shading = wo_local.z * wi_local.z;
    return (geometric >= TINY && shading >= TINY) || (geometric <= -TINY && shading <= -TINY);
}

#endif
