//! Vertex normals computed from faces, and the repair of those a file got wrong.

use crate::scene::Mesh;
use glam::{DVec3, Vec3};
use std::collections::{BTreeMap, HashMap};
use std::f64::consts::PI;

/// The group of faces that say nothing: they are smooth where their edges are not sharp.
pub const BY_CREASE: u32 = u32::MAX;

/// Gives `mesh` smooth normals: at each corner the area-weighted mean of the faces around the vertex whose normals are
/// within `crease` radians of its own face. A vertex where such groups differ is doubled. Vertices count as one where
/// they share an index, so a seam of doubled vertices stays sharp.
pub fn compute_smooth_normals(mesh: &mut Mesh, crease: f64) {
    compute_group_normals(mesh, &[], &[], crease);
}

/// As `compute_smooth_normals`, for faces in the smoothing `groups` of OBJ, one for each triangle (or none at all): faces of
/// group 0 are flat, those of another group are smooth among each other however sharp their edges, and no face is smoothed
/// with one of another group. `crease` is for `BY_CREASE` alone. `points` is the point of each vertex (or empty: each is its
/// own); vertices of one point, which differ in texture coordinates perhaps, count as one.
pub fn compute_group_normals(mesh: &mut Mesh, points: &[u32], groups: &[u32], crease: f64) {
    let point = |vertex: u32| points.get(vertex as usize).copied().unwrap_or(vertex);
    let count = points.iter().max().map_or(mesh.positions.len(), |most| *most as usize + 1);
    let crease = crease.clamp(0.0, PI);
    let mut sums = Sums::new(count);
    for face in 0..mesh.triangles.len() {
        let area = area_vector(mesh, face);
        mesh.triangles[face].iter().for_each(|v| sums.add(point(*v), area));
    }
    // Most points are smooth all around: all their corners have the sum.
    let uneven = uneven_points(mesh, point, groups, &sums, crease);
    let normals = sums.into_directions();
    mesh.normals = match points {
        [] => normals,
        _ => points.iter().map(|point| normals[*point as usize]).collect(),
    };
    let around = Incidence::new(&mesh.triangles, count, point, |point| uneven[point as usize]);
    let cos_crease = libm::cos(crease);
    let mut fan = Fan::default();
    for point in (0..uneven.len() as u32).filter(|point| uneven[*point as usize]) {
        let corners = around.corners(point);
        fan.open(mesh, corners, groups);
        for (i, corner) in corners.iter().enumerate() {
            let normal = fan.corner_normal(i, cos_crease);
            let (face, k) = (*corner as usize / 3, *corner as usize % 3);
            mesh.triangles[face][k] = fan.vertex_of(mesh.triangles[face][k], normal, mesh);
        }
    }
}

/// Which points may have corners of different normals. Where every face is within half the crease angle of the sum, all
/// are within the crease angle of each other.
fn uneven_points(mesh: &Mesh, point: impl Fn(u32) -> u32, groups: &[u32], sums: &Sums, crease: f64) -> Vec<bool> {
    /// What rounding could hide, radians.
    const MARGIN: f64 = 1e-4;
    let cos_half = libm::cos((0.5 * crease - MARGIN).max(0.0));
    let mut uneven = vec![false; sums.count];
    // 0: not seen yet. Faces of group 0 make all their points uneven anyway.
    let mut first_group = vec![0u32; if groups.is_empty() { 0 } else { sums.count }];
    for (face, triangle) in mesh.triangles.iter().enumerate() {
        let own = area_vector(mesh, face);
        let group = groups.get(face).copied().unwrap_or(BY_CREASE);
        for p in triangle.map(|v| point(v) as usize) {
            let sum = sums.at(p);
            let along = own.dot(sum);
            let near = || along >= 0.0 && along * along >= cos_half * cos_half * (own.dot(own) * sum.dot(sum));
            let mut even = group != 0 && sum != DVec3::ZERO && (group != BY_CREASE || near());
            if let Some(first) = first_group.get_mut(p) {
                even &= *first == 0 || *first == group;
                *first = group;
            }
            uneven[p] |= !even;
        }
    }
    uneven
}

/// The sum at each point, in blocks that go one by one: a large mesh does without the room of another mesh.
struct Sums {
    blocks: Vec<Vec<DVec3>>,
    count: usize,
}

impl Sums {
    /// Points of a block, 48 MiB: allocators give as much back to the system as soon as it is free.
    const BLOCK: usize = 1 << 21;

    fn new(count: usize) -> Self {
        let block = |start: usize| vec![DVec3::ZERO; Self::BLOCK.min(count - start)];
        Self { blocks: (0..count).step_by(Self::BLOCK).map(block).collect(), count }
    }

    fn add(&mut self, point: u32, area: DVec3) {
        self.blocks[point as usize / Self::BLOCK][point as usize % Self::BLOCK] += area;
    }

    fn at(&self, point: usize) -> DVec3 {
        self.blocks[point / Self::BLOCK][point % Self::BLOCK]
    }

