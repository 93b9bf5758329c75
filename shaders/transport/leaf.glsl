// Which material of a blend a path meets.
#ifndef TRANSPORT_LEAF_GLSL
#define TRANSPORT_LEAF_GLSL

#include "layout/mod.glsl"
#include "shading/math.glsl"
#include "shading/sampling.glsl"
#include "trace/surface.glsl"
#include "transport/mod.glsl"
#include "transport/textured.glsl"

// The material of `surface`, found for `hit` along `direction` (`material_at`), and of a blend one that is none, drawn by
// the weights: (1 - extra) of the first, extra of the second. `surface` becomes that material's.
// `key`: of the path, which meets one surface at most.
Material leaf_material(vec3 direction, Hit hit, SampleKey key, inout Surface surface) {
    if (!HAS_MODEL(MODEL_BLEND)) {
        return material_at(direction, hit, surface);
    }
    Surface bare = surface;
    uint leaf = bare.material;
    float u = sample_1d(key, DIMENSION_LEAF);
    uint depth = 0u;
    Material material;
    bool blended = true;
    do {
        surface = bare;
        surface.material = leaf;
        material = material_at(direction, hit, surface);
        blended = material.model == MODEL_BLEND && depth < MAX_LEAVES;
        if (blended) {
            float weight = clamp_(material.extra, 0.0, 1.0);
            bool second = u < weight;
            // What is left of u is as random again.
            u = second ? div(u, weight) : div(u - weight, 1.0 - weight);
            leaf = second ? material.table + 1u : material.table;
            depth += 1u;
        }
    } while (blended);
    return material;
}

#endif
