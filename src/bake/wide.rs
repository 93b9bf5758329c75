//! From binary trees to eight-wide ones, parts side by side.
//!
//! Source: Ylitie, Karras and Laine 2017, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs", section
//! 3: C(n, i), the least surface area cost of what lies below node n as a forest of at most i trees, from the leaves up; then
//! the wide nodes from the root down. The binary tree comes in parts that hang below a small top (`split`), and each part is
//! solved and written by itself. Where it was cut does not change the result.

use super::bvh::{Bounds, Item, octant_slots, pack_node, stack_needs};
use super::places::{NODES_MOST, Places};
use super::{BakeError, check};
use crate::layout::Node;
use crate::watch::Watch;
use glam::Vec3A;
use rayon::prelude::*;

/// Cost of a primitive test over that of a node visit (section 3.2 of the paper).
const PRIMITIVE_COST: f32 = 0.3;

/// What is known of all that lies below a node.
#[derive(Clone, Copy, Debug, Default)]
struct Cost {
    /// C(n, i) for i from 1 to 7.
    forest: [f32; 7],
    /// Primitives; more than a leaf may hold count as one more than that.
    primitives: u32,
}

/// How the least cost of an inner node is had.
#[derive(Clone, Copy, Debug, Default)]
struct Plan {
    /// How many trees of a forest of i the left child gets, i from 2 to 8; 0: the best forest of i - 1 is as good.
    split: [u8; 7],
    /// Whether all of it is one leaf of a wide node.
    is_leaf: bool,
}

/// A part of the binary tree, or its top: the root at 0, siblings side by side.
#[derive(Debug, Default)]
pub struct Part {
    /// Leaves are primitives (`first_index` their number), in the top parts.
    nodes: Vec<Item>,
    /// Of inner nodes, by the place of their children.
    plans: Vec<Plan>,
    /// Of the root.
    cost: Cost,
}

/// The place of an inner node among `Part::plans`.
fn pair(node: &Item) -> usize {
    (node.first_index as usize - 1) / 2
}

/// The best forest of `TREES` that has a tree of each child: its cost, and how many trees are the left child's.
#[inline(always)]
fn distribute<const TREES: usize>(l: &Cost, r: &Cost) -> (f32, u8) {
    let mut best = (f32::INFINITY, 1);
    for k in TREES.saturating_sub(7).max(1)..TREES.min(8) {
        let cost = l.forest[k - 1] + r.forest[TREES - k - 1];
        best = if cost < best.0 { (cost, k as u8) } else { best };
    }
    best
}

impl Cost {
    fn of_primitive(node: &Item) -> Self {
        Self { forest: [node.aabb().half_area() * PRIMITIVE_COST; 7], primitives: 1 }
    }

    /// Of a node over `l` and `r`.
    fn join(area: f32, l: &Self, r: &Self, most: u32) -> (Self, Plan) {
        let primitives = (l.primitives + r.primitives).min(most + 1);
        let two = l.forest[0] + r.forest[0];
        // A node of two primitives is made of them however many trees there may be. They are half of all.
        let mut forests = [(two, 1), (two, 0), (two, 0), (two, 0), (two, 0), (two, 0), (two, 1)];
        if l.primitives > 1 || r.primitives > 1 {
            forests = [
                distribute::<2>(l, r),
                distribute::<3>(l, r),
                distribute::<4>(l, r),
                distribute::<5>(l, r),
                distribute::<6>(l, r),
                distribute::<7>(l, r),
                distribute::<8>(l, r),
            ];
        }
        let (mut cost, mut plan) = (Self { primitives, ..Self::default() }, Plan::default());
        let (inside, split) = forests[6];
        plan.split[6] = split;
        let node = inside + area;
        let leaf = if primitives <= most { area * PRIMITIVE_COST * primitives as f32 } else { f32::INFINITY };
        plan.is_leaf = leaf < node;
        cost.forest[0] = leaf.min(node);
        for (i, &(least, split)) in forests.iter().take(6).enumerate() {
            let before = cost.forest[i];
            (cost.forest[i + 1], plan.split[i]) = if least < before { (least, split) } else { (before, 0) };
        }
        (cost, plan)
    }
}

