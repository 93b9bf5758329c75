//! Listening to the validation layers (`GONIO_VALIDATION=1`, set by the tests).

use ash::vk;
use std::ffi::{CStr, c_void};
use std::sync::{Mutex, PoisonError};

pub(super) const LAYER: &CStr = c"VK_LAYER_KHRONOS_validation";

/// Everything the layers said about one instance; shared, so that it outlives the instance.
#[derive(Debug, Default)]
pub struct Messages(Mutex<Vec<String>>);

impl Messages {
    /// Takes what was said so far.
    pub fn take(&self) -> Vec<String> {
        std::mem::take(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }

    fn push(&self, text: String) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).push(text);
    }
}

/// True if the environment asks for the validation layers.
pub fn wanted() -> bool {
    std::env::var_os("GONIO_VALIDATION").is_some_and(|value| value == "1")
}

/// What to listen for. `messages` must outlive the instance that is given this.
pub(super) fn messenger_info<'a>(messages: &Messages) -> vk::DebugUtilsMessengerCreateInfoEXT<'a> {
    vk::DebugUtilsMessengerCreateInfoEXT::default()
        .message_severity(vk::DebugUtilsMessageSeverityFlagsEXT::ERROR | vk::DebugUtilsMessageSeverityFlagsEXT::WARNING)
        .message_type(vk::DebugUtilsMessageTypeFlagsEXT::VALIDATION)
        .pfn_user_callback(Some(listen))
        .user_data(std::ptr::from_ref(messages).cast_mut().cast())
}

// SAFETY: called by the driver with valid `data` for the time of the call and with the `user` pointer that
// `messenger_info` was given: a `Messages` that the instance keeps alive.
unsafe extern "system" fn listen(
    severity: vk::DebugUtilsMessageSeverityFlagsEXT,
    _types: vk::DebugUtilsMessageTypeFlagsEXT,
    data: *const vk::DebugUtilsMessengerCallbackDataEXT<'_>,
    user: *mut c_void,
) -> vk::Bool32 {
    // SAFETY: see above; a null message is handled.
    let (text, messages) = unsafe {
        let text = match (*data).p_message {
            message if message.is_null() => String::new(),
            message => CStr::from_ptr(message).to_string_lossy().into_owned(),
        };
        (text, &*user.cast::<Messages>())
    };
    if severity.contains(vk::DebugUtilsMessageSeverityFlagsEXT::ERROR) {
        log::error!("Vulkan validation: {text}");
    } else {
        log::warn!("Vulkan validation: {text}");
    }
    messages.push(text);
    vk::FALSE // the specification asks layers' callbacks to return false
}
