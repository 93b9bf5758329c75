//! `gonio plot`: pictures of models.

use super::fit::FitArgs;
use super::growth::GrowthArgs;
use super::setup::Size;
use super::{ExitCode, Usage};
use crate::film::{FilmError, OutputFile};
use crate::plot::curves::{self, FACETS, Facets, Interface, InterfaceKind};
use crate::plot::edge::edge_figure;
use crate::plot::shelf::Shelf;
use crate::plot::{Figure, Format, lobes, render};
use crate::scene::load::staging::bare_scene;
use crate::scene::load::toml::{METALS, nearest};
use crate::scene::load::{self, Override};
use crate::scene::{Distribution, Fresnel, Lobe, Masking, Material, Model, Rgb, Scene};
use anyhow::Context;
use clap::{Args, Subcommand};
use std::io::Write;
use std::path::{Path, PathBuf};

#[derive(Args)]
#[command(after_help = "\
Examples:
  gonio plot lobe scenes/lecture/14-cook-torrance.toml --theta 60 -o lobes.svg
  gonio plot lobe scene.toml --material brass --material clay --cartesian -o lobes.png
  gonio plot cos-n --n 1,8,64 -o highlight.svg
  gonio plot albedo --against roughness --theta 0,60,85
  gonio plot fit nickel.binary -o fit.svg
  gonio plot fresnel --metal Cu -o - | display")]
pub struct PlotArgs {
    #[command(subcommand)]
    what: What,
    /// .svg, .png, or .csv for the numbers; `-` is standard output, SVG unless --format says otherwise.
    /// Default: the plot's name, .svg.
    #[arg(short, long, global = true, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Format, where the output's name does not tell: svg, png, csv.
    #[arg(long, global = true, value_name = "NAME", value_parser = format_name)]
    format: Option<Format>,
    /// Size in pixels, from 240x180.
    #[arg(long, global = true, value_name = "WxH", default_value = "900x560")]
    size: Size,
}

#[derive(Subcommand)]
enum What {
    /// Reflection over angle for light from one direction: polar, Cartesian or in perspective.
    Lobe(LobeArgs),
    /// The part of all light that is reflected, against the angle of view or roughness.
    Albedo(AlbedoArgs),
    /// Ward, Phong and Cook-Torrance fitted to a measured table: their lobes, parameters and errors.
    Fit(FitArgs),
    /// Phong's cos^n for several n.
    CosN {
        /// Exponents.
        #[arg(long, value_name = "LIST", value_delimiter = ',', default_value = "1,8,64", value_parser = exponent)]
        n: Vec<f32>,
    },
    /// D, the distribution of facets, against the angle of the half vector.
    D {
        /// Roughness: rms slope m, or alpha.
        #[arg(long, value_name = "LIST", value_delimiter = ',', default_value = "0.2,0.3,0.4,0.6", value_parser = roughness)]
        m: Vec<f32>,
        /// beckmann, gaussian, trowbridge-reitz, phong.
        #[arg(long, value_name = "LIST", value_delimiter = ',', default_value = "beckmann", value_parser = facets)]
        distribution: Vec<Facets>,
    },
    /// G, masking and shadowing, against the angle of view.
    G {
        /// Angles of the light, degrees.
        #[arg(long, value_name = "LIST", value_delimiter = ',', default_value = "0,30,60", value_parser = angle)]
        theta: Vec<f64>,
        /// Roughness of Smith's surface.
        #[arg(long, value_name = "M", default_value = "0.6", value_parser = roughness)]
        m: f32,
    },
    /// Fresnel reflectance against the angle; one metal alone by channel, with Schlick's approximation.
    Fresnel(FresnelArgs),
    /// The colour of Fresnel reflectance against the angle.
    Ramp(FresnelArgs),
    /// Directed light: lines of equal intensity.
    Light {
        /// Exponents.
        #[arg(long, value_name = "LIST", value_delimiter = ',', default_value = "1,8,64", value_parser = exponent)]
        p: Vec<f32>,
        /// Half angle of the cone, degrees.
        #[arg(long, value_name = "DEGREES", default_value = "40", value_parser = angle)]
        delta: f64,
    },
    /// How light falls off with distance.
    Attenuation {
        /// c1, c2 and c3 of min(1, 1 / (c1 + c2 d + c3 d^2)).
        #[arg(long, value_name = "LIST", value_delimiter = ',', default_value = "0.6,0.35,0.05", value_parser = constant)]
        c: Vec<f32>,
    },
    /// Reconstruction filters.
    Filter,
    /// Flat, Gouraud and Phong shading along a row of pixels.
    Edge,
    /// What a display shows of light.
    Tone {
        /// Stops.
        #[arg(long, value_name = "EV", default_value = "0", allow_negative_numbers = true, value_parser = stops)]
        exposure: f64,
    },
    /// Time a ray against the number of triangles, as `gonio bench` measured it.
    Growth(GrowthArgs),
}

