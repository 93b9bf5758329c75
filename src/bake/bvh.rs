//! Eight-wide hierarchies: obvhs chooses their shape, everything else about them is ours.
//!
//! obvhs's own boxes are not conservative and its depth has no bound, so only its tree is taken: boxes are quantised
//! here from the exact bounds of what lies below, and a tree too deep for the traversal stack is replaced by a
//! median split.

use super::wide::widen;
use crate::layout::{Node, STACK_SIZE};
use glam::{DVec3, Vec3};
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::bvh2::reinsertion::ReinsertionOptimizer;
use obvhs::ploc::PlocBuilder;
use rayon::prelude::*;
use std::time::Instant;

/// Primitives in a leaf of a mesh; the node format has room for three.
pub const MESH_LEAF: u32 = 3;
/// Instances in a leaf of the top level: entering one costs more than testing its box.
pub const TOP_LEAF: u32 = 1;

/// Smallest and largest raw exponent of a node's grid: 2^-100, so that no distance is subnormal, to 2^100.
const EXPONENT_RANGE: (i32, i32) = (27, 227);

/// An axis-aligned box; empty if `min > max`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    pub min: Vec3,
    pub max: Vec3,
}

impl Bounds {
    pub const EMPTY: Self = Self { min: Vec3::INFINITY, max: Vec3::NEG_INFINITY };

    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    #[must_use]
    pub fn with(self, point: Vec3) -> Self {
        Self { min: self.min.min(point), max: self.max.max(point) }
    }

    /// Twice the centre.
    fn centre(&self) -> DVec3 {
        self.min.as_dvec3() + self.max.as_dvec3()
    }
}

/// One node without its boxes. Inner children lie side by side from `child_base`, in the order of their slots.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct TreeNode {
    pub child_base: u32,
    pub primitive_base: u32,
    pub inner_mask: u8,
    /// As `Node::child_meta`.
    pub meta: [u8; 8],
}

/// What a slot of a node holds.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Child {
    Empty,
    /// First primitive in the tree's order, and how many.
    Leaf(u32, u32),
    /// Index of a later node.
    Inner(u32),
}

impl TreeNode {
    fn child(&self, slot: usize) -> Child {
        let meta = self.meta[slot];
        if meta == 0 {
            Child::Empty
        } else if self.inner_mask & (1 << slot) != 0 {
            let before = self.inner_mask & ((1u32 << slot) - 1) as u8;
            Child::Inner(self.child_base + before.count_ones())
        } else {
            Child::Leaf(self.primitive_base + u32::from(meta & 31), (meta >> 5).count_ones())
        }
    }

    fn children(&self) -> impl Iterator<Item = Child> + '_ {
        (0..8).map(|slot| self.child(slot))
    }
}

/// The shape of a hierarchy: node 0 is the root, children come after their parents.
#[derive(Clone, Debug, Default)]
pub struct Tree {
    nodes: Vec<TreeNode>,
    /// Which primitive stands at each place of the traversal order.
    pub order: Vec<u32>,
    /// Seconds that its binary tree and the conversion took.
    pub seconds: [f64; 2],
}

impl Tree {
    pub fn node_count(&self) -> usize {
        self.nodes.len()
    }

    /// A tree of good quality that fits the traversal stack, over `count` primitives, one at least. `box_of`: the box of each,
    /// finite; asked for again rather than kept.
    pub fn build(count: usize, box_of: impl Fn(u32) -> Bounds + Sync, leaf: u32) -> Self {
        let tree = Self::by_surface_area(count, &box_of, leaf);
        if tree.stack_depth() <= STACK_SIZE {
            return tree;
        }
        let boxes: Vec<Bounds> = (0..count as u32).map(box_of).collect();
        Self::median_split(&boxes, leaf)
    }