impl Part {
    /// A part of primitives. `most`: primitives in a leaf of the wide tree, 1 to 3.
    pub fn of_primitives(nodes: Vec<Item>, most: u32) -> Self {
        Self::solve(nodes, Cost::of_primitive, most)
    }

    /// The top over `parts`.
    pub fn of_parts(nodes: Vec<Item>, parts: &[Self], most: u32) -> Self {
        Self::solve(nodes, |leaf| parts[leaf.first_index as usize].cost, most)
    }

    /// Solves from the leaves up.
    fn solve(nodes: Vec<Item>, of_leaf: impl Fn(&Item) -> Cost, most: u32) -> Self {
        // Inner nodes, parents before children, and depth first, so that what is needed has just been made.
        let mut inner = Vec::with_capacity(nodes.len() / 2);
        let mut waiting = vec![0u32];
        while let Some(id) = waiting.pop() {
            let node = &nodes[id as usize];
            if !node.is_leaf() {
                inner.push(id);
                waiting.extend([node.first_index, node.first_index + 1]);
            }
        }
        let mut plans = vec![Plan::default(); inner.len()];
        let mut costs = vec![Cost::default(); inner.len()];
        let cost_of = |costs: &[Cost], node: &Item| if node.is_leaf() { of_leaf(node) } else { costs[pair(node)] };
        for &id in inner.iter().rev() {
            let node = &nodes[id as usize];
            let l = cost_of(&costs, &nodes[node.first_index as usize]);
            let r = cost_of(&costs, &nodes[node.first_index as usize + 1]);
            let place = pair(node);
            (costs[place], plans[place]) = Cost::join(node.aabb().half_area(), &l, &r, most);
        }
        let cost = cost_of(&costs, &nodes[0]);
        Self { nodes, plans, cost }
    }

    /// The box around all.
    pub fn bounds(&self) -> &obvhs::aabb::Aabb {
        self.nodes[0].aabb()
    }

    /// The leaves.
    pub fn leaves(&self) -> impl Iterator<Item = &Item> {
        self.nodes.iter().filter(|node| node.is_leaf())
    }
}

/// A node of the binary tree: part and number in it.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Place {
    part: u32,
    node: u32,
}

/// The part that is the top.
const TOP: u32 = u32::MAX;

/// The solved binary tree.
struct Whole<'a> {
    top: &'a Part,
    parts: &'a [Part],
}

/// Wide nodes written so far, and their primitives.
#[derive(Default)]
struct Written {
    nodes: Vec<Node>,
    order: Vec<u32>,
    /// Entries of the traversal stack that the first node needs.
    stack: u32,
}

