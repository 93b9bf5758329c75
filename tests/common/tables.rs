//! Writers of measured tables, from any function of two directions.
#![allow(dead_code, reason = "each test binary uses its own part")]

use glam::{DVec3, Vec3};
use gonio::scene::{DirectionalTable, Table};
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::fmt::Write;
use std::sync::Arc;

/// A table's grid in gonio's own format.
#[derive(Clone, Debug)]
pub struct Grid {
    /// The file's second line.
    pub comment: &'static str,
    /// Degrees.
    pub light_theta: Vec<f64>,
    pub light_phi: u32,
    pub symmetry: u32,
    pub view_theta: Vec<f64>,
    pub view_phi: u32,
    /// Azimuths of view count from the surface's tangent, not from the light.
    pub from_surface: bool,
    pub channels: usize,
}

impl Grid {
    /// Every direction of light and view in the order of the file.
    pub fn directions(&self) -> Vec<[Vec3; 2]> {
        let mut found = Vec::new();
        for light in &self.light_theta {
            for i in 0..self.light_phi {
                let light_phi = TAU * f64::from(i) / f64::from(self.light_phi * self.symmetry);
                for view in &self.view_theta {
                    for j in 0..self.view_phi {
                        let start = if self.from_surface { 0.0 } else { light_phi };
                        let view_phi = start + TAU * f64::from(j) / f64::from(self.view_phi);
                        found.push([polar(*light, light_phi), polar(*view, view_phi)]);
                    }
                }
            }
        }
        found
    }

    fn head(&self, data: &str) -> String {
        let list = |angles: &[f64]| angles.iter().map(f64::to_string).collect::<Vec<_>>().join(" ");
        let mut head = format!("gonio-brdf 1\n# {}\nlight_theta {}\n", self.comment, list(&self.light_theta));
        let from = if self.from_surface { "surface" } else { "light" };
        let _ = writeln!(head, "light_phi {}\nsymmetry {}", self.light_phi, self.symmetry);
        let _ = writeln!(head, "view_theta {}\nview_phi {}", list(&self.view_theta), self.view_phi);
        let _ = writeln!(head, "view_phi_from {from}\nchannels {}\ndata {data}", self.channels);
        head
    }

    /// The file with `brdf` of light and view, its numbers as 32-bit floats.
    pub fn float_file(&self, brdf: impl Fn(Vec3, Vec3) -> [f64; 3]) -> Vec<u8> {
        let mut file = self.head("float32").into_bytes();
        for [light, view] in self.directions() {
            let values = brdf(light, view);
            values[..self.channels].iter().for_each(|value| file.extend((*value as f32).to_le_bytes()));
        }
        file
    }

    /// The table itself, grey and with azimuths of view from the light's.
    pub fn table(&self, brdf: impl Fn(Vec3, Vec3) -> f64) -> Table {
        let radians = |angles: &[f64]| angles.iter().map(|angle| angle.to_radians()).collect();
        Table::Directional(Arc::new(DirectionalTable {
            light_angles: radians(&self.light_theta),
            light_azimuths: self.light_phi,
            fold: self.symmetry,
            view_angles: radians(&self.view_theta),
            view_azimuths: self.view_phi,
            values: self.directions().into_iter().flat_map(|[light, view]| [brdf(light, view) as f32; 3]).collect(),
        }))
    }

    /// The same, its numbers as text.
    pub fn text_file(&self, brdf: impl Fn(Vec3, Vec3) -> [f64; 3]) -> Vec<u8> {
        let mut file = self.head("text");
        for [light, view] in self.directions() {
            brdf(light, view)[..self.channels].iter().for_each(|value| {
                let _ = writeln!(file, "{}", *value as f32);
            });
        }
        file.into_bytes()
    }
}

/// `theta` in degrees, `phi` in radians. Directions at the horizon are taken just above it.
fn polar(theta: f64, phi: f64) -> Vec3 {
    let theta = theta.min(89.99).to_radians();
    DVec3::new(libm::sin(theta) * libm::cos(phi), libm::sin(theta) * libm::sin(phi), libm::cos(theta)).as_vec3()
}

