//! From flags to the devices of a session: `--backend` and `--device`, which names one device, a list, or all.

use super::setup::{BackendFlags, BackendName};
use super::{Usage, drivers, exact};
use crate::bake::SceneData;
use crate::film::Film;
use crate::render::RenderError;
use crate::render::cpu::CpuRenderer;
use crate::render::session::{Member, Session};
use crate::render::vulkan::{DeviceChoice, DeviceInfo, DeviceKind, Instance, VulkanRenderer};
use serde_json::Value;
use std::sync::OnceLock;

/// What `--device` calls the CPU backend.
pub const CPU: &str = "cpu";
/// What it calls everything there is.
pub const ALL: &str = "all";

/// A session with the devices that the flags ask for.
pub fn session<'a>(flags: &BackendFlags, data: &'a SceneData, film: Film) -> anyhow::Result<Session<'a>> {
    let is_open = flags.backend == BackendName::Auto && flags.device.is_none();
    // What nobody chose is made up for when it fails.
    let (members, reserve) = match is_open.then(best_gpu).flatten() {
        Some(index) => {
            let device = Some(index.to_string());
            let gpu = BackendFlags { backend: BackendName::Vulkan, device, ..flags.clone() };
            (vec![member(gpu, data)], Some(cpu_member(flags, data)))
        }
        None => (members(flags, data)?, None),
    };
    Ok(Session::new(film, members).with_reserve(reserve))
}

/// Index of the GPU that suits best. Software devices share the processor with the CPU backend, and have to compile first.
fn best_gpu() -> Option<usize> {
    static FOUND: OnceLock<Option<usize>> = OnceLock::new();
    *FOUND.get_or_init(|| {
        // Where the drivers know of no GPU, this process needs none of them.
        let answer = &drivers::ready().answer;
        let is_gpu = |device: &Value| device["usable"] == true && device["kind"] != DeviceKind::Cpu.to_string();
        if !answer["devices"].as_array().is_some_and(|devices| devices.iter().any(is_gpu)) {
            answer["problem"].as_str().into_iter().for_each(|problem| log::info!("{problem}"));
            return None;
        }
        let found = Instance::new(false).and_then(|instance| instance.devices());
        let devices = found.unwrap_or_else(|error| {
            log::info!("{error}");
            Vec::new()
        });
        let is_gpu = |device: &DeviceInfo| device.is_usable() && device.kind != DeviceKind::Cpu;
        let gpus: Vec<DeviceInfo> = devices.into_iter().filter(is_gpu).collect();
        DeviceChoice::Auto.pick(&gpus).ok().map(|device| device.index)
    })
}

/// The renderers that the flags ask for.
fn members<'a>(flags: &BackendFlags, data: &'a SceneData) -> anyhow::Result<Vec<Member<'a>>> {
    let one = || vec![member(flags.clone(), data)];
    let Some(text) = flags.device.as_deref().filter(|text| *text == ALL || text.contains(',')) else {
        return Ok(one());
    };
    if flags.backend == BackendName::Cpu {
        return Err(Usage(format!("--device {text} cannot be used with --backend cpu")).into());
    }
    drivers::ready();
    let found = Instance::new(false).and_then(|instance| instance.devices());
    let names = match (text, &found) {
        (ALL, Ok(devices)) => all_of(devices, flags.backend),
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
            (BackendName::Vulkan, choice.pick(devices)?.index.to_string())
        };
        if taken.contains(&device) {
            return Err(Usage(format!("--device {text}: \"{name}\" is device {device}, which is named already")).into());
        }
        taken.push(device.clone());
        members.push(member(BackendFlags { backend, device: Some(device), ..flags.clone() }, data));
    }
    Ok(members)
}

/// Names of all devices worth using, and of the CPU backend. Says which are left out.
fn all_of(devices: &[DeviceInfo], backend: BackendName) -> Vec<String> {
    let usable: Vec<_> =
        devices.iter().filter(|device| device.is_usable()).map(|device| (device.index, device.kind)).collect();
    let names = everything(&usable, backend);
    for (index, _) in usable.iter().filter(|(index, _)| !names.contains(&index.to_string())) {
        let why = "a software device shares the processor with the CPU backend, and is used if it is named";
        log::info!("device {index} is left out of \"all\": {why}");
    }
    names
}

/// Numbers of `devices` and the CPU backend, but no software device beside it: both would want the same processor.
fn everything(devices: &[(usize, DeviceKind)], backend: BackendName) -> Vec<String> {
    let with_cpu = backend == BackendName::Auto;
    let has_card = devices.iter().any(|(_, kind)| *kind != DeviceKind::Cpu);
    let worth = |kind: DeviceKind| kind != DeviceKind::Cpu || !(with_cpu || has_card);
    let chosen = devices.iter().filter(|(_, kind)| worth(*kind)).map(|(index, _)| index.to_string());
    chosen.chain(with_cpu.then(|| CPU.to_owned())).collect()
}

/// The one renderer that `flags` ask for: a Vulkan device proved exact or warned of, or the CPU backend, which is exact by
/// definition.
fn member(flags: BackendFlags, data: &SceneData) -> Member<'_> {
    let is_cpu = match flags.backend {
        BackendName::Cpu => true,
        BackendName::Vulkan => false,
        BackendName::Auto => flags.device.as_deref().is_none_or(|device| device == CPU),
    };
    if is_cpu {
        return cpu_member(&flags, data);
    }
    let name = flags.device.clone().map_or_else(|| "the Vulkan device".to_owned(), |name| format!("device {name}"));
    let open = move || {
        drivers::ready();
        let mut renderer = VulkanRenderer::new(data, flags.vulkan_options())?;
        exact::check(renderer.context_mut(), flags.require_exact)?;
        Ok(Box::new(renderer) as _)
    };
    Member::new(name, Box::new(open))
}

fn cpu_member<'a>(flags: &BackendFlags, data: &'a SceneData) -> Member<'a> {
    let threads = flags.threads;
    Member::new("the CPU backend", Box::new(move || Ok(Box::new(CpuRenderer::new(data, threads)?) as _)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_is_every_card_and_the_cpu_backend_but_no_software_device_beside_it() {
        use DeviceKind::{Cpu, Discrete, Integrated};
        let (auto, vulkan) = (BackendName::Auto, BackendName::Vulkan);
        let machine = [(0, Cpu), (1, Discrete), (2, Integrated)];
        assert_eq!(everything(&machine, auto), ["1", "2", CPU]);
        assert_eq!(everything(&machine, vulkan), ["1", "2"]);
        assert_eq!(everything(&machine[..1], auto), [CPU]);
        // Without the CPU backend nobody shares the processor with it.
        assert_eq!(everything(&machine[..1], vulkan), ["0"]);
        assert_eq!(everything(&[], auto), [CPU]);
        assert_eq!(everything(&[], vulkan), [""; 0]);
    }
}