#[derive(Args)]
struct AlbedoArgs {
    #[command(flatten)]
    shelf: ShelfArgs,
    /// angle or roughness.
    #[arg(long, value_name = "WHAT", default_value = "angle", value_parser = ["angle", "roughness"])]
    against: String,
    /// Angles of view, degrees, where it is against roughness.
    #[arg(long, value_name = "LIST", value_delimiter = ',', default_value = "0,60,85", value_parser = angle)]
    theta: Vec<f64>,
}

/// Which materials.
#[derive(Args)]
pub struct ShelfArgs {
    /// A scene file; without it, a few materials of the house.
    scene: Option<PathBuf>,
    /// The material of this name; may be repeated. Default: all that reflect.
    #[arg(long, value_name = "NAME")]
    material: Vec<String>,
    /// Change any key of the scene file first, as in `material.copper.m=0.1`; may be repeated.
    #[arg(long, value_name = "KEY=VALUE", requires = "scene")]
    set: Vec<String>,
}

#[derive(Args)]
struct LobeArgs {
    #[command(flatten)]
    shelf: ShelfArgs,
    /// Angle of the light from the normal, degrees.
    #[arg(long, value_name = "DEGREES", default_value = "45", value_parser = angle)]
    theta: f64,
    /// Against the angle of view instead of around it.
    #[arg(long)]
    cartesian: bool,
    /// In perspective, over all directions.
    #[arg(long = "3d", conflicts_with = "cartesian")]
    perspective: bool,
}

#[derive(Args)]
struct FresnelArgs {
    /// Cu, Au, Ag, Al, Cr.
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = metal)]
    metal: Vec<Interface>,
    /// Indices of refraction.
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = index)]
    eta: Vec<Interface>,
}

fn number_in(text: &str, low: f64, high: f64, what: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(value) if (low..=high).contains(&value) => Ok(value),
        _ => Err(format!("expected {what} from {low} to {high}")),
    }
}

fn exponent(text: &str) -> Result<f32, String> {
    number_in(text, 0.0, 1.0e6, "an exponent").map(|v| v as f32)
}

fn roughness(text: &str) -> Result<f32, String> {
    number_in(text, 0.01, 2.0, "a roughness").map(|v| v as f32)
}

fn constant(text: &str) -> Result<f32, String> {
    number_in(text, 0.0, 1.0e6, "a constant").map(|v| v as f32)
}

pub fn angle(text: &str) -> Result<f64, String> {
    number_in(text, 0.0, 89.0, "degrees")
}

fn stops(text: &str) -> Result<f64, String> {
    number_in(text, -16.0, 16.0, "stops")
}

fn facets(text: &str) -> Result<Facets, String> {
    let known = FACETS.map(|facets| facets.name).join(", ");
    FACETS.into_iter().find(|facets| facets.name == text).ok_or_else(|| format!("allowed: {known}"))
}

fn index(text: &str) -> Result<Interface, String> {
    let eta = number_in(text, 0.1, 10.0, "an index of refraction")? as f32;
    Ok(Interface::dielectric(eta))
}

fn metal(name: &str) -> Result<Interface, String> {
    let found = METALS.iter().find(|(symbol, _)| *symbol == name).map(|(_, metal)| metal.fresnel());
    match found {
        Some(Fresnel::Conductor { eta, k }) => {
            Ok(Interface { name: name.into(), kind: InterfaceKind::Conductor { eta, k } })
        }
        _ => Err(format!("allowed: {}", METALS.iter().map(|(symbol, _)| *symbol).collect::<Vec<_>>().join(", "))),
    }
}

fn format_name(name: &str) -> Result<Format, String> {
    Format::from_name(name).ok_or_else(|| "allowed: svg, png, csv".into())
}

/// Smaller pictures have no room for their words.
const LEAST: [u32; 2] = [240, 180];
/// A bitmap is drawn nine times as large.
const LARGEST: u32 = 8192;

