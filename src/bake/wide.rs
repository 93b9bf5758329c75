//! From binary trees to eight-wide ones, subtrees side by side.
//!
//! Source: Ylitie, Karras and Laine 2017, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs", section
//! 3: C(n, i), the least surface area cost of what lies below node n as a forest of at most i trees, from the leaves up; then
//! the wide nodes from the root down. Both run on all threads: the tree is cut below a few hundred nodes, what lies below
//! the cut is solved and written by itself, and the parts are joined. The cut does not change the result.

use super::bvh::{TreeNode, octant_slots};
use glam::{DVec3, Vec3};
use obvhs::bvh2::Bvh2;
use rayon::prelude::*;

/// Cost of a primitive test over that of a node visit (section 3.2 of the paper).
const PRIMITIVE_COST: f32 = 0.3;
/// Parts that the tree is cut into, at least, if it is large enough: many more than threads, since parts differ in size.
const PARTS: usize = 512;
/// Trees with fewer nodes are not cut.
const CUT_LEAST: usize = 4096;

/// What is known of one node of the binary tree; children are numbers in the same array.
#[derive(Clone, Copy, Debug, Default)]
struct Solved {
    /// Node of the binary tree.
    id: u32,
    /// `NONE`, twice, for a primitive.
    left: u32,
    right: u32,
    /// Primitives below; more than a leaf may hold count as one more than that.
    primitives: u32,
    /// C(n, i) for i from 1 to 7.
    cost: [f32; 7],
    /// How many trees of a forest of i the left child gets, i from 2 to 8; 0: the best forest of i - 1 is as good.
    split: [u8; 7],
    /// Whether all of it is one leaf of a wide node.
    is_leaf: bool,
}

const NONE: u32 = u32::MAX;

fn half_area(bvh: &Bvh2, id: u32) -> f32 {
    bvh.nodes[id as usize].aabb().half_area()
}

impl Solved {
    fn of(bvh: &Bvh2, id: u32, children: Option<(u32, &Solved, u32, &Solved)>, most: u32) -> Self {
        let area = half_area(bvh, id);
        let Some((left, l, right, r)) = children else {
            let cost = [area * PRIMITIVE_COST; 7];
            return Self { id, left: NONE, right: NONE, primitives: 1, cost, split: [0; 7], is_leaf: true };
        };
        let primitives = (l.primitives + r.primitives).min(most + 1);
        let mut solved = Self { id, left, right, primitives, ..Self::default() };
        // The best forest of `trees` that has a tree of each child.
        let distribute = |trees: usize| {
            (1..trees)
                .filter(|k| *k <= 7 && trees - k <= 7)
                .map(|k| (l.cost[k - 1] + r.cost[trees - k - 1], k as u8))
                .reduce(|best, other| if other.0 < best.0 { other } else { best })
                .unwrap_or((f32::INFINITY, 1))
        };
        let (inside, split) = distribute(8);
        solved.split[6] = split;
        let node = inside + area;
        let leaf = if primitives <= most { area * PRIMITIVE_COST * primitives as f32 } else { f32::INFINITY };
        solved.is_leaf = leaf < node;
        solved.cost[0] = leaf.min(node);
        for trees in 2..=7 {
            let (cost, split) = distribute(trees);
            let before = solved.cost[trees - 2];
            (solved.cost[trees - 1], solved.split[trees - 2]) = if cost < before { (cost, split) } else { (before, 0) };
        }
        solved
    }
}

/// Where the tree is cut: nodes, sorted, and the solution below each.
type Cut<'a> = (&'a [u32], &'a [Vec<Solved>]);

/// Solves what lies below `root`: parents first, `root` at 0. A node of the cut is not followed; it has its solution.
fn solve(bvh: &Bvh2, root: u32, (cut, below): Cut, most: u32) -> Vec<Solved> {
    let fresh = |id| Solved { id, left: NONE, right: NONE, ..Solved::default() };
    let mut solved = vec![fresh(root)];
    // Depth first, so that neighbours in space are neighbours here.
    let mut waiting = vec![0u32];
    while let Some(index) = waiting.pop() {
        let id = solved[index as usize].id;
        let node = &bvh.nodes[id as usize];
        if !node.is_leaf() && cut.binary_search(&id).is_err() {
            let left = solved.len() as u32;
            solved.extend([fresh(node.first_index), fresh(node.first_index + 1)]);
            waiting.extend([left + 1, left]);
            (solved[index as usize].left, solved[index as usize].right) = (left, left + 1);
        }
    }
    for index in (0..solved.len()).rev() {
        let Solved { id, left, right, .. } = solved[index];
        solved[index] = match cut.binary_search(&id) {
            Ok(part) => Solved { left: NONE, right: NONE, ..below[part][0] },
            Err(_) if left == NONE => Solved::of(bvh, id, None, most),
            Err(_) => Solved::of(bvh, id, Some((left, &solved[left as usize], right, &solved[right as usize])), most),
        };
    }
    solved
}

/// A node of the solution: part and number in it. Part `parts.len() - 1` is the top.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Place {
    part: u32,
    index: u32,
}

