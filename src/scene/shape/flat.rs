//! Shapes with flat faces.

use super::grid::{Builder, Vertex};
use crate::scene::Mesh;
use glam::{DVec2, DVec3};

/// A rectangle in the plane y = 0 facing +y, centred at the origin.
/// `size`: lengths along x and z; `segments`: cells along each side, 1 to `SEGMENTS_MAX` (Gouraud shading wants many).
/// u runs along +x, v along -z: seen from above with -z up, an image lies as it is.
pub fn quad(size: [f64; 2], segments: u32) -> Mesh {
    let mut builder = Builder::new("quad");
    add_rectangle(&mut builder, DVec3::ZERO, DVec3::X * size[0], DVec3::NEG_Z * size[1], segments);
    builder.finish()
}

/// A box with edges along the axes, centred at the origin.
/// `size`: edge lengths; `segments`: cells along each edge, 1 to `SEGMENTS_MAX`. Each face carries the whole uv square, upright on the sides.
pub fn cuboid(size: [f64; 3], segments: u32) -> Mesh {
    let [x, y, z] = [DVec3::X * size[0], DVec3::Y * size[1], DVec3::Z * size[2]];
    let mut builder = Builder::new("box");
    // centre x 2, direction of u, direction of v: u x v points outwards.
    for (centre, u, v) in [(x, -z, y), (-x, z, y), (y, x, -z), (-y, x, z), (z, x, y), (-z, -x, y)] {
        add_rectangle(&mut builder, centre * 0.5, u, v, segments);
    }
    builder.finish()
}

fn add_rectangle(builder: &mut Builder, centre: DVec3, u: DVec3, v: DVec3, segments: u32) {
    debug_assert!((1..=super::SEGMENTS_MAX).contains(&segments), "segments = {segments}");
    let normal = (u / u.length()).cross(v / v.length());
    builder.add_grid(segments, segments, |i, j| {
        let uv = DVec2::new(f64::from(i), f64::from(j)) / f64::from(segments);
        // Both edges from their own side: opposite corners of faces that meet are then equal bits.
        let position = centre + u * (uv.x - 0.5) + v * (uv.y - 0.5);
        Vertex { position, normal, uv }
    });
}
