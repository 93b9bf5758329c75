//! The Vulkan backend: the only folder with `unsafe`.
//!
//! Bottom up: `instance` and `device` (what is there), `context` (a device in use: submissions, transfers), `memory`
//! (buffers), `reflect`, `kernel` and `cache` (pipelines), `record` (commands); on these `scene` (pages), `plan` and `pace` (sizes),
//! `queues` (the wavefront), `renderer` and `inspect`.

mod cache;
mod context;
mod device;
mod error;
mod inspect;
mod instance;
mod kernel;
mod memory;
mod pace;
mod plan;
mod queues;
mod record;
mod reflect;
mod renderer;
mod scene;
mod validation;

pub use cache::{user_cache, write_whole};
pub use context::{BufferSpec, Context, Device, Submission, is_any_stuck};
pub use device::{
    DeviceChoice, DeviceInfo, DeviceKind, Limits, STORAGE_FETCH_STORAGE_BUFFERS, TEXEL_FETCH_STORAGE_BUFFERS,
    TEXEL_FETCH_TEXEL_BUFFERS, float_control_names,
};
pub use instance::{Instance, choose_drivers};
pub use kernel::{Bound, Kernel};
pub use memory::{Buffer, Place};
pub use queues::compile;
pub use record::Recorder;
pub use reflect::{Binding, BindingKind, bindings};
pub use renderer::{VulkanOptions, VulkanRenderer};
pub use scene::{FetchChoice, SceneBuffers, check_fit};
pub use validation::Messages;