    fn into_directions(self) -> Vec<Vec3> {
        let mut found = Vec::with_capacity(self.count);
        for block in self.blocks {
            found.extend(block.into_iter().map(direction));
        }
        found
    }
}

/// The corners at one point.
#[derive(Default)]
struct Fan {
    /// Of each corner's face, twice its area times the normal.
    areas: Vec<DVec3>,
    groups: Vec<u32>,
    /// Of a fan too large to compare all its pairs: the sum of each group.
    sums: Option<HashMap<u32, DVec3>>,
    /// The vertices that have been made of each vertex here, by the bits of their normals.
    made: BTreeMap<(u32, [u32; 3]), u32>,
}

impl Fan {
    fn open(&mut self, mesh: &Mesh, corners: &[u32], groups: &[u32]) {
        /// A fan this large is round enough; comparing all its pairs would take time quadratic in its size.
        const FAN_MAX: usize = 256;
        let faces = || corners.iter().map(|corner| *corner as usize / 3);
        self.areas.clear();
        self.areas.extend(faces().map(|face| area_vector(mesh, face)));
        self.groups.clear();
        self.groups.extend(faces().map(|face| groups.get(face).copied().unwrap_or(BY_CREASE)));
        self.made.clear();
        self.sums = (corners.len() > FAN_MAX).then(|| {
            let mut sums = HashMap::new();
            for (area, group) in self.areas.iter().zip(&self.groups) {
                *sums.entry(*group).or_default() += *area;
            }
            sums
        });
    }

    /// The normal of corner `i`.
    fn corner_normal(&self, i: usize, cos_crease: f64) -> Vec3 {
        let (own, group) = (self.areas[i], self.groups[i]);
        let is_near = |a: DVec3| a.dot(own) >= cos_crease * libm::sqrt(a.dot(a) * own.dot(own));
        let smooth = |a: DVec3| group != BY_CREASE || own == DVec3::ZERO || is_near(a);
        let sum = match &self.sums {
            _ if group == 0 => own,
            Some(sums) => sums[&group],
            None => {
                let others = self.areas.iter().zip(&self.groups);
                others.filter(|(a, g)| **g == group && smooth(**a)).map(|(a, _)| *a).sum()
            }
        };
        direction(if sum == DVec3::ZERO { own } else { sum })
    }

    /// The vertex like `vertex` that has `normal`: itself for the first normal, copies of it for others.
    fn vertex_of(&mut self, vertex: u32, normal: Vec3, mesh: &mut Mesh) -> u32 {
        let key = |bits| (vertex, bits);
        let is_first = self.made.range(key([0; 3])..=key([u32::MAX; 3])).next().is_none();
        *self.made.entry(key(normal.to_array().map(f32::to_bits))).or_insert_with(|| {
            if is_first {
                mesh.normals[vertex as usize] = normal;
                return vertex;
            }
            let v = vertex as usize;
            mesh.positions.push(mesh.positions[v]);
            mesh.normals.push(normal);
            if !mesh.uvs.is_empty() {
                mesh.uvs.push(mesh.uvs[v]);
            }
            if !mesh.colors.is_empty() {
                mesh.colors.push(mesh.colors[v]);
            }
            mesh.positions.len() as u32 - 1
        })
    }
}

