//! The Vulkan backend: the only folder with `unsafe`.
//!
//! Bottom up: `instance` and `device` (what is there), `context` (a device in use: submissions, transfers), `memory`
//! (buffers), `reflect` and `kernel` (pipelines), `record` (commands).

mod context;
mod device;
mod error;
mod instance;
mod kernel;
mod memory;
mod record;
mod reflect;
mod validation;

pub use context::{BufferSpec, Context, Device, Submission};
pub use device::{DeviceChoice, DeviceInfo, DeviceKind, FloatSupport, Limits};
pub use error::VulkanError;
pub use instance::Instance;
pub use kernel::{Bound, Kernel, WORKGROUP};
pub use memory::{Buffer, Place};
pub use record::Recorder;
pub use reflect::{Binding, BindingKind, bindings};
pub use validation::Messages;
