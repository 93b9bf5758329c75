//! Eight-wide hierarchies.
//!
//! Many boxes are cut into parts first (`split`), each becomes a binary tree (`ploc`) that obvhs improves, and all of it
//! becomes one eight-wide tree (`wide`): parts stay in the cache of the core that works on them. obvhs's own wide boxes are
//! not conservative and its depth has no bound, so boxes are quantised here, from the exact bounds of what lies below, and a
//! tree too deep for the traversal stack is replaced by a median split.

use super::places::{NODES_MOST, Places};
use super::ploc::Ploc;
use super::split::{Cut, cut};
use super::wide::{Part, widen};
use super::{BakeError, check};
use crate::layout::{Node, STACK_SIZE};
use crate::watch::Watch;
use glam::{Vec3, Vec3A};
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::bvh2::node::Bvh2Node;
use obvhs::bvh2::reinsertion::ReinsertionOptimizer;
use rayon::prelude::*;
use std::time::Instant;

/// Primitives in a leaf of a mesh; the node format has room for three.
pub const MESH_LEAF: u32 = 3;
/// Instances in a leaf of the top level: entering one costs more than testing its box.
pub const TOP_LEAF: u32 = 1;
/// Primitives of a part at most: its nodes are 4 MB, and what obvhs needs to make them is no more. Larger parts make better
/// trees of few and unequal triangles (by 2 % for a kitchen of 57,000), smaller ones of many and alike (by 1 % for 4 million).
const PART: usize = 1 << 16;

/// Smallest and largest raw exponent of a node's grid: 2^-100, so that no distance is subnormal, to 2^100.
const EXPONENT_RANGE: (i32, i32) = (27, 227);

/// A primitive's box and number (`first_index`), or a node of a binary tree.
pub type Item = Bvh2Node;

/// The item of primitive `number`.
pub fn item(bounds: Bounds, number: u32) -> Item {
    Bvh2Node::new(Aabb::new(bounds.min.into(), bounds.max.into()), 1, number)
}

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
}

impl From<&Aabb> for Bounds {
    fn from(aabb: &Aabb) -> Self {
        Self { min: aabb.min.into(), max: aabb.max.into() }
    }
}

/// A hierarchy, as if it were alone: node 0 is the root, children come after their parents.
#[derive(Clone, Debug, Default)]
pub struct Tree {
    pub nodes: Vec<Node>,
    /// Which primitive stands at each place of the traversal order.
    pub order: Vec<u32>,
    /// Entries of the traversal stack that the worst ray needs.
    pub stack: u32,
    /// Around everything; none if there is nothing.
    pub bounds: Option<Bounds>,
    /// Seconds that its binary tree and the conversion took.
    pub seconds: [f64; 2],
}

impl Tree {
    /// A tree of good quality that fits the traversal stack, over finite boxes. `leaf`: primitives in a leaf, 1 to 3.
    pub fn build(items: Vec<Item>, leaf: u32, watch: &Watch) -> Result<Self, BakeError> {
        if items.is_empty() {
            return Ok(Self::default());
        }
        let start = Instant::now();
        let (top, parts) = binary(items, leaf, PART, watch)?;
        let binary_s = start.elapsed().as_secs_f64();
        let mut tree = Self::of_binary(&top, &parts, leaf, watch)?;
        tree.seconds = [binary_s, start.elapsed().as_secs_f64() - binary_s];
        Ok(tree)
    }

    /// The tree that a binary one becomes, or another if that is too deep.
    fn of_binary(top: &Part, parts: &[Part], leaf: u32, watch: &Watch) -> Result<Self, BakeError> {
        let (mut nodes, mut order, mut stack) = widen(top, parts, watch)?;
        if stack > STACK_SIZE {
            let items: Vec<Item> = parts.iter().flat_map(Part::leaves).copied().collect();
            (nodes, order, stack) = median_split(&items, leaf);
            if nodes.len() > NODES_MOST {
                return Err(BakeError::Nodes { count: nodes.len() });
            }
        }
        Ok(Self { nodes, order, stack, bounds: Some(Bounds::from(top.bounds())), seconds: [0.0; 2] })
    }
}

