//! Binary trees from the leaves up: neighbours along a curve merge, those first that make the smallest boxes.
//!
//! Source: Meister and Bittner 2018, "Parallel Locally-Ordered Clustering for Bounding Volume Hierarchy Construction". obvhs
//! has it, too, but takes a pass over all for every merge where boxes are equal or their distances grow along the curve.
//! Here neither takes long: of pairs that cost the same those of `index ^ 1` go first, so that all of them merge in one pass,
//! and a pass in which few merge is followed by one that merges all.

use super::bvh::Item;
use glam::DVec3;
use obvhs::aabb::Aabb;
use obvhs::bvh2::{Bvh2, DEFAULT_MAX_STACK_DEPTH};
use obvhs::ploc::morton::morton_encode_u64_unorm;

/// How far a partner of a cluster is looked for: 1 in the first pass, which has the most clusters, then this. obvhs's values
/// for medium quality (14, and 1 in the first three passes) take longer and gain nothing: costs are 0 to 1 % higher (kitchen,
/// hairball and terrain).
const SEARCH_DISTANCE: usize = 6;
/// A pass in which fewer than one in as many clusters find a partner is slow. Scenes are far from it: one in three do.
const SLOW: usize = 32;

/// A pair of clusters: its cost above, the exclusive or of the two indices below. Both find the same number, so that the
/// least of all pairs of both is a pair that both want.
type Pair = u64;

/// Makes trees; keeps its memory for the next one.
#[derive(Default)]
pub struct Ploc {
    codes: Vec<(u64, u32)>,
    clusters: Vec<Item>,
    merged: Vec<Item>,
    wanted: Vec<Pair>,
}

impl Ploc {
    /// The binary tree over `items`, one at least: the root at 0, siblings side by side. Takes time like n log n at most.
    pub fn build(&mut self, items: &[Item]) -> Bvh2 {
        self.sort(items);
        let mut nodes = vec![Item::default(); 2 * items.len() - 1];
        let (mut free, mut passes) = (nodes.len(), 0);
        while self.clusters.len() > 1 {
            let distance = if passes == 0 { 1 } else { SEARCH_DISTANCE };
            self.choose(distance);
            if self.pass(&mut nodes, &mut free) * SLOW < self.wanted.len() && self.clusters.len() > 1 {
                self.choose_neighbours();
                self.pass(&mut nodes, &mut free);
                passes += 1;
            }
            passes += 1;
        }
        nodes[0] = self.clusters[0];
        // A pass makes the tree deeper by one at most.
        let max_depth = DEFAULT_MAX_STACK_DEPTH.max(passes + 1);
        Bvh2 { nodes, max_depth, children_are_ordered_after_parents: true, ..Bvh2::default() }
    }

    /// Clusters of one item each, along a Morton curve through their centres.
    fn sort(&mut self, items: &[Item]) {
        let around = items.iter().fold(Aabb::INVALID, |all, item| all.union(item.aabb()));
        let corner = around.min.as_dvec3();
        let extent = around.max.as_dvec3() - corner;
        let scale = DVec3::select(extent.cmpgt(DVec3::ZERO), extent.recip(), DVec3::ZERO);
        let code = |item: &Item| {
            let centre = (item.min.as_dvec3() + item.max.as_dvec3()) * 0.5;
            morton_encode_u64_unorm((centre - corner) * scale)
        };
        self.codes.clear();
        self.codes.extend(items.iter().zip(0u32..).map(|(item, index)| (code(item), index)));
        self.codes.sort_unstable();
        self.clusters.clear();
        self.clusters.extend(self.codes.iter().map(|&(_, index)| items[index as usize]));
    }

    /// Lets each cluster want the best partner among those before and after it, up to `distance` away.
    fn choose(&mut self, distance: usize) {
        let clusters = &self.clusters[..];
        self.wanted.clear();
        self.wanted.resize(clusters.len(), Pair::MAX);
        for (index, cluster) in clusters.iter().enumerate() {
            let mut best = self.wanted[index];
            let after = index + 1..clusters.len().min(index + 1 + distance);
            for (other, wanted) in after.clone().zip(&mut self.wanted[after]) {
                let cost = cluster.aabb().union(clusters[other].aabb()).half_area();
                // Bits of floats that are not negative are ordered as they are.
                let pair = u64::from(cost.to_bits()) << 32 | (index ^ other) as u64;
                best = best.min(pair);
                *wanted = (*wanted).min(pair);
            }
            self.wanted[index] = best;
        }
    }

