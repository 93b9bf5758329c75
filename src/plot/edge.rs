//! Flat, Gouraud and Phong shading along a line over the triangles of a sphere (row 8), rendered as any scene is.

use super::canvas::PlotError;
use super::figure::{Axis, Curve, Figure, Frame, Mark, palette};
use crate::bake::bake;
use crate::film::{Film, FilmSpec};
use crate::layout::INVALID;
use crate::render::cpu::CpuRenderer;
use crate::render::session::{Member, Session};
use crate::scene::Shading;
use crate::scene::load::toml::scene_from_text;
use crate::watch::Watch;
use std::path::Path;

/// A row of pixels across the highlight of the sphere of scenes/lecture/08-shading-models.toml.
const SCENE: &str = include_str!("edge.toml");

/// Radiance along the row, for one way to shade.
pub struct Profile {
    pub radiance: Vec<f64>,
    /// The triangle at each pixel, or `INVALID`.
    pub triangles: Vec<u32>,
}

/// Renders the row.
pub fn profile(shading: Shading) -> Result<Profile, PlotError> {
    let mut scene = scene_from_text(Path::new("edge.toml"), SCENE.to_owned(), &[]).map_err(PlotError::new)?;
    scene.settings.shading = shading;
    let data = bake(&scene).map_err(PlotError::new)?;
    let renderer = CpuRenderer::new(&data, Some(1)).map_err(PlotError::new)?;
    let film = Film::new(FilmSpec::of(&scene, data.digest(), false, false));
    let session = Session::new(film, vec![Member::of(renderer)]);
    session.render(0..scene.settings.samples, &Watch::default()).map_err(PlotError::new)?;
    let mut triangles = Vec::new();
    for x in 0..scene.film.width {
        let bounces = session.inspect(x, 0, 0).map_err(PlotError::new)?;
        triangles.push(bounces.first().map_or(INVALID, |bounce| bounce.hit.primitive));
    }
    let radiance = session.into_film().resolve().pixels.iter().map(|pixel| f64::from(pixel[1])).collect();
    Ok(Profile { radiance, triangles })
}

/// The three profiles over the same triangles, whose edges are marked.
pub fn edge_figure() -> Result<Figure, PlotError> {
    let mut curves = Vec::new();
    let mut marks = Vec::new();
    let shadings = [("flat", Shading::Flat), ("gouraud", Shading::Gouraud), ("phong", Shading::Phong)];
    for (i, (name, shading)) in shadings.into_iter().enumerate() {
        let profile = profile(shading)?;
        let place = |pixel: usize| (pixel as f64 + 0.5) / profile.radiance.len() as f64;
        let points = profile.radiance.iter().enumerate().map(|(x, radiance)| [place(x), *radiance]).collect();
        curves.push(Curve { name: name.into(), color: palette(i), dashed: false, points });
        let changes = profile.triangles.windows(2).enumerate().filter(|(_, pair)| pair[0] != pair[1]);
        marks = changes
            .map(|(x, _)| Mark { name: String::new(), x: place(x) + 0.5 / profile.radiance.len() as f64 })
            .collect();
    }
    let x = Axis { label: "place along the row".into(), low: 0.0, high: 1.0, step: 0.2 };
    let note = "a row of pixels across the highlight; dashed: edges of triangles";
    let mut figure = Figure::cartesian("Shading models across edges", note, x, "radiance, green", curves);
    if let Frame::Cartesian { marks: shown, .. } = &mut figure.frame {
        *shown = marks;
    }
    Ok(figure)
}
