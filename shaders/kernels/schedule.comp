#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// One invocation: takes the largest chunk that any level can give, and hands last round's shadow rays over.
// A level gives no more rays than the next has room for two branches of each, so no queue overflows; below the deepest
// level that has rays all is empty, so there is always a chunk (ARCHITECTURE.md, "The wavefront").
#include "kernels/bindings.glsl"

uint groups(uint count) {
    return (count + GROUP_SIZE - 1u) / GROUP_SIZE;
}

void main() {
    begin();
    if (gl_GlobalInvocationID.x != 0u) return;
    control.shadow_pending = min(control.shadow_count, control.shadow_capacity);
    control.shadow_count = 0u;
    control.chunk_count = 0u;
    uint most = control.chunk_limit;
    if (SHADOWS == SHADOWS_FILTERED) {
        control.shadow_first = control.shadow_capacity - control.shadow_first;
        // All of those pending may go on behind a pane.
        most = min(most, (control.shadow_capacity - control.shadow_pending) / max(header.shadow_rays, 1u));
    }
    uint room = most; // rays of the last level have no branches
    for (uint level = header.level_count; level-- > 0u;) {
        uint waiting = control.level_count[level];
        if (level == 0u) waiting += control.camera_count;
        uint count = min(min(waiting, most), room);
        if (count > control.chunk_count) {
            control.chunk_level = level;
            control.chunk_count = count;
        }
        room = (control.level_capacity - waiting) >> 1u;
    }
    uint stored = control.level_count[control.chunk_level];
    control.chunk_stored = min(stored, control.chunk_count);
    control.chunk_first = stored - control.chunk_stored;
    control.level_count[control.chunk_level] = control.chunk_first;
    uint cameras = control.chunk_count - control.chunk_stored;
    control.camera_count -= cameras;
    control.extend = DispatchArguments(groups(control.chunk_stored), 1u, 1u);
    control.camera = DispatchArguments(groups(cameras), 1u, 1u);
    // Without groups all paths are in the first; else extend fills them.
    for (uint group = 0u; group < MAX_SHADE_GROUPS; group++) {
        uint count = SHADE_GROUPED || group > 0u ? 0u : control.chunk_count;
        control.shade_count[group] = count;
        control.shade[group] = DispatchArguments(groups(count), 1u, 1u);
    }
    control.shadow = DispatchArguments(groups(control.shadow_pending), 1u, 1u);
    // Without a chunk only the shadow rays of this round are left, and filtered ones may go on.
    bool more = control.chunk_count != 0u || (SHADOWS == SHADOWS_FILTERED && control.shadow_pending != 0u);
    uint done = more ? 0u : 1u;
    control.rounds += (control.done & done) == 0u ? 1u : 0u;
    control.done = done;
    uint closest = control.closest_rays.x + control.chunk_count;
    control.closest_rays.y += closest < control.chunk_count ? 1u : 0u;
    control.closest_rays.x = closest;
    uint shadow = control.shadow_rays.x + control.shadow_pending;
    control.shadow_rays.y += shadow < control.shadow_pending ? 1u : 0u;
    control.shadow_rays.x = shadow;
}