    /// A tree of good quality, of any depth.
    fn by_surface_area(count: usize, box_of: impl Fn(u32) -> Bounds + Sync, leaf: u32) -> Self {
        let start = Instant::now();
        let boxed = |primitive| {
            let Bounds { min, max } = box_of(primitive);
            Aabb::new(min.into(), max.into())
        };
        let boxes: Vec<Aabb> = (0..count as u32).into_par_iter().map(boxed).collect();
        let preset = BvhBuildParams::medium_build();
        // The steps of obvhs's `build_cwbvh` up to the binary tree.
        let mut binary = PlocBuilder::with_capacity(count).build(
            preset.ploc_search_distance,
            &boxes,
            (0..count as u32).collect(),
            preset.sort_precision,
            preset.search_depth_threshold,
        );
        drop(boxes);
        ReinsertionOptimizer::default().run(&mut binary, preset.reinsertion_batch_ratio, None);
        let binary_s = start.elapsed().as_secs_f64();
        let (nodes, order) = widen(&binary, leaf);
        let wide_s = start.elapsed().as_secs_f64() - binary_s;
        Self { nodes, order, seconds: [binary_s, wide_s] }
    }

    /// A tree of the least depth: each node halves its largest part, by the median along its longest axis, until it
    /// has eight.
    fn median_split(boxes: &[Bounds], leaf: u32) -> Self {
        let mut tree =
            Self { nodes: vec![TreeNode::default()], order: Vec::with_capacity(boxes.len()), seconds: [0.0; 2] };
        let mut waiting = vec![(0usize, (0..boxes.len() as u32).collect::<Vec<u32>>())];
        while let Some((index, primitives)) = waiting.pop() {
            let mut parts = vec![primitives];
            while parts.len() < 8 {
                let largest = (0..parts.len()).max_by_key(|&i| parts[i].len()).unwrap_or(0);
                if parts[largest].len() <= leaf as usize {
                    break;
                }
                let half = halve(&mut parts[largest], boxes);
                parts.push(half);
            }
            let bounds: Vec<Bounds> = parts.iter().map(|part| bounds_of(part, boxes)).collect();
            let centres: Vec<DVec3> = bounds.iter().map(Bounds::centre).collect();
            let slots = octant_slots(&centres, bounds.iter().fold(Bounds::EMPTY, |b, &c| b.union(c)).centre());
            let mut node = TreeNode {
                child_base: tree.nodes.len() as u32,
                primitive_base: tree.order.len() as u32,
                ..TreeNode::default()
            };
            for slot in 0..8 {
                let Some(part) = slots.iter().position(|&s| s == slot) else {
                    continue;
                };
                let part = std::mem::take(&mut parts[part]);
                if part.len() <= leaf as usize {
                    let offset = tree.order.len() as u32 - node.primitive_base;
                    node.meta[slot] = ((1u8 << part.len()) - 1) << 5 | offset as u8;
                    tree.order.extend(part);
                } else {
                    node.inner_mask |= 1 << slot;
                    node.meta[slot] = 0b0010_0000 | (24 + slot as u8);
                    waiting.push((tree.nodes.len(), part));
                    tree.nodes.push(TreeNode::default());
                }
            }
            tree.nodes[index] = node;
        }
        tree
    }

    /// Entries of the traversal stack that the worst ray needs: a child leaves one group behind if it has a sibling
    /// (some octant visits it first).
    pub fn stack_depth(&self) -> u32 {
        let mut need = vec![0u32; self.nodes.len()];
        for (index, node) in self.nodes.iter().enumerate().rev() {
            let siblings = u32::from(node.inner_mask.count_ones() > 1);
            let inner = node.children().filter_map(|child| match child {
                Child::Inner(child) => Some(siblings + need[child as usize]),
                Child::Empty | Child::Leaf(..) => None,
            });
            need[index] = inner.max().unwrap_or(0);
        }
        need.first().copied().unwrap_or(0)
    }

