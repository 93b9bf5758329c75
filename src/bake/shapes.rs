//! The shapes of a scene where they stand, and the hierarchies over them: what most of baking is spent on.
//!
//! They depend on meshes and transforms alone, so scenes that differ in anything else share them (`Baker`).

use super::bvh::{Bounds, Item, TOP_LEAF, Tree, item};
use super::geometry::{BakedMesh, bake_mesh, warn_dropped};
use super::instance::{place, top_margin};
use super::scene::check_count;
use super::{BakeError, BakeTimes};
use crate::layout::{Face, INVALID, Node, STACK_SIZE, Triangle, Vertex};
use crate::scene::{Geometry, MaterialId, Mesh, Scene};
use crate::watch::Watch;
use glam::{Vec3, Vec4};
use rayon::prelude::*;
use std::ops::Range;
use std::time::Instant;

/// An object that can be hit, where it stands.
#[derive(Clone, Debug)]
pub struct Placed {
    /// Its place in the scene's list.
    pub object: u32,
    pub to_world: [Vec4; 3],
    pub to_object: [Vec4; 3],
    pub mirrored: bool,
    /// Of a mesh: where its hierarchy, faces and triangles begin (and end). None for the analytic sphere.
    pub mesh: Option<PlacedMesh>,
}

/// Where a mesh lies in the scene's arrays.
#[derive(Clone, Debug, Default)]
pub struct PlacedMesh {
    pub root: u32,
    pub first_face: u32,
    pub triangles: Range<usize>,
}

/// All shapes of a scene. Indices inside are absolute and valid.
#[derive(Clone, Debug)]
pub struct Shapes {
    /// Top-level and mesh BVHs, one after the other.
    pub nodes: Vec<Node>,
    /// In traversal order.
    pub triangles: Vec<Triangle>,
    pub faces: Vec<Face>,
    pub vertices: Vec<Vertex>,
    /// Each is an instance of the scene, in this order.
    pub placed: Vec<Placed>,
    /// Instance of each primitive of the top-level BVH.
    pub top_instances: Vec<u32>,
    /// As in `SceneHeader`.
    pub top_root: u32,
    pub top_margin: f32,
    /// Entries a traversal stack needs in the worst case: the deeper of the top level and the deepest mesh.
    pub stack_depth: u32,
    /// Box of everything.
    pub bounds: Bounds,
    /// Dropped primitives.
    pub warnings: Vec<String>,
}

impl Default for Shapes {
    /// Of a scene without objects.
    fn default() -> Self {
        Self {
            nodes: Vec::new(),
            triangles: Vec::new(),
            faces: Vec::new(),
            vertices: Vec::new(),
            placed: Vec::new(),
            top_instances: Vec::new(),
            top_root: INVALID,
            top_margin: 0.0,
            stack_depth: 0,
            bounds: Bounds::EMPTY,
            warnings: Vec::new(),
        }
    }
}

/// BLAKE3 of all that `bake_shapes` reads: equal keys mean equal shapes.
pub fn shapes_key(scene: &Scene, default_material: MaterialId) -> [u8; 32] {
    let mut hasher = blake3::Hasher::new();
    let mut add = |bytes: &[u8]| {
        hasher.update(&(bytes.len() as u64).to_le_bytes());
        hasher.update(bytes);
    };
    add(&default_material.0.to_le_bytes());
    for (mesh, used) in scene.meshes.iter().zip(used_meshes(scene)) {
        add(&[u8::from(used)]);
        if !used {
            continue;
        }
        add(mesh.name.as_bytes());
        add(bytemuck::cast_slice(&mesh.positions));
        add(bytemuck::cast_slice(&mesh.normals));
        add(bytemuck::cast_slice(&mesh.uvs));
        add(bytemuck::cast_slice(&mesh.colors));
        add(bytemuck::cast_slice(&mesh.triangles));
        let materials: Vec<u32> = mesh.face_materials.iter().map(|id| id.0).collect();
        add(bytemuck::cast_slice(&materials));
    }
    for object in &scene.objects {
        add(object.name.as_bytes());
        add(&match object.geometry {
            Geometry::Sphere => INVALID.to_le_bytes(),
            Geometry::Mesh(id) => id.0.to_le_bytes(),
        });
        add(bytemuck::cast_slice(&object.transform.0.to_cols_array()));
    }
    *hasher.finalize().as_bytes()
}

