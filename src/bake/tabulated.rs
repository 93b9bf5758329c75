//! Tables for directions of light in the layout of `shading/tabulated`.

use crate::layout::{MATERIAL_ANISOTROPIC, MODEL_TABULATED};
use crate::scene::DirectionalTable;
use crate::shading::closure::Closure;
use std::f64::consts::{FRAC_PI_2, TAU};

/// Appends a table. The values at the first and last view angle hold up to the normal and down to the horizon.
pub fn tabulated_table(table: &DirectionalTable, closure: &mut Closure, tables: &mut Vec<f32>) {
    debug_assert_eq!(table.values.len() as u64, table.count());
    closure.model = MODEL_TABULATED;
    closure.flags |= if table.light_azimuths > 1 { MATERIAL_ANISOTROPIC } else { 0 };
    closure.table = tables.len() as u32;
    let (angles, rows) = view_rows(&table.view_angles);
    let azimuths = table.view_azimuths as usize;
    let counts = [table.light_angles.len(), table.light_azimuths as usize, angles.len(), azimuths, table.fold as usize];
    tables.extend(counts.map(|count| count as f32));
    tables.extend(table.light_angles.iter().map(|angle| *angle as f32));
    tables.extend(angles.iter().map(|angle| *angle as f32));
    let cosines: Vec<f64> = angles.iter().map(|angle| libm::cos(*angle).max(0.0)).collect();
    tables.extend(cosines.iter().map(|cosine| *cosine as f32));
    let row = 3 * azimuths;
    for slice in table.values.chunks_exact(row * table.view_angles.len()) {
        let values: Vec<f32> = rows.iter().flat_map(|at| &slice[at * row..][..row]).copied().collect();
        tables.extend(&values);
        tables.extend(steps(&values, &cosines, azimuths));
    }
}

/// View angles from the normal to the horizon, and which row of the table has the values of each.
fn view_rows(angles: &[f64]) -> (Vec<f64>, Vec<usize>) {
    let mut extended: Vec<(f64, usize)> = angles.iter().copied().zip(0..).collect();
    if angles[0] > 0.0 {
        extended.insert(0, (0.0, 0));
    }
    if angles[angles.len() - 1] < FRAC_PI_2 {
        extended.push((FRAC_PI_2, angles.len() - 1));
    }
    extended.into_iter().unzip()
}

/// Ascending shares, 0 to 1, of what goes to the intervals of view angles; then, for each, to those of azimuths.
fn steps(values: &[f32], cosines: &[f64], azimuths: usize) -> Vec<f32> {
    let reflected = |row: usize, column: usize| {
        let at = 3 * (row * azimuths + column % azimuths);
        values[at..at + 3].iter().map(|value| f64::from(*value)).sum::<f64>() * cosines[row]
    };
    let cell = |row: usize, column: usize| {
        let corners = [[row, column], [row + 1, column], [row, column + 1], [row + 1, column + 1]];
        let mean = corners.map(|[row, column]| reflected(row, column)).iter().sum::<f64>() / 4.0;
        mean * (cosines[row] - cosines[row + 1]) * TAU / azimuths as f64
    };
    let cells: Vec<Vec<f64>> =
        (0..cosines.len() - 1).map(|row| (0..azimuths).map(|column| cell(row, column)).collect()).collect();
    let sizes: Vec<f64> = cosines.windows(2).map(|pair| pair[0] - pair[1]).collect();
    let mut steps = shares(&cells.iter().map(|row| row.iter().sum()).collect::<Vec<f64>>(), &sizes);
    cells.iter().for_each(|row| steps.extend(shares(row, &vec![1.0; azimuths])));
    steps
}

/// Running sums of `weights` over their whole, from 0 to exactly 1; of `sizes` where nothing has a weight.
fn shares(weights: &[f64], sizes: &[f64]) -> Vec<f32> {
    let weights = if weights.iter().sum::<f64>() > 0.0 { weights } else { sizes };
    let running = weights.iter().scan(0.0, |sum, weight| {
        *sum += weight;
        Some(*sum)
    });
    let sums: Vec<f64> = std::iter::once(0.0).chain(running).collect();
    let whole = sums[sums.len() - 1];
    sums.iter().map(|sum| (sum / whole) as f32).collect()
}
