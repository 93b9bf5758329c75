//! `gonio parity`: the same samples on two backends, bit for bit.

use super::setup::{
    BackendFlags, BackendName, FetchName, SceneFlags, Size, bake_scene_with, check_film, film_of, thread_count,
};
use super::sheet::Sheet;
use super::{EXIT_DIFFERS, ExitCode, Usage, drivers, render, team};
use crate::bake::{Baker, SceneData};
use crate::film::{Film, Rect};
use crate::render::session::Session;
use crate::render::vulkan::{DeviceChoice, Instance, check_fit};
use crate::render::{Bounce, RenderError};
use crate::scene::Scene;
use crate::watch::Watch;
use anyhow::Context;
use clap::Args;
use std::collections::BTreeMap;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::str::FromStr;

#[derive(Args)]
#[command(after_help = "\
Examples:
  gonio parity scenes/*.toml                              cpu against the Vulkan device, both fetch paths if it has both
  gonio parity scene.toml --between vulkan:0,vulkan:1     two devices
  gonio parity scene.toml --json > here.json              hashes, for another machine
  gonio parity scene.toml --expect here.json              against hashes from another machine, as rendered there
Exit code 0: every bit agrees. 1: something differs.")]
pub struct ParityArgs {
    /// Scenes, as for render.
    #[arg(required = true)]
    scenes: Vec<PathBuf>,
    /// Which two or more to compare, the first being the reference: `cpu`, `vulkan`, `vulkan:DEVICE`, `vulkan:DEVICE:FETCH`.
    /// Default: cpu, and the Vulkan device with each fetch path.
    #[arg(long, value_name = "A,B", value_delimiter = ',')]
    between: Vec<Contender>,
    /// Compare film hashes with those recorded in this file (as `--json` writes them) too. Size, samples and seed are those
    /// of the record unless they are given.
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
    /// Which of the device's ways to fetch could not be compared, and why.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    left_out: Vec<String>,
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
        for flags in args.takes(path, expected.as_ref())? {
            let sheet = Sheet::open(&flags, path)?;
            let mut baker = sheet.is_divided().then(Baker::default);
            for scene in sheet.scenes() {
                let (label, scene) = scene?;
                check_film(&scene, Rect::whole(scene.film.width, scene.film.height))?;
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

    /// How the scene in `path` is to be rendered: as the flags say, and in what they leave open as it was recorded.
    fn takes(&self, path: &Path, expected: Option<&Expected>) -> anyhow::Result<Vec<SceneFlags>> {
        let flags = &self.scene_flags;
        // Standard input can be read once.
        let Some(expected) = expected.filter(|_| path != Path::new("-")) else { return Ok(vec![flags.clone()]) };
        let labels = flags.panels(path)?.labels().to_vec();
        let panels: Vec<Option<String>> = match &flags.panel {
            Some(panel) => vec![Some(panel.clone())],
            None if labels.is_empty() => vec![None],
            None => labels.iter().cloned().map(Some).collect(),
        };
        let mut takes = Vec::new();
        for panel in panels {
            // `--panel` takes a number, too.
            let number = panel.as_ref().and_then(|panel| panel.parse::<usize>().ok());
            let label = panel.as_ref().filter(|panel| labels.contains(panel)).or(number.and_then(|n| labels.get(n)));
            let recorded = expected.takes.iter().filter(|take| {
                take.scene == file_name(path)
                    && take.panel.as_ref() == label
                    && flags.size.is_none_or(|size| size == take.size)
                    && flags.spp.is_none_or(|spp| spp == take.samples)
                    && flags.seed.is_none_or(|seed| seed == take.seed)
            });
            let before = takes.len();
            takes.extend(recorded.map(|take| SceneFlags {
                size: Some(take.size),
                spp: Some(take.samples),
                seed: Some(take.seed),
                panel: panel.clone(),
                ..flags.clone()
            }));
            if takes.len() == before {
                takes.push(SceneFlags { panel, ..flags.clone() });
            }
        }
        Ok(takes)
    }

    fn compare_scene(
        &self,
        path: &Path,
        panel: Option<&str>,
        scene: &Scene,
        data: &SceneData,
        contenders: &[Contender],
    ) -> anyhow::Result<SceneResult> {
        let (contenders, left_out) = self.that_can(contenders, data);
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
            left_out,
        })
    }

    /// Where nobody said what to compare: the contenders whose device can hold the scene, if one can, and of the others the
    /// reason.
    fn that_can<'a>(&self, contenders: &'a [Contender], data: &SceneData) -> (Vec<&'a Contender>, Vec<String>) {
        let all = || contenders.iter().collect();
        if !self.between.is_empty() || self.fetch != FetchName::Auto {
            return (all(), Vec::new());
        }
        let Ok(choice) = self.device.as_deref().unwrap_or("auto").parse::<DeviceChoice>();
        drivers::ready();
        let Ok(devices) = Instance::new(false).and_then(|instance| instance.devices()) else {
            return (all(), Vec::new()); // opening the device says what is wrong
        };
        let Ok(info) = choice.pick(&devices) else { return (all(), Vec::new()) };
        let (mut able, mut left_out) = (Vec::new(), Vec::new());
        for contender in contenders {
            let fits = contender.flags.backend == BackendName::Cpu
                || check_fit(info, data, contender.flags.fetch.into())
                    .map_err(|error| left_out.push(format!("{} left out: {error}", contender.label)))
                    .is_ok();
            able.extend(fits.then_some(contender));
        }
        if able.len() < 2 { (all(), Vec::new()) } else { (able, left_out) }
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
    for reason in &result.left_out {
        writeln!(out, "{}{}: {reason}", result.scene, panel_suffix(result.panel.as_deref()))?;
    }
    Ok(())
}

/// What was recorded.
struct Expected {
    /// Film hashes by `Take::key`.
    hashes: BTreeMap<String, String>,
    takes: Vec<Take>,
}

/// How a scene was rendered.
#[derive(Clone, PartialEq)]
struct Take {
    /// The file's name without its folder.
    scene: String,
    panel: Option<String>,
    size: Size,
    samples: u32,
    seed: u32,
}

impl Take {
    fn key(&self) -> String {
        let Self { scene, size, samples, seed, .. } = self;
        let panel = panel_suffix(self.panel.as_deref());
        format!("{scene}{panel} at {}x{}, {}, seed {seed}", size.width, size.height, counted((*samples).into()))
    }
}

fn file_name(path: &Path) -> String {
    path.file_name().map_or_else(|| path.display().to_string(), |name| name.to_string_lossy().into_owned())
}

/// Reads what `--json` wrote.
fn read_expected(path: &Path) -> anyhow::Result<Expected> {
    let text = std::fs::read_to_string(path).with_context(|| format!("cannot read {}", path.display()))?;
    let bad = |what: &str| crate::film::FilmError::Bad { file: path.display().to_string(), message: what.to_owned() };
    let document: serde_json::Value = serde_json::from_str(&text).map_err(|error| bad(&error.to_string()))?;
    let scenes = document["scenes"].as_array().ok_or_else(|| bad("no list \"scenes\""))?;
    let entry = |scene: &serde_json::Value| {
        let number = |name: &str| u32::try_from(scene[name].as_u64()?).ok();
        let take = Take {
            scene: file_name(Path::new(scene["scene"].as_str()?)),
            panel: scene["panel"].as_str().map(str::to_owned),
            size: Size { width: number("width")?, height: number("height")? },
            samples: number("samples")?,
            seed: number("seed")?,
        };
        Some((take, scene["film_hash"].as_str()?.to_owned()))
    };
    let mut expected = Expected { hashes: BTreeMap::new(), takes: Vec::new() };
    for scene in scenes {
        let (take, hash) = entry(scene).ok_or_else(|| bad("an entry of \"scenes\" lacks a member"))?;
        expected.hashes.insert(take.key(), hash);
        if !expected.takes.contains(&take) {
            expected.takes.push(take);
        }
    }
    Ok(expected)
}

/// Whether the reference film has the recorded hash; an unrecorded scene is a difference.
fn check_expected(result: &SceneResult, expected: &Expected, quiet: bool) -> std::io::Result<bool> {
    let key = Take {
        scene: file_name(Path::new(&result.scene)),
        panel: result.panel.clone(),
        size: Size { width: result.width, height: result.height },
        samples: result.samples,
        seed: result.seed,
    }
    .key();
    let (line, same) = match expected.hashes.get(&key) {
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