pub fn run(args: &PlotArgs) -> anyhow::Result<ExitCode> {
    let size = [args.size.width, args.size.height];
    if size[0] < LEAST[0] || size[1] < LEAST[1] || size.iter().any(|pixels| *pixels > LARGEST) {
        let message = format!("--size {}x{}: allowed is 240x180 to {LARGEST}x{LARGEST}", size[0], size[1]);
        return Err(Usage(message).into());
    }
    let path = args.output.clone().unwrap_or_else(|| PathBuf::from(format!("{}.svg", args.what.name())));
    let format = args.format.map_or_else(|| format_of(&path), Ok)?;
    let mut output = OutputFile::open(&path)?;
    let (figure, report) = args.what.plot()?;
    if format == Format::Csv && figure.curves.is_empty() {
        return Err(Usage("this plot has no curves: .svg or .png".into()).into());
    }
    let file = render(&figure, format, size)?;
    output.write_all(&file).map_err(|error| FilmError::write(&path, error))?;
    let is_stdout = output.is_stdout();
    output.commit()?;
    // Standard output has room for one of them.
    match is_stdout {
        true => std::io::stderr().write_all(report.as_bytes()).context("cannot write standard error")?,
        false => std::io::stdout().write_all(report.as_bytes()).context("cannot write standard output")?,
    }
    Ok(ExitCode::SUCCESS)
}

fn format_of(path: &Path) -> Result<Format, Usage> {
    if path == Path::new("-") {
        return Ok(Format::Svg);
    }
    let extension = path.extension().map(|extension| extension.to_string_lossy().into_owned());
    extension.as_deref().and_then(Format::from_name).ok_or_else(|| {
        let found = extension.map_or_else(|| "no extension".into(), |e| format!("unknown extension .{e}"));
        Usage(format!("{}: {found}; allowed: .svg, .png, .csv", path.display()))
    })
}

impl What {
    fn name(&self) -> &'static str {
        match self {
            Self::Lobe(_) => "lobe",
            Self::Albedo(_) => "albedo",
            Self::Fit(_) => "fit",
            Self::CosN { .. } => "cos-n",
            Self::D { .. } => "d",
            Self::G { .. } => "g",
            Self::Fresnel(_) => "fresnel",
            Self::Ramp(_) => "ramp",
            Self::Light { .. } => "light",
            Self::Attenuation { .. } => "attenuation",
            Self::Filter => "filter",
            Self::Edge => "edge",
            Self::Tone { .. } => "tone",
            Self::Growth(_) => "growth",
        }
    }

    /// The picture, and what is printed beside it.
    fn plot(&self) -> anyhow::Result<(Figure, String)> {
        let figure = match self {
            Self::Lobe(args) => args.figure()?,
            Self::Albedo(args) => args.figure()?,
            Self::Fit(args) => return args.plot(),
            Self::CosN { n } => curves::cos_power_figure(n),
            Self::D { m, distribution } => curves::distribution_figure(distribution, m),
            Self::G { theta, m } => curves::masking_figure(theta, *m),
            Self::Fresnel(args) => curves::fresnel_figure(&args.interfaces(&["1.5", "2.417"])?),
            Self::Ramp(args) => curves::ramp_figure(&args.interfaces(&[])?),
            Self::Light { p, delta } => curves::spot_figure(p, *delta),
            Self::Attenuation { c } => match c[..] {
                [c1, c2, c3] => curves::attenuation_figure([c1, c2, c3]),
                _ => return Err(Usage(format!("--c has three numbers, found {}", c.len())).into()),
            },
            Self::Filter => curves::filter_figure(),
            Self::Edge => edge_figure()?,
            Self::Tone { exposure } => curves::tone_figure(*exposure),
            Self::Growth(args) => args.figure()?,
        };
        Ok((figure, String::new()))
    }
}

impl FresnelArgs {
    /// What was asked for, else all metals and `etas`.
    fn interfaces(&self, etas: &[&str]) -> anyhow::Result<Vec<Interface>> {
        let asked: Vec<Interface> = self.metal.iter().chain(&self.eta).cloned().collect();
        if !asked.is_empty() {
            return Ok(asked);
        }
        let metals = METALS.iter().map(|(symbol, _)| metal(symbol));
        let all: Result<Vec<Interface>, String> = metals.chain(etas.iter().map(|eta| index(eta))).collect();
        all.map_err(|message| Usage(message).into())
    }
}

impl LobeArgs {
    fn figure(&self) -> anyhow::Result<Figure> {
        let (_, shelf, chosen) = self.shelf.open(phong_and_cook_torrance)?;
        Ok(match (self.cartesian, self.perspective) {
            (true, _) => lobes::cartesian_figure(&shelf, &chosen, self.theta),
            (_, true) => lobes::bodies_figure(&shelf, &chosen, self.theta),
            _ => lobes::polar_figure(&shelf, &chosen, self.theta),
        })
    }
}

