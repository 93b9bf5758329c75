//! Tables of the MERL database: three 32-bit sizes, then planes R, G, B of 64-bit floats, little-endian.
//!
//! Source: Matusik et al. 2003, "A Data-Driven Reflectance Model", and the reader that comes with the database.

use crate::scene::{Location, SceneError};
use std::path::Path;

/// Cells in theta_h, theta_d and phi_d.
const SIZES: [u32; 3] = [90, 90, 180];
/// What stored values are multiplied by, per channel.
const SCALES: [f64; 3] = [1.0 / 1500.0, 1.15 / 1500.0, 1.66 / 1500.0];

/// BRDF values per steradian as `Table::Merl` holds them; negative where a direction is below the horizon.
pub fn read_merl(file: &Path, bytes: &[u8]) -> Result<Vec<f32>, SceneError> {
    let bad = |message: String| SceneError::bad(Location::file(file), message);
    let plane = SIZES.iter().map(|&size| size as usize).product::<usize>();
    let expected = 12 + 3 * plane * 8;
    if bytes.len() != expected {
        let found = bytes.len();
        return Err(bad(format!(
            "a MERL table has {expected} bytes, found {found}; gonio's own begin with \"gonio-brdf 1\""
        )));
    }
    let (head, body) = bytes.split_at(12);
    let sizes: Vec<u32> = head.as_chunks::<4>().0.iter().map(|word| u32::from_le_bytes(*word)).collect();
    if sizes != SIZES {
        return Err(bad(format!(
            "a MERL table is of 90 x 90 x 180 cells, found {} x {} x {}",
            sizes[0], sizes[1], sizes[2]
        )));
    }
    let value = |(index, word): (usize, &[u8; 8])| {
        let value = f64::from_le_bytes(*word) * SCALES[index / plane];
        // No measured surface is brighter; NaN is none.
        if value >= 0.0 { value.min(1.0e6) as f32 } else { -1.0 }
    };
    Ok(body.as_chunks::<8>().0.iter().enumerate().map(value).collect())
}
