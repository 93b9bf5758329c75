//! Landscapes over a grid of heights.

use super::grid::{Builder, Vertex};
use crate::scene::{Mesh, Texture, TextureData};
use glam::{DVec2, DVec3};

/// Heights at the nodes of a grid, rows from -z (an image's top) to +z, each from -x to +x.
#[derive(Clone, Debug, PartialEq)]
pub struct HeightGrid {
    /// Nodes along x, 2 to `SEGMENTS_MAX` + 1.
    pub columns: u32,
    /// Nodes along z, 2 to `SEGMENTS_MAX` + 1.
    pub rows: u32,
    pub heights: Vec<f32>,
}

impl HeightGrid {
    /// The luminance (Rec. 709, linear; 8-bit channels as stored) of each texel as a height from 0 to 1.
    pub fn from_texture(texture: &Texture) -> Self {
        let luminance = |r: f32, g: f32, b: f32| 0.2126 * r + 0.7152 * g + 0.0722 * b;
        let heights = match &texture.data {
            // A height map stored in a picture means its codes, not the light they stand for.
            TextureData::Srgb8(texels) | TextureData::Linear8(texels) => {
                texels.iter().map(|t| luminance(f32::from(t[0]), f32::from(t[1]), f32::from(t[2])) / 255.0).collect()
            }
            TextureData::Float(texels) => texels.iter().map(|t| luminance(t[0], t[1], t[2])).collect(),
            // No texels: `height_field` says that their number is wrong.
            TextureData::Pattern(_) => Vec::new(),
        };
        Self { columns: texture.width, rows: texture.height, heights }
    }
}

/// The surface y = `scale` * height over a rectangle centred at the origin, facing up.
/// `size`: lengths along x and z. Normals by central differences; uv as `quad`. The error says what is wrong with `grid`.
pub fn height_field(grid: &HeightGrid, size: [f64; 2], scale: f64) -> Result<Mesh, String> {
    let (columns, rows) = (grid.columns, grid.rows);
    let nodes_max = super::SEGMENTS_MAX + 1;
    if !(2..=nodes_max).contains(&columns) || !(2..=nodes_max).contains(&rows) {
        return Err(format!("a height grid of {columns} x {rows} nodes; allowed are 2 to {nodes_max} each way"));
    }
    if grid.heights.len() as u64 != u64::from(columns) * u64::from(rows) {
        return Err(format!("{} heights for a grid of {columns} x {rows}", grid.heights.len()));
    }
    if let Some(i) = grid.heights.iter().position(|h| !h.is_finite()) {
        return Err(format!("height {i} is not a finite number"));
    }
    let height = |i: u32, row: u32| f64::from(grid.heights[(row * columns + i) as usize]) * scale;
    // Half a central difference inside, a one-sided one at the border.
    let slope = |before: f64, after: f64, steps: u32, step: f64| (after - before) / (f64::from(steps) * step);
    let (dx, dz) = (size[0] / f64::from(columns - 1), size[1] / f64::from(rows - 1));
    let mut builder = Builder::new("height field");
    builder.add_grid(columns - 1, rows - 1, |i, j| {
        let row = rows - 1 - j;
        let (west, east) = (i.saturating_sub(1), (i + 1).min(columns - 1));
        let (north, south) = (row.saturating_sub(1), (row + 1).min(rows - 1));
        let slope_x = slope(height(west, row), height(east, row), east - west, dx);
        let slope_z = slope(height(i, north), height(i, south), south - north, dz);
        let uv = DVec2::new(f64::from(i) / f64::from(columns - 1), f64::from(j) / f64::from(rows - 1));
        Vertex {
            position: DVec3::new((uv.x - 0.5) * size[0], height(i, row), (0.5 - uv.y) * size[1]),
            normal: DVec3::new(-slope_x, 1.0, -slope_z),
            uv,
        }
    });
    Ok(builder.finish())
}
