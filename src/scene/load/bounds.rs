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
        for object in &scene.objects {
            add_points(scene, object, &mut points);
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

fn add_points(scene: &Scene, object: &Object, points: &mut Vec<DVec3>) {
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
            } else if let Some(first) = local.next() {
                let (low, high) = local.fold((first, first), |(low, high), p| (low.min(p), high.max(p)));
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
    let ways: [DVec3; WAYS] = std::array::from_fn(|i| {
        let y = 1.0 - (2 * i + 1) as f64 / WAYS as f64;
        let turn = i as f64 * 2.399_963_229_728_653; // the golden angle
        let r = libm::sqrt(1.0 - y * y);
        DVec3::new(r * libm::cos(turn), y, r * libm::sin(turn))
    });
    let mut nearest = [(f64::INFINITY, false); WAYS];
    for triangle in triangles(scene) {
        for (way, nearest) in ways.iter().zip(&mut nearest) {
            if let Some(found) = intersect(triangle, origin, *way)
                && found.0 < nearest.0
            {
                *nearest = found;
            }
        }
    }
    nearest.iter().filter(|(_, front)| *front).count()
}

fn signed_volume(scene: &Scene, centre: DVec3) -> f64 {
    triangles(scene).map(|[a, b, c]| (a - centre).dot((b - centre).cross(c - centre)) / 6.0).sum()
}

/// Distance from `origin` along `way` (unit) to the first triangle. None: nothing is there.
pub(super) fn free_distance(scene: &Scene, origin: DVec3, way: DVec3) -> Option<f64> {
    triangles(scene).filter_map(|triangle| intersect(triangle, origin, way)).map(|(t, _)| t).reduce(f64::min)
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
