//! Physical devices: what they are, what they lack, and which one is meant.

use super::instance::Instance;
use crate::render::RenderError;
use crate::shaders::FloatControls;
use ash::vk;
use serde::Serialize;
use std::ffi::CStr;
use std::fmt;
use std::str::FromStr;

/// Storage buffers and texel buffers that the largest kernel binds under either way of fetching
/// (`shaders/kernels/bindings.glsl`): queues, and one page of each of the scene's three sets. Every further page is one more
/// to fetch from. Vulkan promises 4 storage buffers, its Roadmap 2022 profile 30.
pub const TEXEL_FETCH_STORAGE_BUFFERS: u32 = 5;
pub const TEXEL_FETCH_TEXEL_BUFFERS: u32 = 4;
pub const STORAGE_FETCH_STORAGE_BUFFERS: u32 = 8;

/// What sort of device it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum DeviceKind {
    Discrete,
    Integrated,
    Virtual,
    Cpu,
    Other,
}

impl DeviceKind {
    /// Place in the order in which `auto` prefers devices.
    fn preference(self) -> usize {
        match self {
            DeviceKind::Discrete => 0,
            DeviceKind::Integrated => 1,
            DeviceKind::Virtual => 2,
            DeviceKind::Cpu => 3,
            DeviceKind::Other => 4,
        }
    }
}

impl fmt::Display for DeviceKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            DeviceKind::Discrete => "discrete",
            DeviceKind::Integrated => "integrated",
            DeviceKind::Virtual => "virtual",
            DeviceKind::Cpu => "cpu",
            DeviceKind::Other => "other",
        })
    }
}

/// Limits that decide sizes here.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Limits {
    /// Bytes one storage buffer binding may cover.
    pub storage_range: u64,
    /// 16-byte words one texel buffer view may cover.
    pub texel_elements: u64,
    /// Bytes of one allocation, and of the largest device-local heap.
    pub allocation: u64,
    pub heap: u64,
    /// Bindings one kernel may have.
    pub stage_storage_buffers: u32,
    pub stage_texel_buffers: u32,
    pub stage_resources: u32,
    /// Workgroups along x in one dispatch, and invocations in a workgroup.
    pub group_count: u32,
    pub group_invocations: u32,
    /// Nanoseconds of one tick of the device's clock; 0 if its compute queue has none.
    pub timestamp_ns: f64,
    /// Bits of that clock that count.
    pub timestamp_bits: u32,
}

/// One physical device.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DeviceInfo {
    /// Place in the driver's list; what `--device N` means.
    pub index: usize,
    pub name: String,
    pub kind: DeviceKind,
    pub driver: String,
    pub driver_version: String,
    pub vulkan_version: String,
    /// UUIDs in hexadecimal: what the strictness probe's result is kept under.
    pub device_uuid: String,
    pub driver_uuid: String,
    pub subgroup_size: u32,
    pub subgroup_ballot: bool,
    /// Execution modes for 32-bit floats that the device promises (DESIGN: strict rule 1).
    #[serde(serialize_with = "float_controls_as_words")]
    pub float_controls: FloatControls,
    pub limits: Limits,
    /// Why it cannot be used; empty if it can.
    pub missing: Vec<String>,
    /// Queue family that is used.
    #[serde(skip)]
    pub(super) queue_family: u32,
    #[serde(skip)]
    pub(super) portability_subset: bool,
}

impl DeviceInfo {
    pub fn is_usable(&self) -> bool {
        self.missing.is_empty()
    }

    /// True if a kernel that fetches a small scene through texel buffers can be bound.
    pub fn can_fetch_texel(&self) -> bool {
        self.limits.stage_storage_buffers >= TEXEL_FETCH_STORAGE_BUFFERS
            && self.limits.stage_texel_buffers >= TEXEL_FETCH_TEXEL_BUFFERS
    }

    /// True if a kernel that fetches a small scene through storage buffers can be bound.
    pub fn can_fetch_storage(&self) -> bool {
        self.limits.stage_storage_buffers >= STORAGE_FETCH_STORAGE_BUFFERS
    }
}