/// Whether an object shows each mesh.
fn used_meshes(scene: &Scene) -> Vec<bool> {
    let mut used = vec![false; scene.meshes.len()];
    for object in &scene.objects {
        if let Geometry::Mesh(id) = object.geometry {
            used[id.0 as usize] = true;
        }
    }
    used
}

/// Bakes meshes, places objects and builds both levels; adds what that took to `times`. `default_material`: of faces that name
/// none.
pub fn bake_shapes(
    scene: &Scene,
    default_material: MaterialId,
    times: &mut BakeTimes,
    watch: &Watch,
) -> Result<Shapes, BakeError> {
    let mut meshes = bake_meshes(scene, default_material, watch)?;
    let mut shapes = Shapes::default();
    for mesh in meshes.iter().flatten() {
        times.geometry_s += mesh.geometry_s;
        times.binary_s += mesh.tree.seconds[0];
        times.wide_s += mesh.tree.seconds[1];
    }
    let start = Instant::now();
    let shown = place_objects(scene, &mut meshes, &mut shapes)?;
    times.top_s += start.elapsed().as_secs_f64();
    build_hierarchy(meshes, &shown, &mut shapes, times, watch)?;
    Ok(shapes)
}

/// Bakes each mesh that an object uses, once.
fn bake_meshes(
    scene: &Scene,
    default_material: MaterialId,
    watch: &Watch,
) -> Result<Vec<Option<BakedMesh>>, BakeError> {
    let one = |(mesh, used): (&Mesh, bool)| used.then(|| bake_mesh(mesh, default_material, watch)).transpose();
    scene.meshes.par_iter().zip(used_meshes(scene)).map(one).collect()
}

/// Mesh and world box of each placed object, and the largest growth of rounding by its transforms.
struct Shown {
    meshes: Vec<(Option<usize>, Bounds)>,
    growth: f64,
}

/// Places the objects, and collects the faces and vertices of the meshes they show.
fn place_objects(scene: &Scene, meshes: &mut [Option<BakedMesh>], shapes: &mut Shapes) -> Result<Shown, BakeError> {
    let faces = meshes.iter().flatten().map(|mesh| mesh.faces.len()).sum();
    let vertices = meshes.iter().flatten().map(|mesh| mesh.vertices.len()).sum();
    check_count("vertices", vertices)?;
    check_count("faces", faces)?;
    shapes.warnings.extend(warn_dropped(meshes.iter().flatten()));
    let mut first_face = vec![0u32; meshes.len()];
    for (id, mesh) in meshes.iter_mut().enumerate() {
        let Some(mesh) = mesh else { continue };
        first_face[id] = shapes.faces.len() as u32;
        let base = shapes.vertices.len() as u32;
        if base > 0 {
            mesh.faces.par_iter_mut().for_each(|face| {
                (face.i0, face.i1, face.i2) = (base + face.i0, base + face.i1, base + face.i2);
            });
        }
        append(&mut shapes.faces, std::mem::take(&mut mesh.faces), faces);
        append(&mut shapes.vertices, std::mem::take(&mut mesh.vertices), vertices);
    }
    let mut shown = Shown { meshes: Vec::new(), growth: 1.0 };
    for (index, object) in scene.objects.iter().enumerate() {
        let sphere = Bounds { min: Vec3::NEG_ONE, max: Vec3::ONE };
        let (mesh, unit, bounds) = match object.geometry {
            Geometry::Sphere => (None, 1.0, sphere),
            Geometry::Mesh(id) => match &meshes[id.0 as usize] {
                Some(BakedMesh { tree: Tree { bounds: Some(bounds), .. }, unit, .. }) => {
                    (Some(id.0 as usize), *unit, *bounds)
                }
                // Nothing of it can be hit.
                _ => continue,
            },
        };
        let placement = place(&object.name, &object.transform, unit, &bounds, mesh.is_none())?;
        shown.growth = shown.growth.max(placement.growth);
        shown.meshes.push((mesh, placement.world));
        shapes.bounds = shapes.bounds.union(placement.world);
        shapes.placed.push(Placed {
            object: index as u32,
            to_world: placement.to_world,
            to_object: placement.to_object,
            mirrored: placement.mirrored,
            mesh: mesh.map(|id| PlacedMesh { first_face: first_face[id], ..PlacedMesh::default() }),
        });
    }
    check_count("instances", shapes.placed.len())?;
    Ok(shown)
}

