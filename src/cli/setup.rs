//! What render, parity and others share: from flags to a baked scene and a renderer.

use super::team::CPU;
use super::view::ViewFlags;
use super::{Usage, progress, strict};
use crate::bake::{Baker, SceneData, bake_watched};
use crate::film::{AovSums, Film, FilmSpec, Rect};
use crate::layout::AovPixel;
use crate::memory;
use crate::render::vulkan::{FetchChoice, VulkanOptions};
use crate::scene::{self, Integrator, Scene, Window, load};
use crate::watch::Watch;
use anyhow::Context;
use clap::{Args, ValueEnum};
use std::path::{Path, PathBuf};
use std::str::FromStr;

/// `WxH`, 1 to 65,535 each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Size {
    pub width: u32,
    pub height: u32,
}

impl FromStr for Size {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parsed = text.split_once(['x', 'X']).and_then(|(w, h)| Some((w.parse().ok()?, h.parse().ok()?)));
        match parsed {
            Some((width, height)) if (1..=65_535).contains(&width) && (1..=65_535).contains(&height) => {
                Ok(Self { width, height })
            }
            _ => Err("expected WIDTHxHEIGHT, each 1 to 65535, as in 1280x720".to_owned()),
        }
    }
}

/// `X0,Y0,X1,Y1` in pixels of the full frame; the second corner is outside.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Crop(pub Rect);

impl FromStr for Crop {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers: Option<Vec<u32>> = text.split(',').map(|part| part.trim().parse().ok()).collect();
        match numbers.as_deref() {
            Some(&[x0, y0, x1, y1]) if x0 < x1 && y0 < y1 => {
                Ok(Self(Rect { x: x0, y: y0, width: x1 - x0, height: y1 - y0 }))
            }
            _ => Err("expected X0,Y0,X1,Y1 with X0 < X1 and Y0 < Y1, in pixels of the full frame".to_owned()),
        }
    }
}

/// `X,Y`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pixel {
    pub x: u32,
    pub y: u32,
}

impl FromStr for Pixel {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parsed = text.split_once(',').and_then(|(x, y)| Some((x.trim().parse().ok()?, y.trim().parse().ok()?)));
        parsed
            .map(|(x, y)| Self { x, y })
            .ok_or_else(|| "expected X,Y in pixels, from the upper left corner".to_owned())
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum IntegratorName {
    Local,
    Whitted,
    Direct,
    Path,
}

impl From<IntegratorName> for Integrator {
    fn from(name: IntegratorName) -> Self {
        match name {
            IntegratorName::Local => Self::Local,
            IntegratorName::Whitted => Self::Whitted,
            IntegratorName::Direct => Self::Direct,
            IntegratorName::Path => Self::Path,
        }
    }
}

/// Parses `--scale`.
fn scale(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(factor) if (0.001..=64.0).contains(&factor) => Ok(factor),
        _ => Err("expected a number from 0.001 to 64".to_owned()),
    }
}

/// The scene and what of it the command line changes.
#[derive(Args, Clone, Debug, Default)]
#[command(next_help_heading = "Scene")]
pub struct SceneFlags {
    /// Size of the full frame.
    #[arg(long, value_name = "WxH")]
    pub size: Option<Size>,
    /// Make the frame so many times as wide and high, as in 0.5.
    #[arg(long, value_name = "X", conflicts_with = "size", value_parser = scale)]
    pub scale: Option<f64>,
    /// Samples a pixel.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=16_777_216))]
    pub spp: Option<u32>,
    /// Seed of the random numbers.
    #[arg(long, value_name = "N")]
    pub seed: Option<u32>,
    /// How light is followed.
    #[arg(long)]
    pub integrator: Option<IntegratorName>,
    /// Scattering events a ray may see.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=64))]
    pub max_depth: Option<u32>,
    /// Change any key of the scene file, as in `material.copper.color=[1,0,0]`; may be repeated.
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// One of the scene's panels alone, by its label or its number from 0.
    #[arg(long, value_name = "LABEL")]
    pub panel: Option<String>,
    /// Give a parameter of a Mitsuba scene a value, as in `spp=64`; may be repeated.
    #[arg(short = 'D', long = "define", value_name = "NAME=VALUE")]
    pub define: Vec<Define>,
    /// Memory that files, pictures and the film may take, as in 900M or 4G; what the machine has free, less a reserve, if
    /// not given. What takes more is refused (exit code 75).
    #[arg(long, value_name = "SIZE", value_parser = memory::parse_size)]
    pub max_memory: Option<u64>,
    /// Read files of this folder only, whatever a scene calls them and wherever its links lead; for scenes of strangers.
    #[arg(long, value_name = "FOLDER")]
    pub root: Option<PathBuf>,
    #[command(flatten)]
    pub view: ViewFlags,
    /// Not a flag: `Controls::cut_out`.
    #[arg(skip)]
    pub cut_out: bool,
}

/// `NAME=VALUE`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Define(String, String);

