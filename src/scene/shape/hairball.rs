//! Hair: long thin triangles in every direction, which no hierarchy of boxes fits well.

use super::grid::{Builder, Vertex, angle_of_turn, unit};
use super::noise::hash3;
use crate::scene::Mesh;
use glam::{DVec2, DVec3};

/// Cells along a hair and around it.
const ALONG: u32 = 16;
const AROUND: u32 = 3;
/// Triangles of a hair.
const HAIR_TRIANGLES: u64 = 2 * (ALONG as u64) * (AROUND as u64);
/// Where hair begins, from the centre; it ends at about 1.
const ROOT: f64 = 0.35;
/// Radius of a hair over the distance between two of them on the unit sphere.
const THICKNESS: f64 = 0.11;

/// About `triangles` triangles (1 to `TRIANGLES_MAX`; whole hairs of 96) in curled hairs that leave a ball around the
/// origin, all within 1.4 of it. The more of them, the thinner.
pub fn hairball(triangles: u64) -> Mesh {
    debug_assert!((1..=super::TRIANGLES_MAX).contains(&triangles), "{triangles} triangles");
    let hairs = ((triangles + HAIR_TRIANGLES / 2) / HAIR_TRIANGLES).max(1) as u32;
    let spacing = libm::sqrt(4.0 * std::f64::consts::PI / f64::from(hairs)).min(1.0);
    let mut builder = Builder::new("hairball");
    for hair in 0..hairs {
        let points = curve(hair, hairs);
        builder.add_grid(AROUND, ALONG, |i, j| {
            let Point { at, tangent, side } = points[j as usize];
            let along = f64::from(j) / f64::from(ALONG);
            let around = angle_of_turn(f64::from(i % AROUND) / f64::from(AROUND));
            let normal = side * around.x + tangent.cross(side) * around.y;
            let radius = spacing * THICKNESS * (1.0 - 0.8 * along);
            let uv = DVec2::new(f64::from(i) / f64::from(AROUND), along);
            Vertex { position: at + normal * radius, normal, uv }
        });
    }
    builder.finish()
}

/// A point in the middle of a hair.
#[derive(Clone, Copy)]
struct Point {
    at: DVec3,
    /// Unit, towards the tip.
    tangent: DVec3,
    /// Unit, across the hair, turned as little as possible from point to point.
    side: DVec3,
}

/// The middle of a hair, root to tip.
fn curve(hair: u32, hairs: u32) -> Vec<Point> {
    let random = |k: u32| f64::from(hash3(hair, k, 0x4a17)) / 4_294_967_296.0;
    // Roots on a Fibonacci lattice of the sphere: even, without rows.
    let height = 1.0 - (2.0 * f64::from(hair) + 1.0) / f64::from(hairs);
    let wide = libm::sqrt((1.0 - height * height).max(0.0));
    let turn = angle_of_turn((f64::from(hair) * 0.618_033_988_749_894_9).fract());
    let out = DVec3::new(wide * turn.x, height, wide * turn.y);
    let right = unit(out.cross(least_axis(out)));
    let up = out.cross(right);
    let (length, curl, turns, phase) =
        (0.55 + 0.15 * random(0), 0.04 + 0.06 * random(1), 1.0 + 2.0 * random(2), random(3));
    let droop = 0.04 + 0.08 * random(4);
    let at = |s: f64| {
        let spin = angle_of_turn((phase + turns * s).fract());
        let sway = (right * spin.x + up * spin.y) * (curl * s);
        out * (ROOT + length * s) + sway - DVec3::Y * (droop * s * s)
    };
    let step = 1.0 / f64::from(ALONG);
    let mut side = right;
    let point = |j: u32| {
        let s = f64::from(j) * step;
        let tangent = unit(at(s + 0.5 * step) - at(s - 0.5 * step));
        side = unit(side - tangent * tangent.dot(side));
        Point { at: at(s), tangent, side }
    };
    (0..=ALONG).map(point).collect()
}

/// The axis along which `v` is shortest.
fn least_axis(v: DVec3) -> DVec3 {
    let a = v.abs();
    if a.x <= a.y && a.x <= a.z {
        DVec3::X
    } else if a.y <= a.z {
        DVec3::Y
    } else {
        DVec3::Z
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hairball_has_about_as_many_triangles_as_asked_for_and_stays_a_ball() {
        for (asked, made) in [(1, 96), (1000, 960), (50_000, 50_016)] {
            let mesh = hairball(asked);
            assert_eq!(mesh.triangles.len(), made, "{asked}");
            assert!(mesh.positions.iter().all(|p| p.length() < 1.4 && p.length() > 0.2), "{asked}");
        }
    }

    #[test]
    fn hairs_are_seen_from_outside() {
        let mesh = hairball(10_000);
        for corners in &mesh.triangles {
            let [a, b, c] = corners.map(|i| mesh.positions[i as usize]);
            let face = (b - a).cross(c - a);
            assert!(face.dot(mesh.normals[corners[0] as usize]) > -1e-9, "{corners:?}");
        }
    }
}
