//! `gonio render`: a picture of a scene.

use super::gallery;
use super::interrupt::Interrupt;
use super::output::{OutputFlags, print_report};
use super::setup::{BackendFlags, Crop, Pixel, SceneFlags, bake_scene, bake_scene_with, crop_of, film_of};
use super::sheet::{self, Sheet};
use super::{ExitCode, Usage, drivers, exposure, progress, team};
use crate::bake::{BakeError, Baker, SceneData};
use crate::film::write::{Aov, Format};
use crate::film::{Film, OutputFile, Rect};
use crate::render::session::{Session, Share};
use crate::render::{Bounce, Counters, RenderError};
use crate::scene::Scene;
use crate::watch::Watch;
use anyhow::Context;
use clap::Args;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::str::FromStr;
use std::time::{Duration, Instant};

#[derive(Args)]
#[command(after_help = "\
Examples:
  gonio render scenes/first-light.toml -o first-light.png
  gonio render bunny.obj --size 1920x1080 --spp 64 -o bunny.png
  gonio render scene.toml --samples 0..32 -o a.gfilm     half of the samples, to merge with another machine's
  gonio render scenes/lecture/02-phong.toml -o n.png     the scene's panels side by side, with labels
  gonio render --gallery scenes/lecture -o gallery       a page of all scenes of a folder
  gonio render scene.toml --time 60 -o best.exr          whatever a minute gives
  gonio render scene.toml --device all                   on every GPU, software device and the CPU at once
  gonio render scene.toml --pixel 320,200                every bounce of one sample
  cat scene.toml | gonio render - -o - | display         from standard input to standard output")]
pub struct RenderArgs {
    /// .toml, .obj, .ply, .gltf, .glb, .xml (Mitsuba); `-` is TOML on standard input; `sphereflake:4`, `terrain:1M`,
    /// `hairball:1M` and `teapots:1M` need no file; with --gallery a folder of .toml files.
    scene: PathBuf,
    /// .png, .jpg, .webp, .exr, .hdr, or .gfilm for the film itself; `-` is PNG on standard output. Default: the scene's name, .png.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Render these sample indices only, the end not included.
    #[arg(long, value_name = "A..B", conflicts_with = "spp")]
    samples: Option<SampleRange>,
    /// Render this part of the frame only; its pixels are those of the whole picture.
    #[arg(long, value_name = "X0,Y0,X1,Y1")]
    crop: Option<Crop>,
    /// Print every bounce of one sample of this pixel (the first of --samples) instead of making a picture.
    #[arg(long, value_name = "X,Y", conflicts_with_all = ["output", "time"])]
    pixel: Option<Pixel>,
    /// Stop at the end of the pass during which this time runs out.
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true, value_parser = parse_seconds)]
    time: Option<Duration>,
    /// Further layers of an EXR, separated by commas: depth, normal, albedo, object, material, samples.
    #[arg(long, value_name = "LIST", value_delimiter = ',')]
    aov: Vec<Aov>,
    /// Leave the background out; alpha is coverage.
    #[arg(long)]
    transparent: bool,
    /// Write what was done, and how fast, as JSON.
    #[arg(long, value_name = "FILE")]
    stats: Option<PathBuf>,
    /// Render every scene of a folder into the folder --output, with a page (index.html) that shows formulas,
    /// pictures, plots and scene files.
    #[arg(long, requires = "output", conflicts_with_all = ["samples", "crop", "pixel", "time", "aov", "transparent", "stats"])]
    gallery: bool,
    /// No progress bar.
    #[arg(long)]
    no_progress: bool,
    #[command(flatten)]
    scene_flags: SceneFlags,
    #[command(flatten)]
    picture: OutputFlags,
    #[command(flatten)]
    backend: BackendFlags,
}

/// How long after a signal a device may still end its first samples. One that compiles, or is slow with them, cannot be made to
/// hurry.
const PATIENCE: Duration = Duration::from_millis(1500);

