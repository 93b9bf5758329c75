//! Where the nodes of a hierarchy stand.
//!
//! The inner child in slot s stands s places after the first, so that a walk finds it without knowing its siblings. Slots
//! without an inner child leave holes, and the children of other nodes go into those. About a tenth stay empty in meshes
//! (kitchen 11 %, terrain 8 %, hairball 10 %), more with slots at random.

/// Nodes of a hierarchy at most: what the 24 bits of `Node::children` tell apart.
pub const NODES_MOST: usize = (1 << 24) - 8;
/// How far before the last node holes are still filled: what lies together in the tree should in memory, too.
const WINDOW: usize = 64;

/// The places of a hierarchy's nodes; its root has the first.
pub struct Places {
    taken: Vec<bool>,
    /// No place before this one is given away any more.
    first_free: usize,
}

impl Places {
    pub fn new() -> Self {
        Self { taken: vec![true], first_free: 1 }
    }

    /// Places up to the last one taken.
    pub fn len(&self) -> usize {
        self.taken.len()
    }

    /// Takes places after `parent` for the inner children in `slots` (a bit each). Returns `Node::children`, for a root at 0.
    pub fn take(&mut self, parent: u32, slots: u8) -> u32 {
        if slots == 0 {
            return 0;
        }
        let (lowest, highest) = (slots.trailing_zeros() as usize, 7 - slots.leading_zeros() as usize);
        let inner = || (lowest..=highest).filter(|slot| slots >> slot & 1 != 0);
        // The place of the lowest child. Behind the last place taken all are free.
        let mut at = self.first_free.max(parent as usize + 1);
        while inner().any(|slot| self.taken.get(at + slot - lowest) == Some(&true)) {
            at += 1;
        }
        self.taken.resize(self.taken.len().max(at + highest - lowest + 1), false);
        inner().for_each(|slot| self.taken[at + slot - lowest] = true);
        self.first_free = self.first_free.max(self.taken.len().saturating_sub(WINDOW));
        while self.taken.get(self.first_free) == Some(&true) {
            self.first_free += 1;
        }
        ((at + 7 - lowest) as u32) << 8
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layout::Node;

    #[test]
    fn nodes_have_places_of_their_own_after_their_parents_and_holes_are_filled() {
        let (mut places, mut random) = (Places::new(), 1u32);
        let (mut waiting, mut taken) = (vec![(0u32, 0)], vec![0u32]);
        while let Some((parent, depth)) = waiting.pop() {
            random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let slots = if depth < 7 { (random >> 24) as u8 } else { 0 };
            let node = Node {
                exponents_imask: u32::from(slots) << 24,
                children: places.take(parent, slots),
                ..Node::default()
            };
            let children: Vec<u32> = node.inner_children(0).map(|(_, place)| place).collect();
            assert_eq!(children.len(), slots.count_ones() as usize);
            assert!(children.iter().all(|&place| place > parent), "{children:?} of {parent}");
            taken.extend(&children);
            waiting.extend(children.into_iter().map(|place| (place, depth + 1)));
        }
        let count = taken.len();
        assert!(count > 10_000);
        // With nothing in the holes it would be 7 places for 4 nodes.
        assert!(4 * places.len() < 5 * count, "{count} nodes in {} places", places.len());
        taken.sort_unstable();
        taken.dedup();
        assert_eq!(taken.len(), count);
        assert_eq!(taken.last().map(|&last| last as usize + 1), Some(places.len()));
    }
}
