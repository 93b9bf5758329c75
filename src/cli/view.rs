//! Flags of the viewer: what is around a scene, from where it is seen, what it stands on.

use super::{Usage, tables};
use crate::scene::Integrator;
use crate::scene::load::Controls;
use crate::scene::load::controls::Around;
use clap::{Args, ValueEnum};
use glam::Vec3;

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum UpName {
    Y,
    Z,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Switch {
    On,
    Off,
}

/// What every viewer lets one turn, for scenes of every format.
#[derive(Args, Clone, Debug, Default)]
#[command(next_help_heading = "View")]
pub struct ViewFlags {
    /// What surrounds and lights the scene: studio, sky, white, or an equirectangular picture (.hdr, .exr).
    #[arg(long, value_name = "NAME|FILE")]
    environment: Option<String>,
    /// Turn the surroundings, degrees, counter-clockwise seen from above.
    #[arg(long, value_name = "DEGREES", requires = "environment", allow_negative_numbers = true, value_parser = angle)]
    environment_rotate: Option<f64>,
    /// Factor on the light of the surroundings.
    #[arg(long, value_name = "X", requires = "environment", allow_negative_numbers = true, value_parser = factor)]
    environment_scale: Option<f64>,
    /// One of the file's own cameras, by its name or its number from 0.
    #[arg(long, value_name = "NAME|N")]
    camera: Option<String>,
    /// See all of the scene from this side, degrees: 0 is the front (+z), 90 the right (+x).
    #[arg(long, value_name = "DEGREES", allow_negative_numbers = true, value_parser = angle)]
    azimuth: Option<f64>,
    /// See all of the scene from this height, degrees above the horizon, -90 to 90.
    #[arg(long, value_name = "DEGREES", allow_negative_numbers = true, value_parser = elevation)]
    elevation: Option<f64>,
    /// Show the middle so many times as large.
    #[arg(long, value_name = "X", allow_negative_numbers = true, value_parser = factor)]
    zoom: Option<f64>,
    /// Where the eye is.
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = point)]
    look_from: Option<Vec3>,
    /// What is in the middle of the picture; of the scene its middle if not given.
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = point)]
    look_at: Option<Vec3>,
    /// Full vertical field of view, degrees, 0.01 to 179.
    #[arg(long, value_name = "DEGREES", allow_negative_numbers = true, value_parser = field_of_view)]
    fov: Option<f64>,
    /// Which axis of the file points up; files of CAD programs and printers have z.
    #[arg(long)]
    up: Option<UpName>,
    /// Put the scene on a ground, or take that away which it would get.
    #[arg(long)]
    ground: Option<Switch>,
    /// One more light, by the keys of a [[light]], as in `type=point, position=[0,3,2], intensity=40`; may be repeated.
    #[arg(long, value_name = "KEYS", value_parser = light)]
    light: Vec<String>,
    /// Another material for one of the file's (`*`: for all), by a colour or by the keys of a [[material]], as in
    /// `body=red` or `body=model=rough-conductor, metal=Au, alpha=0.2`; may be repeated.
    #[arg(long, value_name = "NAME=KEYS", value_parser = material)]
    material: Vec<(String, String)>,
}

fn light(text: &str) -> Result<String, String> {
    tables::lines(text).ok_or_else(|| "expected keys and values, as in type=point, position=[0,3,2]".to_owned())
}

fn material(text: &str) -> Result<(String, String), String> {
    let expected = "expected NAME=COLOR, or NAME and keys, as in body=model=mirror or *=color=0.5, k_s=0.2";
    let (name, keys) = text.split_once('=').filter(|(name, _)| !name.is_empty()).ok_or(expected)?;
    let color = || format!("color = {}", tables::value(keys.trim()));
    let table = if keys.contains('=') { tables::lines(keys).ok_or(expected)? } else { color() };
    Ok((name.trim().to_owned(), table))
}

fn number(text: &str, range: std::ops::RangeInclusive<f64>, expected: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(value) if range.contains(&value) => Ok(value),
        _ => Err(format!("expected {expected}")),
    }
}

fn angle(text: &str) -> Result<f64, String> {
    number(text, -36_000.0..=36_000.0, "degrees from -36000 to 36000")
}

fn elevation(text: &str) -> Result<f64, String> {
    number(text, -90.0..=90.0, "degrees from -90 to 90")
}

fn field_of_view(text: &str) -> Result<f64, String> {
    number(text, 0.01..=179.0, "degrees from 0.01 to 179")
}

fn factor(text: &str) -> Result<f64, String> {
    number(text, 1e-6..=1e6, "a number from 1e-6 to 1e6")
}

fn point(text: &str) -> Result<Vec3, String> {
    let expected = "X,Y,Z, three numbers up to 1e9";
    let numbers = text.split(',').map(|part| number(part, -1e9..=1e9, expected).map(|v| v as f32));
    let numbers = numbers.collect::<Result<Vec<f32>, _>>()?;
    <[f32; 3]>::try_from(numbers).map(Vec3::from).map_err(|_| format!("expected {expected}"))
}

impl ViewFlags {
    /// What they ask for.
    pub fn controls(&self, integrator: Option<Integrator>, cut_out: bool) -> Result<Controls, Usage> {
        if let (Some(from), Some(at)) = (self.look_from, self.look_at)
            && from == at
        {
            return Err(Usage("--look-from and --look-at are the same point".to_owned()));
        }
        Ok(Controls {
            integrator,
            surroundings: self.environment.as_deref().map(Around::from_text),
            turn: self.environment_rotate.unwrap_or(0.0),
            strength: self.environment_scale.map(|scale| scale as f32),
            camera: self.camera.clone(),
            azimuth: self.azimuth,
            elevation: self.elevation,
            zoom: self.zoom,
            look_from: self.look_from,
            look_at: self.look_at,
            fov: self.fov.map(|degrees| degrees.to_radians() as f32),
            z_up: self.up == Some(UpName::Z),
            ground: self.ground.map(|ground| ground == Switch::On),
            cut_out,
            lights: self.light.clone(),
            materials: self.material.clone(),
        })
    }
}