/// `A..B`.
#[derive(Clone, Debug, PartialEq, Eq)]
struct SampleRange(std::ops::Range<u32>);

impl FromStr for SampleRange {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parsed = text.split_once("..").and_then(|(a, b)| Some((a.parse().ok()?, b.parse().ok()?)));
        match parsed {
            Some((a, b)) if a < b && b <= crate::film::MAX_SAMPLES => Ok(Self(a..b)),
            _ => Err("expected A..B with A < B <= 16777216".to_owned()),
        }
    }
}

fn parse_seconds(text: &str) -> Result<Duration, String> {
    let seconds: f64 = text.parse().map_err(|_| "expected a number of seconds".to_owned())?;
    Duration::try_from_secs_f64(seconds).map_err(|_| "expected a number of seconds, not negative".to_owned())
}

/// How a render ended.
struct Outcome {
    shares: Vec<Share>,
    counters: Counters,
    render_time: Duration,
    interrupted: Option<u8>,
    /// Every device has failed; the film holds what was finished.
    error: Option<RenderError>,
}

pub fn run(args: &RenderArgs, quiet: bool) -> anyhow::Result<ExitCode> {
    if let (true, Some(folder)) = (args.gallery, &args.output) {
        return gallery::run(&args.scene, folder, &args.scene_flags, &args.backend);
    }
    if args.backend.may_use_vulkan() {
        drivers::begin();
    }
    let flags = SceneFlags { cut_out: args.picture.background.is_some(), ..args.scene_flags.clone() };
    let sheet = Sheet::open(&flags, &args.scene)?;
    if let Some(pixel) = args.pixel {
        if sheet.is_divided() {
            return Err(sheet.refuse("--pixel").into());
        }
        return inspect(args, &sheet, pixel);
    }
    if sheet.is_divided() && args.time.is_some() {
        return Err(sheet.refuse("--time").into());
    }
    // From here on there is something to clean up or to save; before, a signal just ends the program.
    let interrupt = Interrupt::listen()?;
    // Opened first: a bad path must not cost a render.
    let path = args.output.clone().unwrap_or_else(|| default_output(&args.scene));
    let format = sheet::format_of(&sheet, &args.picture, &path)?;
    if !args.aov.is_empty() && !matches!(format, Format::Exr | Format::Gfilm) {
        return Err(Usage(format!("--aov needs an .exr (or .gfilm) file, not {}", path.display())).into());
    }
    if path == Path::new("-") && args.stats.as_deref() == Some(Path::new("-")) {
        return Err(Usage("--output - and --stats - cannot both go to standard output".to_owned()).into());
    }
    if format == Format::Jpeg && args.transparent && args.picture.background.is_none() {
        return Err(Usage(format!("--transparent: {} is a JPEG, which has no alpha", path.display())).into());
    }
    let output = OutputFile::open(&path)?;
    let stats_file = args.stats.as_deref().map(OutputFile::open).transpose()?;

    let (mut films, mut stats) = (Vec::new(), Vec::new());
    let mut interrupted = None;
    let mut failed = None;
    let mut baker = sheet.is_divided().then(Baker::default);
    let mut scenes = sheet.scenes();
    loop {
        let next = || {
            scenes.next().map(|scene| {
                scene.and_then(|(label, scene)| Ok((label, prepare(args, scene, baker.as_mut(), &interrupt)?)))
            })
        };
        let unfinished: Vec<&OutputFile> = std::iter::once(&output).chain(&stats_file).collect();
        let prepared = interrupt.expendable(&unfinished, Duration::ZERO, || !films.is_empty(), next);
        let Some(prepared) = prepared else { break };
        let (label, prepared) = match prepared {
            Err(error) if matches!(error.downcast_ref(), Some(BakeError::Aborted)) => {
                interrupted = interrupt.exit_code();
                break;
            }
            prepared => prepared?,
        };
        let is_worth = !films.is_empty();
        let mut developed = develop(args, &prepared, &interrupt, (&unfinished, is_worth), !quiet && !args.no_progress)?;
        interrupted = developed.interrupted;
        if interrupted.is_some() && developed.film.samples().total() == 0 {
            break;
        }
        if let (Some(label), Some(stats)) = (label, &mut developed.stats) {
            stats["panel"] = label.into();
        }
        log::info!("{} in {:.2} s", label.map_or_else(|| path.display().to_string(), str::to_owned), developed.seconds);
        films.push((label.map(str::to_owned), developed.film));
        stats.extend(developed.stats);
        failed = developed.error;
        if interrupted.is_some() || failed.is_some() {
            break;
        }
    }
    match &mut films[..] {
        // Interrupted before there was anything to save.
        [] => return Ok(interrupted.map_or(ExitCode::SUCCESS, ExitCode::from)),
        [(_, film)] if !sheet.is_divided() => args.picture.write(film, format, &args.aov, output)?,
        panels => sheet::write(&sheet, panels, &args.picture, format, output)?,
    }
    if args.output.is_none() {
        print_report(&format!("picture {}\n", path.display()), false)?;
    }
    if let Some(mut file) = stats_file {
        let stats =
            if sheet.is_divided() { serde_json::json!({ "schema": 1, "panels": stats }) } else { stats.remove(0) };
        writeln!(file, "{stats:#}").with_context(|| format!("cannot write {}", file.path().display()))?;
        file.commit()?;
    }
    match failed {
        Some(error) => Err(error.into()),
        None => Ok(interrupted.map_or(ExitCode::SUCCESS, ExitCode::from)),
    }
}

