//! Measured tables in the layout of `shading/measured`.

use crate::layout::MODEL_MEASURED;
use crate::shading::closure::Closure;
use crate::shading::measured::{MEASURED_D, MEASURED_H, MEASURED_P, measured_edge};

/// Appends a table: first the steps of the integral over theta_h that samples are drawn from, then its three planes.
pub fn measured_table(values: &[f32], closure: &mut Closure, tables: &mut Vec<f32>) {
    closure.model = MODEL_MEASURED;
    let plane = (MEASURED_H * MEASURED_D * MEASURED_P) as usize;
    debug_assert_eq!(values.len(), 3 * plane);
    closure.table = tables.len() as u32;
    tables.extend(steps(values, plane));
    // Below the horizon MERL's tables hold -1.
    tables.extend(values.iter().map(|value| value.max(0.0)));
}

/// Ascending shares, 0 to 1, of what half vectors up to each cell's end reflect: the mean of the cell's valid values times
/// its projected solid angle.
fn steps(values: &[f32], plane: usize) -> Vec<f32> {
    let row = plane / MEASURED_H as usize;
    let weight = |cell: u32| {
        let (mut sum, mut count) = (0.0f64, 0u32);
        for channel in values.chunks_exact(plane) {
            for &value in channel[cell as usize * row..][..row].iter().filter(|value| **value >= 0.0) {
                sum += f64::from(value);
                count += 1;
            }
        }
        let size = f64::from(measured_edge(cell + 1)) - f64::from(measured_edge(cell));
        sum / f64::from(count.max(1)) * size
    };
    let weights: Vec<f64> = (0..MEASURED_H).map(weight).collect();
    let whole: f64 = weights.iter().sum();
    let mut steps = vec![0.0];
    let mut sum = 0.0;
    for (cell, weight) in weights.iter().enumerate() {
        // A table that reflects nothing is drawn from evenly.
        sum += if whole > 0.0 { weight / whole } else { 1.0 / weights.len() as f64 };
        steps.push(if cell + 1 == weights.len() { 1.0 } else { sum as f32 });
    }
    steps
}
