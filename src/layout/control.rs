//! The wavefront's counters: what the schedule kernel and the queues keep on the device.

use bytemuck::{Pod, Zeroable};

/// Levels of pending rays: one per scattering depth, 0 to 64.
pub const MAX_LEVELS: u32 = 66;
/// Groups of paths that are shaded together: those that hit nothing, and one for each model.
pub const MAX_SHADE_GROUPS: u32 = 24;
pub const SHADE_GROUP_MISSED: u32 = 0;

/// Arguments of an indirect dispatch, in workgroups.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub struct DispatchArguments {
    pub x: u32,
    pub y: u32,
    pub z: u32,
}

/// One per device. 772 bytes.
/// A round is: schedule; extend (this round's chunk: what waited, then camera rays) and shadow (last round's queue); shade.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
pub struct Control {
    /// Indirect arguments written by schedule.
    pub extend: DispatchArguments,
    pub camera: DispatchArguments,
    pub shadow: DispatchArguments,
    /// By extend: of each group.
    pub shade: [DispatchArguments; MAX_SHADE_GROUPS as usize],
    /// Paths of the chunk in each group.
    pub shade_count: [u32; MAX_SHADE_GROUPS as usize],
    /// 1 once nothing is pending but the shadow rays of this round.
    pub done: u32,
    /// Level the chunk was taken from, its first entry and how many entries; its size with the camera rays that follow.
    pub chunk_level: u32,
    pub chunk_first: u32,
    pub chunk_stored: u32,
    pub chunk_count: u32,
    /// Shadow rays the shadow kernel traces in this round.
    pub shadow_pending: u32,
    /// Shadow rays appended by shade, and where those that the shadow kernel traces begin: where it appends some itself the
    /// queue has two halves, which take turns.
    pub shadow_count: u32,
    pub shadow_first: u32,
    /// Limits set by the host: rays a chunk may hold, entries of levels 0 and >= 1, entries of the shadow queue.
    pub chunk_limit: u32,
    pub level0_capacity: u32,
    pub level_capacity: u32,
    pub shadow_capacity: u32,
    /// Appends that found a queue full: a bug, reported as an error, never a lost ray.
    pub overflows: u32,
    /// Contributions that were not a number; samples whose sum was clamped.
    pub nan_count: u32,
    pub clamped_count: u32,
    /// Contributions that the scene's `clamp` has limited.
    pub limited_count: u32,
    /// Rays traced, low and high words.
    pub closest_rays: [u32; 2],
    pub shadow_rays: [u32; 2],
    /// Rounds of all batches, each up to the one that was done.
    pub rounds: u32,
    /// Samples of the batch without a camera ray yet, those of the lowest slots: they wait below level 0.
    pub camera_count: u32,
    /// Entries waiting on each level.
    pub level_count: [u32; MAX_LEVELS as usize],
}