/// A rendered scene.
struct Developed {
    film: Film,
    /// For `--stats`, if it is wanted.
    stats: Option<serde_json::Value>,
    seconds: f64,
    interrupted: Option<u8>,
    error: Option<RenderError>,
}

/// A scene that is ready to be rendered.
struct Prepared {
    scene: Scene,
    crop: Rect,
    data: SceneData,
    bake_time: Duration,
    /// The meter chose what limits specks.
    metered: bool,
}

/// Bakes a scene as the flags want it.
fn prepare(
    args: &RenderArgs,
    mut scene: Scene,
    baker: Option<&mut Baker>,
    interrupt: &Interrupt,
) -> anyhow::Result<Prepared> {
    scene.settings.aovs |= !args.aov.is_empty();
    let crop = crop_of(&scene, args.crop)?;
    scene.settings.transparent |= args.transparent || args.picture.background.is_some();
    let start = Instant::now();
    let asked = || interrupt.exit_code().is_some();
    let mut own = Baker::default();
    // What the meter bakes the picture shares.
    let metered = scene.metered && scene.settings.clamp.is_none();
    let baker = if scene.metered { Some(baker.unwrap_or(&mut own)) } else { baker };
    let data = match baker {
        Some(baker) => {
            if scene.metered {
                exposure::expose(&mut scene, baker, args.backend.threads, &asked)?;
            }
            bake_scene_with(&scene, Some(baker), &asked)?
        }
        None => bake_scene_with(&scene, None, &asked)?,
    };
    Ok(Prepared { scene, crop, data, bake_time: start.elapsed(), metered })
}

