//! `gonio bench`: how fast rays are traced, with every hit verified.

use super::parity::Contender;
use super::setup::{
    BackendFlags, BackendName, FetchName, IntegratorName, SceneFlags, bake_scene, bake_scene_with, film_of,
    thread_count,
};
use super::{EXIT_DIFFERS, ExitCode, drivers, team};
use crate::bake::{Baker, SceneData};
use crate::bench::export::export;
use crate::bench::hierarchy::size_of_scene;
use crate::bench::image::{self, frame_of};
use crate::bench::rays::{RayKind, RaySet, make_rays};
use crate::bench::report::{Backend, ImageReport, RayReport, Report, SCHEMA, SceneReport, SetupOn, with_memory};
use crate::bench::run::{Plan, measure};
use crate::bench::table::Table;
use crate::bench::tracer::{CpuTracer, Tracer, VulkanTracer};
use crate::film::{FilmError, OutputFile, Rect};
use crate::render::RenderError;
use crate::scene::{Integrator, Scene};
use crate::shaders::Fetch;
use anyhow::Context;
use clap::{Args, ValueEnum};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Scenes where none is named: one of each sort, small enough for any machine.
const DEFAULT_SCENES: [&str; 4] = ["sphereflake:4", "terrain:200k", "hairball:200k", "teapots:200k"];

#[derive(Args)]
#[command(after_help = "\
Examples:
  gonio bench                                        built-in scenes on the CPU and on the Vulkan device
  gonio bench terrain:4M --only primary,diffuse      two kinds of rays
  gonio bench scene.toml --on vulkan:0:texel,vulkan:0:storage
  gonio bench --json now.json --baseline before.json ratios to an earlier run
  gonio bench teapots:1M --export-rays work          the same work for another ray tracer
README.md, \"Benchmark\", defines every number. Exit code 0: every hit is the CPU's, bit for bit. 1: one is not.")]
pub struct BenchArgs {
    /// Scenes, as for render. Default: sphereflake:4 terrain:200k hairball:200k teapots:200k.
    scenes: Vec<PathBuf>,
    /// Backends, which take turns: `cpu`, `vulkan`, `vulkan:DEVICE`, `vulkan:DEVICE:FETCH`.
    /// Default: cpu, and the Vulkan device if there is one.
    #[arg(long, value_name = "A,B", value_delimiter = ',')]
    on: Vec<Contender>,
    /// The Vulkan device, where --on does not say.
    #[arg(long, value_name = "INDEX|NAME|KIND")]
    device: Option<String>,
    /// How kernels read the scene, where --on does not say.
    #[arg(long, default_value = "auto")]
    fetch: FetchName,
    /// Threads of the CPU backend.
    #[arg(short, long, value_name = "N", value_parser = thread_count)]
    threads: Option<usize>,
    /// Rays of each kind, about: the frame has so many pixels.
    #[arg(long, value_name = "N", default_value = "1000000", value_parser = clap::value_parser!(u32).range(1..=16_777_216))]
    rays: u32,
    /// Timed runs.
    #[arg(long, value_name = "N", default_value = "5", value_parser = clap::value_parser!(u32).range(1..=10_000))]
    runs: u32,
    /// Runs before those, not counted.
    #[arg(long, value_name = "N", default_value = "1", value_parser = clap::value_parser!(u32).range(0..=10_000))]
    warmup: u32,
    /// Measure these only.
    #[arg(long, value_name = "WHAT", value_delimiter = ',')]
    only: Vec<What>,
    /// Write the results to this file, too, after each scene; `-` is standard output, which then has no table.
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Compare with the results in this file, which --json wrote.
    #[arg(long, value_name = "FILE.json")]
    baseline: Option<PathBuf>,
    /// Write triangles, rays and hits as raw arrays into a folder for each scene in this one.
    #[arg(long, value_name = "DIR")]
    export_rays: Option<PathBuf>,
    /// Seed of the random numbers.
    #[arg(long, value_name = "N")]
    seed: Option<u32>,
    /// Change any key of the scene file, as for render.
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
}

/// What can be measured: kinds of rays, and whole samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum What {
    Primary,
    Diffuse,
    Second,
    Occlusion,
    Shadow,
    /// Whole samples, with each integrator.
    Images,
}

impl What {
    fn of(kind: RayKind) -> Self {
        match kind {
            RayKind::Primary => Self::Primary,
            RayKind::Diffuse => Self::Diffuse,
            RayKind::Second => Self::Second,
            RayKind::Occlusion => Self::Occlusion,
            RayKind::Shadow => Self::Shadow,
        }
    }
}