impl FromStr for Define {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text.split_once('=') {
            Some((name, value)) if !name.is_empty() => Ok(Self(name.to_owned(), value.to_owned())),
            _ => Err("expected NAME=VALUE, as in spp=64".to_owned()),
        }
    }
}

/// Names of parameters and their values.
type Defines = Vec<(String, String)>;

impl SceneFlags {
    /// Loads a scene without the changes of its panels and applies the flags. Prints the loader's warnings.
    pub fn load(&self, path: &Path) -> anyhow::Result<Scene> {
        self.adjusted(self.panels(path)?.scene(None)?)
    }

    /// Opens a scene (`-` is TOML on standard input) with its keys changed by the flags.
    pub fn panels(&self, path: &Path) -> anyhow::Result<load::Panels> {
        let (overrides, defines, controls) = self.changes()?;
        load::confine::begin(path);
        Ok(load::Panels::open(path, &overrides, &defines)?.controlled(controls))
    }

    /// What the flags change: keys, parameters, and what a viewer lets one turn.
    pub fn changes(&self) -> anyhow::Result<(Vec<load::Override>, Defines, load::Controls)> {
        self.max_memory.into_iter().for_each(memory::set_limit);
        if let Some(root) = &self.root {
            let failed = |error| anyhow::Error::from(error).context(format!("--root {}", root.display()));
            load::confine::set_root(root).map_err(failed)?;
        }
        let size = self.size.map(|size| format!("film.size=[{},{}]", size.width, size.height));
        let overrides = self
            .set
            .iter()
            .chain(&size)
            .map(|text| text.parse().map_err(|error| Usage(format!("--set {text}: {error}"))))
            .collect::<Result<Vec<load::Override>, _>>()?;
        let defines = self.define.iter().map(|d| (d.0.clone(), d.1.clone())).collect();
        let controls = self.view.controls(self.integrator.map(Integrator::from), self.cut_out)?;
        Ok((overrides, defines, controls))
    }

    /// A loaded scene with its settings changed by the flags. Prints the loader's warnings.
    pub fn adjusted(&self, mut scene: Scene) -> anyhow::Result<Scene> {
        if let Some(factor) = self.scale {
            resize(&mut scene.film, factor)?;
        }
        let settings = &mut scene.settings;
        settings.samples = self.spp.unwrap_or(settings.samples);
        settings.seed = self.seed.unwrap_or(settings.seed);
        settings.max_depth = self.max_depth.unwrap_or(settings.max_depth);
        settings.integrator = self.integrator.map_or(settings.integrator, Integrator::from);
        scene.warnings.extend(load::confine::strayed());
        strict::tell(&scene.warnings)?;
        strict::note(&scene.notes);
        Ok(scene)
    }
}

/// Makes a film's frame `factor` times as large, and its crop with it.
fn resize(film: &mut scene::Film, factor: f64) -> Result<(), Usage> {
    let side = |pixels: u32| (f64::from(pixels) * factor).round().max(1.0);
    let (width, height) = (side(film.width), side(film.height));
    if width.max(height) > 65_535.0 {
        return Err(Usage(format!("--scale {factor}: a frame of {width} x {height}; at most 65535 each way")));
    }
    (film.width, film.height) = (width as u32, height as u32);
    film.crop = film.crop.map(|crop| {
        let edge = |at: u32, end: f64| (f64::from(at) * factor).round().min(end);
        let (x, y) = (edge(crop.x, width - 1.0), edge(crop.y, height - 1.0));
        let [x1, y1] = [edge(crop.x + crop.width, width).max(x + 1.0), edge(crop.y + crop.height, height).max(y + 1.0)];
        Window { x: x as u32, y: y as u32, width: (x1 - x) as u32, height: (y1 - y) as u32 }
    });
    Ok(())
}

/// Bakes a scene that is baked again later, which says what was dropped.
pub fn bake_quietly(scene: &Scene, baker: &mut Baker, asked: &(dyn Fn() -> bool + Sync)) -> anyhow::Result<SceneData> {
    let bar = progress::baking(scene);
    let told = |steps: i64| bar.inc(steps.unsigned_abs());
    let data = baker.bake(scene, &Watch::default().asking(asked).telling(&told));
    bar.finish_and_clear();
    data.with_context(|| scene.name.clone())
}

/// Bakes a scene and prints what baking dropped.
pub fn bake_scene(scene: &Scene) -> anyhow::Result<SceneData> {
    bake_scene_with(scene, None, &|| false)
}

