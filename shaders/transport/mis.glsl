// Multiple importance sampling where things are in the way: what the two ways to find light could both have found.
#ifndef TRANSPORT_MIS_GLSL
#define TRANSPORT_MIS_GLSL

#include "layout/features.glsl"
#include "layout/records.glsl"
#include "trace/surface.glsl"
#include "transport/weight.glsl"

// Weight of light that `path` has met where light samples would have had density `sampled`; `path.pdf` > 0.
float met_weight(PathState path, float sampled) {
    if (HAS_SHADOWLESS && (path.flags & PATH_BEHIND_SHADOWLESS) != 0u && sampled > 0.0) {
        return 0.0;
    }
    return power_heuristic(path.pdf, sampled);
}

// Notes that `path` goes straight on through `surface`, which it has met at `t`. `filtered`: shadow rays go through it as well,
// with what it lets through.
void pass_surface(Surface surface, float t, bool filtered, inout PathState path) {
    if (HAS_SHADOWLESS && (load_instance(surface.instance).flags & INSTANCE_NO_SHADOW) != 0u) {
        path.flags |= PATH_BEHIND_SHADOWLESS;
        path.passed += t;
    } else if (filtered) {
        path.passed += t;
    } else {
        path.pdf = 0.0;
    }
}

#endif