/// Appends `more` to `all`, which is to have `total` items in the end. The first part of a scene moves without a copy: large
/// arrays grow in place.
fn append<T>(all: &mut Vec<T>, mut more: Vec<T>, total: usize) {
    if all.is_empty() {
        std::mem::swap(all, &mut more);
    }
    all.reserve_exact(total - all.len());
    all.append(&mut more);
}

/// Builds the top level and lays all hierarchies out in one array.
fn build_hierarchy(
    mut meshes: Vec<Option<BakedMesh>>,
    shown: &Shown,
    shapes: &mut Shapes,
    times: &mut BakeTimes,
    watch: &Watch,
) -> Result<(), BakeError> {
    shapes.top_margin = top_margin(shown.growth);
    if shown.meshes.is_empty() {
        return Ok(());
    }
    let start = Instant::now();
    let boxes: Vec<Item> = (0..).zip(&shown.meshes).map(|(index, &(_, world))| item(world, index)).collect();
    let top = Tree::build(boxes, TOP_LEAF, watch)?;
    shapes.stack_depth = meshes.iter().flatten().map(|mesh| mesh.tree.stack).fold(top.stack, u32::max);
    if shapes.stack_depth > STACK_SIZE {
        return Err(BakeError::Deep(shapes.stack_depth));
    }
    times.top_s += start.elapsed().as_secs_f64();

    let start = Instant::now();
    let triangles = meshes.iter().flatten().map(|mesh| mesh.triangles.len()).sum();
    check_count("triangles", triangles)?;
    let nodes = meshes.iter().flatten().map(|mesh| mesh.tree.nodes.len()).sum::<usize>() + top.nodes.len();
    check_count("nodes", nodes)?;
    let mut laid = vec![(INVALID, 0..0); meshes.len()];
    for (mesh, laid) in meshes.iter_mut().zip(&mut laid) {
        let Some(mesh) = mesh.as_mut().filter(|mesh| !mesh.is_empty()) else {
            continue;
        };
        let first = (shapes.nodes.len() as u32, shapes.triangles.len());
        *laid = (first.0, first.1..first.1 + mesh.triangles.len());
        append(&mut shapes.nodes, shifted(std::mem::take(&mut mesh.tree.nodes), first.1 as u32), nodes);
        append(&mut shapes.triangles, std::mem::take(&mut mesh.triangles), triangles);
    }
    // The top level last, so that the nodes of a large mesh need not make room for it.
    shapes.top_root = shapes.nodes.len() as u32;
    append(&mut shapes.nodes, top.nodes, nodes);
    shapes.top_instances = top.order;
    for (placed, (mesh, _)) in shapes.placed.iter_mut().zip(&shown.meshes) {
        if let (Some(placed), Some(id)) = (&mut placed.mesh, mesh) {
            (placed.root, placed.triangles) = laid[*id].clone();
        }
    }
    times.pack_s += start.elapsed().as_secs_f64();
    Ok(())
}

/// Nodes of a hierarchy whose primitives begin at `first` in the scene's array.
fn shifted(mut nodes: Vec<Node>, first: u32) -> Vec<Node> {
    if first != 0 {
        nodes.par_iter_mut().for_each(|node| node.primitive_base += first);
    }
    nodes
}
