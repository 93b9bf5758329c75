//! `gonio devices`: what can be used, and why the rest cannot.

use super::ExitCode;
use super::drivers::{self, Question};
use crate::render::RenderError;
use crate::render::vulkan::{Context as Device, DeviceInfo, Instance};
use crate::verify::probe::{Cache, Exactness, probe as probe_exactness};
use crate::verify::twins::Mismatch;
use clap::Args;
use serde::Deserialize;
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::io::{self, Write as _};
use std::sync::Arc;

#[derive(Args, Clone, Debug)]
#[command(after_help = "\
Examples:
  gonio devices                                           a table; what is under DEVICE goes after --device
  gonio devices --json                                    everything that is known
  VK_DRIVER_FILES=/path/to/icd.json gonio devices         of one driver only")]
pub struct DevicesArgs {
    /// Print everything that is known as JSON.
    #[arg(long)]
    json: bool,
    /// Ask the drivers in this process and print JSON: all for their devices, or one whether it is exact. A driver may
    /// abort, so the visible command runs a child for each question.
    #[arg(long, hide = true, value_name = "INDEX")]
    probe: Option<Option<usize>>,
}

/// Lists the Vulkan devices and the CPU backend.
pub fn run(args: &DevicesArgs) -> anyhow::Result<ExitCode> {
    if let Some(device) = args.probe {
        return Ok(drivers::answer(device, || device.map_or_else(list, probe))?);
    }
    let prove = |index| drivers::ask(&Question { device: Some(index), ..Question::default() }).answer;
    let answer = with_exactness(drivers::ready().answer.clone(), prove);
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let mut out = io::stdout().lock();
    if args.json {
        let report = json!({
            "vulkan": answer,
            "cpu": { "threads": threads, "usable": true },
        });
        writeln!(out, "{}", serde_json::to_string_pretty(&report)?)?;
    } else {
        write!(out, "{}", table(&Answer::deserialize(answer)?, threads))?;
    }
    Ok(ExitCode::SUCCESS)
}

/// The drivers and their devices, or why there is nothing.
fn found() -> Result<(Arc<Instance>, Vec<DeviceInfo>), RenderError> {
    let instance = Instance::new(false)?;
    let devices = instance.devices()?;
    Ok((instance, devices))
}

/// What the drivers say of their devices.
fn list() -> Value {
    match found() {
        Ok((_, devices)) => {
            let described = devices.iter().map(|info| {
                let mut value = json!(info);
                value["usable"] = json!(info.is_usable());
                value
            });
            json!({ "devices": described.collect::<Vec<_>>(), "problem": null })
        }
        Err(error) => json!({ "devices": [], "problem": error.to_string() }),
    }
}

/// Whether a device is exact: null with a reason where that cannot be told.
fn probe(index: usize) -> Value {
    let asked = found().and_then(|(instance, devices)| {
        let gone = || RenderError::NoDevice("it is no longer there".to_owned());
        let info = devices.into_iter().find(|info| info.index == index).ok_or_else(gone)?;
        probe_exactness(&mut Device::on(instance, info)?, &Cache::user())
    });
    match asked.map(|probed| probed.exactness) {
        Ok(Exactness::Exact) => exactness(Some(true), None, None),
        Ok(Exactness::Inexact(mismatch)) => exactness(Some(false), Some(mismatch), None),
        Err(error) => exactness(None, None, Some(error.to_string())),
    }
}

fn exactness(exact: Option<bool>, inexact: Option<Mismatch>, problem: Option<String>) -> Value {
    json!({ "exact": exact, "inexact": inexact, "exact_problem": problem })
}

/// The list of devices, each that can be used with its exactness, which `prove` asks for.
fn with_exactness(mut answer: Value, prove: impl Fn(usize) -> Result<Value, String>) -> Value {
    for device in answer["devices"].as_array_mut().into_iter().flatten() {
        let index = device["index"].as_u64().filter(|_| device["usable"] == true);
        let found = match index {
            Some(index) => prove(index as usize).unwrap_or_else(|crash| exactness(None, None, Some(crash))),
            None => exactness(None, None, None),
        };
        for (key, value) in found.as_object().into_iter().flatten() {
            device[key] = value.clone();
        }
    }
    answer
}

/// The probe's answer as far as the table shows it.
#[derive(Deserialize)]
struct Answer {
    devices: Vec<Row>,
    problem: Option<String>,
}

#[derive(Deserialize)]
struct Row {
    index: usize,
    name: String,
    kind: String,
    vulkan_version: String,
    driver: String,
    driver_version: String,
    missing: Vec<String>,
    exact: Option<bool>,
    inexact: Option<Mismatch>,
    exact_problem: Option<String>,
}

/// Arguments of an inexact operation that the table shows; the line below it has all of them.
const SHOWN_ARGUMENTS: usize = 3;

