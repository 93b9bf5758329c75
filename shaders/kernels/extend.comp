#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// The closest hit of every ray in the chunk, and the group in which it is shaded, if there are groups. What waited is copied
// out of its level, so that shade may append to that level; camera rays are made here, where they are first needed.
#define PATHS_FROM_LEVELS
#include "kernels/bindings.glsl"
#include "kernels/queues.glsl"
#include "trace/traverse.glsl"
#include "transport/begin.glsl"

// The group of what was hit: models that the scene has are numbered in their order.
uint shade_group(Hit hit) {
    if (hit.instance == INVALID) return SHADE_GROUP_MISSED;
    Instance instance = load_instance(hit.instance);
    bool by_face = instance.material == INVALID && instance.kind != KIND_SPHERE;
    uint material = by_face ? load_face(instance.first_face + hit.primitive).material : instance.material;
    uint model = load_model(material);
    return 1u + uint(bitCount(MODELS & ~(0xffffffffu << model)));
}

void main() {
    begin_round();
    uint stored = control.chunk_stored;
    uint first = EXTEND_CAMERA ? control.camera_count : level_first(control.chunk_level) + control.chunk_first;
    uint i = gl_GlobalInvocationID.x;
    if (i >= (EXTEND_CAMERA ? round_.chunk_count - stored : stored)) return;
    PathState path;
    if (EXTEND_CAMERA) {
        path = begin_path(batch, first + i);
        i += stored;
    } else {
        path = load_path_state(first + i);
    }
    Hit hit = trace_closest(path.ray);
    store_hit(i, hit);
    store_path_state(i, path);
    if (SHADE_GROUPED) push_shade(shade_group(hit), i);
}