    /// The nodes as the traversal reads them. Every quantised child box contains the boxes of all primitives below it.
    /// `node_base`, `primitive_base`: where the tree's nodes and its order begin in the scene's arrays.
    pub fn pack(&self, box_of: impl Fn(u32) -> Bounds + Sync, node_base: u32, primitive_base: u32) -> Vec<Node> {
        let leaves = |node: &TreeNode| {
            std::array::from_fn(|slot| match node.child(slot) {
                Child::Empty | Child::Inner(_) => Bounds::EMPTY,
                Child::Leaf(first, count) => {
                    let inside = &self.order[first as usize..(first + count) as usize];
                    inside.iter().fold(Bounds::EMPTY, |b, &p| b.union(box_of(p)))
                }
            })
        };
        let mut child_bounds: Vec<[Bounds; 8]> = self.nodes.par_iter().map(leaves).collect();
        let mut bounds = vec![Bounds::EMPTY; self.nodes.len()];
        for (index, node) in self.nodes.iter().enumerate().rev() {
            for (slot, child) in node.children().enumerate() {
                if let Child::Inner(child) = child {
                    child_bounds[index][slot] = bounds[child as usize];
                }
            }
            bounds[index] = child_bounds[index].iter().fold(Bounds::EMPTY, |b, &c| b.union(c));
        }
        let pack_one = |(index, node): (usize, &TreeNode)| {
            pack_node(node, &bounds[index], &child_bounds[index], node_base, primitive_base)
        };
        self.nodes.par_iter().enumerate().map(pack_one).collect()
    }
}

/// Takes the upper half, by the median of the centres along their longest axis, out of `part`.
fn halve(part: &mut Vec<u32>, boxes: &[Bounds]) -> Vec<u32> {
    let centre = |p: u32| boxes[p as usize].centre();
    let (low, high) = part
        .iter()
        .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), &p| (low.min(centre(p)), high.max(centre(p))));
    let extent = high - low;
    let axis = if extent.x >= extent.y && extent.x >= extent.z { 0 } else { 1 + usize::from(extent.z > extent.y) };
    let middle = part.len() / 2;
    part.select_nth_unstable_by(middle, |&a, &b| centre(a)[axis].total_cmp(&centre(b)[axis]).then(a.cmp(&b)));
    part.split_off(middle)
}

fn bounds_of(part: &[u32], boxes: &[Bounds]) -> Bounds {
    part.iter().fold(Bounds::EMPTY, |b, &p| b.union(boxes[p as usize]))
}

/// The slot of each child, 8 at most, such that slot xor octant is a near-to-far order (Ylitie et al. 2017, section 3.2,
/// greedily): bits 4, 2, 1 of a slot stand for the positive side in x, y, z. `centres`, `middle`: of the children's boxes
/// and of the box around all, each in the same multiple.
pub(super) fn octant_slots(centres: &[DVec3], middle: DVec3) -> [usize; 8] {
    debug_assert!(centres.len() <= 8, "{} children", centres.len());
    let mut wishes = [[0.0; 8]; 8];
    for (wishes, &centre) in wishes.iter_mut().zip(centres) {
        let v = centre - middle;
        for (slot, wish) in wishes.iter_mut().enumerate() {
            let sign = |bit: usize| if slot & bit != 0 { 1.0 } else { -1.0 };
            *wish = sign(4) * v.x + sign(2) * v.y + sign(1) * v.z;
        }
    }
    let mut slots = [usize::MAX; 8];
    let mut taken = [false; 8];
    for _ in centres {
        let mut best = (f64::NEG_INFINITY, 0, 0);
        for child in (0..centres.len()).filter(|&child| slots[child] == usize::MAX) {
            for slot in (0..8).filter(|&slot| !taken[slot]) {
                if wishes[child][slot] > best.0 {
                    best = (wishes[child][slot], child, slot);
                }
            }
        }
        let (_, child, slot) = best;
        slots[child] = slot;
        taken[slot] = true;
    }
    slots
}

/// The raw exponent of the finest grid whose 255 steps span `extent`.
fn grid_exponent(extent: f64) -> u32 {
    let mut raw = EXPONENT_RANGE.0;
    if extent > 0.0 {
        // The exponent of extent / 256 is at most one too small.
        raw = (((extent.to_bits() >> 52) as i32 - 1023) - 8 + 127).max(EXPONENT_RANGE.0);
        while 255.0 * grid_step(raw as u32) < extent {
            raw += 1;
        }
    }
    debug_assert!(raw <= EXPONENT_RANGE.1, "extent {extent} of a node");
    raw as u32
}