    /// Lets each cluster want the one beside it.
    fn choose_neighbours(&mut self) {
        self.wanted.clear();
        self.wanted.resize(self.clusters.len(), 1);
    }

    /// Merges those that want each other, into `nodes` from `free` backwards; returns their number.
    fn pass(&mut self, nodes: &mut [Item], free: &mut usize) -> usize {
        self.merged.clear();
        for (index, &pair) in self.wanted.iter().enumerate() {
            let other = index ^ (pair as u32 as usize);
            let (first, agree) = (self.clusters[index], self.wanted.get(other) == Some(&pair));
            match self.clusters.get(other) {
                // Done with the first of the two.
                Some(_) if agree && other < index => {}
                Some(&second) if agree => {
                    *free -= 2;
                    nodes[*free..*free + 2].copy_from_slice(&[first, second]);
                    self.merged.push(Item::new(first.aabb().union(second.aabb()), 0, *free as u32));
                }
                _ => self.merged.push(first),
            }
        }
        std::mem::swap(&mut self.clusters, &mut self.merged);
        self.merged.len() - self.clusters.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bake::bvh::{Bounds, item};
    use glam::Vec3;

    /// `Bvh2::max_depth`, which grows with the passes, and the depth of the tree of `boxes`.
    fn depth(boxes: impl Iterator<Item = Bounds>) -> (usize, usize) {
        let items: Vec<Item> = boxes.zip(0..).map(|(bounds, number)| item(bounds, number)).collect();
        let tree = Ploc::default().build(&items);
        let (mut deepest, mut waiting, mut found) = (0, vec![(0u32, 1)], vec![false; items.len()]);
        while let Some((index, depth)) = waiting.pop() {
            let node = tree.nodes[index as usize];
            deepest = deepest.max(depth);
            match node.is_leaf() {
                true => assert!(!std::mem::replace(&mut found[node.first_index as usize], true)),
                false => waiting.extend([(node.first_index, depth + 1), (node.first_index + 1, depth + 1)]),
            }
        }
        assert!(found.iter().all(|&found| found), "an item is lost");
        (tree.max_depth, deepest)
    }

    fn at(x: f32, size: f32) -> Bounds {
        Bounds { min: Vec3::X * x, max: Vec3::X * x + Vec3::splat(size) }
    }

    #[test]
    fn equal_boxes_are_halved_in_each_pass() {
        for count in [1u32, 2, 3, 1000, 1 << 14] {
            let levels = count.next_power_of_two().trailing_zeros() as usize + 1;
            assert_eq!(depth((0..count).map(|_| at(1.0, 1.0))), (DEFAULT_MAX_STACK_DEPTH, levels), "{count}");
        }
    }

    #[test]
    fn boxes_whose_distances_or_sizes_grow_take_few_passes() {
        const COUNT: u32 = 1 << 14;
        let numbers = || (0..COUNT).map(|i| i as f32);
        let mut x = 0.0;
        let mut step = |i: f32| {
            x += 1.0 + i * 0.001;
            at(x, 0.1)
        };
        let passes = |boxes: &mut dyn Iterator<Item = Bounds>| depth(boxes).0;
        assert_eq!(passes(&mut numbers().map(&mut step)), DEFAULT_MAX_STACK_DEPTH, "distances grow");
        let nested = &mut numbers().map(|i| at(-i, 2.0 * i + 1.0));
        assert_eq!(passes(nested), DEFAULT_MAX_STACK_DEPTH, "one within the other");
        assert_eq!(passes(&mut numbers().map(|i| at(0.0, 1.0 + i))), DEFAULT_MAX_STACK_DEPTH, "from one corner");
    }
}