/// The same. `baker`: of scenes that may share their shapes. Gives up with `BakeError::Aborted` when `asked` says so.
pub fn bake_scene_with(
    scene: &Scene,
    baker: Option<&mut Baker>,
    asked: &(dyn Fn() -> bool + Sync),
) -> anyhow::Result<SceneData> {
    let bar = progress::baking(scene);
    log::info!("{}: baking", scene.name);
    let told = |steps: i64| bar.inc(steps.unsigned_abs());
    let watch = Watch::default().asking(asked).telling(&told);
    let data = match baker {
        Some(baker) => baker.bake(scene, &watch),
        None => bake_watched(scene, &watch),
    };
    bar.finish_and_clear();
    let data = data.with_context(|| scene.name.clone())?;
    strict::tell(&data.warnings)?;
    Ok(data)
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum BackendName {
    /// A GPU if there is one (discrete, integrated, virtual in this order), else the CPU, which also goes on with the picture
    /// where the GPU fails.
    #[default]
    Auto,
    /// A Vulkan device, a software one if there is no other.
    Vulkan,
    /// All cores of this machine.
    Cpu,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum FetchName {
    /// Texel buffers on software devices, storage buffers on others.
    #[default]
    Auto,
    Texel,
    Storage,
}

impl From<FetchName> for FetchChoice {
    fn from(name: FetchName) -> Self {
        match name {
            FetchName::Auto => Self::Auto,
            FetchName::Texel => Self::Texel,
            FetchName::Storage => Self::Storage,
        }
    }
}

/// Parses `--threads`. A million threads would take the machine's memory.
pub fn thread_count(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(count @ 1..=1024) => Ok(count),
        _ => Err("expected a number from 1 to 1024".to_owned()),
    }
}

/// What to compute on.
#[derive(Args, Clone, Debug, Default)]
#[command(next_help_heading = "Device")]
pub struct BackendFlags {
    /// What to compute on.
    #[arg(long, default_value = "auto")]
    pub backend: BackendName,
    /// A Vulkan device: its index or a part of its name as `gonio devices` prints them, or its kind
    /// (discrete, integrated, virtual, software); or `cpu`, the CPU backend. `render` takes several at once, as in
    /// `0,1,cpu`, or `all`.
    #[arg(long, value_name = "INDEX|NAME|KIND|cpu")]
    pub device: Option<String>,
    /// How kernels read the scene.
    #[arg(long, default_value = "auto")]
    pub fetch: FetchName,
    /// Threads of the CPU backend; as many as cores if not given.
    #[arg(short, long, value_name = "N", value_parser = thread_count)]
    pub threads: Option<usize>,
    /// Fail on a Vulkan device that does not compute every bit as it must (`gonio devices`), instead of a warning.
    #[arg(long)]
    pub require_exact: bool,
    /// Not a flag: `VulkanOptions::group_from`.
    #[arg(skip)]
    pub group_from: Option<u64>,
}

impl BackendFlags {
    /// Whether a driver may have to be asked.
    pub fn may_use_vulkan(&self) -> bool {
        self.backend != BackendName::Cpu && self.device.as_deref() != Some(CPU)
    }

    /// What the flags say of a Vulkan device.
    pub fn vulkan_options(&self) -> VulkanOptions {
        VulkanOptions {
            device: self.device.clone(),
            fetch: self.fetch.into(),
            group_from: self.group_from,
            ..VulkanOptions::default()
        }
    }
}

/// The crop the flag asks for, or else the scene, checked against the frame; the whole frame without either.
pub fn crop_of(scene: &Scene, crop: Option<Crop>) -> anyhow::Result<Rect> {
    let whole = Rect::whole(scene.film.width, scene.film.height);
    let own = scene.film.crop.map(|Window { x, y, width, height }| Rect { x, y, width, height });
    let (what, rect) = match crop {
        Some(Crop(rect)) => ("--crop", rect),
        None => ("the scene's crop", own.unwrap_or(whole)),
    };
    match whole.contains(&rect) {
        true => {
            check_film(scene, rect)?;
            Ok(rect)
        }
        // --size may have made the frame smaller.
        false => Err(Usage(format!("{what} {rect} is not inside the frame {whole}")).into()),
    }
}

/// Bytes a pixel takes: in the film, in what a device gives back, in the picture and in what is encoded of it.
const PIXEL_BYTES: u64 = 32 + 32 + 16 + 16;
/// Bytes its auxiliary values take beside them, in the same places: the picture and its layers have ten numbers of them.
const AOV_BYTES: u64 = size_of::<AovSums>() as u64 + size_of::<AovPixel>() as u64 + 10 * 4 + 2 * 10 * 4;

/// An error if there is no memory for the film of `crop`, with auxiliary values where the scene's settings want them.
pub fn check_film(scene: &Scene, crop: Rect) -> Result<(), memory::Shortage> {
    let (layers, pixel) = match scene.settings.aovs {
        true => (" with auxiliary values", PIXEL_BYTES + AOV_BYTES),
        false => ("", PIXEL_BYTES),
    };
    let what = format!("a film of {} x {} pixels{layers}", crop.width, crop.height);
    memory::check(&what, crop.area() as u64 * pixel)
}

/// An empty film for a scene.
pub fn film_of(scene: &Scene, data: &SceneData, crop: Rect) -> Film {
    let (transparent, aovs) = (data.features.hides_background, data.features.has_aovs);
    Film::new(FilmSpec { crop, ..FilmSpec::of(scene, data.digest(), transparent, aovs) })
}
