//! Polygons and strips as triangles.

use glam::{DVec2, DVec3, Vec3};

/// Above this many corners a polygon is taken for convex: ear clipping takes time quadratic in it.
const CLIPPED_MAX: usize = 64;

/// Appends the triangles of the polygon `corners` (3 or more), counter-clockwise where it is. Concave polygons are clipped
/// ear by ear (Meisters 1975) in the plane of their Newell normal; corners outside `positions` make it a plain fan.
pub(super) fn triangulate(corners: &[u32], positions: &[Vec3], triangles: &mut Vec<[u32; 3]>) {
    debug_assert!(corners.len() >= 3);
    let known = corners.iter().all(|c| (*c as usize) < positions.len());
    if corners.len() == 3 || corners.len() > CLIPPED_MAX || !known {
        triangles.extend((1..corners.len() - 1).map(|i| [corners[0], corners[i], corners[i + 1]]));
        return;
    }
    let points: Vec<DVec3> = corners.iter().map(|c| positions[*c as usize].as_dvec3()).collect();
    let plane = flatten(&points);
    let mut left: Vec<usize> = (0..corners.len()).collect();
    while left.len() > 3 {
        let n = left.len();
        let corner = |k: usize| (left[(k + n - 1) % n], left[k], left[(k + 1) % n]);
        // A polygon that crosses itself may have no ear: then its first corner goes.
        // The second corner is tried first, which makes a convex polygon a fan.
        let ear = (1..=n).map(|k| k % n).find(|k| is_ear(&plane, &left, corner(*k))).unwrap_or(1);
        let (a, b, c) = corner(ear);
        triangles.push([corners[a], corners[b], corners[c]]);
        left.remove(ear);
    }
    triangles.push([corners[left[0]], corners[left[1]], corners[left[2]]]);
}

/// Appends the triangles of a strip: every second one turned.
pub(super) fn unroll_strip(corners: &[u32], triangles: &mut Vec<[u32; 3]>) {
    for (i, w) in corners.windows(3).enumerate() {
        let triangle = if i % 2 == 0 { [w[0], w[1], w[2]] } else { [w[1], w[0], w[2]] };
        // Repeated corners join strips and draw nothing.
        if w[0] != w[1] && w[1] != w[2] && w[2] != w[0] {
            triangles.push(triangle);
        }
    }
}

/// Drops the axis along which the polygon's normal (Newell's method) is largest, keeping counter-clockwise order.
fn flatten(points: &[DVec3]) -> Vec<DVec2> {
    let origin = points[0];
    let mut normal = DVec3::ZERO;
    for (i, p) in points.iter().enumerate() {
        normal += (*p - origin).cross(points[(i + 1) % points.len()] - origin);
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
    points.iter().map(project).collect()
}

fn turn(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - a)
}

fn is_ear(plane: &[DVec2], left: &[usize], (a, b, c): (usize, usize, usize)) -> bool {
    let (pa, pb, pc) = (plane[a], plane[b], plane[c]);
    turn(pa, pb, pc) > 0.0
        && left.iter().filter(|i| ![a, b, c].contains(i)).all(|i| {
            let p = plane[*i];
            turn(pa, pb, p) < 0.0 || turn(pb, pc, p) < 0.0 || turn(pc, pa, p) < 0.0
        })
}