/// Cells of a MERL table.
const MERL: [usize; 3] = [90, 90, 180];
/// What a file's values are the BRDF divided by.
const MERL_SCALES: [f64; 3] = [1.0 / 1500.0, 1.15 / 1500.0, 1.66 / 1500.0];

/// Light and view in the middle of a cell of a MERL table; below the horizon too.
pub fn merl_directions(cell: [usize; 3]) -> [DVec3; 2] {
    let middle = cell.map(|index| index as f64 + 0.5);
    let x = middle[0] / MERL[0] as f64;
    let theta_h = FRAC_PI_2 * x * x;
    let (theta_d, phi_d) = (FRAC_PI_2 * middle[1] / MERL[1] as f64, PI * middle[2] / MERL[2] as f64);
    let turned = |phi_d: f64| {
        let d = [libm::sin(theta_d) * libm::cos(phi_d), libm::sin(theta_d) * libm::sin(phi_d), libm::cos(theta_d)];
        DVec3::new(
            d[0] * libm::cos(theta_h) + d[2] * libm::sin(theta_h),
            d[1],
            d[2] * libm::cos(theta_h) - d[0] * libm::sin(theta_h),
        )
    };
    [turned(phi_d), turned(phi_d + PI)]
}

/// The cell of a MERL table that has light and view, by the database's own rules (Matusik et al. 2003).
pub fn merl_cell(light: DVec3, view: DVec3) -> [usize; 3] {
    let half = (light + view).normalize();
    let theta_h = libm::acos(half.z.min(1.0));
    let phi_h = libm::atan2(half.y, half.x);
    let a = DVec3::new(
        light.x * libm::cos(phi_h) + light.y * libm::sin(phi_h),
        light.y * libm::cos(phi_h) - light.x * libm::sin(phi_h),
        light.z,
    );
    let d = DVec3::new(
        a.x * libm::cos(theta_h) - a.z * libm::sin(theta_h),
        a.y,
        a.x * libm::sin(theta_h) + a.z * libm::cos(theta_h),
    );
    let theta_d = libm::acos(d.z.clamp(-1.0, 1.0));
    let phi_d = libm::atan2(d.y, d.x).rem_euclid(PI);
    let cell = |x: f64, count: usize| ((x * count as f64) as usize).min(count - 1);
    [cell((theta_h / FRAC_PI_2).sqrt(), MERL[0]), cell(theta_d / FRAC_PI_2, MERL[1]), cell(phi_d / PI, MERL[2])]
}

/// A MERL table, grey, of a function of theta_h and theta_d at the cells' middles.
pub fn merl_table(f: impl Fn(f64, f64) -> f64) -> Table {
    let mut plane = Vec::new();
    for h in 0..MERL[0] {
        let x = (h as f64 + 0.5) / MERL[0] as f64;
        for d in 0..MERL[1] {
            let value = f(FRAC_PI_2 * x * x, FRAC_PI_2 * (d as f64 + 0.5) / MERL[1] as f64) as f32;
            plane.extend([value; MERL[2]]);
        }
    }
    Table::Merl { values: Arc::new(plane.repeat(3)) }
}

/// The MERL file of `brdf` of light and view at the cells' middles; -1 below the horizon, as the database has it.
pub fn merl_file(brdf: impl Fn(Vec3, Vec3) -> [f64; 3]) -> Vec<u8> {
    let mut file: Vec<u8> = MERL.iter().flat_map(|size| (*size as u32).to_le_bytes()).collect();
    let mut planes = vec![Vec::new(); 3];
    for h in 0..MERL[0] {
        for d in 0..MERL[1] {
            for p in 0..MERL[2] {
                let [light, view] = merl_directions([h, d, p]);
                let value = (light.z > 0.0 && view.z > 0.0).then(|| brdf(light.as_vec3(), view.as_vec3()));
                for (channel, plane) in planes.iter_mut().enumerate() {
                    plane.push(value.map_or(-1.0, |value| value[channel] / MERL_SCALES[channel]));
                }
            }
        }
    }
    planes.iter().flatten().for_each(|value| file.extend(value.to_le_bytes()));
    file
}