impl Row {
    /// "yes", "no (operation, input)", "unknown" where that could not be found out, or "-".
    fn exactness(&self) -> String {
        match (self.exact, &self.inexact) {
            (Some(true), _) => "yes".to_owned(),
            (Some(false), Some(mismatch)) => {
                let arguments = mismatch.arguments.iter().take(SHOWN_ARGUMENTS);
                let mut input: Vec<_> = arguments.map(|word| format!("{:?}", f32::from_bits(*word))).collect();
                if mismatch.arguments.len() > SHOWN_ARGUMENTS {
                    input.push("...".to_owned());
                }
                format!("no ({}, {})", mismatch.twin, input.join(" "))
            }
            (Some(false), None) => "no".to_owned(),
            (None, _) if self.exact_problem.is_some() => "unknown".to_owned(),
            (None, _) => "-".to_owned(),
        }
    }
}

/// Devices by index, the CPU backend last, and below them the reasons.
fn table(answer: &Answer, threads: usize) -> String {
    let mut rows = vec![["DEVICE", "NAME", "KIND", "VULKAN", "DRIVER", "USABLE", "EXACT"].map(str::to_owned)];
    for row in &answer.devices {
        rows.push([
            row.index.to_string(),
            row.name.clone(),
            row.kind.clone(),
            row.vulkan_version.clone(),
            format!("{} {}", row.driver, row.driver_version).trim().to_owned(),
            if row.missing.is_empty() { "yes" } else { "no" }.to_owned(),
            row.exactness(),
        ]);
    }
    let unit = if threads == 1 { "thread" } else { "threads" };
    rows.push(["cpu", "", "cpu", "-", "-", "yes", "yes"].map(str::to_owned));
    if let Some(row) = rows.last_mut() {
        row[1] = format!("the CPU backend ({threads} {unit})");
    }
    let width = |column: usize| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let widths = [0, 1, 2, 3, 4, 5].map(width);
    let mut text = String::new();
    for row in &rows {
        for (cell, width) in row.iter().zip(widths) {
            let _ = write!(text, "{cell:width$}  ");
        }
        let _ = writeln!(text, "{}", row[6]);
    }
    for row in &answer.devices {
        for reason in &row.missing {
            let _ = writeln!(text, "device {} cannot be used: {reason}", row.index);
        }
        if let Some(mismatch) = &row.inexact {
            let _ = writeln!(text, "device {} is not exact: {mismatch}", row.index);
        }
        if let Some(problem) = &row.exact_problem {
            let _ = writeln!(text, "device {} may be exact or not: {problem}", row.index);
        }
    }
    if let Some(problem) = &answer.problem {
        let _ = writeln!(text, "{problem}");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_lines_up_and_gives_the_reasons_below() {
        let answer = json!({
            "devices": [
                { "index": 0, "name": "Soft", "kind": "cpu", "vulkan_version": "1.3.0", "driver": "lava", "driver_version": "2", "missing": [],
                  "exact": false, "exact_problem": null,
                  "inexact": { "twin": "div", "arguments": [0x3f80_0000u32, 0x4000_0000u32], "cpu": [0x3f00_0000u32], "device": [0u32] } },
                { "index": 1, "name": "Old Card", "kind": "discrete", "vulkan_version": "1.1.0", "driver": "", "driver_version": "",
                  "missing": ["Vulkan 1.1.0 only"], "exact": null, "inexact": null, "exact_problem": null },
            ],
            "problem": null,
        });
        let text = table(&Answer::deserialize(answer).unwrap(), 2);
        let expected = "\
DEVICE  NAME                         KIND      VULKAN  DRIVER  USABLE  EXACT
0       Soft                         cpu       1.3.0   lava 2  yes     no (div, 1.0 2.0)
1       Old Card                     discrete  1.1.0           no      -
cpu     the CPU backend (2 threads)  cpu       -       -       yes     yes
device 0 is not exact: div(1.0 (0x3f800000), 2.0 (0x40000000)): cpu 0.5 (0x3f000000), device 0.0 (0x00000000)
device 1 cannot be used: Vulkan 1.1.0 only
";
        assert_eq!(text, expected);
    }

    #[test]
    fn where_no_driver_answers_the_cpu_backend_is_still_listed() {
        let answer = json!({ "devices": [], "problem": "a Vulkan driver crashed" });
        let text = table(&Answer::deserialize(answer).unwrap(), 1);
        assert!(text.contains("the CPU backend (1 thread)") && text.ends_with("a Vulkan driver crashed\n"), "{text}");
    }

    #[test]
    fn a_device_whose_driver_aborts_is_listed_with_its_neighbours() {
        let device = |index: usize, name: &str| {
            json!({ "index": index, "name": name, "kind": "cpu", "vulkan_version": "1.3.0", "driver": "d", "driver_version": "2",
                    "missing": [], "usable": true })
        };
        let answer = json!({ "devices": [device(0, "Wild"), device(1, "Tame")], "problem": null });
        let prove = |index| match index {
            0 => Err("it crashed".to_owned()),
            _ => Ok(exactness(Some(true), None, None)),
        };
        let text = table(&Answer::deserialize(with_exactness(answer, prove)).unwrap(), 1);
        assert!(
            text.contains("\n0       Wild                        cpu   1.3.0   d 2     yes     unknown\n"),
            "{text}"
        );
        assert!(text.contains("\n1       Tame                        cpu   1.3.0   d 2     yes     yes\n"), "{text}");
        assert!(text.contains("\ndevice 0 may be exact or not: it crashed\n"), "{text}");
    }
}
