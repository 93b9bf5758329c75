// What the materials of a blend do together to light from one direction.
//
// A path draws one of them (`resolve_material`) to see what glows there, whether it goes on behind, and where it goes. Light from
// a direction that is known is scattered by all of them: their weighted sum has less noise than one of them at random.
#ifndef TRANSPORT_BLEND_GLSL
#define TRANSPORT_BLEND_GLSL

#include "layout/records.glsl"
#include "shading/closure.glsl"
#include "shading/frame.glsl"
#include "shading/material.glsl"
#include "shading/math.glsl"
#include "shading/spectrum.glsl"
#include "trace/surface.glsl"
#include "transport/local.glsl"
#include "transport/mod.glsl"
#include "transport/resolve.glsl"
#include "transport/weight.glsl"

// What a surface does to light from a direction.
struct Scattering {
    // f |cos theta_i|, per steradian.
    Spectrum value;
    // Density per solid angle with which a path that stays at the surface goes there.
    float pdf;
};

// Nothing.
Scattering no_scattering() {
    return Scattering(spectrum_zero(), 0.0);
}

// Probability that a path goes straight on through a pane rather than being scattered by it, 0..1: each as often as it is
// bright.
float pass_probability(Closure closure) {
    if (closure.k_t <= 0.0) {
        return 0.0;
    }
    float through = spectrum_max(pane_tint(closure));
    return div(through, own_weight(closure.flags, closure.k_t) + through);
}

// What all materials of a blend together do to light from `wi`, seen from `wo` (world): of a path that has not gone on through
// one of them. `bare`: the surface as it is without their normal maps, found for `hit`. `hidden`: the path looks through what
// glows.
Scattering eval_blend(Hit hit, Surface bare, vec3 wo, vec3 wi, bool hidden) {
    Scattering sum = no_scattering();
    float stays = 0.0;
    for (uint leaf = 0u; leaf < MAX_LEAVES; leaf++) {
        Surface surface = bare;
        Closure closure = resolve_part(-wo, hit, leaf, 0.0, DIMENSION_LEAF, surface);
        bool looked_through = hidden && closure.emission != vec3(0.0);
        if (closure.share > 0.0 && !looked_through) {
            float stay = closure.share * (1.0 - pass_probability(closure));
            stays += stay;
            Frame frame = shading_frame(surface, closure, wo);
            vec3 wo_local = to_local(frame, wo);
            vec3 wi_local = to_local(frame, wi);
            bool dark = is_hidden_back(surface, closure, wo);
            if (!dark && consistent(surface, wo, wi, wo_local, wi_local)) {
                float own = closure.share * own_weight(closure.flags, closure.k_t);
                sum.value += eval_closure(closure, wo_local, wi_local) * own;
                sum.pdf += pdf_closure(closure, wo_local, wi_local) * stay;
            }
        }
        if (leaf + 1u >= closure.leaf_count) {
            break;
        }
    }
    if (stays <= 0.0) {
        return no_scattering();
    }
    return Scattering(sum.value * rcp(stays), sum.pdf * rcp(stays));
}

#endif