pub fn run(args: &BenchArgs) -> anyhow::Result<ExitCode> {
    let baseline = args.baseline.as_deref().map(read_baseline).transpose()?;
    let contenders = args.contenders();
    if contenders.iter().any(|contender| contender.flags.may_use_vulkan()) {
        drivers::ready();
    }
    let mut report = Report {
        schema: SCHEMA,
        gonio: env!("CARGO_PKG_VERSION").to_owned(),
        platform: format!("{}-{}", std::env::consts::OS, std::env::consts::ARCH),
        threads: std::thread::available_parallelism().map_or(1, usize::from),
        warmup: args.warmup as usize,
        runs: args.runs as usize,
        backends: Vec::new(),
        scenes: Vec::new(),
    };
    let on_stdout = args.json.as_deref() == Some(Path::new("-"));
    // A bad path must not cost a measurement.
    if !on_stdout {
        args.store(&report)?;
    }
    let table = Table { plan: args.plan(), baseline: baseline.as_ref() };
    for scene in args.scenes() {
        let found = args.bench_scene(&scene, &contenders, &mut report.backends, !on_stdout)?;
        if !on_stdout {
            writeln!(std::io::stdout(), "{}", table.scene(&found))?;
        }
        table.warnings(&found).iter().for_each(|warning| log::warn!("{warning}"));
        report.scenes.push(found);
        if !on_stdout {
            args.store(&report)?;
        }
    }
    if on_stdout {
        args.store(&report)?;
    }
    Ok(if report.is_equal() { ExitCode::SUCCESS } else { ExitCode::from(EXIT_DIFFERS) })
}

fn read_baseline(path: &Path) -> anyhow::Result<Report> {
    let text = std::fs::read_to_string(path).with_context(|| format!("cannot read {}", path.display()))?;
    let bad = |message| FilmError::Bad { file: path.display().to_string(), message };
    Ok(Report::from_json(&text).map_err(bad)?)
}

impl BenchArgs {
    fn plan(&self) -> Plan {
        Plan { runs: self.runs as usize, warmup: self.warmup as usize }
    }

    fn scenes(&self) -> Vec<PathBuf> {
        if self.scenes.is_empty() { DEFAULT_SCENES.map(PathBuf::from).to_vec() } else { self.scenes.clone() }
    }

    fn wants(&self, what: What) -> bool {
        self.only.is_empty() || self.only.contains(&what)
    }

    fn contenders(&self) -> Vec<Contender> {
        let complete = |mut contender: Contender| {
            let flags = &mut contender.flags;
            flags.threads = self.threads;
            if flags.device.is_none() {
                flags.device = self.device.clone();
            }
            if flags.fetch == FetchName::Auto {
                flags.fetch = self.fetch;
            }
            contender
        };
        if !self.on.is_empty() {
            return self.on.iter().cloned().map(complete).collect();
        }
        let of = |backend, label: &str| {
            complete(Contender { label: label.to_owned(), flags: BackendFlags { backend, ..BackendFlags::default() } })
        };
        vec![of(BackendName::Cpu, "cpu"), of(BackendName::Vulkan, "vulkan")]
    }

    /// Writes the JSON, if it is wanted.
    fn store(&self, report: &Report) -> anyhow::Result<()> {
        let Some(path) = &self.json else { return Ok(()) };
        let mut file = OutputFile::open(path)?;
        let text = serde_json::to_string_pretty(report)?;
        writeln!(file, "{text}").with_context(|| format!("cannot write {}", path.display()))?;
        Ok(file.commit()?)
    }

    /// Loads and bakes a scene, then measures everything that is wanted.
    fn bench_scene(
        &self,
        path: &Path,
        contenders: &[Contender],
        backends: &mut Vec<Backend>,
        print: bool,
    ) -> anyhow::Result<SceneReport> {
        let name = path.display().to_string();
        let start = Instant::now();
        let flags = SceneFlags { spp: Some(1), seed: self.seed, set: self.set.clone(), ..SceneFlags::default() };
        let mut scene = flags.load(path)?;
        let load_s = start.elapsed().as_secs_f64();
        let frame = frame_of(scene.film.width, scene.film.height, self.rays);
        (scene.film.width, scene.film.height) = (frame.width, frame.height);
        let (data, [peak_bytes, bake_bytes]) = with_memory(|| bake_scene(&scene));
        let data = data?;
        let mut report = SceneReport {
            scene: name.clone(),
            width: frame.width,
            height: frame.height,
            seed: scene.settings.seed,
            size: size_of_scene(&data),
            load_s,
            bake: data.times,
            peak_bytes,
            bake_bytes,
            setup: Vec::new(),
            rays: Vec::new(),
            images: Vec::new(),
        };
        log::info!("{name}: making rays");
        let sets = make_rays(&data, frame.width, frame.height);
        if let Some(folder) = &self.export_rays {
            export(&folder.join(folder_name(path)), &name, &data, &sets)?;
        }
        let mut tracers = self.tracers(&data, contenders)?;
        let is_new = backends.is_empty();
        for (on, tracer) in &tracers {
            report.setup.extend(tracer.setup().map(|setup| SetupOn { on: on.clone(), setup }));
            if is_new {
                backends.push(backend(on, tracer));
            }
        }
        if is_new && print {
            print_backends(backends)?;
        }
        report.rays = self.measure_rays(&name, &sets, &mut tracers)?;
        drop((tracers, sets));
        if self.wants(What::Images) {
            report.images = self.measure_images(&mut scene, data, frame, contenders)?;
        }
        Ok(report)
    }

