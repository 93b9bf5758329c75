//! `gonio verify --functions`: every function that exists in Rust and in GLSL, on a device.

use super::setup::{BackendFlags, BackendName};
use super::{Usage, drivers};
use crate::render::vulkan::{Context, DeviceChoice};
use crate::verify::report::{Outcome, Row};
use crate::verify::twins::{FAMILIES, compare};
use std::time::Instant;

/// Where the random arguments start; neither the tests' seed nor the strictness probe's.
const SEED: u32 = 3;

/// A row for each function whose name is `wanted`, compared on `count` sets of arguments.
pub fn run(count: u32, flags: &BackendFlags, wanted: impl Fn(&str) -> bool) -> anyhow::Result<Vec<Row>> {
    if flags.backend == BackendName::Cpu {
        return Err(Usage(
            "--functions compares a Vulkan device with the CPU: --backend cpu leaves nothing".to_owned(),
        )
        .into());
    }
    let Ok(choice) = flags.device.as_deref().unwrap_or("auto").parse::<DeviceChoice>();
    drivers::ready();
    let mut context = Context::new(&choice, false)?;
    let mut rows = Vec::new();
    for family in FAMILIES {
        for (number, twin) in family.twins.iter().enumerate().filter(|(_, twin)| wanted(twin.name)) {
            let start = Instant::now();
            let (differ, first) = compare(&mut context, family, number, count as usize, SEED)?;
            let first = first.map_or(String::new(), |first| format!("; {first}"));
            let row = Row {
                proof: "functions",
                subject: twin.name.to_owned(),
                backend: context.info().to_string(),
                outcome: if differ == 0 { Outcome::Proved } else { Outcome::Unproved },
                finding: format!("{differ} of {count} differ{first}"),
                measures: serde_json::json!({ "differ": differ, "count": count }),
                seconds: start.elapsed().as_secs_f64(),
            };
            log::info!("{}: {}", row.subject, row.finding);
            rows.push(row);
        }
    }
    Ok(rows)
}