/// Renders one scene. A signal ends the program, without the unfinished files, while there is nothing worth saving: neither
/// samples nor what the flag beside the files says.
fn develop(
    args: &RenderArgs,
    prepared: &Prepared,
    interrupt: &Interrupt,
    (unfinished, is_worth): (&[&OutputFile], bool),
    show_progress: bool,
) -> anyhow::Result<Developed> {
    let Prepared { scene, crop, data, bake_time, metered } = prepared;
    let session = team::session(&args.backend, data, film_of(scene, data, *crop))?;
    let samples = match (&args.samples, args.time, args.scene_flags.spp) {
        (Some(range), _, _) => range.0.clone(),
        // With a time limit and no count, the time decides.
        (None, Some(_), None) => 0..crate::film::MAX_SAMPLES,
        (None, _, _) => 0..scene.settings.samples,
    };
    let worth = || is_worth || session.snapshot().samples().total() > 0;
    let outcome = interrupt.expendable(unfinished, PATIENCE, worth, || {
        render_samples(&session, samples, args.time, interrupt, show_progress)
    })?;
    let film = session.into_film();
    report(&film, &outcome.counters, *metered);
    // Costs a hash of the film.
    let stats = args.stats.as_ref().map(|_| stats_json(args, data, &film, &outcome, *bake_time));
    let seconds = outcome.render_time.as_secs_f64();
    Ok(Developed { film, stats, seconds, interrupted: outcome.interrupted, error: outcome.error })
}

/// The scene's name in the current folder, as a PNG; standard input makes `out.png`.
fn default_output(scene: &Path) -> PathBuf {
    let stem = if scene == Path::new("-") { None } else { scene.file_stem() };
    PathBuf::from(stem.unwrap_or("out".as_ref())).with_extension("png")
}

/// Renders range by range, each a whole number of samples for every pixel of the crop, until the samples, the time or the
/// user's patience end.
fn render_samples(
    session: &Session,
    samples: std::ops::Range<u32>,
    time: Option<Duration>,
    interrupt: &Interrupt,
    show_progress: bool,
) -> anyhow::Result<Outcome> {
    let start = Instant::now();
    let pixels = session.snapshot().crop().area() as u64;
    let bar = progress::bar(pixels * u64::from(samples.end - samples.start), show_progress);
    let told = |steps: i64| match u64::try_from(steps) {
        Ok(steps) => bar.inc(steps),
        Err(_) => bar.dec(steps.unsigned_abs()),
    };
    let asked = || interrupt.exit_code().is_some();
    let watch = Watch::default().asking(&asked).telling(&told);
    let watch = if let Some(time) = time { watch.limited(time) } else { watch };
    let rendered = session.render(samples, &watch);
    bar.finish_and_clear();
    let (shares, error) = match rendered {
        Ok(shares) => (shares, None),
        // What was finished is saved.
        Err(error) if session.snapshot().samples().total() > 0 => (Vec::new(), Some(error)),
        Err(error) => return Err(error.into()),
    };
    let mut counters = Counters::default();
    shares.iter().for_each(|share| counters += share.counters);
    Ok(Outcome { shares, counters, render_time: start.elapsed(), interrupted: interrupt.exit_code(), error })
}

/// Says what the user should know of the samples.
fn report(film: &Film, counters: &Counters, metered: bool) {
    if counters.limited > 0 {
        // Who asked for no limit has no specks to miss, and may ask for them: `--set render.clamp=0`.
        let level = if metered { log::Level::Info } else { log::Level::Warn };
        let limited = counters.limited;
        log::log!(level, "{limited} contributions were limited by \"clamp\": the picture is darker than the scene");
    }
    if film.nan_count() > 0 {
        log::warn!("{} contributions were not a number and count as 0", film.nan_count());
    }
    if film.clamped_count() > 0 {
        log::warn!("{} samples were clamped at 65536 film units; raise film.unit", film.clamped_count());
    }
}

