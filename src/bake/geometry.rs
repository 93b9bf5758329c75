//! Meshes: faces, vertices, traversal triangles and their hierarchy.

use super::bvh::{Bounds, MESH_LEAF, Tree};
use crate::layout::{Face, Node, Triangle, Vertex};
use crate::scene::{MaterialId, Mesh};
use glam::{DVec3, Vec3};
use rayon::prelude::*;
use std::time::Instant;

/// Coordinates below this (2^-60 of the mesh's size) become 0, as the ray's do (`trace::ray`): no difference between the
/// two then has so few bits that the survival of subnormals could matter.
const DUST: f32 = 8.6736174e-19;

/// One mesh, indices relative to its own arrays.
#[derive(Clone, Debug, Default)]
pub struct BakedMesh {
    /// One for each triangle as written, dropped ones included.
    pub faces: Vec<Face>,
    pub vertices: Vec<Vertex>,
    /// In traversal order.
    pub triangles: Vec<Triangle>,
    /// Shape of the hierarchy, and its nodes as if they and the triangles were alone.
    pub tree: Tree,
    pub nodes: Vec<Node>,
    pub bounds: Option<Bounds>,
    /// Coordinates are stored divided by this power of two, so that the largest is in 1..2 and the strict arithmetic of
    /// `trace` works far from overflow and underflow at any scale. Instances multiply it back, exactly.
    pub unit: f64,
    pub warning: Option<String>,
    /// Seconds that the nodes took, and all but the hierarchy.
    pub pack_s: f64,
    pub geometry_s: f64,
}

impl BakedMesh {
    /// Whether a ray can hit anything of it.
    pub fn is_empty(&self) -> bool {
        self.triangles.is_empty()
    }
}

/// The power of two that brings `largest` (> 0) into 1..2.
fn unit_of(largest: f32) -> f64 {
    let (_, exponent) = libm::frexp(f64::from(largest));
    libm::ldexp(1.0, exponent - 1)
}

/// Bakes one mesh. `default_material`: of faces that name none. Triangles with corners that are not numbers or without
/// area are dropped and counted in `warning`.
pub fn bake_mesh(mesh: &Mesh, default_material: MaterialId) -> BakedMesh {
    let start = Instant::now();
    let finite = |corners: &[u32; 3]| corners.iter().all(|&i| mesh.positions[i as usize].is_finite());
    let used = mesh.triangles.par_iter().filter(|corners| finite(corners)).flatten_iter();
    let largest = used.map(|&i| mesh.positions[i as usize].abs().max_element()).reduce(|| 0.0, f32::max);
    let unit = if largest > 0.0 { unit_of(largest) } else { 1.0 };
    let mut baked = BakedMesh { unit, ..BakedMesh::default() };
    let positions: Vec<Vec3> = mesh.positions.par_iter().map(|&p| scaled(p, unit)).collect();
    let corners = |primitive: u32| mesh.triangles[primitive as usize].map(|i| positions[i as usize]);
    let states: Vec<State> = (0..mesh.triangles.len() as u32)
        .into_par_iter()
        .map(|primitive| match face_normal(corners(primitive)) {
            _ if !finite(&mesh.triangles[primitive as usize]) => State::NotFinite,
            None => State::Flat,
            Some(_) => State::Kept,
        })
        .collect();
    let of = |state| (0u32..).zip(&states).filter(move |(_, found)| **found == state).map(|(primitive, _)| primitive);
    let kept: Vec<u32> = of(State::Kept).collect();
    if kept.len() < states.len() {
        let reasons = [(State::NotFinite, "with coordinates that are not finite"), (State::Flat, "without area")];
        let counted = reasons.map(|(state, reason)| (of(state).count(), reason));
        let told = counted.iter().filter(|(count, _)| *count > 0).map(|(count, reason)| format!("{count} {reason}"));
        let told = told.collect::<Vec<_>>().join(" and ");
        baked.warning = Some(format!("mesh \"{}\": dropped triangles: {told}", mesh.name));
    }
    let before = start.elapsed().as_secs_f64();
    // The hierarchy before all that stays: building it takes the most memory.
    if !kept.is_empty() {
        let box_of = |index: u32| bounds_of(corners(kept[index as usize]));
        baked.tree = Tree::build(kept.len(), box_of, MESH_LEAF);
        let start = Instant::now();
        baked.nodes = baked.tree.pack(box_of, 0, 0);
        baked.pack_s = start.elapsed().as_secs_f64();
    }
    let start = Instant::now();
    let triangle = |&index: &u32| {
        let primitive = kept[index as usize];
        let [v0, v1, v2] = corners(primitive);
        Triangle { v0, v1, v2, primitive, ..Triangle::default() }
    };
    baked.triangles = baked.tree.order.par_iter().map(triangle).collect();
    let boxes = kept.par_iter().map(|&primitive| bounds_of(corners(primitive)));
    baked.bounds = boxes.reduce_with(Bounds::union);
    let mut builder = VertexBuilder::new(mesh, &positions);
    baked.faces.reserve_exact(mesh.triangles.len());
    for (primitive, &corners) in mesh.triangles.iter().enumerate() {
        let material = mesh.face_materials.get(primitive).copied().unwrap_or(default_material).0;
        let [i0, i1, i2] = builder.face(corners);
        baked.faces.push(Face { i0, i1, i2, material });
    }
    baked.vertices = builder.vertices;
    baked.geometry_s = before + start.elapsed().as_secs_f64();
    baked
}

