// Which material of a blend a path meets.
#ifndef TRANSPORT_LEAF_GLSL
#define TRANSPORT_LEAF_GLSL

#include "layout/mod.glsl"
#include "shading/math.glsl"
#include "shading/sampling.glsl"
#include "transport/mod.glsl"

// The material itself, or of a blend one that is none, drawn by the weights: (1 - extra) of the first, extra of the second.
// `index`: into the materials. `key`: of the path, which meets one surface at most.
uint leaf_material(uint index, SampleKey key) {
    uint leaf = index;
    Material material = load_material(leaf);
    if (!HAS_MODEL(MODEL_BLEND) || material.model != MODEL_BLEND) {
        return leaf;
    }
    float u = sample_1d(key, DIMENSION_LEAF);
    for (uint depth = 0u; depth < MAX_LEAVES; depth++) {
        if (material.model == MODEL_BLEND) {
            float weight = clamp_(material.extra, 0.0, 1.0);
            bool second = u < weight;
            // What is left of u is as random again.
            u = second ? div(u, weight) : div(u - weight, 1.0 - weight);
            leaf = second ? material.table + 1u : material.table;
            material = load_material(leaf);
        }
    }
    return leaf;
}

#endif