/// The solution of the whole tree: what lies below the cut, in its order, then the top.
struct Solution<'a> {
    bvh: &'a Bvh2,
    cut: Vec<u32>,
    parts: Vec<Vec<Solved>>,
}

/// Wide nodes written so far, and their primitives.
#[derive(Default)]
struct Written {
    nodes: Vec<TreeNode>,
    order: Vec<u32>,
}

impl Solution<'_> {
    fn get(&self, place: Place) -> &Solved {
        &self.parts[place.part as usize][place.index as usize]
    }

    /// The same node in the part that knows its children.
    fn resolve(&self, place: Place) -> Place {
        let solved = self.get(place);
        if place.part as usize + 1 < self.parts.len() || solved.left != NONE {
            return place;
        }
        match self.cut.binary_search(&solved.id) {
            Ok(part) => Place { part: part as u32, index: 0 },
            Err(_) => place,
        }
    }

    fn children(&self, place: Place) -> Option<(Place, Place)> {
        let Solved { left, right, .. } = *self.get(place);
        let of = |index| self.resolve(Place { part: place.part, index });
        (left != NONE).then(|| (of(left), of(right)))
    }

    /// The roots of the best forest of at most `trees` trees below `place`.
    fn forest(&self, place: Place, trees: usize, roots: &mut Vec<Place>) {
        let split = if trees > 1 { usize::from(self.get(place).split[trees - 2]) } else { 0 };
        match self.children(place) {
            Some((left, right)) if split > 0 => {
                self.forest(left, split, roots);
                self.forest(right, trees - split, roots);
            }
            Some(_) if trees > 1 => self.forest(place, trees - 1, roots),
            _ => roots.push(place),
        }
    }

    fn centre(&self, place: Place) -> DVec3 {
        let aabb = self.bvh.nodes[self.get(place).id as usize].aabb();
        Vec3::from(aabb.min).as_dvec3() + Vec3::from(aabb.max).as_dvec3()
    }

    /// Appends the primitives below `place`.
    fn primitives(&self, place: Place, order: &mut Vec<u32>) {
        match self.children(place) {
            Some((left, right)) => {
                self.primitives(left, order);
                self.primitives(right, order);
            }
            None => {
                let node = &self.bvh.nodes[self.get(place).id as usize];
                order.push(self.bvh.primitive_indices[node.first_index as usize]);
            }
        }
    }

    /// Writes the wide node of `root` and all below it, but for those that `put_off` wants: of these the node's place and
    /// its number are returned, and nothing is written there.
    fn write(&self, root: Place, put_off: impl Fn(Place) -> bool) -> (Written, Vec<(Place, u32)>) {
        let mut out = Written { nodes: vec![TreeNode::default()], order: Vec::new() };
        let (mut waiting, mut later) = (vec![(root, 0u32)], Vec::new());
        let mut roots = Vec::with_capacity(8);
        while let Some((place, number)) = waiting.pop() {
            roots.clear();
            match self.children(place) {
                Some(_) => self.forest(place, 8, &mut roots),
                None => roots.push(place),
            }
            let centres: Vec<DVec3> = roots.iter().map(|&root| self.centre(root)).collect();
            let slots = octant_slots(&centres, self.centre(place));
            let mut node = TreeNode {
                child_base: out.nodes.len() as u32,
                primitive_base: out.order.len() as u32,
                ..TreeNode::default()
            };
            for slot in 0..8 {
                let Some(child) = slots[..roots.len()].iter().position(|&s| s == slot) else { continue };
                let child = roots[child];
                if self.get(child).is_leaf {
                    let offset = out.order.len() as u32 - node.primitive_base;
                    self.primitives(child, &mut out.order);
                    let count = out.order.len() as u32 - node.primitive_base - offset;
                    node.meta[slot] = ((1u8 << count) - 1) << 5 | offset as u8;
                    continue;
                }
                node.inner_mask |= 1 << slot;
                node.meta[slot] = 0b0010_0000 | (24 + slot as u8);
                let number = out.nodes.len() as u32;
                out.nodes.push(TreeNode::default());
                if put_off(child) { later.push((child, number)) } else { waiting.push((child, number)) }
            }
            out.nodes[number as usize] = node;
        }
        (out, later)
    }
}