impl fmt::Display for DeviceInfo {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}, {} {}", self.name, self.driver, self.driver_version)
    }
}

/// "1.2.3" of a packed Vulkan version.
pub(super) fn version_text(version: u32) -> String {
    let (major, minor) = (vk::api_version_major(version), vk::api_version_minor(version));
    format!("{major}.{minor}.{}", vk::api_version_patch(version))
}

fn text(name: &[std::ffi::c_char]) -> String {
    // SAFETY: c_char and u8 have the same size, and a slice stays a slice.
    let bytes = unsafe { std::slice::from_raw_parts(name.as_ptr().cast::<u8>(), name.len()) };
    CStr::from_bytes_until_nul(bytes).map(|text| text.to_string_lossy().into_owned()).unwrap_or_default()
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Asks the driver about one device. Nothing is created.
pub(super) fn describe(instance: &Instance, index: usize, physical: vk::PhysicalDevice) -> DeviceInfo {
    let raw = &instance.raw;
    // SAFETY: `physical` came from this instance, here and below.
    let properties = unsafe { raw.get_physical_device_properties(physical) };
    let mut info = DeviceInfo {
        index,
        name: text(&properties.device_name),
        kind: match properties.device_type {
            vk::PhysicalDeviceType::DISCRETE_GPU => DeviceKind::Discrete,
            vk::PhysicalDeviceType::INTEGRATED_GPU => DeviceKind::Integrated,
            vk::PhysicalDeviceType::VIRTUAL_GPU => DeviceKind::Virtual,
            vk::PhysicalDeviceType::CPU => DeviceKind::Cpu,
            _ => DeviceKind::Other,
        },
        driver: String::new(),
        driver_version: String::new(),
        vulkan_version: version_text(properties.api_version),
        device_uuid: String::new(),
        driver_uuid: String::new(),
        subgroup_size: 0,
        subgroup_ballot: false,
        float_controls: FloatControls::default(),
        limits: Limits::default(),
        missing: Vec::new(),
        queue_family: 0,
        portability_subset: false,
    };
    if properties.api_version < vk::API_VERSION_1_2 {
        info.missing.push(format!(
            "Vulkan {} only; the kernels are built for Vulkan 1.2 and its SPIR-V 1.5",
            info.vulkan_version
        ));
        return info;
    }
    describe_1_2(instance, physical, &mut info);
    info
}

fn describe_1_2(instance: &Instance, physical: vk::PhysicalDevice, info: &mut DeviceInfo) {
    let raw = &instance.raw;
    let mut vulkan_1_1 = vk::PhysicalDeviceVulkan11Properties::default();
    let mut vulkan_1_2 = vk::PhysicalDeviceVulkan12Properties::default();
    let mut properties = vk::PhysicalDeviceProperties2::default().push_next(&mut vulkan_1_1).push_next(&mut vulkan_1_2);
    let mut features_1_2 = vk::PhysicalDeviceVulkan12Features::default();
    let mut features = vk::PhysicalDeviceFeatures2::default().push_next(&mut features_1_2);
    // SAFETY: `physical` is of this instance and knows Vulkan 1.2, so it fills these structures.
    let (memory, families, extensions) = unsafe {
        raw.get_physical_device_properties2(physical, &mut properties);
        raw.get_physical_device_features2(physical, &mut features);
        (
            raw.get_physical_device_memory_properties(physical),
            raw.get_physical_device_queue_family_properties(physical),
            raw.enumerate_device_extension_properties(physical).unwrap_or_default(),
        )
    };
    let limits = properties.properties.limits;
    info.portability_subset = extensions
        .iter()
        .any(|extension| extension.extension_name_as_c_str() == Ok(ash::khr::portability_subset::NAME));
    info.driver = text(&vulkan_1_2.driver_name);
    info.driver_version = text(&vulkan_1_2.driver_info);
    info.device_uuid = hex(&vulkan_1_1.device_uuid);
    info.driver_uuid = hex(&vulkan_1_1.driver_uuid);
    info.subgroup_size = vulkan_1_1.subgroup_size;
    info.subgroup_ballot = vulkan_1_1.subgroup_supported_stages.contains(vk::ShaderStageFlags::COMPUTE)
        && vulkan_1_1.subgroup_supported_operations.contains(vk::SubgroupFeatureFlags::BALLOT);
    info.float_controls = float_controls(&vulkan_1_2);

    // A queue with a clock if there is one: stages are then timed on the device.
    let compute = |family: &&(u32, &vk::QueueFamilyProperties)| family.1.queue_flags.contains(vk::QueueFlags::COMPUTE);
    let numbered: Vec<_> = (0..).zip(&families).collect();
    let family = numbered.iter().filter(compute).find(|family| family.1.timestamp_valid_bits > 0);
    let family = family.or_else(|| numbered.iter().find(compute));
    let timestamp_bits = family.map_or(0, |family| family.1.timestamp_valid_bits);
    match family {
        Some((number, _)) => info.queue_family = *number,
        None => info.missing.push("no compute queue; every kernel is a compute shader".to_owned()),
    }

    let local =
        memory.memory_heaps_as_slice().iter().filter(|heap| heap.flags.contains(vk::MemoryHeapFlags::DEVICE_LOCAL));
    info.limits = Limits {
        storage_range: limits.max_storage_buffer_range.into(),
        texel_elements: limits.max_texel_buffer_elements.into(),
        allocation: vulkan_1_1.max_memory_allocation_size,
        heap: local.map(|heap| heap.size).max().unwrap_or(0),
        stage_storage_buffers: limits
            .max_per_stage_descriptor_storage_buffers
            .min(limits.max_descriptor_set_storage_buffers),
        stage_texel_buffers: limits
            .max_per_stage_descriptor_sampled_images
            .min(limits.max_descriptor_set_sampled_images),
        stage_resources: limits.max_per_stage_resources,
        group_count: limits.max_compute_work_group_count[0],
        group_invocations: limits.max_compute_work_group_invocations.min(limits.max_compute_work_group_size[0]),
        timestamp_ns: if timestamp_bits > 0 { limits.timestamp_period.into() } else { 0.0 },
        timestamp_bits,
    };
    if features_1_2.scalar_block_layout == vk::FALSE {
        info.missing.push("no scalarBlockLayout; records lie in buffers as in Rust's repr(C)".to_owned());
    }
    missing_limits(info);
}

fn missing_limits(info: &mut DeviceInfo) {
    let limits = info.limits;
    if limits.group_invocations < 64 {
        info.missing.push(format!("workgroups of {} at most; the kernels use 64", limits.group_invocations));
    }
    let enough = if info.can_fetch_storage() {
        STORAGE_FETCH_STORAGE_BUFFERS
    } else {
        TEXEL_FETCH_STORAGE_BUFFERS + TEXEL_FETCH_TEXEL_BUFFERS
    };
    if !info.can_fetch_storage() && !info.can_fetch_texel() {
        info.missing.push(format!(
            "{} storage and {} texel buffers per kernel at most; the scene's pages and the queues need {} and {}, or {} and none",
            limits.stage_storage_buffers,
            limits.stage_texel_buffers,
            TEXEL_FETCH_STORAGE_BUFFERS,
            TEXEL_FETCH_TEXEL_BUFFERS,
            STORAGE_FETCH_STORAGE_BUFFERS,
        ));
    } else if limits.stage_resources < enough {
        info.missing.push(format!(
            "{} bindings per kernel at most; the scene's pages and the queues need {enough}",
            limits.stage_resources
        ));
    }
}

fn float_controls(properties: &vk::PhysicalDeviceVulkan12Properties) -> FloatControls {
    // Where widths may not differ at all, a module that sets a mode for 32 bits alone is not allowed.
    let free = |independence| independence != vk::ShaderFloatControlsIndependence::NONE;
    FloatControls {
        rounding_rte: properties.shader_rounding_mode_rte_float32 == vk::TRUE
            && free(properties.rounding_mode_independence),
        signed_zero_inf_nan_preserve: properties.shader_signed_zero_inf_nan_preserve_float32 == vk::TRUE,
        denorm_preserve: properties.shader_denorm_preserve_float32 == vk::TRUE
            && free(properties.denorm_behavior_independence),
    }
}

fn float_controls_as_words<S: serde::Serializer>(controls: &FloatControls, to: S) -> Result<S::Ok, S::Error> {
    to.collect_seq(float_control_names(*controls))
}

/// The execution modes as SPIR-V calls them.
pub fn float_control_names(controls: FloatControls) -> Vec<&'static str> {
    let FloatControls { rounding_rte, signed_zero_inf_nan_preserve, denorm_preserve } = controls;
    [
        (rounding_rte, "RoundingModeRTE"),
        (signed_zero_inf_nan_preserve, "SignedZeroInfNanPreserve"),
        (denorm_preserve, "DenormPreserve"),
    ]
    .into_iter()
    .filter_map(|(offered, name)| offered.then_some(name))
    .collect()
}

