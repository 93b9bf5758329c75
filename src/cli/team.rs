//! `--device`: one device, a list, or all.

use super::Usage;
use super::setup::{BackendFlags, BackendName};
use crate::bake::SceneData;
use crate::render::RenderError;
use crate::render::team::Member;
use crate::render::vulkan::{DeviceChoice, DeviceInfo, Instance};

/// What `--device` calls the CPU backend.
pub const CPU: &str = "cpu";
/// What it calls everything there is.
pub const ALL: &str = "all";

/// The renderers that the flags ask for.
pub fn members<'a>(flags: &BackendFlags, data: &'a SceneData) -> anyhow::Result<Vec<Member<'a>>> {
    let one = || vec![member(flags.clone(), data)];
    let Some(text) = flags.device.as_deref().filter(|text| *text == ALL || text.contains(',')) else {
        return Ok(one());
    };
    if flags.backend == BackendName::Cpu {
        return Err(Usage(format!("--device {text} cannot be used with --backend cpu")).into());
    }
    let found = Instance::new(false).and_then(|instance| instance.devices());
    let names = match (text, &found) {
        (ALL, Ok(devices)) => everything(devices, flags.backend),
        (ALL, Err(error)) if flags.backend == BackendName::Auto => {
            log::warn!("{error}: using the CPU backend alone");
            vec![CPU.to_owned()]
        }
        // Some devices have a comma in their name.
        (_, Ok(devices)) if devices.iter().any(|device| device.name.contains(text)) => return Ok(one()),
        _ => text.split(',').map(|name| name.trim().to_owned()).collect(),
    };
    if names.is_empty() {
        return Err(RenderError::NoDevice("no Vulkan device of this machine can be used".to_owned()).into());
    }
    let mut members = Vec::new();
    let mut taken: Vec<String> = Vec::new();
    for name in names {
        let is_cpu = name == CPU && flags.backend == BackendName::Auto;
        let (backend, device) = if is_cpu {
            (BackendName::Cpu, CPU.to_owned())
        } else {
            let devices = found.as_deref().map_err(|error| RenderError::NoDevice(error.to_string()))?;
            let Ok(choice) = name.parse::<DeviceChoice>();
            (BackendName::Vulkan, choice.pick(devices).map_err(RenderError::from)?.index.to_string())
        };
        if taken.contains(&device) {
            return Err(Usage(format!("--device {text}: \"{name}\" is device {device}, which is named already")).into());
        }
        taken.push(device.clone());
        members.push(member(BackendFlags { backend, device: Some(device), ..flags.clone() }, data));
    }
    Ok(members)
}

/// Names of all devices that can be used, and of the CPU backend.
fn everything(devices: &[DeviceInfo], backend: BackendName) -> Vec<String> {
    let usable = devices.iter().filter(|device| device.is_usable()).map(|device| device.index.to_string());
    usable.chain((backend == BackendName::Auto).then(|| CPU.to_owned())).collect()
}

/// The one renderer that `flags` ask for.
fn member(flags: BackendFlags, data: &SceneData) -> Member<'_> {
    let name = flags.device.clone().map_or_else(|| "the renderer".to_owned(), |name| format!("device {name}"));
    Member { name, open: Box::new(move || flags.renderer(data)) }
}
