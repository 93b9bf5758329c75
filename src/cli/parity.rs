//! `gonio parity`: the same samples on two backends, bit for bit.

use super::setup::{BackendFlags, BackendName, FetchName, SceneFlags, bake_scene_with, film_of, thread_count};
use super::sheet::Sheet;
use super::{EXIT_DIFFERS, Usage, render, team};
use crate::bake::{Baker, SceneData};
use crate::film::{Film, Rect};
use crate::render::session::Session;
use crate::render::{Bounce, RenderError};
use crate::scene::Scene;
use crate::watch::Watch;
use anyhow::Context;
use clap::Args;
use std::collections::BTreeMap;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::str::FromStr;

#[derive(Args)]
#[command(after_help = "\
Examples:
  gonio parity scenes/*.toml                              cpu against the Vulkan device, both fetch paths
  gonio parity scene.toml --between vulkan:0,vulkan:1     two devices
  gonio parity scene.toml --json > here.json              hashes, for another machine
  gonio parity scene.toml --expect here.json              against hashes from another machine
Exit code 0: every bit agrees. 1: something differs.")]
pub struct ParityArgs {
    /// Scenes, as for render.
    #[arg(required = true)]
    scenes: Vec<PathBuf>,
    /// Which two or more to compare, the first being the reference: `cpu`, `vulkan`, `vulkan:DEVICE`, `vulkan:DEVICE:FETCH`.
    /// Default: cpu, and the Vulkan device with each fetch path.
    #[arg(long, value_name = "A,B", value_delimiter = ',')]
    between: Vec<Contender>,
    /// Compare film hashes with those recorded in this file (as `--json` writes them) too.
    #[arg(long, value_name = "FILE.json")]
    expect: Option<PathBuf>,
    /// Print the result as JSON.
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    scene_flags: SceneFlags,
    /// The Vulkan device, where --between does not say.
    #[arg(long, value_name = "INDEX|NAME|KIND")]
    device: Option<String>,
    /// One fetch path only, where --between does not say.
    #[arg(long, default_value = "auto")]
    fetch: FetchName,
    /// Threads of the CPU backend.
    #[arg(short, long, value_name = "N", value_parser = thread_count)]
    threads: Option<usize>,
    /// Fail on a Vulkan device that the strictness probe finds inexact, before any scene is compared on it.
    #[arg(long)]
    require_exact: bool,
}

/// One side of a comparison.
#[derive(Clone, Debug)]
pub(super) struct Contender {
    pub label: String,
    pub flags: BackendFlags,
}

impl FromStr for Contender {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let mut parts = text.split(':');
        let backend = match parts.next() {
            Some("cpu") => BackendName::Cpu,
            Some("vulkan") => BackendName::Vulkan,
            _ => return Err("expected cpu, vulkan, vulkan:DEVICE or vulkan:DEVICE:FETCH".to_owned()),
        };
        let mut flags = BackendFlags { backend, ..BackendFlags::default() };
        if flags.backend == BackendName::Vulkan {
            flags.device = parts.next().filter(|name| !name.is_empty()).map(str::to_owned);
            flags.fetch = match parts.next() {
                None => FetchName::Auto,
                Some(name) => clap::ValueEnum::from_str(name, false)
                    .map_err(|_| format!("no fetch path {name:?}: texel or storage"))?,
            };
        }
        match parts.next() {
            None => Ok(Self { label: text.to_owned(), flags }),
            Some(rest) => Err(format!("{rest:?} is one part too many")),
        }
    }
}

/// What comparing one scene found.
#[derive(serde::Serialize)]
struct SceneResult {
    scene: String,
    /// Of a scene with panels.
    #[serde(skip_serializing_if = "Option::is_none")]
    panel: Option<String>,
    width: u32,
    height: u32,
    samples: u32,
    seed: u32,
    film_hash: String,
    comparisons: Vec<Comparison>,
}

#[derive(serde::Serialize)]
struct Comparison {
    reference: String,
    other: String,
    pixels: usize,
    differ: usize,
    /// First differing pixel in reading order.
    #[serde(skip_serializing_if = "Option::is_none")]
    first: Option<Difference>,
}

#[derive(serde::Serialize)]
struct Difference {
    x: u32,
    y: u32,
    /// The first sample, bounce and value that differ, where they can be told apart.
    cause: String,
}

pub fn run(args: &ParityArgs, _quiet: bool) -> anyhow::Result<ExitCode> {
    let contenders = args.contenders();
    if contenders.len() < 2 && args.expect.is_none() {
        return Err(Usage("--between needs two or more".to_owned()).into());
    }
    let expected = args.expect.as_deref().map(read_expected).transpose()?;
    let mut results = Vec::new();
    let mut agree = true;
    for path in &args.scenes {
        let sheet = Sheet::open(&args.scene_flags, path)?;
        let mut baker = sheet.is_divided().then(Baker::default);
        for scene in sheet.scenes() {
            let (label, scene) = scene?;
            let data = bake_scene_with(&scene, baker.as_mut(), &|| false)?;
            let result = args.compare_scene(path, label, &scene, &data, &contenders)?;
            agree &= result.comparisons.iter().all(|comparison| comparison.differ == 0);
            if !args.json {
                print_result(&result)?;
            }
            if let Some(expected) = &expected {
                agree &= check_expected(&result, expected, args.json)?;
            }
            results.push(result);
        }
    }
    if args.json {
        let document = serde_json::json!({ "schema": 1, "gonio": env!("CARGO_PKG_VERSION"), "scenes": results });
        writeln!(std::io::stdout(), "{document:#}")?;
    }
    Ok(if agree { ExitCode::SUCCESS } else { ExitCode::from(EXIT_DIFFERS) })
}

impl ParityArgs {
    fn contenders(&self) -> Vec<Contender> {
        let complete = |mut contender: Contender| {
            contender.flags.threads = self.threads;
            contender.flags.require_exact = self.require_exact;
            if contender.flags.device.is_none() {
                contender.flags.device = self.device.clone();
            }
            contender
        };
        if !self.between.is_empty() {
            return self.between.iter().cloned().map(complete).collect();
        }
        let vulkan = |fetch: FetchName, label: &str| Contender {
            label: label.to_owned(),
            flags: BackendFlags { backend: BackendName::Vulkan, fetch, ..BackendFlags::default() },
        };
        let mut list = vec![Contender {
            label: "cpu".to_owned(),
            flags: BackendFlags { backend: BackendName::Cpu, ..BackendFlags::default() },
        }];
        if self.fetch != FetchName::Storage {
            list.push(vulkan(FetchName::Texel, "vulkan texel"));
        }
        if self.fetch != FetchName::Texel {
            list.push(vulkan(FetchName::Storage, "vulkan storage"));
        }
        list.into_iter().map(complete).collect()
    }

    fn compare_scene(
        &self,
        path: &Path,
        panel: Option<&str>,
        scene: &Scene,
        data: &SceneData,
        contenders: &[Contender],
    ) -> anyhow::Result<SceneResult> {
        let reference = render_all(&contenders[0].flags, scene, data)?;
        let film = reference.snapshot();
        let mut comparisons = Vec::new();
        for contender in &contenders[1..] {
            let session = render_all(&contender.flags, scene, data)?;
            let other = session.snapshot();
            comparisons.push(Comparison {
                reference: contenders[0].label.clone(),
                other: format!("{} ({})", contender.label, session.names().join(" + ")),
                pixels: film.sums().len(),
                differ: film.sums().iter().zip(other.sums()).filter(|(a, b)| a != b).count(),
                first: first_difference(scene, (&film, &reference), (&other, &session))?,
            });
        }
        Ok(SceneResult {
            scene: path.display().to_string(),
            panel: panel.map(str::to_owned),
            width: scene.film.width,
            height: scene.film.height,
            samples: scene.settings.samples,
            seed: scene.settings.seed,
            film_hash: film.hash().to_string(),
            comparisons,
        })
    }
}

/// All samples of the scene.
fn render_all<'a>(flags: &BackendFlags, scene: &Scene, data: &'a SceneData) -> anyhow::Result<Session<'a>> {
    let film = film_of(scene, data, Rect::whole(scene.film.width, scene.film.height));
    let session = team::session(flags, data, film)?;
    session.render(0..scene.settings.samples, &Watch::default())?;
    Ok(session)
}

/// Finds the first pixel in reading order whose sums differ, then the first of its samples with a differing bounce.
fn first_difference(
    scene: &Scene,
    (film, reference): (&Film, &Session),
    (other, session): (&Film, &Session),
) -> Result<Option<Difference>, RenderError> {
    let Some(index) = film.sums().iter().zip(other.sums()).position(|(a, b)| a != b) else {
        return Ok(None);
    };
    let (x, y) = (index as u32 % scene.film.width, index as u32 / scene.film.width);
    for sample in 0..scene.settings.samples {
        let (a, b) = (reference.inspect(x, y, sample)?, session.inspect(x, y, sample)?);
        if let Some(cause) = differing_bounce(&a, &b) {
            return Ok(Some(Difference { x, y, cause: format!("sample {sample}, {cause}") }));
        }
    }
    let (a, b) = (film.sums()[index], other.sums()[index]);
    Ok(Some(Difference { x, y, cause: format!("same rays and hits in every sample; sums {a:?} and {b:?}") }))
}

/// The first bounce of one sample in which two backends differ, as text.
fn differing_bounce(a: &[Bounce], b: &[Bounce]) -> Option<String> {
    for (a, b) in a.iter().zip(b) {
        if bytemuck::bytes_of(&a.path) == bytemuck::bytes_of(&b.path)
            && bytemuck::bytes_of(&a.hit) == bytemuck::bytes_of(&b.hit)
        {
            continue;
        }
        let mut text = Vec::new();
        let _ = render::print_bounce(&mut text, a).and_then(|()| render::print_bounce(&mut text, b));
        return Some(format!("depth {}:\n{}", a.path.depth, String::from_utf8_lossy(&text).trim_end()));
    }
    (a.len() != b.len()).then(|| format!("{} bounces and {}", a.len(), b.len()))
}

/// `1 sample`, `2 samples`.
fn counted(samples: u64) -> String {
    format!("{samples} sample{}", if samples == 1 { "" } else { "s" })
}

/// What follows the name of a scene in messages.
fn panel_suffix(panel: Option<&str>) -> String {
    panel.map_or(String::new(), |label| format!(", panel {label:?}"))
}

fn print_result(result: &SceneResult) -> std::io::Result<()> {
    let mut out = std::io::stdout().lock();
    for comparison in &result.comparisons {
        writeln!(
            out,
            "{}{}: {} of {} pixels differ ({}x{}, {}, seed {}; {} and {})",
            result.scene,
            panel_suffix(result.panel.as_deref()),
            comparison.differ,
            comparison.pixels,
            result.width,
            result.height,
            counted(result.samples.into()),
            result.seed,
            comparison.reference,
            comparison.other
        )?;
        if let Some(first) = &comparison.first {
            writeln!(out, "  first at {},{}: {}", first.x, first.y, first.cause)?;
        }
    }
    Ok(())
}

/// Film hashes by scene file name, panel, size, samples and seed.
type Expected = BTreeMap<String, String>;

fn key(scene: &str, panel: Option<&str>, width: u64, height: u64, samples: u64, seed: u64) -> String {
    let name =
        Path::new(scene).file_name().map_or_else(|| scene.to_owned(), |name| name.to_string_lossy().into_owned());
    format!("{name}{} at {width}x{height}, {}, seed {seed}", panel_suffix(panel), counted(samples))
}

/// Reads what `--json` wrote.
fn read_expected(path: &Path) -> anyhow::Result<Expected> {
    let text = std::fs::read_to_string(path).with_context(|| format!("cannot read {}", path.display()))?;
    let bad = |what: &str| crate::film::FilmError::Bad { file: path.display().to_string(), message: what.to_owned() };
    let document: serde_json::Value = serde_json::from_str(&text).map_err(|error| bad(&error.to_string()))?;
    let scenes = document["scenes"].as_array().ok_or_else(|| bad("no list \"scenes\""))?;
    let entry = |scene: &serde_json::Value| {
        let number = |name: &str| scene[name].as_u64();
        let key = key(
            scene["scene"].as_str()?,
            scene["panel"].as_str(),
            number("width")?,
            number("height")?,
            number("samples")?,
            number("seed")?,
        );
        Some((key, scene["film_hash"].as_str()?.to_owned()))
    };
    scenes.iter().map(|scene| entry(scene).ok_or_else(|| bad("an entry of \"scenes\" lacks a member").into())).collect()
}

/// Whether the reference film has the recorded hash; an unrecorded scene is a difference.
fn check_expected(result: &SceneResult, expected: &Expected, quiet: bool) -> std::io::Result<bool> {
    let panel = result.panel.as_deref();
    let key =
        key(&result.scene, panel, result.width.into(), result.height.into(), result.samples.into(), result.seed.into());
    let (line, same) = match expected.get(&key) {
        Some(hash) if *hash == result.film_hash => (format!("{key}: the recorded hash"), true),
        Some(hash) => (format!("{key}: hash {} differs from the recorded {hash}", result.film_hash), false),
        None => (format!("{key}: no hash recorded"), false),
    };
    match quiet {
        // Standard output is the JSON's.
        true if !same => log::warn!("{line}"),
        true => {}
        false => writeln!(std::io::stdout(), "{line}")?,
    }
    Ok(same)
}
