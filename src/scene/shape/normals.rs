//! Vertex normals computed from faces, and the repair of those a file got wrong.

use crate::scene::Mesh;
use glam::{DVec3, Vec2, Vec3};
use std::collections::HashMap;

/// Gives `mesh` smooth normals: at each corner the area-weighted mean of the faces around the vertex whose normals are
/// within `crease` radians of its own face. A vertex where such groups differ is doubled. Vertices count as one where
/// they share an index, so a seam of doubled vertices stays sharp.
pub fn compute_smooth_normals(mesh: &mut Mesh, crease: f64) {
    let areas: Vec<DVec3> = (0..mesh.triangles.len()).map(|face| area_vector(mesh, face)).collect();
    let around = Incidence::new(mesh);
    let cos_crease = libm::cos(crease.clamp(0.0, std::f64::consts::PI));
    let mut split: HashMap<(u32, [u32; 3]), u32> = HashMap::new();
    // What no face uses needs a unit normal too.
    let mut normals = vec![Vec3::Y; mesh.positions.len()];
    let mut first_use = vec![true; mesh.positions.len()];
    for face in 0..mesh.triangles.len() {
        for k in 0..3 {
            let vertex = mesh.triangles[face][k];
            let normal = corner_normal(&areas, around.faces(vertex), face, cos_crease);
            let v = vertex as usize;
            if first_use[v] {
                first_use[v] = false;
                normals[v] = normal;
            }
            if normals[v] == normal {
                continue;
            }
            let key = (vertex, normal.to_array().map(f32::to_bits));
            mesh.triangles[face][k] = *split.entry(key).or_insert_with(|| {
                normals.push(normal);
                duplicate_vertex(mesh_vectors(&mut mesh.positions, &mut mesh.uvs, &mut mesh.colors), v)
            });
        }
    }
    mesh.normals = normals;
}

/// Makes every normal of `mesh` unit; one that is zero or not finite becomes the mean of the faces around its vertex.
/// Returns how many were replaced. A mesh without normals stays so.
pub fn repair_normals(mesh: &mut Mesh) -> usize {
    let usable = |n: Vec3| n.is_finite() && n.as_dvec3().length() > 1e-12;
    let replaced = mesh.normals.iter().filter(|n| !usable(**n)).count();
    let around = (replaced > 0).then(|| Incidence::new(mesh));
    for v in 0..mesh.normals.len() {
        let n = mesh.normals[v];
        mesh.normals[v] = match &around {
            Some(around) if !usable(n) => {
                direction(around.faces(v as u32).iter().map(|f| area_vector(mesh, *f as usize)).sum())
            }
            _ => direction(n.as_dvec3()),
        };
    }
    replaced
}

type VertexArrays<'a> = (&'a mut Vec<Vec3>, &'a mut Vec<Vec2>, &'a mut Vec<Vec3>);

fn mesh_vectors<'a>(p: &'a mut Vec<Vec3>, uv: &'a mut Vec<Vec2>, c: &'a mut Vec<Vec3>) -> VertexArrays<'a> {
    (p, uv, c)
}

fn duplicate_vertex((positions, uvs, colors): VertexArrays<'_>, v: usize) -> u32 {
    positions.push(positions[v]);
    if !uvs.is_empty() {
        uvs.push(uvs[v]);
    }
    if !colors.is_empty() {
        colors.push(colors[v]);
    }
    positions.len() as u32 - 1
}

fn corner_normal(areas: &[DVec3], faces: &[u32], face: usize, cos_crease: f64) -> Vec3 {
    /// A fan this large is round enough; comparing all its pairs would take time quadratic in its size.
    const FAN_MAX: usize = 256;
    let own = areas[face];
    let sum: DVec3 = faces
        .iter()
        .map(|f| areas[*f as usize])
        .filter(|a| {
            faces.len() > FAN_MAX
                || own == DVec3::ZERO
                || a.dot(own) >= cos_crease * libm::sqrt(a.dot(*a) * own.dot(own))
        })
        .sum();
    direction(if sum == DVec3::ZERO { own } else { sum })
}

/// Unit; +y for a zero vector, which only a degenerate face has.
fn direction(v: DVec3) -> Vec3 {
    // Scaled first: squares of small areas would vanish.
    let largest = v.abs().max_element();
    if !(largest > 0.0 && largest.is_finite()) {
        return Vec3::Y;
    }
    super::grid::unit(v / largest).as_vec3()
}

/// Twice the area times the normal.
fn area_vector(mesh: &Mesh, face: usize) -> DVec3 {
    let [a, b, c] = mesh.triangles[face].map(|i| mesh.positions[i as usize].as_dvec3());
    (b - a).cross(c - a)
}

/// Which faces each vertex has, as one array in vertex order.
struct Incidence {
    starts: Vec<u32>,
    faces: Vec<u32>,
}

impl Incidence {
    fn new(mesh: &Mesh) -> Self {
        let mut starts = vec![0u32; mesh.positions.len() + 1];
        for &v in mesh.triangles.iter().flatten() {
            starts[v as usize + 1] += 1;
        }
        for v in 0..mesh.positions.len() {
            starts[v + 1] += starts[v];
        }
        let mut next = starts.clone();
        let mut faces = vec![0u32; mesh.triangles.len() * 3];
        for (face, triangle) in mesh.triangles.iter().enumerate() {
            for &v in triangle {
                faces[next[v as usize] as usize] = face as u32;
                next[v as usize] += 1;
            }
        }
        Self { starts, faces }
    }

    fn faces(&self, vertex: u32) -> &[u32] {
        &self.faces[self.starts[vertex as usize] as usize..self.starts[vertex as usize + 1] as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::shape::sphere_mesh;
    use std::f64::consts::PI;

    /// A unit cube whose eight vertices are shared.
    fn shared_cube() -> Mesh {
        let positions = (0..8).map(|i| Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32)).collect();
        let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let triangles = quads.iter().flat_map(|q| [[q[0], q[1], q[2]], [q[0], q[2], q[3]]]).collect();
        Mesh { positions, triangles, ..Mesh::default() }
    }

    #[test]
    fn smooth_normals_keep_a_cubes_edges_and_round_a_sphere() {
        let mut cube = shared_cube();
        compute_smooth_normals(&mut cube, 0.7);
        assert_eq!(cube.positions.len(), 24);
        assert!(cube.normals.iter().all(|n| n.abs().max_element() == 1.0), "{:?}", cube.normals);
        let mut round = shared_cube();
        compute_smooth_normals(&mut round, PI);
        assert_eq!(round.positions.len(), 8);
        let mut sphere = sphere_mesh(1.0, 32);
        let exact = std::mem::take(&mut sphere.normals);
        compute_smooth_normals(&mut sphere, 1.0);
        assert_eq!(sphere.positions.len(), exact.len());
        assert!(sphere.normals.iter().zip(&exact).all(|(a, b)| a.dot(*b) > 0.97));
    }

    #[test]
    fn zero_and_infinite_normals_are_replaced_and_others_made_unit() {
        let mut mesh = shared_cube();
        mesh.normals = mesh.positions.iter().map(|p| (*p - Vec3::splat(0.5)) * 10.0).collect();
        mesh.normals[0] = Vec3::ZERO;
        mesh.normals[7] = Vec3::new(f32::NAN, 0.0, 1.0);
        assert_eq!(repair_normals(&mut mesh), 2);
        for (p, n) in mesh.positions.iter().zip(&mesh.normals) {
            assert!((n.length() - 1.0).abs() < 1e-6 && n.dot(*p - Vec3::splat(0.5)) > 0.3, "{p} {n}");
        }
    }
}
