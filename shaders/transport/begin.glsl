// A sample's beginning.
#ifndef TRANSPORT_BEGIN_GLSL
#define TRANSPORT_BEGIN_GLSL

#include "layout/features.glsl"
#include "transport/generate.glsl"

// The state of the sample in `slot` before its first ray is traced; its auxiliary channels begin with nothing met.
PathState begin_path(Batch batch, uint slot) {
    PathState path = generate(batch, slot);
    if (HAS_AOVS) {
        miss_aov(path);
    }
    return path;
}

#endif