/// A binary tree, solved for `widen`: its top, and its parts of `part` primitives at most.
pub(super) fn binary(
    mut items: Vec<Item>,
    leaf: u32,
    part: usize,
    watch: &Watch,
) -> Result<(Part, Vec<Part>), BakeError> {
    let cut = cut(&mut items, part, 0, 0);
    let mut ranges = Vec::new();
    let mut nodes = top_nodes(&cut, &mut ranges);
    let build = |builder: &mut Ploc, range: &std::ops::Range<usize>| {
        check(watch)?;
        let part = Part::of_primitives(part_nodes(builder, &items[range.clone()]), leaf);
        watch.advance(range.len() as i64);
        Ok(part)
    };
    let parts = ranges.par_iter().map_init(Ploc::default, build).collect::<Result<Vec<Part>, BakeError>>()?;
    for index in (0..nodes.len()).rev() {
        let node = &nodes[index];
        let first = node.first_index as usize;
        let around = match node.is_leaf() {
            true => *parts[first].bounds(),
            false => nodes[first].aabb().union(nodes[first + 1].aabb()),
        };
        nodes[index].set_aabb(around);
    }
    Ok((Part::of_parts(nodes, &parts, leaf), parts))
}

/// The nodes above the parts, without boxes, parents first; leaves are numbers in `ranges`.
fn top_nodes(cut: &Cut, ranges: &mut Vec<std::ops::Range<usize>>) -> Vec<Item> {
    let mut nodes = vec![Bvh2Node::default()];
    let mut waiting = vec![(cut, 0)];
    while let Some((cut, index)) = waiting.pop() {
        match cut {
            Cut::Part(range) => {
                nodes[index] = Bvh2Node::new(Aabb::INVALID, 1, ranges.len() as u32);
                ranges.push(range.clone());
            }
            Cut::Two(two) => {
                let first = nodes.len();
                nodes[index] = Bvh2Node::new(Aabb::INVALID, 0, first as u32);
                nodes.extend([Bvh2Node::default(); 2]);
                waiting.extend([(&two[1], first + 1), (&two[0], first)]);
            }
        }
    }
    nodes
}

/// The binary tree over `items`, one at least.
fn part_nodes(builder: &mut Ploc, items: &[Item]) -> Vec<Item> {
    let mut tree = builder.build(items);
    ReinsertionOptimizer::default().run(&mut tree, BvhBuildParams::medium_build().reinsertion_batch_ratio, None);
    tree.nodes
}

/// A tree of the least depth: each node halves its largest part, by the median along its longest axis, until it has eight.
/// Its nodes, the order of its primitives and the stack that it needs.
fn median_split(items: &[Item], leaf: u32) -> (Vec<Node>, Vec<u32>, u32) {
    let (mut nodes, mut order) = (vec![Node::default()], Vec::with_capacity(items.len()));
    let mut places = Places::new();
    let mut waiting = vec![(0, (0..items.len() as u32).collect::<Vec<u32>>())];
    while let Some((index, inside)) = waiting.pop() {
        let mut parts = vec![inside];
        while parts.len() < 8 {
            let largest = (0..parts.len()).max_by_key(|&i| parts[i].len()).unwrap_or(0);
            if parts[largest].len() <= leaf as usize {
                break;
            }
            let half = halve(&mut parts[largest], items);
            parts.push(half);
        }
        let around = |part: &Vec<u32>| part.iter().fold(Aabb::INVALID, |all, &i| all.union(items[i as usize].aabb()));
        let bounds: Vec<Aabb> = parts.iter().map(around).collect();
        let whole = bounds.iter().fold(Aabb::INVALID, |all, part| all.union(part));
        let centres: Vec<Vec3A> = bounds.iter().map(|part| part.min + part.max).collect();
        let primitive_base = order.len() as u32;
        let (mut inner_mask, mut meta, mut boxes) = (0u8, [0u8; 8], [Bounds::EMPTY; 8]);
        let mut inner = Vec::new();
        for (slot, part) in octant_slots(&centres, whole.min + whole.max).into_iter().enumerate() {
            let Some(part) = part else { continue };
            boxes[slot] = Bounds::from(&bounds[part]);
            let part = std::mem::take(&mut parts[part]);
            if part.len() <= leaf as usize {
                let offset = order.len() as u32 - primitive_base;
                meta[slot] = ((1u8 << part.len()) - 1) << 5 | offset as u8;
                order.extend(part.into_iter().map(|i| items[i as usize].first_index));
            } else {
                inner_mask |= 1 << slot;
                meta[slot] = 0b0010_0000 | (24 + slot as u8);
                inner.push(part);
            }
        }
        let children = places.take(index, inner_mask);
        nodes.resize(places.len(), Node::default());
        let node = pack_node(&Bounds::from(&whole), &boxes, inner_mask, meta);
        let node = Node { children, primitive_base, ..node };
        waiting.extend(node.inner_children(0).map(|(_, place)| place).zip(inner));
        nodes[index as usize] = node;
    }
    let stack = stack_needs(&nodes, vec![0; nodes.len()]);
    (nodes, order, stack)
}