impl Whole<'_> {
    #[inline]
    fn part(&self, place: Place) -> &Part {
        if place.part == TOP { self.top } else { &self.parts[place.part as usize] }
    }

    #[inline]
    fn get(&self, place: Place) -> &Item {
        &self.part(place).nodes[place.node as usize]
    }

    /// The node itself; for what hangs below the top the root of the part.
    fn resolve(&self, place: Place) -> Place {
        let node = self.get(place);
        if place.part == TOP && node.is_leaf() { Place { part: node.first_index, node: 0 } } else { place }
    }

    #[inline]
    fn children(&self, place: Place) -> Option<[Place; 2]> {
        let node = self.get(place);
        let of = |i| self.resolve(Place { part: place.part, node: node.first_index + i });
        (!node.is_leaf()).then(|| [of(0), of(1)])
    }

    #[inline]
    fn plan(&self, place: Place) -> Option<&Plan> {
        let node = self.get(place);
        (!node.is_leaf()).then(|| &self.part(place).plans[pair(node)])
    }

    /// The roots of the best forest of at most `trees` trees below `place`.
    fn forest(&self, place: Place, trees: usize, roots: &mut Vec<Place>) {
        let plan = self.plan(place).filter(|_| trees > 1);
        // The best forest of fewer trees may be as good.
        let best = plan.and_then(|plan| (2..=trees).rev().find(|i| plan.split[i - 2] > 0));
        match (best, plan, self.children(place)) {
            (Some(best), Some(plan), Some([left, right])) => {
                let split = usize::from(plan.split[best - 2]);
                self.forest(left, split, roots);
                self.forest(right, best - split, roots);
            }
            _ => roots.push(place),
        }
    }

    /// Appends the primitives below `place`.
    fn primitives(&self, place: Place, order: &mut Vec<u32>) {
        match self.children(place) {
            Some([left, right]) => {
                self.primitives(left, order);
                self.primitives(right, order);
            }
            None => order.push(self.get(place).first_index),
        }
    }

    /// Writes the wide node of `root` and all below it, but for those that `put_off` wants: of these the node's place and
    /// its number are returned, and nothing is written there.
    fn write(&self, root: Place, put_off: impl Fn(Place) -> bool) -> (Written, Vec<(Place, u32)>) {
        let mut out = Written { nodes: vec![Node::default()], ..Written::default() };
        let (mut waiting, mut later) = (vec![(root, 0u32)], Vec::new());
        let mut places = Places::new();
        let (mut roots, mut inner) = (Vec::with_capacity(8), Vec::with_capacity(8));
        while let Some((place, number)) = waiting.pop() {
            roots.clear();
            self.forest(place, 8, &mut roots);
            let around = self.get(place).aabb();
            let mut centres = [Vec3A::ZERO; 8];
            for (centre, &root) in centres.iter_mut().zip(&roots) {
                *centre = self.get(root).aabb().min + self.get(root).aabb().max;
            }
            let children = octant_slots(&centres[..roots.len()], around.min + around.max);
            let primitive_base = out.order.len() as u32;
            let (mut inner_mask, mut meta, mut boxes) = (0u8, [0u8; 8], [Bounds::EMPTY; 8]);
            for (slot, child) in children.into_iter().enumerate() {
                let Some(&child) = child.and_then(|child| roots.get(child)) else { continue };
                boxes[slot] = Bounds::from(self.get(child).aabb());
                if self.plan(child).is_none_or(|plan| plan.is_leaf) {
                    let offset = out.order.len() as u32 - primitive_base;
                    self.primitives(child, &mut out.order);
                    let count = out.order.len() as u32 - primitive_base - offset;
                    meta[slot] = ((1u8 << count) - 1) << 5 | offset as u8;
                    continue;
                }
                inner_mask |= 1 << slot;
                meta[slot] = 0b0010_0000 | (24 + slot as u8);
                inner.push(child);
            }
            let children = places.take(number, inner_mask);
            out.nodes.resize(places.len(), Node::default());
            let node = Node { children, primitive_base, ..pack_node(&Bounds::from(around), &boxes, inner_mask, meta) };
            for (child, (_, number)) in inner.drain(..).zip(node.inner_children(0)) {
                if put_off(child) { later.push((child, number)) } else { waiting.push((child, number)) }
            }
            out.nodes[number as usize] = node;
        }
        (out, later)
    }
}

