//! `gonio plot fit`: analytic models fitted to a measured table.

use super::Usage;
use super::plot::ShelfArgs;
use crate::plot::Figure;
use crate::plot::figure::number;
use crate::plot::fit::{FIT_MODELS, Fit, FitModel, Fitting, fit, fit_figure, percent};
use crate::plot::shelf::Shelf;
use crate::scene::load::measured::read_table;
use crate::scene::load::staging::bare_scene;
use crate::scene::{Material, Model, Scene, TableId};
use anyhow::Context;
use clap::Args;
use serde_json::{Map, Value, json};
use std::path::{Path, PathBuf};

#[derive(Args)]
pub struct FitArgs {
    /// A measured table (scenes/README.md, "Measured tables"), or a scene file.
    file: PathBuf,
    /// Of a scene: the material of this name. Default: its first measured one.
    #[arg(long, value_name = "NAME")]
    material: Option<String>,
    /// Of a scene: change any of its keys first; may be repeated.
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// ward, phong, cook-torrance.
    #[arg(long, value_name = "LIST", value_delimiter = ',', default_value = "ward,phong,cook-torrance", value_parser = model)]
    model: Vec<FitModel>,
    /// Angle of the light from the normal in the picture, degrees.
    #[arg(long, value_name = "DEGREES", default_value = "45", value_parser = super::plot::angle)]
    theta: f64,
    /// Against the angle of view instead of around it.
    #[arg(long)]
    cartesian: bool,
    /// Print the result as one JSON object.
    #[arg(long)]
    pub json: bool,
}

fn model(text: &str) -> Result<FitModel, String> {
    let known = FIT_MODELS.map(|(name, _)| name).join(", ");
    FIT_MODELS.into_iter().find(|(name, _)| *name == text).map(|(_, m)| m).ok_or_else(|| format!("allowed: {known}"))
}

/// Formats that `scene::load` reads; everything else is a table.
const SCENES: [&str; 6] = ["toml", "obj", "gltf", "glb", "ply", "xml"];

impl FitArgs {
    /// The picture, and what is printed beside it.
    pub fn plot(&self) -> anyhow::Result<(Figure, String)> {
        let (scene, index) = self.open()?;
        let shelf = Shelf::of(&scene).with_context(|| scene.name.clone())?;
        if !shelf.reflects(index) {
            let name = &shelf.names()[index];
            return Err(Usage(format!("{name:?} does not reflect over a range of angles")).into());
        }
        let fitting = fit(&shelf, index, &self.model)?;
        let figure = fit_figure(&scene, index, &fitting, self.theta, !self.cartesian)?;
        let report = if self.json { json(&fitting)? } else { table(&fitting) };
        Ok((figure, report))
    }

    /// A scene with the material, and its number.
    fn open(&self) -> anyhow::Result<(Scene, usize)> {
        let extension = self.file.extension().map(|extension| extension.to_string_lossy().to_ascii_lowercase());
        if self.file == Path::new("-") || extension.is_some_and(|extension| SCENES.contains(&extension.as_str())) {
            let scene = ShelfArgs::load(&self.file, &self.set)?;
            let index = match &self.material {
                Some(name) => Shelf::of(&scene)?.find(name).ok_or_else(|| ShelfArgs::unknown(&scene, name))?,
                None => measured(&scene)?,
            };
            return Ok((scene, index));
        }
        if self.material.is_some() || !self.set.is_empty() {
            return Err(Usage("--material and --set are of scene files; this is a table".into()).into());
        }
        let mut scene = bare_scene(&self.file);
        scene.tables = vec![read_table(&self.file)?];
        let name = self.file.file_stem().map_or_else(|| "measured".into(), |stem| stem.to_string_lossy());
        let material = Material { model: Model::Measured { table: TableId(0) }, ..Material::grey(name) };
        scene.materials = vec![material];
        Ok((scene, 0))
    }
}

fn measured(scene: &Scene) -> Result<usize, Usage> {
    let found = scene.materials.iter().position(|material| matches!(material.model, Model::Measured { .. }));
    found.ok_or_else(|| Usage("the scene has no measured material; choose one with --material".into()))
}

/// The errors as a table, then the materials as a scene file has them.
fn table(fitting: &Fitting) -> String {
    let mut text = format!(
        "{}: {} pairs of light and view, root mean square of f cos θ {} /sr\n\n",
        fitting.name,
        fitting.pairs,
        number(fitting.rms)
    );
    for fit in &fitting.fits {
        let (name, error) = (fit.model.name(), number(fit.error));
        text.push_str(&format!("{name:14} error {error:>9} /sr {:>8}\n", percent(fit.error, fitting.rms)));
    }
    for fit in &fitting.fits {
        text.push_str(&format!("\n{}", fit.toml(&format!("{}, {}", fitting.name, fit.model.name()))));
    }
    text
}

fn json(fitting: &Fitting) -> anyhow::Result<String> {
    let one = |fit: &Fit| {
        let parameters = fit.parameters().into_iter().map(|(key, values)| {
            let value = if let [one] = values[..] { json!(one) } else { json!(values) };
            (key.to_owned(), value)
        });
        json!({
            "model": fit.model.name(),
            "parameters": parameters.collect::<Map<String, Value>>(),
            "diffuse": fit.diffuse,
            "specular": fit.specular,
            "error": fit.error,
            "relative_error": if fitting.rms > 0.0 { fit.error / fitting.rms } else { 0.0 },
            "material": fit.toml(&format!("{}, {}", fitting.name, fit.model.name())),
        })
    };
    let fits: Vec<Value> = fitting.fits.iter().map(one).collect();
    let report = json!({ "name": fitting.name, "pairs": fitting.pairs, "rms": fitting.rms, "fits": fits });
    Ok(serde_json::to_string_pretty(&report)? + "\n")
}