/// Makes every normal of `mesh` unit; one that is zero or not finite becomes the mean of the faces around its vertex.
/// Returns how many were replaced. A mesh without normals stays so.
pub fn repair_normals(mesh: &mut Mesh) -> usize {
    let usable = |n: Vec3| n.is_finite() && n.as_dvec3().length() > 1e-12;
    let replaced = mesh.normals.iter().filter(|n| !usable(**n)).count();
    let around = (replaced > 0).then(|| {
        let wanted = |v: u32| !usable(mesh.normals[v as usize]);
        Incidence::new(&mesh.triangles, mesh.normals.len(), |v| v, wanted)
    });
    for v in 0..mesh.normals.len() {
        let n = mesh.normals[v];
        mesh.normals[v] = match &around {
            Some(around) if !usable(n) => {
                direction(around.corners(v as u32).iter().map(|c| area_vector(mesh, *c as usize / 3)).sum())
            }
            _ => direction(n.as_dvec3()),
        };
    }
    replaced
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

/// Which corners of triangles points have, as one array in the order of points. Corner k of face f is 3 f + k.
struct Incidence {
    starts: Vec<u32>,
    corners: Vec<u32>,
}

impl Incidence {
    /// Of those of `count` points that are `wanted`.
    fn new(triangles: &[[u32; 3]], count: usize, point: impl Fn(u32) -> u32, wanted: impl Fn(u32) -> bool) -> Self {
        let mut starts = vec![0u32; count + 1];
        let corners = || triangles.as_flattened().iter().map(|v| point(*v)).zip(0..).filter(|(p, _)| wanted(*p));
        corners().for_each(|(p, _)| starts[p as usize + 1] += 1);
        for p in 0..count {
            starts[p + 1] += starts[p];
        }
        let mut found = vec![0u32; starts[count] as usize];
        // Each start moves on to the next one, and then back.
        for (p, corner) in corners() {
            found[starts[p as usize] as usize] = corner;
            starts[p as usize] += 1;
        }
        starts.rotate_right(1);
        starts[0] = 0;
        Self { starts, corners: found }
    }

    fn corners(&self, point: u32) -> &[u32] {
        &self.corners[self.starts[point as usize] as usize..self.starts[point as usize + 1] as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::shape::sphere_mesh;
    use glam::Vec2;

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

    /// The number of different normals at the corners of each face of the cube.
    fn normals_of(mesh: &Mesh, face: usize) -> Vec<Vec3> {
        mesh.triangles[face].iter().map(|v| mesh.normals[*v as usize]).collect()
    }

    #[test]
    fn smoothing_groups_are_smooth_within_and_sharp_between() {
        // Top and bottom are flat, the four sides are one round band.
        let mut mesh = shared_cube();
        let groups = [0, 0, 0, 0, 7, 7, 7, 7, 7, 7, 7, 7];
        compute_group_normals(&mut mesh, &[], &groups, 0.1);
        assert_eq!(mesh.positions.len(), 16);
        for (face, group) in groups.into_iter().enumerate() {
            for (corner, normal) in mesh.triangles[face].iter().zip(normals_of(&mesh, face)) {
                let side = mesh.positions[*corner as usize] - Vec3::splat(0.5);
                let expected = if group == 0 { Vec3::Z * side.z.signum() } else { side.with_z(0.0) };
                assert!(normal.dot(expected.normalize()) > 0.94, "{face} {normal} {expected}");
                assert!(group != 0 || normal == expected, "flat is exactly flat");
            }
        }
        // Two groups in one plane and a third that bends: the crease angle does not count, the groups do.
        let mut apart = shared_cube();
        compute_group_normals(&mut apart, &[], &[1, 1, 2, 2, 3, 3, 4, 4, 5, 5, 6, 6], PI);
        let mut flat = shared_cube();
        compute_smooth_normals(&mut flat, 0.1);
        assert_eq!((apart.positions.len(), apart.normals.len()), (24, 24));
        for face in 0..12 {
            assert_eq!(normals_of(&apart, face), normals_of(&flat, face));
        }
    }

    /// A disk of `count` faces around one vertex, bent a little.
    fn fan(count: u32) -> Mesh {
        let rim = (0..count).map(|i| {
            let turn = f64::from(i) / f64::from(count) * 2.0 * PI;
            Vec3::new(libm::cos(turn) as f32, libm::sin(turn) as f32, 0.5 - (i % 2) as f32)
        });
        let positions = std::iter::once(Vec3::Z).chain(rim).collect();
        let triangles = (0..count).map(|i| [0, 1 + i, 1 + (i + 1) % count]).collect();
        Mesh { positions, triangles, ..Mesh::default() }
    }

    #[test]
    fn a_million_faces_around_one_vertex_take_no_longer_than_elsewhere() {
        let time = |groups: &[u32], crease: f64, mut mesh: Mesh| {
            let start = std::time::Instant::now();
            compute_group_normals(&mut mesh, &[], groups, crease);
            (start.elapsed().as_secs_f64(), mesh)
        };
        let groups: Vec<u32> = (0..1 << 20).map(|i| i % 1000).collect();
        for (groups, crease) in [(&groups[..], 0.7), (&[], 0.7), (&[], 0.0)] {
            let (small, _) = time(groups, crease, fan(1 << 16));
            let (large, mesh) = time(groups, crease, fan(1 << 20));
            assert!(mesh.normals.iter().all(|n| (n.length() - 1.0).abs() < 1e-5));
            // Sixteen times the faces; quadratic time would be 256 times as long.
            assert!(large < 80.0 * small + 1.0, "{small} s, {large} s");
        }
    }

    #[test]
    fn vertices_of_one_point_are_smooth_together_and_stay_apart() {
        // The cube, every corner of every triangle a vertex of its own, told apart by its texture coordinates.
        let shared = shared_cube();
        let points: Vec<u32> = shared.triangles.iter().flatten().copied().collect();
        let mut mesh = Mesh {
            positions: points.iter().map(|p| shared.positions[*p as usize]).collect(),
            uvs: (0..36).map(|i| Vec2::splat(i as f32)).collect(),
            triangles: (0..12).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(),
            ..Mesh::default()
        };
        let before = mesh.clone();
        compute_group_normals(&mut mesh, &points, &[], PI);
        let mut expected = shared.clone();
        compute_smooth_normals(&mut expected, PI);
        assert_eq!((mesh.positions.len(), &mesh.uvs, &mesh.triangles), (36, &before.uvs, &before.triangles));
        assert!(mesh.normals.iter().zip(&points).all(|(normal, p)| *normal == expected.normals[*p as usize]));
        // Sharp edges: the vertices are apart already, and none is doubled.
        let mut sharp = before.clone();
        compute_group_normals(&mut sharp, &points, &[], 0.1);
        assert_eq!((sharp.positions.len(), &sharp.triangles), (36, &before.triangles));
        assert!(sharp.normals.iter().all(|normal| normal.abs().max_element() == 1.0));
    }
}
