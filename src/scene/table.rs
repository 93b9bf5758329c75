//! Measured reflectance as loaded (row 9).

use std::sync::Arc;

/// One table of measured values.
#[derive(Clone, Debug, PartialEq)]
pub enum Table {
    /// MERL's isotropic layout: planes R, G, B of 90 x 90 x 180 values, phi_d fastest, then theta_d, then theta_h (its index grows as
    /// the square root of the angle). BRDF per steradian, already scaled; negative where a direction is below the horizon.
    Merl { values: Arc<Vec<f32>> },
}
