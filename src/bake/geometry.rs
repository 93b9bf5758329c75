//! Meshes: faces, vertices, traversal triangles and their hierarchy.

use super::bvh::{Bounds, Item, MESH_LEAF, Tree, item};
use super::{BakeError, check};
use crate::layout::{Face, INVALID, Triangle, Vertex};
use crate::scene::{MaterialId, Mesh};
use crate::watch::Watch;
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
    /// Its hierarchy; the order is that of `triangles` and no longer there.
    pub tree: Tree,
    /// Coordinates are stored divided by this power of two, so that the largest is in 1..2 and the strict arithmetic of
    /// `trace` works far from overflow and underflow at any scale. Instances multiply it back, exactly.
    pub unit: f64,
    /// Its name, and its triangles that were dropped.
    pub name: String,
    pub dropped: Dropped,
    /// Seconds that all but the hierarchy took.
    pub geometry_s: f64,
}

/// Triangles that nothing can hit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Dropped {
    pub not_finite: usize,
    pub flat: usize,
}

/// One warning for all `meshes`, if triangles of any were dropped.
pub fn warn_dropped<'a>(meshes: impl Iterator<Item = &'a BakedMesh>) -> Option<String> {
    let with: Vec<&BakedMesh> = meshes.filter(|mesh| mesh.dropped != Dropped::default()).collect();
    let sum = |of: fn(&Dropped) -> usize| with.iter().map(|mesh| of(&mesh.dropped)).sum::<usize>();
    let counted = [
        (sum(|dropped| dropped.not_finite), "with coordinates that are not finite"),
        (sum(|dropped| dropped.flat), "without area"),
    ];
    let told = counted.iter().filter(|(count, _)| *count > 0).map(|(count, reason)| format!("{count} {reason}"));
    let told = told.collect::<Vec<_>>().join(" and ");
    match &with[..] {
        [] => None,
        [mesh] => Some(format!("mesh \"{}\": dropped triangles: {told}", mesh.name)),
        meshes => Some(format!("{} meshes: dropped triangles: {told}", meshes.len())),
    }
}

impl BakedMesh {
    /// Whether a ray can hit anything of it.
    pub fn is_empty(&self) -> bool {
        self.triangles.is_empty()
    }
}

/// Bakes one mesh. `default_material`: of faces that name none. Triangles with corners that are not numbers or without
/// area are dropped and counted.
pub fn bake_mesh(mesh: &Mesh, default_material: MaterialId, watch: &Watch) -> Result<BakedMesh, BakeError> {
    check(watch)?;
    let start = Instant::now();
    let finite = |corners: &[u32; 3]| corners.iter().all(|&i| mesh.positions[i as usize].is_finite());
    let unit = mesh.unit();
    let mut baked = BakedMesh { unit, name: mesh.name.clone(), ..BakedMesh::default() };
    let positions: Vec<Vec3> = mesh.positions.par_iter().map(|&p| scaled(p, unit)).collect();
    let corners = |primitive: u32| mesh.triangles[primitive as usize].map(|i| positions[i as usize]);
    let state = |primitive: u32| match face_normal(corners(primitive)) {
        _ if !finite(&mesh.triangles[primitive as usize]) => State::NotFinite,
        None => State::Flat,
        Some(_) => State::Kept,
    };
    let numbers = (0..mesh.triangles.len() as u32).into_par_iter();
    let boxed = |primitive| match state(primitive) {
        State::Kept => item(bounds_of(corners(primitive)), primitive),
        State::NotFinite | State::Flat => item(Bounds::EMPTY, INVALID),
    };
    let mut items: Vec<Item> = numbers.clone().map(boxed).collect();
    let dropped = items.par_iter().filter(|item| item.first_index == INVALID).count();
    if dropped > 0 {
        items.retain(|item| item.first_index != INVALID);
        let not_finite = numbers.filter(|&primitive| state(primitive) == State::NotFinite).count();
        baked.dropped = Dropped { not_finite, flat: dropped - not_finite };
    }
    let before = start.elapsed().as_secs_f64();
    // The hierarchy before all that stays: building it takes the most memory.
    baked.tree = Tree::build(items, MESH_LEAF, watch)?;
    let start = Instant::now();
    let triangle = |&primitive: &u32| {
        let [v0, v1, v2] = corners(primitive);
        Triangle { v0, v1, v2, primitive, ..Triangle::default() }
    };
    baked.triangles = std::mem::take(&mut baked.tree.order).par_iter().map(triangle).collect();
    (baked.faces, baked.vertices) = faces(mesh, &positions, default_material);
    baked.geometry_s = before + start.elapsed().as_secs_f64();
    Ok(baked)
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

/// The faces and their vertices, which are shared where the mesh has a usable normal and made for each face where it has none,
/// in the order in which faces use them.
fn faces(mesh: &Mesh, positions: &[Vec3], default_material: MaterialId) -> (Vec<Face>, Vec<Vertex>) {
    /// Of corners that no face has used yet, and of those without a usable normal.
    const UNUSED: u32 = u32::MAX;
    const OWN: u32 = u32::MAX - 1;
    let normal = |corner: u32| mesh.normals.get(corner as usize).and_then(|n| unit(n.as_dvec3()));
    let corners = (0..positions.len() as u32).into_par_iter();
    let mut shared: Vec<u32> = corners.map(|c| if normal(c).is_some() { UNUSED } else { OWN }).collect();
    // Corner and face that each vertex is made from. More than 2^32 of them are refused when the scene is put together.
    let mut sources: Vec<[u32; 2]> = Vec::with_capacity(positions.len());
    let mut faces = Vec::with_capacity(mesh.triangles.len());
    for (face, &corners) in mesh.triangles.iter().enumerate() {
        let [i0, i1, i2] = corners.map(|corner| {
            let index = &mut shared[corner as usize];
            if *index < OWN {
                return *index;
            }
            let next = sources.len() as u32;
            if *index == UNUSED {
                *index = next;
            }
            sources.push([corner, face as u32]);
            next
        });
        let material = mesh.face_materials.get(face).copied().unwrap_or(default_material).0;
        faces.push(Face { i0, i1, i2, material });
    }
    let vertex = |&[corner, face]: &[u32; 2]| {
        let at = corner as usize;
        let of_face = || face_normal(mesh.triangles[face as usize].map(|i| positions[i as usize]));
        let uv = mesh.uvs.get(at).copied().filter(|uv| uv.is_finite()).unwrap_or_default();
        Vertex {
            position: positions[at],
            u: uv.x,
            normal: normal(corner).or_else(of_face).unwrap_or(Vec3::Z),
            v: uv.y,
            color: mesh.colors.get(at).copied().filter(|c| c.is_finite()).unwrap_or(Vec3::ONE),
            ..Vertex::default()
        }
    };
    let vertices = sources.par_iter().map(vertex).collect();
    (faces, vertices)
}