fn grid_step(raw: u32) -> f64 {
    f64::from(f32::from_bits(raw << 23))
}

fn pack_node(node: &TreeNode, bounds: &Bounds, children: &[Bounds; 8], node_base: u32, primitive_base: u32) -> Node {
    let origin = bounds.min;
    let corner = origin.as_dvec3();
    let extent = bounds.max.as_dvec3() - corner;
    let raw = [grid_exponent(extent.x), grid_exponent(extent.y), grid_exponent(extent.z)];
    let mut planes = [[[0u8; 8]; 2]; 3];
    for (slot, child) in children.iter().enumerate() {
        if child.min.x > child.max.x {
            continue;
        }
        for axis in 0..3 {
            let step = grid_step(raw[axis]);
            let low = ((f64::from(child.min[axis]) - corner[axis]) / step).floor();
            let high = ((f64::from(child.max[axis]) - corner[axis]) / step).ceil();
            debug_assert!(low >= 0.0 && high <= 255.0, "child {low}..{high} of a node");
            planes[axis][0][slot] = low as u8;
            planes[axis][1][slot] = high as u8;
        }
    }
    let words = |bytes: [u8; 8]| {
        let [a, b, c, d, e, f, g, h] = bytes;
        [u32::from_le_bytes([a, b, c, d]), u32::from_le_bytes([e, f, g, h])]
    };
    Node {
        origin,
        exponents_imask: raw[0] | raw[1] << 8 | raw[2] << 16 | u32::from(node.inner_mask) << 24,
        child_base: node_base + node.child_base,
        primitive_base: primitive_base + node.primitive_base,
        child_meta: words(node.meta),
        min_x: words(planes[0][0]),
        max_x: words(planes[0][1]),
        min_y: words(planes[1][0]),
        max_y: words(planes[1][1]),
        min_z: words(planes[2][0]),
        max_z: words(planes[2][1]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Clusters of four boxes that shrink geometrically towards the origin, along x.
    fn cascade(clusters: u32, factor: f32) -> Vec<Bounds> {
        let mut radius = 1.0f32;
        let mut boxes = Vec::new();
        for _ in 0..clusters {
            for i in 0..4u8 {
                let within = Vec3::new(f32::from(i % 3), f32::from(i / 3), 0.0);
                let corner = Vec3::X * radius + within * (0.02 * radius);
                boxes.push(Bounds { min: corner, max: corner + Vec3::splat(0.004 * radius) });
            }
            radius *= factor;
        }
        boxes
    }

    #[test]
    fn a_tree_too_deep_for_the_stack_is_shallow_after_a_median_split() {
        let boxes = cascade(800, 0.9);
        let box_of = |index: u32| boxes[index as usize];
        let deep = Tree::by_surface_area(boxes.len(), box_of, MESH_LEAF);
        assert!(deep.stack_depth() > STACK_SIZE, "{}", deep.stack_depth());
        let flat = Tree::build(boxes.len(), box_of, MESH_LEAF);
        assert!(flat.stack_depth() <= 5, "{}", flat.stack_depth());
        let mut order = flat.order.clone();
        order.sort_unstable();
        assert_eq!(order, (0..boxes.len() as u32).collect::<Vec<_>>());
    }

    #[test]
    fn the_grid_spans_its_extent_and_is_no_coarser_than_need_be() {
        for extent in [0.0, 1e-30, 1.0, 255.0, 255.000001, 256.0, 510.0, 3.7e9] {
            let raw = grid_exponent(extent);
            assert!(255.0 * grid_step(raw) >= extent, "{extent}");
            assert!(raw == EXPONENT_RANGE.0 as u32 || 255.0 * grid_step(raw - 1) < extent, "{extent}");
        }
    }
}
