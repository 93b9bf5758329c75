//! The Utah teapot (Newell 1975): 32 bicubic Bezier patches.

use super::grid::{Builder, Vertex};
use super::teapot_data::{HALF_TUBES, PROFILES, QUARTER, QUARTER_KNOB};
use crate::scene::Mesh;
use glam::{DVec2, DVec3};

/// 24 patches of revolution (bottom 4, body 8, rim 4, lid 8), handle 4, spout 4.
pub const TEAPOT_PATCHES: usize = 32;

/// `[row j][column i]`, oriented so that (direction of i) x (direction of j) points outwards.
type Patch = [[DVec3; 4]; 4];

/// The teapot on y = 0, y up, spout towards +x, in Newell's unit: 3.15 high, 6.434 from handle to spout. Not closed: lid and
/// body do not touch, the spout is open, handle and spout end inside the body.
/// `steps`: cells along each side of a patch, 1 to 128; 2 * 32 * steps^2 triangles, fewer at the poles.
/// Normals are the patches' own; each patch carries the whole uv square.
pub fn teapot(steps: u32) -> Mesh {
    debug_assert!((1..=128).contains(&steps), "steps = {steps}");
    let mut builder = Builder::new("teapot");
    for patch in teapot_control_points() {
        builder.add_grid(steps, steps, |i, j| {
            let uv = DVec2::new(f64::from(i), f64::from(j)) / f64::from(steps);
            let (position, normal) = evaluate(&patch, uv);
            Vertex { position, normal, uv }
        });
    }
    builder.finish()
}

/// All 32 x 16 control points, y up.
pub fn teapot_control_points() -> [Patch; TEAPOT_PATCHES] {
    let mut patches = [[[DVec3::ZERO; 4]; 4]; TEAPOT_PATCHES];
    let mut next = patches.iter_mut();
    for profile in PROFILES {
        for quarter in 0..4 {
            *next.next().expect("32 patches") = profile.map(|[r, z]| quarter_row(r, z, quarter));
        }
    }
    for half in HALF_TUBES {
        // y up: (x, y, z) becomes (x, z, -y); the half at y <= 0 then lies at z >= 0.
        let near = half.map(|row| row.map(|[x, y, z]| DVec3::new(x, z, -y)));
        let far = near.map(|row| row.map(|p| DVec3::new(p.x, p.y, 0.0 - p.z)));
        // The mirror image is inside out until its rows run the other way.
        let far = far.map(|[a, b, c, d]| [d, c, b, a]);
        *next.next().expect("32 patches") = near;
        *next.next().expect("32 patches") = far;
    }
    patches
}

/// Control points of a quarter circle from `quarter` * 90 degrees on, counter-clockwise seen from above.
fn quarter_row(r: f64, z: f64, quarter: u32) -> [DVec3; 4] {
    let k = r * if r == 0.8 { QUARTER_KNOB } else { QUARTER };
    [[r, 0.0], [r, k], [k, r], [0.0, r]].map(|[a, b]| {
        let (x, y) = [(a, b), (-b, a), (-a, -b), (b, -a)][quarter as usize];
        DVec3::new(x, z, -y) + DVec3::ZERO
    })
}

/// Point and normal (any length) at `uv` in [0, 1]^2.
fn evaluate(patch: &Patch, uv: DVec2) -> (DVec3, DVec3) {
    let rows = patch.map(|row| cubic(&row, uv.x));
    let at = cubic(&rows.map(|r| r.0), uv.y);
    let du = cubic(&rows.map(|r| r.1), uv.y);
    let dv = at.1;
    let normal = du.0.cross(dv);
    // At a pole the whole row is one point and du is zero: a step away from it du is proportional to its change along v,
    // so d2/dudv stands in for it, with the sign of the step.
    if du.0.length_squared() > 1e-18 {
        return (at.0, normal);
    }
    let step = if uv.y < 0.5 { 1.0 } else { -1.0 };
    (at.0, (du.1 * step).cross(dv))
}

/// Point and derivative of a cubic Bezier curve, in Bernstein form: both ends are exactly the end points.
fn cubic(p: &[DVec3; 4], t: f64) -> (DVec3, DVec3) {
    let s = 1.0 - t;
    let at = p[0] * (s * s * s) + p[1] * (3.0 * s * s * t) + p[2] * (3.0 * s * t * t) + p[3] * (t * t * t);
    let d = (p[1] - p[0]) * (3.0 * s * s) + (p[2] - p[1]) * (6.0 * s * t) + (p[3] - p[2]) * (3.0 * t * t);
    (at, d)
}
