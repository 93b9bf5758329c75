//! Polygons and strips as triangles.

use earcut::Earcut;
use glam::{DVec2, DVec3, Vec3};
use std::collections::HashMap;

/// Cuts polygons; what it needs on the way is kept for the next one.
pub(super) struct Triangulator {
    points: Vec<DVec3>,
    plane: Vec<DVec2>,
    earcut: Earcut<f64>,
    /// Corners of triangles, three by three, as numbers of corners of the polygon.
    cut: Vec<u32>,
}

impl Triangulator {
    pub fn new() -> Self {
        Self { points: Vec::new(), plane: Vec::new(), earcut: Earcut::new(), cut: Vec::new() }
    }

    /// Appends the triangles of the polygon `corners` (3 or more), whose places `position` gives, turned as it is. Convex
    /// polygons become a fan from their first corner; of others ears are cut (`earcut`, after Mapbox) in the plane of their
    /// Newell normal. Holes may be joined to the outline by edges that are there twice. Triangles with a repeated corner are left
    /// out; their number is returned.
    pub fn triangulate(
        &mut self,
        corners: &[u32],
        position: impl Fn(u32) -> Vec3,
        triangles: &mut Vec<[u32; 3]>,
    ) -> usize {
        let before = triangles.len();
        self.cut_up(corners, position, triangles);
        let mut kept = before;
        for index in before..triangles.len() {
            if has_three_corners(&triangles[index]) {
                triangles[kept] = triangles[index];
                kept += 1;
            }
        }
        triangles.truncate(kept);
        // Cutting ears leaves out repeated corners itself.
        (corners.len() - 2).saturating_sub(kept - before)
    }

    fn cut_up(&mut self, corners: &[u32], position: impl Fn(u32) -> Vec3, triangles: &mut Vec<[u32; 3]>) {
        debug_assert!(corners.len() >= 3);
        if let [a, b, c] = *corners {
            triangles.push([a, b, c]);
            return;
        }
        self.points.clear();
        self.points.extend(corners.iter().map(|corner| position(*corner).as_dvec3()));
        flatten(&self.points, &mut self.plane);
        self.cut.clear();
        if !is_convex(&self.plane) {
            self.earcut.earcut(self.plane.iter().map(|p| p.to_array()), &[], &mut self.cut);
            self.turn_upright();
            self.put_back_straight_corners();
        }
        if self.cut.is_empty() {
            // Convex, or without an area in its plane.
            triangles.extend((1..corners.len() - 1).map(|i| [corners[0], corners[i], corners[i + 1]]));
            return;
        }
        triangles.extend(self.cut.chunks_exact(3).map(|t| [t[0], t[1], t[2]].map(|corner| corners[corner as usize])));
    }

    fn turn_upright(&mut self) {
        for t in self.cut.chunks_exact_mut(3) {
            let [a, b, c] = [t[0], t[1], t[2]].map(|corner| self.plane[corner as usize]);
            if turn(a, b, c) < 0.0 {
                t.swap(1, 2);
            }
        }
    }

    /// Corners on a straight line between their neighbours are left out by `earcut`. A neighbouring face has them, too, and
    /// they carry texture coordinates: the triangle at that line is cut up into a fan that has them.
    fn put_back_straight_corners(&mut self) {
        let count = self.plane.len();
        let mut is_used = vec![false; count];
        self.cut.iter().for_each(|corner| is_used[*corner as usize] = true);
        let Some(first) = is_used.iter().position(|used| *used).filter(|_| is_used.contains(&false)) else { return };
        let mut edges: HashMap<[u32; 2], usize> = HashMap::new();
        for (triangle, t) in self.cut.chunks_exact(3).enumerate() {
            edges.extend([[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]].map(|edge| (edge, triangle)));
        }
        let mut at = first;
        while at < first + count {
            let end = (at + 1..=first + count).find(|i| is_used[i % count]).unwrap_or(first + count);
            let run: Vec<u32> = (at..=end).map(|i| (i % count) as u32).collect();
            at = end;
            let (from, to) = (run[0], run[run.len() - 1]);
            if run.len() == 2 || !self.is_straight(&run) {
                continue;
            }
            let Some(triangle) = edges.remove(&[from, to]) else { continue };
            let t = &mut self.cut[3 * triangle..3 * triangle + 3];
            // Its corner across the line.
            let Some(across) = t.iter().copied().find(|corner| *corner != from && *corner != to) else { continue };
            t.copy_from_slice(&[across, from, run[1]]);
            let first_new = self.cut.len() / 3;
            self.cut.extend(run.windows(2).skip(1).flat_map(|edge| [across, edge[0], edge[1]]));
            // Its other edges may be such lines as well.
            edges.insert([across, from], triangle);
            edges.insert([to, across], first_new + run.len() - 3);
        }
    }

    /// Whether the corners follow each other on the way from the first to the last.
    fn is_straight(&self, run: &[u32]) -> bool {
        let point = |corner: u32| self.plane[corner as usize];
        let way = point(run[run.len() - 1]) - point(run[0]);
        run.windows(2).all(|pair| (point(pair[1]) - point(pair[0])).dot(way) > 0.0)
    }
}

/// Appends the triangles of a strip: every second one turned.
pub(super) fn unroll_strip(corners: &[u32], triangles: &mut Vec<[u32; 3]>) {
    for (i, w) in corners.windows(3).enumerate() {
        let triangle = if i % 2 == 0 { [w[0], w[1], w[2]] } else { [w[1], w[0], w[2]] };
        // Repeated corners join strips and draw nothing.
        if has_three_corners(&triangle) {
            triangles.push(triangle);
        }
    }
}

/// Whether no corner is repeated.
pub(super) fn has_three_corners(&[a, b, c]: &[u32; 3]) -> bool {
    a != b && b != c && c != a
}

/// Drops the axis along which the polygon's normal (Newell's method) is largest, keeping counter-clockwise order.
fn flatten(points: &[DVec3], plane: &mut Vec<DVec2>) {
    let origin = points[0];
    let mut normal = DVec3::ZERO;
    for (i, p) in points.iter().enumerate() {
        let next = if i + 1 < points.len() { points[i + 1] } else { origin };
        normal += (*p - origin).cross(next - origin);
    }
    let size = normal.abs();
    let project = |p: &DVec3| {
        let p = *p - origin;
        if size.x >= size.y && size.x >= size.z {
            DVec2::new(p.y, p.z) * DVec2::new(normal.x.signum(), 1.0)
        } else if size.y >= size.z {
            DVec2::new(p.z, p.x) * DVec2::new(normal.y.signum(), 1.0)
        } else {
            DVec2::new(p.x, p.y) * DVec2::new(normal.z.signum(), 1.0)
        }
    };
    plane.clear();
    plane.extend(points.iter().map(project));
}

fn turn(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - a)
}

/// Whether the polygon turns left at every corner, once around.
fn is_convex(plane: &[DVec2]) -> bool {
    let count = plane.len();
    (0..count).all(|i| {
        let [b, c] = [1, 2].map(|k| plane[if i + k < count { i + k } else { i + k - count }]);
        turn(plane[i], b, c) > 0.0
    }) && (2..count - 1).all(|i| turn(plane[0], plane[i], plane[i + 1]) > 0.0)
}
