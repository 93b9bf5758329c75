//! What can go wrong between us and a Vulkan driver.

use crate::render::RenderError;
use ash::vk;

/// For `map_err`: a call of the driver failed while doing `what`.
pub(super) fn call_failed(what: impl Into<String>) -> impl FnOnce(vk::Result) -> RenderError {
    let what = what.into();
    move |result| match result {
        vk::Result::ERROR_DEVICE_LOST => RenderError::Lost(format!("the device was lost: {what}")),
        vk::Result::ERROR_OUT_OF_HOST_MEMORY | vk::Result::ERROR_OUT_OF_DEVICE_MEMORY => {
            RenderError::OutOfMemory(format!("{what}: {result}"))
        }
        _ => RenderError::Failed(format!("{what}: {result}")),
    }
}
