//! How large a scene is, and whether one stands in it or before it.

use crate::scene::{Geometry, Object, Scene};
use glam::DVec3;

/// Points computed exactly; beyond this the corners of the meshes' boxes stand for them.
const EXACT_MAX: usize = 1 << 23;

/// What a scene encloses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Room {
    /// It is an object, to be seen from outside.
    None,
    /// A side may be missing, as in a stage set.
    Open,
    /// Doors and windows at most.
    Closed,
}

/// Directions in which `room` looks around, and those of them that must end at a front (a room has doors and windows).
const WAYS: usize = 64;
const ROOM_FRONTS: usize = 58;

/// The extent of all objects, in world space.
pub(super) struct Bounds {
    points: Vec<DVec3>,
    low: DVec3,
    high: DVec3,
    radius: f64,
}

impl Bounds {
    pub fn of(scene: &Scene) -> Self {
        let mut points = Vec::new();
        let mut boxes = vec![None; scene.meshes.len()];
        for object in &scene.objects {
            add_points(scene, object, &mut boxes, &mut points);
        }
        points.retain(|p| p.is_finite());
        let low = points.iter().copied().reduce(DVec3::min).unwrap_or(DVec3::ZERO);
        let high = points.iter().copied().reduce(DVec3::max).unwrap_or(DVec3::ZERO);
        let centre = (low + high) * 0.5;
        let radius = points.iter().map(|p| (*p - centre).length()).fold(0.0, f64::max);
        // What is smaller than the rounding of its place cannot be looked at from its own distance; a single point has none.
        let radius = radius.max(centre.abs().max_element() * 1e-5);
        let radius = if radius > 0.0 { radius } else { 1.0 };
        Self { points, low, high, radius }
    }

    pub fn points(&self) -> impl Iterator<Item = DVec3> + '_ {
        self.points.iter().copied()
    }

    pub fn centre(&self) -> DVec3 {
        (self.low + self.high) * 0.5
    }

    pub fn low(&self) -> DVec3 {
        self.low
    }

    pub fn size(&self) -> DVec3 {
        self.high - self.low
    }

    /// Of the sphere around the centre, greater than 0.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Whether one stands inside: walls face inwards, an object's faces outwards. Either almost every way from the centre
    /// ends at the front of a face (cups and bowls are open wider than that), or the faces enclose a negative volume.
    pub fn room(&self, scene: &Scene) -> Room {
        let size = self.size();
        let centre = self.centre();
        if size.min_element() <= 0.05 * size.max_element() {
            Room::None
        } else if fronts_around(scene, centre) >= ROOM_FRONTS {
            Room::Closed
        } else if signed_volume(scene, centre) < -0.2 * (size.x * size.y * size.z) {
            Room::Open
        } else {
            Room::None
        }
    }

    /// Objects stand on something; landscapes are ground, and pictures hang.
    pub fn wants_ground(&self) -> bool {
        let size = self.size();
        !self.points.is_empty() && size.min_element() > 0.05 * size.max_element()
    }
}

/// `boxes`: of the meshes as far as they were needed, so that none is gone through for each object that shows it.
fn add_points(scene: &Scene, object: &Object, boxes: &mut [Option<[DVec3; 2]>], points: &mut Vec<DVec3>) {
    let world = |p: DVec3| object.transform.0.transform_point3(p);
    let corners = |low: DVec3, high: DVec3| {
        (0..8).map(move |i| {
            let pick = |axis: u32, l: f64, h: f64| if i >> axis & 1 == 0 { l } else { h };
            DVec3::new(pick(0, low.x, high.x), pick(1, low.y, high.y), pick(2, low.z, high.z))
        })
    };
    match object.geometry {
        Geometry::Sphere => points.extend(corners(DVec3::NEG_ONE, DVec3::ONE).map(world)),
        Geometry::Mesh(id) => {
            let positions = &scene.meshes[id.0 as usize].positions;
            let mut local = positions.iter().map(|p| p.as_dvec3());
            if points.len() + positions.len() <= EXACT_MAX {
                points.extend(local.map(world));
            } else if !positions.is_empty() {
                let [low, high] = *boxes[id.0 as usize].get_or_insert_with(|| {
                    let first = local.next().unwrap_or_default();
                    local.fold([first; 2], |[low, high], p| [low.min(p), high.max(p)])
                });
                points.extend(corners(low, high).map(world));
            }
        }
    }
}

