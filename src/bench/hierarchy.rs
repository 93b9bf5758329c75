//! What is traced through: size, cost and extent of a baked scene, read from the nodes as the traversal reads them.

use crate::bake::SceneData;
use crate::layout::{INVALID, KIND_MESH, Node};
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::collections::HashMap;

/// Numbers of a baked scene.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Size {
    /// Triangles that are stored.
    pub triangles: u64,
    pub instances: u64,
    /// Triangles and spheres that are seen: each as often as it is placed.
    pub placed: u64,
    pub nodes: u64,
    /// Nodes visited and primitives tested by a line through the scene's box, on average, both levels together: the
    /// surface area heuristic with a cost of 1 for each (MacDonald and Booth 1990).
    pub sah: f64,
    /// Bytes of the nodes, of the triangles and of everything else that is uploaded.
    pub node_bytes: u64,
    pub triangle_bytes: u64,
    pub data_bytes: u64,
}

/// Measures a scene.
pub fn size_of_scene(data: &SceneData) -> Size {
    let mesh = Level::new(data, |_| 1.0);
    let mut costs = HashMap::new();
    let mut counts = HashMap::new();
    let mut placed = 0;
    for instance in &data.instances {
        if instance.kind == KIND_MESH {
            costs.entry(instance.root).or_insert_with(|| mesh.cost(instance.root));
            placed += *counts.entry(instance.root).or_insert_with(|| mesh.primitives(instance.root));
        } else {
            placed += 1;
        }
    }
    let top = Level::new(data, |place| {
        let instance = &data.instances[data.shapes.top_instances[place as usize] as usize];
        if instance.kind == KIND_MESH { costs[&instance.root] } else { 1.0 }
    });
    Size {
        triangles: data.shapes.triangles.len() as u64,
        instances: data.instances.len() as u64,
        placed,
        nodes: data.shapes.nodes.iter().filter(|node| node.child_meta != [0; 2]).count() as u64,
        sah: if data.header.top_root == INVALID { 0.0 } else { top.cost(data.header.top_root) },
        node_bytes: size_of_val(data.shapes.nodes.as_slice()) as u64,
        triangle_bytes: size_of_val(data.shapes.triangles.as_slice()) as u64,
        data_bytes: data.heap_words() * 16,
    }
}

/// The diagonal of the scene's box, world units; 0 for an empty scene.
pub fn diagonal(data: &SceneData) -> f64 {
    if data.header.top_root == INVALID {
        return 0.0;
    }
    let (low, high) = extent(&data.shapes.nodes[data.header.top_root as usize]);
    let size = high - low;
    libm::sqrt(size.x * size.x + size.y * size.y + size.z * size.z)
}

/// The triangles of the mesh below `root`: places in the triangle array, in the mesh's own order.
pub fn triangles_below(data: &SceneData, root: u32) -> Vec<u32> {
    let mut found = Vec::new();
    Level::new(data, |_| 1.0).walk(root, |_, _, places| found.extend(places.into_iter().flatten()));
    found.sort_by_key(|&place| data.shapes.triangles[place as usize].primitive);
    found
}

/// One byte of a node's two words.
fn byte(words: [u32; 2], slot: usize) -> u32 {
    words[slot / 4] >> (8 * (slot % 4)) & 255
}

/// The box of a child that is there.
fn child_box(node: &Node, slot: usize) -> (DVec3, DVec3) {
    let step = |axis: u32| f64::from(f32::from_bits((node.exponents_imask >> (8 * axis) & 255) << 23));
    let corner = |x, y, z| {
        let at = |words, axis| f64::from(byte(words, slot)) * step(axis);
        node.origin.as_dvec3() + DVec3::new(at(x, 0), at(y, 1), at(z, 2))
    };
    (corner(node.min_x, node.min_y, node.min_z), corner(node.max_x, node.max_y, node.max_z))
}

/// The box of all children.
fn extent(node: &Node) -> (DVec3, DVec3) {
    let children = (0..8).filter(|&slot| byte(node.child_meta, slot) != 0).map(|slot| child_box(node, slot));
    children.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))).unwrap_or_default()
}

fn half_area((low, high): (DVec3, DVec3)) -> f64 {
    let size = high - low;
    size.x * size.y + size.y * size.z + size.z * size.x
}

/// One level of the hierarchy; `cost_of` a primitive by its place.
struct Level<'a, F> {
    data: &'a SceneData,
    cost_of: F,
}

impl<'a, F: Fn(u32) -> f64> Level<'a, F> {
    fn new(data: &'a SceneData, cost_of: F) -> Self {
        Self { data, cost_of }
    }

    /// Visits every child below `root`: its node, its slot, and the node or the primitives in it.
    fn walk(&self, root: u32, mut visit: impl FnMut(&Node, usize, Option<std::ops::Range<u32>>)) {
        let mut waiting = vec![root];
        while let Some(index) = waiting.pop() {
            let node = &self.data.shapes.nodes[index as usize];
            for (slot, child) in node.inner_children(root) {
                visit(node, slot as usize, None);
                waiting.push(child);
            }
            for slot in 0..8 {
                let meta = byte(node.child_meta, slot);
                if node.exponents_imask >> (24 + slot) & 1 == 0 && meta != 0 {
                    let first = node.primitive_base + (meta & 31);
                    visit(node, slot, Some(first..first + (meta >> 5).count_ones()));
                }
            }
        }
    }

    fn primitives(&self, root: u32) -> u64 {
        let mut count = 0;
        self.walk(root, |_, _, places| count += places.map_or(0, |places| places.len() as u64));
        count
    }

    fn cost(&self, root: u32) -> f64 {
        let whole = half_area(extent(&self.data.shapes.nodes[root as usize]));
        let mut cost = 1.0;
        self.walk(root, |node, slot, places| {
            let share = if whole > 0.0 { half_area(child_box(node, slot)) / whole } else { 1.0 };
            cost += share * places.map_or(1.0, |places| places.map(&self.cost_of).sum());
        });
        cost
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bake::bake;
    use crate::scene::load::Override;
    use std::path::Path;

    fn baked(objects: &str) -> SceneData {
        let text = format!("[camera]\neye = [0, 0, 9]\ntarget = [0, 0, 0]\n{objects}");
        let overrides: [Override; 0] = [];
        let scene = crate::scene::load::toml::scene_from_text(Path::new("test.toml"), text, &overrides);
        bake(&scene.expect("a scene")).expect("bakes")
    }

    #[test]
    fn a_line_through_one_sphere_visits_one_node_and_tests_one_primitive() {
        let size = size_of_scene(&baked("[[object]]\nshape = \"sphere\"\n"));
        assert_eq!((size.nodes, size.instances, size.placed, size.triangles), (1, 1, 1, 0));
        assert_eq!(size.sah, 2.0);
    }

    #[test]
    fn a_shared_mesh_is_stored_once_and_placed_as_often_as_it_is_seen() {
        let two = "instances = [{ translate = [0, 0, 0] }, { translate = [5, 0, 0] }]\n";
        let size = size_of_scene(&baked(&format!("[[object]]\nshape = \"box\"\n{two}")));
        assert_eq!((size.triangles, size.instances, size.placed), (12, 2, 24));
        assert!(size.sah > 2.0 && size.sah < 14.0, "{}", size.sah);
    }

    #[test]
    fn the_diagonal_is_that_of_the_box_and_hardly_larger() {
        let found = diagonal(&baked("[[object]]\nshape = \"box\"\nsize = [1, 2, 2]\n"));
        assert!((3.0..3.1).contains(&found), "{found}");
    }
}
