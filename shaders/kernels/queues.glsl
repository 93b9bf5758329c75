// Where the transport steps put what they make: the device's side of `src/transport/mod.rs`.
#ifndef KERNELS_QUEUES_GLSL
#define KERNELS_QUEUES_GLSL

#include "transport/film.glsl"
#include "transport/generate.glsl"

// What no kernel of a round but schedule writes of the control record.
struct Round {
    uint chunk_count;
    uint level0_capacity;
    uint level_capacity;
    uint shadow_capacity;
    uint shadow_first;
};
Round round_;

// `begin`, for kernels of a round.
void begin_round() {
    begin();
    round_.chunk_count = control.chunk_count;
    round_.level0_capacity = control.level0_capacity;
    round_.level_capacity = control.level_capacity;
    round_.shadow_capacity = control.shadow_capacity;
    round_.shadow_first = control.shadow_first;
}

// First entry of a level in the level buffer.
uint level_first(uint level) {
    return level == 0u ? 0u : round_.level0_capacity + (level - 1u) * round_.level_capacity;
}

// Appends a ray to the level of its depth, or to the only one. A full queue is counted, and ends the render with an error.
void push_path(PathState path) {
    uint level = min(path.depth, header.level_count - 1u);
    uint capacity = level == 0u ? round_.level0_capacity : round_.level_capacity;
    uint at = atomicAdd(control.level_count[level], 1u);
    if (at >= capacity) {
        atomicAdd(control.overflows, 1u);
        return;
    }
    store_path_state(level_first(level) + at, path);
}

// Appends path `i` of the chunk to a group. A group begins after as many entries as the chunk has for each before it.
void push_shade(uint group, uint i) {
    uint at = atomicAdd(control.shade_count[group], 1u);
    order[group * round_.chunk_count + at] = i;
    if (at % GROUP_SIZE == 0u) atomicAdd(control.shade[group].x, 1u);
}

// Appends a shadow ray. Where the shadow kernel does so while others are read, to the half of the queue that is not.
void push_shadow(ShadowRay shadow) {
    uint at = atomicAdd(control.shadow_count, 1u);
    if (at >= round_.shadow_capacity) {
        atomicAdd(control.overflows, 1u);
        return;
    }
    uint first = SHADOWS == SHADOWS_FILTERED ? round_.shadow_capacity - round_.shadow_first : 0u;
    store_shadow_ray(first + at, shadow);
}

// Notes that a contribution which reaches the film was limited.
void count_limited() {
    atomicAdd(control.limited_count, 1u);
}

// Adds a 64-bit integer to lane `lane` of a sum in a buffer: two atomic words with carry, so any order gives the same.
#define ATOMIC_ADD_FIXED(sum, lane, value)                                     \
    {                                                                          \
        uint before = atomicAdd(sum.low[lane], value.low);                     \
        uint carry = before + value.low < before ? 1u : 0u;                    \
        if (value.high + carry != 0u) atomicAdd(sum.high[lane], value.high + carry); \
    }

// Adds `value` (radiance and alpha, throughput included) to the sample in `slot`.
void add_contribution(float scale, uint slot, vec4 value, uint dither) {
    for (uint lane = 0u; lane < 4u; lane++) {
        Fixed units = to_fixed(value[lane], lane_scale(scale, lane), dither_lane(dither, lane));
        if ((units.low | units.high) != 0u) ATOMIC_ADD_FIXED(slots[slot], lane, units)
        if (is_nan(value[lane])) atomicAdd(control.nan_count, 1u);
    }
}

// Records for the auxiliary channels that a camera ray has met nothing; its first hit takes the place of that.
void miss_aov(PathState path) {
    if (path.sample_index == 0u) {
        uint index = slot_pixel(batch, path.slot);
        aovs[index].depth = T_INFINITE;
        aovs[index].object = INVALID;
        aovs[index].material = INVALID;
    }
}

// Records the first hit of a camera ray for the auxiliary channels.
void add_aov(PathState path, float depth, vec3 normal, vec3 albedo, uint object, uint material) {
    uint index = slot_pixel(batch, path.slot);
    for (uint lane = 0u; lane < 3u; lane++) {
        Fixed normal_units = to_fixed(normal[lane], AOV_SCALE, 0.5);
        ATOMIC_ADD_FIXED(aovs[index].normal, lane, normal_units)
        Fixed albedo_units = to_fixed(albedo[lane], AOV_SCALE, 0.5);
        ATOMIC_ADD_FIXED(aovs[index].albedo, lane, albedo_units)
    }
    if (path.sample_index == 0u) {
        aovs[index].depth = depth;
        aovs[index].object = object;
        aovs[index].material = material;
    }
}

#endif