impl AlbedoArgs {
    fn figure(&self) -> anyhow::Result<Figure> {
        if self.against == "angle" {
            let (_, shelf, chosen) = self.shelf.open(rough_metals)?;
            return Ok(lobes::albedo_figure(&shelf, &chosen));
        }
        let (scene, _, chosen) = self.shelf.open(metals_of_any_roughness)?;
        let materials: Vec<Material> = chosen.iter().map(|index| scene.materials[*index].clone()).collect();
        let figure = lobes::albedo_by_roughness_figure(&materials, &self.theta)?;
        if figure.curves.len() < 2 {
            return Err(Usage("none of the materials has a roughness".into()).into());
        }
        Ok(figure)
    }
}

impl ShelfArgs {
    /// A scene with `--set` applied.
    pub fn load(path: &Path, set: &[String]) -> anyhow::Result<Scene> {
        let parse = |text: &String| text.parse().map_err(|error| Usage(format!("--set {text}: {error}")));
        let overrides = set.iter().map(parse).collect::<Result<Vec<Override>, _>>()?;
        let scene = load::load(path, &overrides)?;
        super::strict::check(&scene.warnings)?;
        Ok(scene)
    }

    /// The error for a material that is not there.
    pub fn unknown(scene: &Scene, name: &str) -> Usage {
        let known: Vec<&str> = scene.materials.iter().map(|material| material.name.as_str()).collect();
        let hint = nearest(name, known.iter().copied())
            .map_or_else(|| format!("; there are {}", known.join(", ")), |near| format!("; did you mean {near:?}?"));
        Usage(format!("there is no material {name:?}{hint}"))
    }

    /// The scene, or one of the materials that `house` makes; its materials, and which of them to show.
    fn open(&self, house: fn() -> Vec<Material>) -> anyhow::Result<(Scene, Shelf, Vec<usize>)> {
        let scene = match &self.scene {
            None => Scene { materials: house(), ..bare_scene(Path::new("gonio plot")) },
            Some(path) => Self::load(path, &self.set)?,
        };
        let shelf = Shelf::of(&scene).with_context(|| scene.name.clone())?;
        let named = |name: &String| shelf.find(name).ok_or_else(|| Self::unknown(&scene, name));
        let chosen = match self.material.is_empty() {
            false => self.material.iter().map(named).collect::<Result<Vec<usize>, _>>()?,
            true => (0..shelf.names().len()).filter(|index| shelf.reflects(*index)).collect(),
        };
        if chosen.is_empty() {
            return Err(Usage("the scene has no material that reflects over a range of angles".into()).into());
        }
        Ok((scene, shelf, chosen))
    }
}

fn phong_and_cook_torrance() -> Vec<Material> {
    let white = Material { color: Rgb::splat(0.3), k_d: 0.5, k_s: 0.5, ..Material::grey("") };
    let facets = Model::CookTorrance {
        lobes: vec![Lobe::beckmann(0.3, 1.0)],
        fresnel: Fresnel::Schlick { f0: Rgb::ONE },
        masking: Masking::VCavity,
        normalisation_1982: false,
    };
    vec![
        Material { name: "lambert".into(), model: Model::Lambert, k_d: 1.0, k_s: 0.0, ..white.clone() },
        Material {
            name: "phong, n = 16".into(),
            model: Model::Phong { exponent: 16.0, lafortune: Some(true) },
            ..white.clone()
        },
        Material { name: "cook-torrance, m = .3".into(), model: facets, ..white },
    ]
}

fn rough_metals() -> Vec<Material> {
    let metal = |alpha: f32, compensate: bool| {
        let name = format!("α = {alpha}{}", if compensate { ", compensated" } else { "" });
        Material { name, ..white_metal(alpha, compensate) }
    };
    [0.1, 0.3, 0.6, 1.0].map(|alpha| metal(alpha, false)).into_iter().chain([metal(1.0, true)]).collect()
}

fn metals_of_any_roughness() -> Vec<Material> {
    vec![white_metal(1.0, false), white_metal(1.0, true)]
}

/// Reflects everything: what is missing was lost between facets.
fn white_metal(alpha: f32, compensate: bool) -> Material {
    Material {
        name: if compensate { "compensated" } else { "scattered once" }.into(),
        model: Model::RoughConductor {
            distribution: Distribution::TrowbridgeReitz,
            alpha_u: alpha,
            alpha_v: alpha,
            fresnel: Fresnel::Schlick { f0: Rgb::ONE },
            compensate,
        },
        ..Material::grey("")
    }
}
