//! A landscape of any number of triangles.

use super::{fractal_heights, height_field};
use crate::scene::Mesh;
use glam::Vec3;

/// Triangles of a terrain, a hairball at most.
pub const TRIANGLES_MAX: u64 = 2 * (super::SEGMENTS_MAX as u64) * (super::SEGMENTS_MAX as u64);
/// Hills along a side, and how high they are: the square is 2 x 2.
const FEATURES: f64 = 5.0;
const HEIGHT: f64 = 0.12;

/// A fractal height field of about `triangles` triangles (2 to `TRIANGLES_MAX`; twice the nearest square number) over a
/// square of 2 x 2 around the origin, y up, about -0.07 to 0.2 high. As fine as its grid. Colours of vertices: grass where it
/// is low and flat, rock, snow.
pub fn terrain(triangles: u64) -> Mesh {
    debug_assert!((2..=TRIANGLES_MAX).contains(&triangles), "{triangles} triangles");
    let cells = (libm::sqrt(triangles as f64 / 2.0).round() as u32).clamp(1, super::SEGMENTS_MAX);
    // Octaves down to two cells a hill.
    let octaves = (libm::log2(f64::from(cells) / FEATURES).max(0.0) as u32 + 1).min(16);
    let mut grid = fractal_heights(cells + 1, FEATURES, octaves, 0.5, 7);
    // Valleys are wide and flat, peaks are steep: height times itself, above a floor.
    for height in &mut grid.heights {
        let above = (*height + 0.6).max(0.0);
        *height = above * above - 0.6;
    }
    let mut mesh = height_field(&grid, [2.0, 2.0], HEIGHT).expect("a finite grid of a size that is allowed");
    mesh.name = "terrain".to_owned();
    mesh.colors = mesh.positions.iter().zip(&mesh.normals).map(|(p, n)| color(p.y, n.y)).collect();
    mesh
}

/// Linear colour at height `y` where the unit normal's height is `flat`.
fn color(y: f32, flat: f32) -> Vec3 {
    const GRASS: Vec3 = Vec3::new(0.10, 0.16, 0.04);
    const ROCK: Vec3 = Vec3::new(0.22, 0.18, 0.14);
    const SNOW: Vec3 = Vec3::new(0.85, 0.87, 0.90);
    let step = |low: f32, high: f32, x: f32| ((x - low) / (high - low)).clamp(0.0, 1.0);
    let ground = ROCK + (GRASS - ROCK) * (step(0.72, 0.86, flat) * (1.0 - step(0.0, 0.06, y)));
    ground + (SNOW - ground) * (step(0.07, 0.11, y) * step(0.5, 0.7, flat))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_terrain_has_about_as_many_triangles_as_asked_for() {
        for (asked, made) in [(2, 2), (200, 200), (1000, 968), (20_000, 20_000)] {
            let mesh = terrain(asked);
            assert_eq!(mesh.triangles.len(), made, "{asked}");
            assert_eq!(mesh.colors.len(), mesh.positions.len());
        }
    }

    #[test]
    fn a_terrain_faces_up_and_stays_in_its_square() {
        let mesh = terrain(5000);
        assert!(mesh.normals.iter().all(|n| n.y > 0.0));
        assert!(mesh.positions.iter().all(|p| p.x.abs() <= 1.0 && p.z.abs() <= 1.0 && p.y.abs() < 0.35));
        let high = mesh.positions.iter().fold(f32::MIN, |high, p| high.max(p.y));
        assert!(high > 0.05, "no mountains: {high}");
    }
}