/// Entries of the traversal stack that the worst ray below `nodes[0]` needs: a child leaves one group behind if it has a
/// sibling (some octant visits it first). `known`: the need of nodes that have no children yet.
pub(super) fn stack_needs(nodes: &[Node], mut known: Vec<u32>) -> u32 {
    for (index, node) in nodes.iter().enumerate().rev() {
        let siblings = (node.exponents_imask >> 24).count_ones() > 1;
        let below = node.inner_children(0).map(|(_, child)| known[child as usize]).max();
        let deepest = below.map_or(0, |need| need + u32::from(siblings));
        known[index] = known[index].max(deepest);
    }
    known.first().copied().unwrap_or(0)
}

/// Takes the upper half, by the median of the centres along their longest axis, out of `part`.
fn halve(part: &mut Vec<u32>, items: &[Item]) -> Vec<u32> {
    let centre = |p: u32| items[p as usize].aabb().min + items[p as usize].aabb().max;
    let around = part.iter().fold(Aabb::INVALID, |all, &p| all.union(&Aabb::from_point(centre(p))));
    let axis = around.largest_axis();
    let middle = part.len() / 2;
    part.select_nth_unstable_by(middle, |&a, &b| centre(a)[axis].total_cmp(&centre(b)[axis]).then(a.cmp(&b)));
    part.split_off(middle)
}

