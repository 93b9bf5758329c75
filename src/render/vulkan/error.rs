//! What can go wrong between us and a Vulkan driver.

use crate::render::RenderError;
use ash::vk;

/// Errors of the Vulkan layer, told apart so that a caller can fall back to the CPU backend.
#[derive(Debug, thiserror::Error)]
pub enum VulkanError {
    /// This machine has no Vulkan loader at all.
    #[error("no Vulkan loader on this machine ({0})")]
    NoLoader(String),
    /// No device, not the one asked for, or it lacks something needed.
    #[error("{0}")]
    NoDevice(String),
    /// Device lost, out of memory, array too large.
    #[error("{0}")]
    Device(String),
}

impl VulkanError {
    /// For `map_err`: a call of the driver failed while doing `what`.
    pub(super) fn call(what: impl Into<String>) -> impl FnOnce(vk::Result) -> VulkanError {
        let what = what.into();
        move |result| match result {
            vk::Result::ERROR_DEVICE_LOST => VulkanError::Device(format!("the device was lost: {what}")),
            _ => VulkanError::Device(format!("{what}: {result}")),
        }
    }
}

impl From<VulkanError> for RenderError {
    fn from(error: VulkanError) -> Self {
        match error {
            VulkanError::NoLoader(_) | VulkanError::NoDevice(_) => RenderError::NoDevice(error.to_string()),
            VulkanError::Device(text) => RenderError::Device(text),
        }
    }
}
