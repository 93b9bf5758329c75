//! What was measured, as `--json` writes it and `--baseline` reads it.

use super::hierarchy::Size;
use super::rays::RayKind;
use super::stats::{Rate, Runs};
use super::tracer::Setup;
use crate::bake::BakeTimes;
use serde::{Deserialize, Serialize};

/// Changes whenever a member changes its meaning.
pub const SCHEMA: u32 = 1;

/// A whole run of `gonio bench`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Report {
    pub schema: u32,
    /// Version of the program.
    pub gonio: String,
    /// Operating system and processor architecture it was built for.
    pub platform: String,
    /// Hardware threads of the machine.
    pub threads: usize,
    pub warmup: usize,
    pub runs: usize,
    pub backends: Vec<Backend>,
    pub scenes: Vec<SceneReport>,
}

/// One backend under test.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Backend {
    /// What the results call it.
    pub on: String,
    /// "cpu (8 threads)", or device and driver.
    pub name: String,
    /// texel or storage; none for the CPU.
    pub fetch: Option<String>,
    /// All that `gonio devices --json` says of it: driver, version, UUIDs, limits; none for the CPU.
    pub device: Option<serde_json::Value>,
}

/// One scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SceneReport {
    pub scene: String,
    /// The frame whose pixels send the primary rays.
    pub width: u32,
    pub height: u32,
    pub seed: u32,
    pub size: Size,
    /// Seconds to read or make the scene.
    pub load_s: f64,
    pub bake: BakeTimes,
    /// Most bytes of memory the program has had by the end of baking; none where the system does not tell.
    pub peak_bytes: Option<u64>,
    /// Most bytes that baking added to what the program had before, what it made included.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bake_bytes: Option<u64>,
    /// Seconds before the first ray, by device.
    pub setup: Vec<SetupOn>,
    pub rays: Vec<RayReport>,
    pub images: Vec<ImageReport>,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SetupOn {
    pub on: String,
    #[serde(flatten)]
    pub setup: Setup,
}

/// One kind of rays.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RayReport {
    pub kind: RayKind,
    pub rays: u64,
    /// Rays that hit something.
    pub hits: u64,
    pub results: Vec<RunsOn>,
}

/// Whole samples: one a pixel of the frame, with everything that takes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ImageReport {
    pub integrator: String,
    pub samples: u64,
    /// Of one sample a pixel.
    pub film_hash: String,
    pub results: Vec<RunsOn>,
}

/// The timed runs on one backend.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RunsOn {
    pub on: String,
    /// Seconds on the host's clock.
    pub wall_s: Runs,
    /// Seconds on the device's own clock; none where it has none.
    pub device_s: Option<Runs>,
    /// Hits (pixels of an image) that are not those of the CPU's twins, bit for bit.
    pub differ: u64,
    /// The first of them, in words.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub first: Option<String>,
    /// Rays of a dispatch.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dispatch: Option<u32>,
    /// Of an image: the part of each run's time on the host's clock that was in kernels that trace or shade, by timestamps.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub kernel_share: Option<Runs>,
}

impl RunsOn {
    /// The runs that count: the device's clock, where there is one.
    pub fn best(&self) -> &Runs {
        self.device_s.as_ref().unwrap_or(&self.wall_s)
    }

    /// Work a second on that clock.
    pub fn rate(&self, amount: u64) -> Rate {
        Rate::of(amount as f64, self.best())
    }
}

impl Report {
    /// Reads what `--json` wrote; the error is in words.
    pub fn from_json(text: &str) -> Result<Self, String> {
        let value: serde_json::Value = serde_json::from_str(text).map_err(|error| error.to_string())?;
        match value["schema"].as_u64() {
            Some(schema) if schema == u64::from(SCHEMA) => {}
            Some(schema) => return Err(format!("schema {schema}; this program reads schema {SCHEMA}")),
            None => return Err("no number \"schema\": not a result of `gonio bench --json`".to_owned()),
        }
        serde_json::from_value(value).map_err(|error| error.to_string())
    }

    /// Median rate of one row; `what`: a kind of rays or an integrator.
    pub fn rate(&self, scene: &str, what: &str, on: &str) -> Option<f64> {
        let scene = self.scenes.iter().find(|report| report.scene == scene)?;
        let rays = scene.rays.iter().find(|report| report.kind.name() == what);
        let images = scene.images.iter().find(|report| report.integrator == what);
        let rays = rays.map(|report| (report.rays, &report.results));
        let (amount, results) = rays.or_else(|| images.map(|report| (report.samples, &report.results)))?;
        results.iter().find(|result| result.on == on).map(|result| result.rate(amount).median)
    }

    /// Whether every hit and every pixel was the CPU's.
    pub fn is_equal(&self) -> bool {
        self.scenes.iter().all(SceneReport::is_equal)
    }
}

impl SceneReport {
    pub fn is_equal(&self) -> bool {
        let rays = self.rays.iter().flat_map(|report| &report.results);
        rays.chain(self.images.iter().flat_map(|report| &report.results)).all(|result| result.differ == 0)
    }
}

/// Bytes of memory that this program has and the most it has had; none where the system does not tell (Linux does).
fn memory() -> Option<[u64; 2]> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let of = |name| {
        let line = status.lines().find_map(|line| line.strip_prefix(name))?;
        line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok().map(|kib| kib * 1024)
    };
    Some([of("VmRSS:")?, of("VmHWM:")?])
}

/// What `work` gives, the most bytes of memory that this program has had by its end, and the most that `work` added to what
/// the program had before it.
pub fn with_memory<T>(work: impl FnOnce() -> T) -> (T, [Option<u64>; 2]) {
    // From here on the most is counted anew, if the system lets us; if not, it is no less.
    let before = memory();
    let _ = std::fs::write("/proc/self/clear_refs", "5");
    let done = work();
    let after = memory();
    let peak = before.zip(after).map(|([_, before], [_, after])| before.max(after));
    let added = before.zip(after).map(|([had, _], [_, most])| most.saturating_sub(had));
    (done, [peak, added])
}
