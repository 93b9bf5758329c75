//! Measured reflectance as loaded (row 9).

use std::sync::Arc;

/// One table of measured values.
#[derive(Clone, Debug, PartialEq)]
pub enum Table {
    /// MERL's isotropic layout: planes R, G, B of 90 x 90 x 180 values, phi_d fastest, then theta_d, then theta_h (its index grows as
    /// the square root of the angle). BRDF per steradian, already scaled; negative where a direction is below the horizon.
    Merl {
        values: Arc<Vec<f32>>,
    },
    Directional(Arc<DirectionalTable>),
}

/// Values for each of a set of directions of light; anisotropic if that has several azimuths.
#[derive(Clone, Debug, PartialEq)]
pub struct DirectionalTable {
    /// From the normal, radians, 0 to pi / 2, ascending; at least one.
    pub light_angles: Vec<f64>,
    /// Azimuths of light: so many equal parts of a period.
    pub light_azimuths: u32,
    /// Periods in a turn: turning the surface by one of them changes nothing.
    pub fold: u32,
    /// From the normal, radians, 0 to pi / 2, ascending; at least one.
    pub view_angles: Vec<f64>,
    /// Azimuths of view: so many equal parts of a turn, counted from the light's azimuth.
    pub view_azimuths: u32,
    /// BRDF per steradian, >= 0: channel fastest (R, G, B), then view azimuth, view angle, light azimuth, light angle.
    pub values: Vec<f32>,
}

impl DirectionalTable {
    /// Numbers in `values`.
    pub fn count(&self) -> u64 {
        let lights = self.light_angles.len() as u64 * u64::from(self.light_azimuths);
        lights * self.view_angles.len() as u64 * u64::from(self.view_azimuths) * 3
    }
}
