//! Spheres upon spheres.

use crate::scene::Transform;
use glam::{DAffine3, DMat3, DVec3};

/// Most levels of a sphereflake: 5,380,840 spheres.
pub const SPHEREFLAKE_LEVELS: u32 = 7;

/// Haines's sphereflake (1987, "A Proposal for Standard Graphics Environments"): a unit sphere at the origin that carries
/// nine of a third of its size, six around its equator and three on its upper half, each of which carries nine again, down
/// to `level`. (9^(level + 1) - 1) / 8 unit spheres' transforms, parents first. y up; all of it is above y = -1 and within
/// 2 of the origin.
pub fn sphereflake(level: u32) -> Vec<Transform> {
    debug_assert!(level <= SPHEREFLAKE_LEVELS, "level {level}");
    let children = directions().map(|direction| (direction, frame(direction)));
    let mut spheres = vec![DAffine3::IDENTITY];
    let mut first = 0;
    for _ in 0..level {
        let last = spheres.len();
        for at in first..last {
            let parent = spheres[at];
            spheres.extend(children.iter().map(|(direction, frame)| {
                // In the parent's space: it touches the unit sphere, and its own axis leaves that.
                let own = DAffine3 { matrix3: *frame * (1.0 / 3.0), translation: *direction * (4.0 / 3.0) };
                parent * own
            }));
        }
        first = last;
    }
    spheres.into_iter().map(Transform).collect()
}

/// Nine of the twelve corners of a cuboctahedron that stands on a triangle: its equator and its upper triangle.
fn directions() -> [DVec3; 9] {
    // cos and sin of 30 degrees; height and radius of the upper triangle.
    let (c, s) = (libm::sqrt(0.75), 0.5);
    let (high, wide) = (libm::sqrt(2.0 / 3.0), libm::sqrt(1.0 / 3.0));
    [
        DVec3::new(1.0, 0.0, 0.0),
        DVec3::new(s, 0.0, c),
        DVec3::new(-s, 0.0, c),
        DVec3::new(-1.0, 0.0, 0.0),
        DVec3::new(-s, 0.0, -c),
        DVec3::new(s, 0.0, -c),
        DVec3::new(wide * c, high, wide * s),
        DVec3::new(-wide * c, high, wide * s),
        DVec3::new(0.0, high, -wide),
    ]
}

/// Right-handed columns with `axis` (unit, not -y) in the middle: y turned onto it the short way.
fn frame(axis: DVec3) -> DMat3 {
    let DVec3 { x, y, z } = axis;
    let k = 1.0 / (1.0 + y);
    DMat3::from_cols(DVec3::new(1.0 - x * x * k, -x, -x * z * k), axis, DVec3::new(-x * z * k, -z, 1.0 - z * z * k))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_sphere_touches_its_parent_and_is_a_third_of_it() {
        let spheres = sphereflake(3);
        assert_eq!(spheres.len(), 1 + 9 + 81 + 729);
        let radius = |at: usize| spheres[at].0.matrix3.y_axis.length();
        for child in 1..spheres.len() {
            let parent = (child - 1) / 9;
            assert!((radius(child) * 3.0 - radius(parent)).abs() < 1e-12);
            let apart = (spheres[child].0.translation - spheres[parent].0.translation).length();
            assert!((apart - radius(child) - radius(parent)).abs() < 1e-12, "sphere {child}");
            assert!(spheres[child].determinant() > 0.0);
        }
    }

    #[test]
    fn a_sphereflake_stays_above_minus_one_and_within_two() {
        for sphere in sphereflake(4) {
            let (centre, radius) = (sphere.0.translation, sphere.0.matrix3.y_axis.length());
            assert!(centre.y - radius >= -1.0 - 1e-12 && centre.length() + radius <= 2.0 + 1e-12, "{centre}");
        }
    }
}