fn stats_json(
    args: &RenderArgs,
    data: &SceneData,
    film: &Film,
    outcome: &Outcome,
    bake_time: Duration,
) -> serde_json::Value {
    let seconds = outcome.render_time.as_secs_f64();
    let rays = outcome.counters.closest_rays + outcome.counters.shadow_rays;
    let names: Vec<&str> = outcome.shares.iter().map(|share| share.name.as_str()).collect();
    let devices: Vec<_> = outcome.shares.iter().map(share_json).collect();
    serde_json::json!({
        "schema": 1,
        "gonio": env!("CARGO_PKG_VERSION"),
        "scene": args.scene,
        "film_hash": film.hash().to_string(),
        "device": names.join(" + "),
        "devices": devices,
        "width": film.spec().width,
        "height": film.spec().height,
        "crop": film.crop(),
        "seed": film.spec().seed,
        "samples": film.samples().to_string(),
        "passes": outcome.shares.iter().map(|share| share.ranges).sum::<u32>(),
        "interrupted": outcome.interrupted.is_some(),
        "nan_count": film.nan_count(),
        "clamped_count": film.clamped_count(),
        "limited_count": film.limited_count(),
        "render_s": seconds,
        "bake_s": bake_time.as_secs_f64(),
        "rays_per_s": rays as f64 / seconds.max(1e-9),
        "counters": outcome.counters,
        "triangles": data.shapes.triangles.len(),
        "instances": data.instances.len(),
        "nodes": data.shapes.nodes.len(),
        "lights": data.lights.len(),
    })
}

/// What one device did.
fn share_json(share: &Share) -> serde_json::Value {
    let rays = share.counters.closest_rays + share.counters.shadow_rays;
    serde_json::json!({
        "device": share.name,
        "samples": share.samples,
        "passes": share.ranges,
        "busy_s": share.busy_s,
        "rays_per_s": rays as f64 / share.busy_s.max(1e-9),
        "counters": share.counters,
        "error": share.error.as_ref().map(ToString::to_string),
    })
}

/// Prints every bounce of one sample.
fn inspect(args: &RenderArgs, sheet: &Sheet, pixel: Pixel) -> anyhow::Result<ExitCode> {
    let Some(scene) = sheet.scenes().next() else { return Ok(ExitCode::SUCCESS) };
    let (_, scene) = scene?;
    if pixel.x >= scene.film.width || pixel.y >= scene.film.height {
        let frame = Rect::whole(scene.film.width, scene.film.height);
        return Err(Usage(format!("--pixel {},{} is not inside the frame {frame}", pixel.x, pixel.y)).into());
    }
    let data = bake_scene(&scene)?;
    let sample = args.samples.as_ref().map_or(0, |range| range.0.start);
    let frame = Rect::whole(scene.film.width, scene.film.height);
    let session = team::session(&args.backend, &data, film_of(&scene, &data, frame))?;
    let device = args.backend.device.as_deref().unwrap_or_default();
    if device == team::ALL || session.names().len() > 1 {
        return Err(RenderError::NoDevice(format!("--device {device}: this command takes one device")).into());
    }
    let bounces = session.inspect(pixel.x, pixel.y, sample)?;
    let mut out = std::io::stdout().lock();
    writeln!(out, "pixel {},{} sample {sample} on {}", pixel.x, pixel.y, session.names()[0])?;
    for bounce in &bounces {
        print_bounce(&mut out, bounce)?;
    }
    Ok(ExitCode::SUCCESS)
}

/// One bounce in a block of lines.
pub(super) fn print_bounce(out: &mut impl Write, bounce: &Bounce) -> std::io::Result<()> {
    let (path, ray, hit) = (&bounce.path, &bounce.path.ray, &bounce.hit);
    writeln!(out, "depth {} path {:08x}", path.depth, path.path_id)?;
    writeln!(out, "  origin     {:?}", ray.origin.to_array())?;
    writeln!(out, "  direction  {:?}", ray.direction.to_array())?;
    writeln!(out, "  throughput {:?}", path.throughput.to_array())?;
    if hit.instance == crate::layout::INVALID {
        return writeln!(out, "  leaves the scene");
    }
    writeln!(
        out,
        "  hit        t {:?}, instance {}, primitive {}, b {:?} {:?}",
        hit.t, hit.instance, hit.primitive, hit.b1, hit.b2
    )
}