    /// The backends with the scene. Where none was named and there is no Vulkan device, the CPU is measured alone.
    fn tracers<'a>(
        &self,
        data: &'a SceneData,
        contenders: &[Contender],
    ) -> Result<Vec<(String, Tracer<'a>)>, RenderError> {
        let mut tracers = Vec::new();
        for Contender { label, flags } in contenders {
            if flags.backend == BackendName::Cpu {
                tracers.push((label.clone(), Tracer::Cpu(CpuTracer::new(data, flags.threads)?)));
                continue;
            }
            match VulkanTracer::new(data, &flags.vulkan_options()) {
                Ok(tracer) => tracers.push((label.clone(), Tracer::Vulkan(Box::new(tracer)))),
                Err(RenderError::NoDevice(reason)) if self.on.is_empty() && self.device.is_none() => {
                    log::warn!("{reason}: measuring the CPU backend alone");
                }
                Err(error) => return Err(error),
            }
        }
        Ok(tracers)
    }

    fn measure_rays(
        &self,
        name: &str,
        sets: &[RaySet],
        tracers: &mut [(String, Tracer)],
    ) -> Result<Vec<RayReport>, RenderError> {
        let mut reports = Vec::new();
        for set in sets.iter().filter(|set| self.wants(What::of(set.kind))) {
            if set.rays.is_empty() {
                log::warn!("{name}: no {} rays: the camera sees nothing", set.kind.name());
                continue;
            }
            log::info!("{name}: tracing {} {} rays", set.rays.len(), set.kind.name());
            reports.push(measure(set, tracers, self.plan())?);
        }
        Ok(reports)
    }

    /// Whole samples with each integrator.
    fn measure_images(
        &self,
        scene: &mut Scene,
        data: SceneData,
        frame: Rect,
        contenders: &[Contender],
    ) -> anyhow::Result<Vec<ImageReport>> {
        // The one it was baked for comes first, so that no two baked scenes are held at a time.
        let mut names = IntegratorName::value_variants().to_vec();
        names.sort_by_key(|name| Integrator::from(*name) != scene.settings.integrator);
        let mut baker = Baker::after(scene, &data);
        let mut baked = Some(data);
        let mut reports = Vec::new();
        for name in names {
            let data = match baked.take() {
                Some(data) => data,
                None => {
                    scene.settings.integrator = name.into();
                    bake_scene_with(scene, Some(&mut baker), &|| false)?
                }
            };
            let film = film_of(scene, &data, frame);
            let mut sessions = Vec::new();
            for Contender { label, flags } in contenders {
                // As large pictures are rendered; in the middle of a run would be too late.
                let flags = BackendFlags { group_from: Some(0), ..flags.clone() };
                let session = team::session(&flags, &data, film.clone())?;
                match session.open() {
                    Ok(()) => sessions.push((label.clone(), session)),
                    Err(RenderError::NoDevice(_)) if self.on.is_empty() && self.device.is_none() => {}
                    Err(error) => return Err(error.into()),
                }
            }
            let text = name.to_possible_value().map_or_else(String::new, |value| value.get_name().to_owned());
            log::info!("{}: {text} samples", scene.name);
            reports.push(image::measure(&text, &film, &sessions, self.plan())?);
        }
        Ok(reports)
    }
}

fn backend(on: &str, tracer: &Tracer) -> Backend {
    let (name, fetch, device) = match tracer {
        Tracer::Cpu(tracer) => match tracer.threads() {
            1 => ("cpu (1 thread)".to_owned(), None, None),
            n => (format!("cpu ({n} threads)"), None, None),
        },
        Tracer::Vulkan(tracer) => {
            let fetch = match tracer.fetch() {
                Fetch::Texel => "texel",
                Fetch::Storage => "storage",
            };
            (tracer.info().to_string(), Some(fetch.to_owned()), serde_json::to_value(tracer.info()).ok())
        }
    };
    Backend { on: on.to_owned(), name, fetch, device }
}

fn print_backends(backends: &[Backend]) -> std::io::Result<()> {
    let mut out = std::io::stdout().lock();
    for Backend { on, name, fetch, .. } in backends {
        let fetch = fetch.as_ref().map_or(String::new(), |fetch| format!(", {fetch} buffers"));
        writeln!(out, "{on}: {name}{fetch}")?;
    }
    writeln!(out)
}

/// A scene's folder among the exported ones: its file name, or a built-in scene's name with `-` for the colon.
fn folder_name(path: &Path) -> String {
    let name = path.file_stem().unwrap_or("scene".as_ref()).to_string_lossy();
    name.replace(':', "-")
}