/// Which device the user means.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum DeviceChoice {
    /// The first usable one by kind: discrete, integrated, virtual, cpu.
    #[default]
    Auto,
    Index(usize),
    Kind(DeviceKind),
    /// Part of the name, in any case.
    Name(String),
}

impl FromStr for DeviceChoice {
    type Err = std::convert::Infallible;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        Ok(match text {
            "auto" => DeviceChoice::Auto,
            "discrete" => DeviceChoice::Kind(DeviceKind::Discrete),
            "integrated" => DeviceChoice::Kind(DeviceKind::Integrated),
            "virtual" => DeviceChoice::Kind(DeviceKind::Virtual),
            "cpu" | "software" => DeviceChoice::Kind(DeviceKind::Cpu),
            _ => match text.parse() {
                Ok(index) => DeviceChoice::Index(index),
                Err(_) => DeviceChoice::Name(text.to_owned()),
            },
        })
    }
}

impl DeviceChoice {
    /// Picks from the driver's list; the error says what there is, or what the device lacks.
    pub fn pick<'a>(&self, devices: &'a [DeviceInfo]) -> Result<&'a DeviceInfo, RenderError> {
        let matches = |device: &&DeviceInfo| match self {
            DeviceChoice::Auto => true,
            DeviceChoice::Index(index) => device.index == *index,
            DeviceChoice::Kind(kind) => device.kind == *kind,
            DeviceChoice::Name(part) => device.name.to_lowercase().contains(&part.to_lowercase()),
        };
        let mut fitting: Vec<_> = devices.iter().filter(matches).collect();
        fitting.sort_by_key(|device| device.kind.preference());
        if let Some(device) = fitting.iter().find(|device| device.is_usable()) {
            return Ok(device);
        }
        if let Some(device) = fitting.first() {
            return Err(RenderError::NoDevice(format!(
                "Vulkan device {} ({}) cannot be used: {}",
                device.index,
                device.name,
                device.missing.join("; ")
            )));
        }
        let there: Vec<_> = devices.iter().map(|device| format!("{} ({})", device.index, device.name)).collect();
        let there = if there.is_empty() { "none".to_owned() } else { there.join(", ") };
        Err(RenderError::NoDevice(match self {
            DeviceChoice::Auto => "no Vulkan device on this machine".to_owned(),
            DeviceChoice::Index(index) => format!("no Vulkan device {index}; there are: {there}"),
            DeviceChoice::Kind(kind) => {
                format!("no Vulkan device of kind {kind}; there are: {there}")
            }
            DeviceChoice::Name(part) => {
                format!("no Vulkan device with \"{part}\" in its name; there are: {there}")
            }
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn device(index: usize, name: &str, kind: DeviceKind, missing: &[&str]) -> DeviceInfo {
        DeviceInfo {
            index,
            name: name.to_owned(),
            kind,
            driver: "driver".to_owned(),
            driver_version: "1".to_owned(),
            vulkan_version: "1.2.0".to_owned(),
            device_uuid: String::new(),
            driver_uuid: String::new(),
            subgroup_size: 32,
            subgroup_ballot: true,
            float_controls: FloatControls::default(),
            limits: Limits::default(),
            missing: missing.iter().map(|&text| text.to_owned()).collect(),
            queue_family: 0,
            portability_subset: false,
        }
    }

    fn machine() -> Vec<DeviceInfo> {
        vec![
            device(0, "llvmpipe (LLVM 15)", DeviceKind::Cpu, &[]),
            device(1, "Old Card 9", DeviceKind::Discrete, &["no scalarBlockLayout"]),
            device(2, "Iris Graphics", DeviceKind::Integrated, &[]),
            device(3, "GeForce 4070", DeviceKind::Discrete, &[]),
        ]
    }

    fn picked(text: &str, devices: &[DeviceInfo]) -> Result<usize, String> {
        let Ok(choice) = text.parse::<DeviceChoice>();
        choice.pick(devices).map(|device| device.index).map_err(|error| error.to_string())
    }

    #[test]
    fn auto_prefers_a_discrete_device_that_can_be_used() {
        let devices = machine();
        assert_eq!(picked("auto", &devices), Ok(3));
        assert_eq!(picked("auto", &devices[..3]), Ok(2));
        assert_eq!(picked("auto", &devices[..1]), Ok(0));
    }

    #[test]
    fn a_device_is_chosen_by_index_by_part_of_its_name_and_by_kind() {
        let devices = machine();
        for (text, index) in [("0", 0), ("LLVMpipe", 0), ("iris", 2), ("discrete", 3), ("integrated", 2), ("cpu", 0)] {
            assert_eq!(picked(text, &devices), Ok(index), "{text}");
        }
    }

    #[test]
    fn a_choice_that_nothing_fits_lists_what_there_is() {
        let devices = machine();
        let there = "0 (llvmpipe (LLVM 15)), 1 (Old Card 9), 2 (Iris Graphics), 3 (GeForce 4070)";
        assert_eq!(picked("7", &devices), Err(format!("no Vulkan device 7; there are: {there}")));
        let name = picked("Radeon", &devices);
        assert_eq!(name, Err(format!("no Vulkan device with \"Radeon\" in its name; there are: {there}")));
        assert_eq!(picked("virtual", &devices), Err(format!("no Vulkan device of kind virtual; there are: {there}")));
        assert_eq!(picked("auto", &[]), Err("no Vulkan device on this machine".to_owned()));
    }

    #[test]
    fn a_chosen_device_that_lacks_something_says_what() {
        let error = picked("old", &machine());
        assert_eq!(error, Err("Vulkan device 1 (Old Card 9) cannot be used: no scalarBlockLayout".to_owned()));
    }

    #[test]
    fn a_device_with_few_bindings_is_refused_with_the_numbers() {
        let mut small = device(0, "small", DeviceKind::Other, &[]);
        small.limits = Limits {
            group_invocations: 128,
            stage_storage_buffers: 4,
            stage_texel_buffers: 16,
            stage_resources: 128,
            ..Limits::default()
        };
        missing_limits(&mut small);
        assert_eq!(small.missing.len(), 1);
        assert!(small.missing[0].starts_with("4 storage and 16 texel buffers per kernel"), "{:?}", small.missing);
        small.missing.clear();
        small.limits = Limits {
            stage_storage_buffers: TEXEL_FETCH_STORAGE_BUFFERS,
            stage_texel_buffers: TEXEL_FETCH_TEXEL_BUFFERS,
            ..small.limits
        };
        missing_limits(&mut small);
        assert_eq!(small.missing, [""; 0]);
        assert!(small.can_fetch_texel() && !small.can_fetch_storage());
    }
}