/// The eight-wide tree of least cost over a binary one: its nodes, children after parents, the order of primitives, and the
/// entries that the traversal stack needs.
pub fn widen(top: &Part, parts: &[Part], watch: &Watch) -> Result<(Vec<Node>, Vec<u32>, u32), BakeError> {
    let whole = Whole { top, parts };
    let root = whole.resolve(Place { part: TOP, node: 0 });
    let (mut first, later) = whole.write(root, |place| place.part != TOP);
    watch.advance(first.order.len() as i64);
    let write = |&(place, _): &(Place, u32)| {
        check(watch)?;
        let (mut part, _) = whole.write(place, |_| false);
        part.stack = stack_needs(&part.nodes, vec![0; part.nodes.len()]);
        watch.advance(part.order.len() as i64);
        Ok(part)
    };
    let below = later.par_iter().map(write).collect::<Result<Vec<Written>, BakeError>>()?;
    // A part's root has its place already; the others follow what is there, one number earlier.
    let node_count = first.nodes.len() + below.iter().map(|part| part.nodes.len() - 1).sum::<usize>();
    if node_count > NODES_MOST {
        return Err(BakeError::Nodes { count: node_count });
    }
    let order_count = first.order.len() + below.iter().map(|part| part.order.len()).sum::<usize>();
    let mut needs = vec![0; first.nodes.len()];
    later.iter().zip(&below).for_each(|(&(_, number), part)| needs[number as usize] = part.stack);
    let stack = stack_needs(&first.nodes, needs);
    let (mut nodes, mut order) = (vec![Node::default(); node_count], vec![0u32; order_count]);
    let (mut free_nodes, mut free_order) = (&mut nodes[first.nodes.len()..], &mut order[first.order.len()..]);
    let (mut next_node, mut next_place) = (first.nodes.len() as u32, first.order.len() as u32);
    let mut jobs = Vec::with_capacity(below.len());
    for (&(_, number), part) in later.iter().zip(below) {
        let shift = (next_node - 1, next_place);
        first.nodes[number as usize] = moved(&part.nodes[0], shift);
        let (node_slice, order_slice);
        (node_slice, free_nodes) = free_nodes.split_at_mut(part.nodes.len() - 1);
        (order_slice, free_order) = free_order.split_at_mut(part.order.len());
        (next_node, next_place) = (next_node + node_slice.len() as u32, next_place + order_slice.len() as u32);
        jobs.push((node_slice, order_slice, part, shift));
    }
    jobs.into_par_iter().for_each(|(nodes, order, part, shift)| {
        nodes.iter_mut().zip(&part.nodes[1..]).for_each(|(to, from)| *to = moved(from, shift));
        order.copy_from_slice(&part.order);
    });
    nodes[..first.nodes.len()].copy_from_slice(&first.nodes);
    order[..first.order.len()].copy_from_slice(&first.order);
    Ok((nodes, order, stack))
}