/// The child in each slot, such that slot xor octant is a near-to-far order (Ylitie et al. 2017, section 3.2, greedily): bits
/// 4, 2, 1 of a slot stand for the positive side in x, y, z. `centres`, `middle`: of the children's boxes, 8 at most, and of
/// the box around all, each in the same multiple.
pub(super) fn octant_slots(centres: &[Vec3A], middle: Vec3A) -> [Option<usize>; 8] {
    debug_assert!(centres.len() <= 8, "{} children", centres.len());
    let wish = |child: usize, slot: usize| {
        let v = centres[child] - middle;
        let sign = |bit: usize, x: f32| if slot & bit != 0 { x } else { -x };
        sign(4, v.x) + sign(2, v.y) + sign(1, v.z)
    };
    // The free slot that each child wants most, and how much: at first that of its octant.
    let mut first = [(f32::NEG_INFINITY, 0); 8];
    for (child, &centre) in centres.iter().enumerate() {
        let v = centre - middle;
        let slot = usize::from(v.x > 0.0) << 2 | usize::from(v.y > 0.0) << 1 | usize::from(v.z > 0.0);
        first[child] = (wish(child, slot), slot);
    }
    let mut slots = [None; 8];
    let mut waiting = (1u32 << centres.len()) - 1;
    while waiting != 0 {
        let mut child = waiting.trailing_zeros() as usize;
        for other in child + 1..centres.len() {
            child = if waiting & 1 << other != 0 && first[other].0 > first[child].0 { other } else { child };
        }
        let taken = first[child].1;
        slots[taken] = Some(child);
        waiting &= !(1 << child);
        for other in (0..centres.len()).filter(|other| waiting & 1 << other != 0) {
            if first[other].1 == taken {
                let free = (0..8).filter(|&slot| slots[slot].is_none()).map(|slot| (wish(other, slot), slot));
                first[other] = free.reduce(|best, next| if next.0 > best.0 { next } else { best }).unwrap_or_default();
            }
        }
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

/// A node with everything but its bases. Every quantised child box contains the box that it is made of; `children`: by slot.
pub(super) fn pack_node(bounds: &Bounds, children: &[Bounds; 8], inner_mask: u8, meta: [u8; 8]) -> Node {
    let origin = bounds.min;
    let corner = origin.as_dvec3();
    let extent = bounds.max.as_dvec3() - corner;
    let raw = [grid_exponent(extent.x), grid_exponent(extent.y), grid_exponent(extent.z)];
    // Steps are powers of two, so multiplying by the inverse is exact.
    let inverse = raw.map(|raw| 1.0 / grid_step(raw));
    let mut planes = [[[0u8; 8]; 2]; 3];
    for (slot, child) in children.iter().enumerate() {
        if meta[slot] == 0 {
            continue;
        }
        for axis in 0..3 {
            let low = (f64::from(child.min[axis]) - corner[axis]) * inverse[axis];
            let high = (f64::from(child.max[axis]) - corner[axis]) * inverse[axis];
            debug_assert!(low >= 0.0 && high <= 255.0, "child {low}..{high} of a node");
            // Rounded down and up.
            let below = high as u8;
            planes[axis][0][slot] = low as u8;
            planes[axis][1][slot] = below + u8::from(f64::from(below) < high);
        }
    }
    let words = |bytes: [u8; 8]| {
        let [a, b, c, d, e, f, g, h] = bytes;
        [u32::from_le_bytes([a, b, c, d]), u32::from_le_bytes([e, f, g, h])]
    };
    Node {
        origin,
        exponents_imask: raw[0] | raw[1] << 8 | raw[2] << 16 | u32::from(inner_mask) << 24,
        children: 0,
        primitive_base: 0,
        child_meta: words(meta),
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

    /// A binary tree that takes four items after the other from the rest, two at least.
    fn chain(items: &[Item]) -> Vec<Item> {
        let (mut nodes, mut waiting) = (vec![Item::default()], vec![(0, items)]);
        while let Some((at, inside)) = waiting.pop() {
            if let [item] = inside {
                nodes[at] = *item;
                continue;
            }
            let (near, rest) = inside.split_at(if inside.len() > 4 { 4 } else { inside.len() / 2 });
            let first = nodes.len();
            nodes[at] = Item::new(Aabb::INVALID, 0, first as u32);
            nodes.extend([Item::default(); 2]);
            waiting.extend([(first, near), (first + 1, rest)]);
        }
        for at in (0..nodes.len()).rev().filter(|&at| !nodes[at].is_leaf()).collect::<Vec<_>>() {
            let first = nodes[at].first_index as usize;
            let around = nodes[first].aabb().union(nodes[first + 1].aabb());
            nodes[at].set_aabb(around);
        }
        nodes
    }

    #[test]
    fn a_tree_too_deep_for_the_stack_is_shallow_after_a_median_split() {
        let boxes = cascade(800, 0.9);
        let items: Vec<Item> = (0..).zip(&boxes).map(|(number, &bounds)| item(bounds, number)).collect();
        let parts = [Part::of_primitives(chain(&items), MESH_LEAF)];
        let top = Part::of_parts(vec![Item::new(*parts[0].bounds(), 1, 0)], &parts, MESH_LEAF);
        let (_, _, deep) = widen(&top, &parts, &Watch::default()).expect("nobody aborts");
        assert!(deep > STACK_SIZE, "{deep}");
        let flat = Tree::of_binary(&top, &parts, MESH_LEAF, &Watch::default()).expect("nobody aborts");
        assert!(flat.stack <= 5, "{}", flat.stack);
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
