//! What kernels bind, by name: `shaders/kernels/bindings.glsl` and the host use these numbers and no others.

/// The set of the scene, and what is bound in it: its header, and pages of its arrays.
pub const SET_SCENE: u32 = 0;
pub const BINDING_HEADER: u32 = 0;
pub const BINDING_NODES: u32 = 1;
pub const BINDING_TRIANGLES: u32 = 2;
pub const BINDING_DATA: u32 = 3;

/// The set of the work, and what is bound in it.
pub const SET_WORK: u32 = 1;
pub const BINDING_CONTROL: u32 = 0;
/// Rays that wait, level by level.
pub const BINDING_LEVELS: u32 = 1;
/// Rays of the round in hand.
pub const BINDING_CHUNK: u32 = 2;
pub const BINDING_HITS: u32 = 3;
pub const BINDING_SHADOWS: u32 = 4;
pub const BINDING_SLOTS: u32 = 5;
pub const BINDING_FILM: u32 = 6;
pub const BINDING_AOVS: u32 = 7;
/// Which paths each group shades.
pub const BINDING_ORDER: u32 = 8;
/// Views of the same buffers for kernels that read them: as texel buffers, where kernels fetch so.
pub const BINDING_LEVELS_READ: u32 = 9;
pub const BINDING_CHUNK_READ: u32 = 10;
pub const BINDING_HITS_READ: u32 = 11;
pub const BINDING_SHADOWS_READ: u32 = 12;
pub const BINDING_SLOTS_READ: u32 = 13;
pub const BINDING_FILM_READ: u32 = 14;
