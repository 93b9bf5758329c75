//! The Vulkan loader and instance.

use super::cache::user_cache;
use super::device::{self, DeviceInfo};
use super::error::call_failed;
use super::validation::{self, Messages};
use crate::render::RenderError;
use ash::{ext, khr, vk};
use std::ffi::{CStr, OsStr};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Once};

/// An instance, with validation if the environment asks for it and the layer is installed.
pub struct Instance {
    pub(super) raw: ash::Instance,
    messenger: Option<(ext::debug_utils::Instance, vk::DebugUtilsMessengerEXT)>,
    messages: Arc<Messages>,
    /// Last, so that the loader's library outlives every call above.
    _entry: ash::Entry,
}

/// No driver is left to be used.
static NO_DRIVERS: AtomicBool = AtomicBool::new(false);

/// Instances of this process, and of those that it starts, are of the drivers of these manifests from now on; there are none
/// if the list is empty.
pub fn choose_drivers(manifests: &[PathBuf]) {
    NO_DRIVERS.store(manifests.is_empty(), Ordering::Relaxed);
    if let Ok(files) = std::env::join_paths(manifests) {
        set_variable("VK_DRIVER_FILES", &files);
        set_variable("VK_ICD_FILENAMES", &files); // what older loaders read
        set_variable("VK_ADD_DRIVER_FILES", "".as_ref());
    }
}

fn set_variable(name: &str, value: &OsStr) {
    // SAFETY: whoever else in this process reads the environment is Rust, which takes its lock, or a Vulkan loader or driver,
    // which no thread has called yet or calls now.
    unsafe { std::env::set_var(name, value) };
}

/// Free bytes below which a disk counts as full: a driver's cache takes a few MiB.
const FULL: u64 = 16 << 20;

/// Turns Mesa's own cache off where its disk is full: it writes to a file in memory that the disk has no room for, which ends
/// the process (SIGBUS).
fn spare_a_full_disk() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let named = std::env::var_os("MESA_SHADER_CACHE_DIR").map(PathBuf::from);
        let folder = named.or_else(|| user_cache()?.parent().map(Path::to_owned));
        if folder.as_deref().and_then(free_bytes).is_some_and(|free| free < FULL) {
            log::info!("the disk of the driver's cache is full: going without that cache");
            set_variable("MESA_SHADER_CACHE_DISABLE", "true".as_ref());
            set_variable("MESA_GLSL_CACHE_DISABLE", "true".as_ref()); // what older versions read
        }
    });
}

/// Bytes that may be written where `folder` is, or would be.
#[cfg(unix)]
fn free_bytes(folder: &Path) -> Option<u64> {
    let found = folder.ancestors().find_map(|folder| rustix::fs::statvfs(folder).ok())?;
    Some(found.f_bavail.saturating_mul(found.f_frsize))
}

#[cfg(not(unix))]
fn free_bytes(_: &Path) -> Option<u64> {
    None
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
        if NO_DRIVERS.load(Ordering::Relaxed) {
            return Err(RenderError::NoDevice("no Vulkan driver of this machine answers (gonio devices)".to_owned()));
        }
        spare_a_full_disk();
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