/// The same node where its hierarchy's nodes and its primitives begin later.
fn moved(node: &Node, (nodes, primitives): (u32, u32)) -> Node {
    Node { children: node.children + (nodes << 8), primitive_base: node.primitive_base + primitives, ..*node }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bake::bvh::{binary, item};
    use glam::Vec3;
    use obvhs::aabb::Aabb;
    use obvhs::bvh2::Bvh2;
    use obvhs::cwbvh::bvh2_to_cwbvh::bvh2_to_cwbvh;

    /// Small boxes anywhere in a cube, from a linear congruential generator.
    fn items(count: u32) -> Vec<Item> {
        let mut state = 1u32;
        let mut random = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 8) as f32 / 16_777_216.0
        };
        let mut corner = || Vec3::new(random(), random(), random());
        let mut make = |number| {
            let (low, size) = (corner(), corner());
            item(Bounds { min: low, max: low + size * 0.05 }, number)
        };
        (0..count).map(&mut make).collect()
    }

    /// The binary tree in one piece.
    fn joined(top: &Part, parts: &[Part], count: u32) -> Bvh2 {
        let mut nodes = top.nodes.clone();
        for index in 0..top.nodes.len() {
            if !top.nodes[index].is_leaf() {
                continue;
            }
            let base = nodes.len() as u32 - 1;
            let part = parts[top.nodes[index].first_index as usize].nodes.iter().map(|node| {
                let shift = if node.is_leaf() { 0 } else { base };
                Item::new(*node.aabb(), node.prim_count, node.first_index + shift)
            });
            let mut part = part;
            nodes[index] = part.next().expect("a part has a root");
            nodes.extend(part);
        }
        Bvh2 { nodes, primitive_indices: (0..count).collect(), ..Bvh2::default() }
    }

    /// A node of a wide tree without its boxes.
    struct Bare {
        /// Of the inner children, by slot.
        children: Vec<usize>,
        primitive_base: u32,
        inner_mask: u8,
        meta: [u8; 8],
    }

    /// Cost of a wide tree: what `Cost::forest` adds up. Every primitive must stand in one place.
    fn cost(nodes: &[Bare], order: &[u32], items: &[Item]) -> f64 {
        let mut sorted = order.to_vec();
        sorted.sort_unstable();
        assert_eq!(sorted, (0..items.len() as u32).collect::<Vec<_>>());
        let mut around = vec![Aabb::empty(); nodes.len()];
        let mut cost = 0.0;
        for (index, node) in nodes.iter().enumerate().rev() {
            let mut inner = node.children.iter();
            for slot in 0..8 {
                let meta = node.meta[slot];
                let (inside, weight) = if node.inner_mask & 1 << slot != 0 {
                    let &child = inner.next().expect("a child for every bit of the mask");
                    assert!(child > index, "children come after their parents");
                    (around[child], 1.0)
                } else if meta != 0 {
                    let first = node.primitive_base as usize + usize::from(meta & 31);
                    let count = (meta >> 5).count_ones() as usize;
                    let leaf = order[first..first + count].iter();
                    let whole = leaf.fold(Aabb::empty(), |whole, &p| whole.union(items[p as usize].aabb()));
                    (whole, f64::from(PRIMITIVE_COST) * count as f64)
                } else {
                    continue;
                };
                cost += weight * f64::from(inside.half_area());
                around[index] = around[index].union(&inside);
            }
        }
        cost + f64::from(around[0].half_area())
    }

    #[test]
    fn a_tree_in_parts_costs_what_the_builders_own_conversion_of_the_whole_costs() {
        let cases = [(1, 3, 9), (2, 3, 9), (3, 1, 9), (9, 3, 4), (100, 1, 200), (1000, 3, 70), (20_000, 3, 500)];
        for (count, most, part) in cases {
            let items = items(count);
            let (top, parts) = binary(items.clone(), most, part, &Watch::default()).expect("nobody aborts");
            assert!(parts.iter().all(|found| found.leaves().count() <= part), "{count} primitives");
            assert_eq!(parts.len() > 1, count as usize > part, "{count} primitives");
            let (nodes, order, _) = widen(&top, &parts, &Watch::default()).expect("nobody aborts");
            let bytes = |[low, high]: [u32; 2]| (u64::from(low) | u64::from(high) << 32).to_le_bytes();
            let ours: Vec<Bare> = nodes
                .iter()
                .map(|n| Bare {
                    children: n.inner_children(0).map(|(_, child)| child as usize).collect(),
                    primitive_base: n.primitive_base,
                    inner_mask: (n.exponents_imask >> 24) as u8,
                    meta: bytes(n.child_meta),
                })
                .collect();
            let theirs = bvh2_to_cwbvh(&joined(&top, &parts, count), most, true, false);
            let bare = |n: &obvhs::cwbvh::node::CwBvhNode| Bare {
                children: (n.child_base_idx as usize..).take(n.imask.count_ones() as usize).collect(),
                primitive_base: n.primitive_base_idx,
                inner_mask: n.imask,
                meta: n.child_meta,
            };
            let nodes_of_theirs: Vec<Bare> = theirs.nodes.iter().map(bare).collect();
            let (ours, theirs) =
                (cost(&ours, &order, &items), cost(&nodes_of_theirs, &theirs.primitive_indices, &items));
            // The same optimum; sums in single precision break ties differently.
            assert!((ours - theirs).abs() < 1e-4 * theirs, "{count} primitives, {most} a leaf: {ours} and {theirs}");
        }
    }
}