/// The triangles of all objects in world space, at most `EXACT_MAX`.
fn triangles(scene: &Scene) -> impl Iterator<Item = [DVec3; 3]> + '_ {
    scene
        .objects
        .iter()
        .filter_map(|object| match object.geometry {
            Geometry::Mesh(id) => Some((object, &scene.meshes[id.0 as usize])),
            Geometry::Sphere => None,
        })
        .flat_map(|(object, mesh)| {
            let mirrored = object.transform.determinant() < 0.0;
            mesh.triangles.iter().map(move |corners| {
                let [a, b, c] =
                    corners.map(|i| object.transform.0.transform_point3(mesh.positions[i as usize].as_dvec3()));
                if mirrored { [a, c, b] } else { [a, b, c] }
            })
        })
        .take(EXACT_MAX)
}

/// In how many of `WAYS` directions, evenly spread (a Fibonacci lattice), the first triangle shows its front to `origin`.
fn fronts_around(scene: &Scene, origin: DVec3) -> usize {
    let ways = ways();
    let mut nearest = [(f64::INFINITY, false); WAYS];
    for triangle in triangles(scene) {
        for i in ways_towards(triangle, origin) {
            if let Some(found) = intersect(triangle, origin, ways[i])
                && found.0 < nearest[i].0
            {
                nearest[i] = found;
            }
        }
    }
    nearest.iter().filter(|(_, front)| *front).count()
}

/// Unit vectors, evenly spread, from +y to -y.
fn ways() -> [DVec3; WAYS] {
    std::array::from_fn(|i| {
        let y = 1.0 - (2 * i + 1) as f64 / WAYS as f64;
        let turn = i as f64 * 2.399_963_229_728_653; // the golden angle
        let r = libm::sqrt(1.0 - y * y);
        DVec3::new(r * libm::cos(turn), y, r * libm::sin(turn))
    })
}

/// The middle of a ball around a triangle, from `origin`, and the square of its radius.
fn ball([a, b, c]: [DVec3; 3], origin: DVec3) -> (DVec3, f64) {
    let middle = (a + b + c) / 3.0;
    let reach = (a - middle).length_squared().max((b - middle).length_squared()).max((c - middle).length_squared());
    (middle - origin, reach)
}

/// The `ways` that may meet a triangle: those at heights that a ball around it covers as seen from `origin`. Of most
/// triangles that is none or one, so that millions of them are soon gone through.
fn ways_towards(triangle: [DVec3; 3], origin: DVec3) -> std::ops::Range<usize> {
    let (towards, reach) = ball(triangle, origin);
    let distance = towards.length_squared();
    // Also where something is not a number.
    if !(reach < distance) {
        return 0..WAYS;
    }
    // The angle from +y to the middle, and the ball's half angle.
    let (sin_ball, cos_ball) = (libm::sqrt(reach / distance), libm::sqrt(1.0 - reach / distance));
    let cos = (towards.y / libm::sqrt(distance)).clamp(-1.0, 1.0);
    let (along, across) = (cos * cos_ball, libm::sqrt(1.0 - cos * cos) * sin_ball);
    let highest = if cos >= cos_ball { 1.0 } else { along + across };
    let lowest = if cos <= -cos_ball { -1.0 } else { along - across };
    // Of way i it is 1 - (2 i + 1) / WAYS. Rounding moves it by far less than a millionth.
    let number = |height: f64| ((1.0 - height) * WAYS as f64 - 1.0) * 0.5;
    let first = libm::ceil(number(highest) - 1e-6).max(0.0) as usize;
    let last = libm::floor(number(lowest) + 1e-6);
    first..((last + 1.0).max(0.0) as usize).clamp(first, WAYS.max(first))
}

fn signed_volume(scene: &Scene, centre: DVec3) -> f64 {
    triangles(scene).map(|[a, b, c]| (a - centre).dot((b - centre).cross(c - centre)) / 6.0).sum()
}

