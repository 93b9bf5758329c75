//! The Vulkan loader and instance.

use super::device::{self, DeviceInfo};
use super::error::call_failed;
use super::validation::{self, Messages};
use crate::render::RenderError;
use ash::{ext, khr, vk};
use std::ffi::CStr;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// An instance, with validation if the environment asks for it and the layer is installed.
pub struct Instance {
    pub(super) raw: ash::Instance,
    messenger: Option<(ext::debug_utils::Instance, vk::DebugUtilsMessengerEXT)>,
    messages: Arc<Messages>,
    /// Last, so that the loader's library outlives every call above.
    _entry: ash::Entry,
}

impl Instance {
    /// Opens the system's loader at run time and makes an instance of Vulkan 1.2. The validation layers are asked for by
    /// `validate` or by `GONIO_VALIDATION=1`.
    ///
    /// `GONIO_VULKAN_LOADER` names another loader library; tests use it to act out a machine without one.
    pub fn new(validate: bool) -> Result<Arc<Instance>, RenderError> {
        let loader = std::env::var_os("GONIO_VULKAN_LOADER").map(PathBuf::from);
        Self::with_loader(loader.as_deref(), validate)
    }

    /// The same with the loader library at `loader`; `None` for the system's.
    pub fn with_loader(loader: Option<&Path>, validate: bool) -> Result<Arc<Instance>, RenderError> {
        // SAFETY: the loader is a library made to be opened so; it is closed after everything that came from it.
        let entry = unsafe {
            match loader {
                Some(path) => ash::Entry::load_from(path),
                None => ash::Entry::load(),
            }
        }
        .map_err(|error| RenderError::NoDevice(format!("no Vulkan loader on this machine ({error})")))?;

        // SAFETY: `entry` is open.
        let version = unsafe { entry.try_enumerate_instance_version() };
        let version = version.ok().flatten().unwrap_or(vk::API_VERSION_1_0);
        if version < vk::API_VERSION_1_2 {
            return Err(RenderError::NoDevice(format!(
                "the Vulkan loader knows version {} only; 1.2 is needed",
                device::version_text(version)
            )));
        }
        Self::create(entry, validate || validation::wanted())
    }

    fn create(entry: ash::Entry, validate: bool) -> Result<Arc<Instance>, RenderError> {
        let listening = validate && has_layer(&entry);
        if validate && !listening {
            log::warn!("validation is wanted, but the Khronos validation layer is not installed");
        }
        let portability = has_extension(&entry, khr::portability_enumeration::NAME);
        let mut extensions = Vec::new();
        let mut flags = vk::InstanceCreateFlags::empty();
        if portability {
            extensions.push(khr::portability_enumeration::NAME.as_ptr());
            flags |= vk::InstanceCreateFlags::ENUMERATE_PORTABILITY_KHR;
        }
        let layers: Vec<_> = listening.then(|| validation::LAYER.as_ptr()).into_iter().collect();
        if listening {
            extensions.push(ext::debug_utils::NAME.as_ptr());
        }

        let messages = Arc::new(Messages::default());
        let application = vk::ApplicationInfo::default()
            .application_name(c"gonio")
            .engine_name(c"gonio")
            .api_version(vk::API_VERSION_1_2);
        let mut messenger_info = validation::messenger_info(&messages);
        let enabled = [vk::ValidationFeatureEnableEXT::SYNCHRONIZATION_VALIDATION];
        let mut features = vk::ValidationFeaturesEXT::default().enabled_validation_features(&enabled);
        let mut info = vk::InstanceCreateInfo::default()
            .application_info(&application)
            .flags(flags)
            .enabled_layer_names(&layers)
            .enabled_extension_names(&extensions);
        if listening {
            info = info.push_next(&mut messenger_info).push_next(&mut features);
        }
        // SAFETY: every pointer in `info` lives until the end of this function.
        let raw = unsafe { entry.create_instance(&info, None) }
            .map_err(|error| RenderError::NoDevice(format!("no Vulkan driver can be used: {error}")))?;
        let mut instance = Instance { raw, messenger: None, messages, _entry: entry };
        if listening {
            let functions = ext::debug_utils::Instance::new(&instance._entry, &instance.raw);
            let info = validation::messenger_info(&instance.messages);
            // SAFETY: the extension is enabled, and `messages` is kept until the messenger is destroyed.
            let messenger = unsafe { functions.create_debug_utils_messenger(&info, None) }
                .map_err(call_failed("cannot listen to the validation layer"))?;
            instance.messenger = Some((functions, messenger));
        }
        Ok(Arc::new(instance))
    }

    /// All physical devices in the driver's order, usable or not.
    pub fn devices(&self) -> Result<Vec<DeviceInfo>, RenderError> {
        Ok(self.physical_devices()?.into_iter().enumerate().map(|(at, raw)| device::describe(self, at, raw)).collect())
    }

    pub(super) fn physical_devices(&self) -> Result<Vec<vk::PhysicalDevice>, RenderError> {
        // SAFETY: the instance is alive.
        unsafe { self.raw.enumerate_physical_devices() }
            .map_err(|error| RenderError::NoDevice(format!("cannot list the Vulkan devices: {error}")))
    }

    /// True if a validation layer is at work.
    pub fn is_validated(&self) -> bool {
        self.messenger.is_some()
    }

    /// What the validation layers have to say; also after the instance is gone.
    pub fn messages(&self) -> Arc<Messages> {
        self.messages.clone()
    }
}

impl Drop for Instance {
    fn drop(&mut self) {
        // SAFETY: whatever came from this instance holds an `Arc` of it, so nothing is left.
        unsafe {
            if let Some((functions, messenger)) = self.messenger.take() {
                functions.destroy_debug_utils_messenger(messenger, None);
            }
            self.raw.destroy_instance(None);
        }
    }
}

fn has_layer(entry: &ash::Entry) -> bool {
    // SAFETY: `entry` is open.
    let layers = unsafe { entry.enumerate_instance_layer_properties() }.unwrap_or_default();
    layers.iter().any(|layer| layer.layer_name_as_c_str() == Ok(validation::LAYER))
}

fn has_extension(entry: &ash::Entry, name: &CStr) -> bool {
    // SAFETY: `entry` is open.
    let extensions = unsafe { entry.enumerate_instance_extension_properties(None) }.unwrap_or_default();
    extensions.iter().any(|extension| extension.extension_name_as_c_str() == Ok(name))
}
