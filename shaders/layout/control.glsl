// The wavefront's counters: what the schedule kernel and the queues keep on the device.
#ifndef LAYOUT_CONTROL_GLSL
#define LAYOUT_CONTROL_GLSL

// Levels of pending rays: one per scattering depth, 0 to 64.
const uint MAX_LEVELS = 66u;
// Groups of paths that are shaded together: those that hit nothing, and one for each model.
const uint MAX_SHADE_GROUPS = 24u;
const uint SHADE_GROUP_MISSED = 0u;

// Arguments of an indirect dispatch, in workgroups.
struct DispatchArguments {
    uint x;
    uint y;
    uint z;
};

// One per device. 772 bytes.
// A round is: schedule; extend (this round's chunk: what waited, then camera rays) and shadow (last round's queue); shade.
struct Control {
    // Indirect arguments written by schedule.
    DispatchArguments extend;
    DispatchArguments camera;
    DispatchArguments shadow;
    // By extend: of each group.
    DispatchArguments shade[MAX_SHADE_GROUPS];
    // Paths of the chunk in each group.
    uint shade_count[MAX_SHADE_GROUPS];
    // 1 once nothing is pending but the shadow rays of this round.
    uint done;
    // Level the chunk was taken from, its first entry and how many entries; its size with the camera rays that follow.
    uint chunk_level;
    uint chunk_first;
    uint chunk_stored;
    uint chunk_count;
    // Shadow rays the shadow kernel traces in this round.
    uint shadow_pending;
    // Shadow rays appended by shade, and where those that the shadow kernel traces begin: where it appends some itself the
    // queue has two halves, which take turns.
    uint shadow_count;
    uint shadow_first;
    // Limits set by the host: rays a chunk may hold, entries of levels 0 and >= 1, entries of the shadow queue.
    uint chunk_limit;
    uint level0_capacity;
    uint level_capacity;
    uint shadow_capacity;
    // Appends that found a queue full: a bug, reported as an error, never a lost ray.
    uint overflows;
    // Contributions that were not a number; samples whose sum was clamped.
    uint nan_count;
    uint clamped_count;
    // Contributions that the scene's `clamp` has limited.
    uint limited_count;
    // Rays traced, low and high words.
    uvec2 closest_rays;
    uvec2 shadow_rays;
    // Rounds of all batches, each up to the one that was done.
    uint rounds;
    // Samples of the batch without a camera ray yet, those of the lowest slots: they wait below level 0.
    uint camera_count;
    // Entries waiting on each level.
    uint level_count[MAX_LEVELS];
};

#endif