/// Distances from `origin` along `ways` (unit) to the first triangle. None: nothing is there.
pub(super) fn free_distances<const N: usize>(scene: &Scene, origin: DVec3, ways: [DVec3; N]) -> [Option<f64>; N] {
    let mut free = [None; N];
    for triangle in triangles(scene) {
        for (way, free) in ways.iter().zip(&mut free) {
            if passes_near(triangle, origin, *way)
                && let Some((t, _)) = intersect(triangle, origin, *way)
            {
                *free = Some(free.map_or(t, |nearest: f64| nearest.min(t)));
            }
        }
    }
    free
}

/// Whether a ray passes through the ball around a triangle, but for rounding; sooner known than whether it meets it.
fn passes_near(triangle: [DVec3; 3], origin: DVec3, way: DVec3) -> bool {
    let (towards, reach) = ball(triangle, origin);
    let (distance, along) = (towards.length_squared(), towards.dot(way));
    // Also where something is not a number.
    !(distance - along * along > reach * (1.0 + 1e-9) + distance * 1e-12)
}

/// Where the ray meets the triangle, and whether at its front. Möller and Trumbore 1997, both sides.
fn intersect([a, b, c]: [DVec3; 3], origin: DVec3, way: DVec3) -> Option<(f64, bool)> {
    let (e1, e2, s) = (b - a, c - a, origin - a);
    let p = way.cross(e2);
    let det = e1.dot(p);
    if det == 0.0 {
        return None;
    }
    let q = s.cross(e1);
    let (u, v, t) = (s.dot(p) / det, way.dot(q) / det, e2.dot(q) / det);
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0).then_some((t, det > 0.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Mesh, MeshId, Transform};
    use glam::Vec3;

    /// Corners anywhere around the origin, of triangles of any size, from a linear congruential generator.
    fn some_triangles(count: usize, size: f64) -> Vec<[DVec3; 3]> {
        let mut state = 1u32;
        let mut random = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(state >> 8) / 8_388_608.0 - 1.0
        };
        let mut point = || DVec3::new(random(), random(), random());
        let mut triangle = || {
            let corner = point();
            [corner, corner + point() * size, corner + point() * size]
        };
        (0..count).map(|_| triangle()).collect()
    }

    #[test]
    fn no_way_that_meets_a_triangle_is_left_out() {
        let origin = DVec3::new(0.1, -0.2, 0.05);
        let (ways, mut met) = (ways(), 0);
        for size in [0.01, 0.3, 2.0] {
            for triangle in some_triangles(20_000, size) {
                let range = ways_towards(triangle, origin);
                for (i, &way) in ways.iter().enumerate() {
                    let hit = intersect(triangle, origin, way).is_some();
                    met += u32::from(hit);
                    assert!(!hit || range.contains(&i), "{triangle:?}: way {i} is not in {range:?}");
                    assert!(!hit || passes_near(triangle, origin, way), "{triangle:?}, way {i}");
                }
            }
        }
        assert!(met > 10_000, "{met}");
    }

    #[test]
    fn small_triangles_are_tested_against_few_ways() {
        let triangles = some_triangles(100_000, 0.005);
        let tests: usize = triangles.iter().map(|&triangle| ways_towards(triangle, DVec3::ZERO).len()).sum();
        assert!(tests < triangles.len(), "{tests} tests");
        assert_eq!(ways_towards([DVec3::NAN; 3], DVec3::ZERO), 0..WAYS);
    }

    #[test]
    fn a_mesh_is_measured_once_however_often_it_is_placed() {
        // 10^10 points in all. Going through them takes minutes; the corners of boxes take less than a second.
        let positions: Vec<Vec3> = (0..100_000u32).map(|i| Vec3::splat(i as f32 / 1e5)).collect();
        let mesh = Mesh { positions, ..Mesh::default() };
        let object = |i: u32| Object {
            name: String::new(),
            geometry: Geometry::Mesh(MeshId(0)),
            transform: Transform(glam::DAffine3::from_translation(DVec3::X * f64::from(i))),
            material: None,
            casts_shadow: None,
            shading: None,
        };
        let mut scene = super::super::staging::bare_scene(std::path::Path::new("many"));
        scene.meshes = vec![mesh];
        scene.objects = (0..100_000).map(object).collect();
        let start = std::time::Instant::now();
        let bounds = Bounds::of(&scene);
        assert!(start.elapsed().as_secs() < 20, "{:?}", start.elapsed());
        assert!((bounds.size().x - 100_000.0).abs() < 0.1, "{}", bounds.size());
    }
}