/// What becomes of a triangle.
#[derive(Clone, Copy, PartialEq)]
enum State {
    Kept,
    NotFinite,
    Flat,
}

fn bounds_of([v0, v1, v2]: [Vec3; 3]) -> Bounds {
    Bounds::EMPTY.with(v0).with(v1).with(v2)
}

/// A position in the mesh's unit; 0 where it is not finite (such triangles are dropped).
fn scaled(p: Vec3, unit: f64) -> Vec3 {
    let one = |x: f32| {
        let y = (f64::from(x) / unit) as f32;
        if y.is_finite() && y.abs() >= DUST { y } else { 0.0 }
    };
    Vec3::new(one(p.x), one(p.y), one(p.z))
}

/// The unit normal of the counter-clockwise side; none if the triangle has no area.
fn face_normal([v0, v1, v2]: [Vec3; 3]) -> Option<Vec3> {
    let (e1, e2) = ((v1.as_dvec3() - v0.as_dvec3()), (v2.as_dvec3() - v0.as_dvec3()));
    unit(DVec3::new(e1.y * e2.z - e1.z * e2.y, e1.z * e2.x - e1.x * e2.z, e1.x * e2.y - e1.y * e2.x))
}

/// `v` made unit; none if it has no direction.
fn unit(v: DVec3) -> Option<Vec3> {
    let length = libm::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
    let n = v / length;
    (length > 0.0 && n.is_finite()).then(|| n.as_vec3())
}

/// Vertices are shared where the mesh has a usable normal, and made per face where it has none.
struct VertexBuilder<'a> {
    mesh: &'a Mesh,
    positions: &'a [Vec3],
    /// Index of each vertex as written, once it is needed.
    shared: Vec<Option<u32>>,
    vertices: Vec<Vertex>,
}

impl<'a> VertexBuilder<'a> {
    fn new(mesh: &'a Mesh, positions: &'a [Vec3]) -> Self {
        Self { mesh, positions, shared: vec![None; positions.len()], vertices: Vec::new() }
    }

    fn face(&mut self, corners: [u32; 3]) -> [u32; 3] {
        let mut own = None;
        corners.map(|corner| {
            let normal = self.mesh.normals.get(corner as usize).and_then(|n| unit(n.as_dvec3()));
            match (normal, self.shared[corner as usize]) {
                (None, _) => {
                    let of_face = || face_normal(corners.map(|i| self.positions[i as usize])).unwrap_or(Vec3::Z);
                    let normal = *own.get_or_insert_with(of_face);
                    self.push(corner, normal)
                }
                (Some(_), Some(index)) => index,
                (Some(normal), None) => {
                    let index = self.push(corner, normal);
                    self.shared[corner as usize] = Some(index);
                    index
                }
            }
        })
    }

    /// More than 2^32 of them are refused when the scene is put together.
    fn push(&mut self, corner: u32, normal: Vec3) -> u32 {
        let at = corner as usize;
        let uv = self.mesh.uvs.get(at).copied().filter(|uv| uv.is_finite()).unwrap_or_default();
        let color = self.mesh.colors.get(at).copied().filter(|c| c.is_finite()).unwrap_or(Vec3::ONE);
        self.vertices.push(Vertex {
            position: self.positions[at],
            u: uv.x,
            normal,
            v: uv.y,
            color,
            ..Vertex::default()
        });
        (self.vertices.len() - 1) as u32
    }
}
