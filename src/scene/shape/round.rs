//! Round shapes with closed forms: analytic normals, vertices on the true surface.

use super::grid::{Builder, Vertex, angle_of_turn, circle};
use super::lathe::{Row, add_revolved, revolve};
use crate::scene::Mesh;
use glam::{DVec2, DVec3};

/// A disk in the plane y = 0 facing +y, centred at the origin; `segments` around. uv: the square around the disk, u along +x, v along -z.
pub fn disk(radius: f64, segments: u32) -> Mesh {
    let mut builder = Builder::new("disk");
    add_cap(&mut builder, radius, 0.0, true, segments);
    builder.finish()
}

/// The same disk with polar coordinates: u around it, counter-clockwise seen from above, v from its middle to the rim.
pub fn polar_disk(radius: f64, segments: u32) -> Mesh {
    let mut builder = Builder::new("disk");
    let circle = circle(segments);
    builder.add_grid(segments, 1, |i, j| {
        let v = f64::from(1 - j);
        let d = circle[i as usize] * radius * v;
        let uv = DVec2::new(f64::from(i) / f64::from(segments), v);
        Vertex { position: DVec3::new(d.x, 0.0, -d.y), normal: DVec3::Y, uv }
    });
    builder.finish()
}

/// A cylinder around the y axis from y = 0 to `height`; `segments` around; `capped`: with its two disks, else a tube.
/// Side: u around, v up; caps: as `disk`.
pub fn cylinder(radius: f64, height: f64, capped: bool, segments: u32) -> Mesh {
    let mut builder = Builder::new("cylinder");
    let normal = DVec2::X;
    let side =
        [Row { at: DVec2::new(radius, 0.0), normal, v: 0.0 }, Row { at: DVec2::new(radius, height), normal, v: 1.0 }];
    add_revolved(&mut builder, &side, segments);
    if capped {
        add_cap(&mut builder, radius, 0.0, false, segments);
        add_cap(&mut builder, radius, height, true, segments);
    }
    builder.finish()
}

/// A cone around the y axis, its base at y = 0 and its tip at `height`; `segments` around; `capped`: with its base.
pub fn cone(radius: f64, height: f64, capped: bool, segments: u32) -> Mesh {
    let mut builder = Builder::new("cone");
    let normal = DVec2::new(height, radius) / libm::hypot(height, radius);
    let side =
        [Row { at: DVec2::new(radius, 0.0), normal, v: 0.0 }, Row { at: DVec2::new(0.0, height), normal, v: 1.0 }];
    add_revolved(&mut builder, &side, segments);
    if capped {
        add_cap(&mut builder, radius, 0.0, false, segments);
    }
    builder.finish()
}

/// A tessellated sphere around the origin: `segments` around the axis, half as many (at least 2) from pole to pole.
/// u around, v = 0 at the south pole. For the analytic sphere use `Geometry::Sphere`.
pub fn sphere_mesh(radius: f64, segments: u32) -> Mesh {
    let stacks = (segments / 2).max(2);
    let row = |j: u32| {
        let v = f64::from(j) / f64::from(stacks);
        // A quarter turn back, so that j = 0 is the south pole; poles lie exactly on the axis.
        let mut normal = angle_of_turn(v * 0.5 - 0.25);
        if j == 0 || j == stacks {
            normal.x = 0.0;
        }
        Row { at: normal * radius, normal, v }
    };
    revolve("sphere", &(0..=stacks).map(row).collect::<Vec<_>>(), segments)
}

/// A torus around the y axis: a circle of radius `minor` around one of radius `major` > `minor`.
/// `segments` around the axis, `rings` around the tube. u around the axis, v around the tube, up from the outer equator.
pub fn torus(major: f64, minor: f64, segments: u32, rings: u32) -> Mesh {
    debug_assert!(major > minor, "a torus of radii {major} and {minor} crosses its axis");
    let rows: Vec<Row> = circle(rings)
        .into_iter()
        .enumerate()
        .map(|(j, normal)| Row {
            at: DVec2::new(major + minor * normal.x, minor * normal.y),
            normal,
            v: j as f64 / f64::from(rings),
        })
        .collect();
    revolve("torus", &rows, segments)
}

/// A disk at height `y` that faces up or down, its rim bit-equal to that of a revolved row.
fn add_cap(builder: &mut Builder, radius: f64, y: f64, up: bool, segments: u32) {
    debug_assert!((super::SEGMENTS_MIN..=super::SEGMENTS_MAX).contains(&segments), "segments = {segments}");
    let circle = circle(segments);
    builder.add_grid(segments, 1, |i, j| {
        // From the rim inwards it faces up, from the centre outwards down.
        let r = if (j == 0) == up { radius } else { 0.0 };
        let d = circle[i as usize];
        let unit = if r > 0.0 { d } else { DVec2::ZERO };
        let v = if up { unit.y } else { -unit.y };
        Vertex {
            position: DVec3::new(r * d.x, y, -r * d.y),
            normal: if up { DVec3::Y } else { DVec3::NEG_Y },
            uv: DVec2::new(unit.x, v) * 0.5 + 0.5,
        }
    });
}
