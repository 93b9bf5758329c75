//! Meshes built from rectangular grids of vertices.

use crate::scene::Mesh;
use glam::{DVec2, DVec3, Vec2, Vec3};

/// A point of a surface, before it is rounded.
#[derive(Clone, Copy, Debug)]
pub(super) struct Vertex {
    pub position: DVec3,
    /// Any non-zero length.
    pub normal: DVec3,
    pub uv: DVec2,
}

/// A mesh that always has normals and uvs.
#[derive(Debug, Default)]
pub(super) struct Builder {
    mesh: Mesh,
}

impl Builder {
    pub fn new(name: &str) -> Self {
        Self { mesh: Mesh { name: name.to_owned(), ..Mesh::default() } }
    }

    fn push(&mut self, vertex: Vertex) -> u32 {
        let index = self.mesh.positions.len() as u32;
        // Adding zero turns -0 into +0, so that equal positions are equal bits.
        self.mesh.positions.push(vertex.position.as_vec3() + Vec3::ZERO);
        self.mesh.normals.push(unit(vertex.normal).as_vec3() + Vec3::ZERO);
        self.mesh.uvs.push(vertex.uv.as_vec2().clamp(Vec2::ZERO, Vec2::ONE));
        index
    }

    /// Adds `columns` x `rows` cells over the vertices `at(i, j)`, 0 <= i <= columns, 0 <= j <= rows. The outside is where
    /// (direction of i) x (direction of j) points. Triangles with two equal corners are left out: a row that is one point
    /// makes a fan.
    pub fn add_grid(&mut self, columns: u32, rows: u32, at: impl Fn(u32, u32) -> Vertex) {
        let first = self.mesh.positions.len() as u32;
        for j in 0..=rows {
            for i in 0..=columns {
                self.push(at(i, j));
            }
        }
        for j in 0..rows {
            for i in 0..columns {
                let a = first + j * (columns + 1) + i;
                let (b, c, d) = (a + 1, a + columns + 2, a + columns + 1);
                self.add_triangle([a, b, c]);
                self.add_triangle([a, c, d]);
            }
        }
    }

    fn add_triangle(&mut self, corners: [u32; 3]) {
        let [a, b, c] = corners.map(|i| self.mesh.positions[i as usize]);
        if a != b && b != c && c != a {
            self.mesh.triangles.push(corners);
        }
    }

    /// The mesh without the vertices that no triangle uses.
    pub fn finish(self) -> Mesh {
        drop_unused(self.mesh)
    }
}

/// `v` with length 1; `v` is not zero.
pub(super) fn unit(v: DVec3) -> DVec3 {
    let length = libm::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
    debug_assert!(length > 0.0, "a normal of length zero");
    v / length
}

fn drop_unused(mut mesh: Mesh) -> Mesh {
    const UNUSED: u32 = u32::MAX;
    let mut moved_to = vec![UNUSED; mesh.positions.len()];
    for &corner in mesh.triangles.iter().flatten() {
        moved_to[corner as usize] = 0;
    }
    let mut kept = 0;
    for (old, new) in moved_to.iter_mut().enumerate() {
        if *new == UNUSED {
            continue;
        }
        *new = kept as u32;
        mesh.positions[kept] = mesh.positions[old];
        mesh.normals[kept] = mesh.normals[old];
        mesh.uvs[kept] = mesh.uvs[old];
        kept += 1;
    }
    mesh.positions.truncate(kept);
    mesh.normals.truncate(kept);
    mesh.uvs.truncate(kept);
    for corner in mesh.triangles.iter_mut().flatten() {
        *corner = moved_to[*corner as usize];
    }
    mesh
}

/// Cosine and sine at `segments` + 1 equal steps around the circle; the last is the first, bit for bit.
pub(super) fn circle(segments: u32) -> Vec<DVec2> {
    let at = |i: u32| angle_of_turn(f64::from(i % segments) / f64::from(segments));
    (0..=segments).map(at).collect()
}

/// Cosine and sine of a fraction of a full turn; exact at the quarters.
pub(super) fn angle_of_turn(turn: f64) -> DVec2 {
    let quarters = libm::floor(turn * 4.0);
    let rest = (turn * 4.0 - quarters) * std::f64::consts::FRAC_PI_2;
    let (c, s) = (libm::cos(rest), libm::sin(rest));
    match quarters.rem_euclid(4.0) as u32 {
        0 => DVec2::new(c, s),
        1 => DVec2::new(-s, c),
        2 => DVec2::new(-c, -s),
        _ => DVec2::new(s, -c),
    }
}