/// The eight-wide tree of least cost over a binary one: its nodes, children after parents, and the order of primitives.
/// `bvh` has one primitive a leaf and one at least; `most`: primitives in a leaf of the result, 1 to 3.
pub fn widen(bvh: &Bvh2, most: u32) -> (Vec<TreeNode>, Vec<u32>) {
    let cut = cut(bvh);
    let mut parts: Vec<Vec<Solved>> = cut.par_iter().map(|&root| solve(bvh, root, (&[], &[]), most)).collect();
    parts.push(solve(bvh, 0, (&cut, &parts), most));
    let solution = Solution { bvh, cut, parts };
    let last = solution.parts.len() as u32 - 1;
    let root = solution.resolve(Place { part: last, index: 0 });
    let (mut whole, later) = solution.write(root, |place| place.part != last);
    let below: Vec<Written> = later.par_iter().map(|&(place, _)| solution.write(place, |_| false).0).collect();
    for ((_, number), part) in later.into_iter().zip(below) {
        // A part's root has its place already; the others follow what is there, one number earlier.
        let (nodes, order) = (whole.nodes.len() as u32, whole.order.len() as u32);
        let moved = |node: &TreeNode| TreeNode {
            child_base: node.child_base + nodes - 1,
            primitive_base: node.primitive_base + order,
            ..*node
        };
        let mut moved = part.nodes.iter().map(moved);
        whole.nodes[number as usize] = moved.next().expect("a part has a root");
        whole.nodes.extend(moved);
        whole.order.extend(part.order);
    }
    (whole.nodes, whole.order)
}

/// Nodes, sorted, of which each path from the root to a leaf has one at most: the tree breadth first until there are enough.
fn cut(bvh: &Bvh2) -> Vec<u32> {
    if bvh.nodes.len() < CUT_LEAST {
        return Vec::new();
    }
    let mut front = vec![0u32];
    while front.len() < PARTS {
        let inner = |id: &u32| !bvh.nodes[*id as usize].is_leaf();
        let next: Vec<u32> = front
            .iter()
            .filter(|id| inner(id))
            .flat_map(|&id| [bvh.nodes[id as usize].first_index, bvh.nodes[id as usize].first_index + 1])
            .collect();
        if next.is_empty() {
            break;
        }
        front = next;
    }
    // A primitive is no part.
    front.retain(|&id| !bvh.nodes[id as usize].is_leaf());
    front.sort_unstable();
    front
}

#[cfg(test)]
mod tests {
    use super::*;
    use obvhs::aabb::Aabb;
    use obvhs::cwbvh::bvh2_to_cwbvh::bvh2_to_cwbvh;
    use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};

    /// Small boxes anywhere in a cube, from a linear congruential generator.
    fn boxes(count: u32) -> Vec<Aabb> {
        let mut state = 1u32;
        let mut random = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 8) as f32 / 16_777_216.0
        };
        let mut corner = || Vec3::new(random(), random(), random());
        let mut make = || {
            let (low, size) = (corner(), corner());
            Aabb::new(low.into(), (low + size * 0.05).into())
        };
        (0..count).map(|_| make()).collect()
    }

    fn binary(boxes: &[Aabb]) -> Bvh2 {
        let numbers = (0..boxes.len() as u32).collect();
        PlocBuilder::with_capacity(boxes.len()).build(PlocSearchDistance::Low, boxes, numbers, SortPrecision::U64, 0)
    }

    /// Cost of a wide tree: what `Solved::cost` adds up. Every primitive must stand in one place.
    fn cost(nodes: &[TreeNode], order: &[u32], boxes: &[Aabb]) -> f64 {
        let mut sorted = order.to_vec();
        sorted.sort_unstable();
        assert_eq!(sorted, (0..boxes.len() as u32).collect::<Vec<_>>());
        let mut around = vec![Aabb::empty(); nodes.len()];
        let mut cost = 0.0;
        for (index, node) in nodes.iter().enumerate().rev() {
            let mut inner = node.child_base as usize;
            for slot in 0..8 {
                let meta = node.meta[slot];
                let (inside, weight) = if node.inner_mask & 1 << slot != 0 {
                    assert!(inner > index, "children come after their parents");
                    inner += 1;
                    (around[inner - 1], 1.0)
                } else if meta != 0 {
                    let first = node.primitive_base as usize + usize::from(meta & 31);
                    let count = (meta >> 5).count_ones() as usize;
                    let leaf = order[first..first + count].iter();
                    let whole = leaf.fold(Aabb::empty(), |whole, &p| whole.union(&boxes[p as usize]));
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
    fn the_cut_tree_costs_what_the_builders_own_conversion_costs() {
        for (count, most) in [(1, 3), (2, 3), (3, 1), (9, 3), (100, 1), (1000, 3), (20_000, 3), (20_000, 1)] {
            let boxes = boxes(count);
            let bvh = binary(&boxes);
            assert_eq!(cut(&bvh).is_empty(), count < 3000, "{count} primitives");
            let (nodes, order) = widen(&bvh, most);
            let theirs = bvh2_to_cwbvh(&bvh, most, true, false);
            let node = |n: &obvhs::cwbvh::node::CwBvhNode| TreeNode {
                child_base: n.child_base_idx,
                primitive_base: n.primitive_base_idx,
                inner_mask: n.imask,
                meta: n.child_meta,
            };
            let nodes_of_theirs: Vec<TreeNode> = theirs.nodes.iter().map(node).collect();
            let (ours, theirs) =
                (cost(&nodes, &order, &boxes), cost(&nodes_of_theirs, &theirs.primitive_indices, &boxes));
            // The same optimum; sums in single precision break ties differently.
            assert!((ours - theirs).abs() < 1e-4 * theirs, "{count} primitives, {most} a leaf: {ours} and {theirs}");
        }
    }
}
