//! Large sets of boxes cut into parts that fit a processor's cache, top down, by the surface area heuristic over bins.
//!
//! Source: Wald 2007, "On fast Construction of SAH-based Bounding Volume Hierarchies", section 3. The parts are built by
//! themselves, side by side; how they are cut depends on the boxes only, never on the number of threads.

use super::bvh::Item;
use glam::Vec3A;
use obvhs::aabb::Aabb;
use rayon::prelude::*;

/// Bins an axis.
const BINS: usize = 32;
/// Cuts below each other; what is deeper is halved by number, so that no set of boxes takes long.
const DEPTH_MAX: u32 = 40;
/// Sets with fewer boxes are looked through by one thread, larger ones in pieces of as many.
const PIECE: usize = 1 << 16;

/// Boxes cut in two again and again: places in the sorted array.
#[derive(Debug)]
pub enum Cut {
    Part(std::ops::Range<usize>),
    Two(Box<[Cut; 2]>),
}

/// Sorts `items` into parts of `part` at most (1 at least). `first`: the place of `items[0]` in the whole array; `depth`: cuts
/// above.
pub fn cut(items: &mut [Item], part: usize, first: usize, depth: u32) -> Cut {
    if items.len() <= part {
        return Cut::Part(first..first + items.len());
    }
    let middle = divide(items, depth);
    let (low, high) = items.split_at_mut(middle);
    let (low, high) = rayon::join(|| cut(low, part, first, depth + 1), || cut(high, part, first + middle, depth + 1));
    Cut::Two(Box::new([low, high]))
}

/// Twice the centre.
fn centre(item: &Item) -> Vec3A {
    item.aabb().min + item.aabb().max
}

/// What falls into one bin.
#[derive(Clone, Copy)]
struct Bin {
    bounds: Aabb,
    count: usize,
}

impl Bin {
    const EMPTY: Self = Self { bounds: Aabb::INVALID, count: 0 };

    fn with(self, other: Self) -> Self {
        Self { bounds: self.bounds.union(&other.bounds), count: self.count + other.count }
    }

    /// Expected cost of what is in it, but for the area of the whole.
    fn cost(&self) -> f32 {
        if self.count == 0 { 0.0 } else { self.bounds.half_area() * self.count as f32 }
    }
}

/// Where centres lie, cut into bins.
#[derive(Clone, Copy)]
struct Grid {
    low: Vec3A,
    scale: Vec3A,
}

impl Grid {
    fn of(centres: &Aabb) -> Self {
        let extent = centres.max - centres.min;
        // What lies in a plane falls into its first bin.
        let one = |x: f32| if x > 0.0 && (BINS as f32 / x).is_finite() { BINS as f32 / x } else { 0.0 };
        // Items keep numbers in the fourth lane, which are subnormal as floats and slow to multiply: less 1 they are not.
        let low = Vec3A::from_vec4(centres.min.extend(1.0));
        Self { low, scale: Vec3A::new(one(extent.x), one(extent.y), one(extent.z)) }
    }

    /// The bin on an axis, of where a centre lies in the grid.
    fn bin(x: f32) -> usize {
        // Through a signed number: a single instruction.
        (x as i32 as usize).min(BINS - 1)
    }

    fn place(&self, item: &Item) -> Vec3A {
        (centre(item) - self.low) * self.scale
    }
}

type Bins = [[Bin; BINS]; 3];

/// `one` of every piece of `items`, put together by `join`, whose result must not depend on the order.
fn over<T: Send>(items: &[Item], one: impl Fn(&[Item]) -> T + Sync, join: impl Fn(T, T) -> T + Sync + Send) -> T {
    if items.len() < 2 * PIECE {
        return one(items);
    }
    items.par_chunks(PIECE).map(&one).reduce_with(join).unwrap_or_else(|| one(&[]))
}

fn binned(items: &[Item], grid: &Grid) -> Box<Bins> {
    let one = |items: &[Item]| {
        let mut bins = Box::new([[Bin::EMPTY; BINS]; 3]);
        for item in items {
            let (place, around) = (grid.place(item), item.aabb());
            for (bins, x) in bins.iter_mut().zip([place.x, place.y, place.z]) {
                let bin = &mut bins[Grid::bin(x)];
                *bin = Bin { bounds: bin.bounds.union(around), count: bin.count + 1 };
            }
        }
        bins
    };
    let join = |mut a: Box<Bins>, b: Box<Bins>| {
        for (a, b) in a.iter_mut().flatten().zip(b.iter().flatten()) {
            *a = a.with(*b);
        }
        a
    };
    over(items, one, join)
}

/// The axis and the first bin of the upper side of the cheapest cut; none if all fall into one bin.
fn best(bins: &Bins) -> Option<(usize, usize)> {
    let mut best = (f32::INFINITY, None);
    for (axis, bins) in bins.iter().enumerate() {
        let mut above = [Bin::EMPTY; BINS + 1];
        for i in (0..BINS).rev() {
            above[i] = above[i + 1].with(bins[i]);
        }
        let mut below = Bin::EMPTY;
        for i in 1..BINS {
            below = below.with(bins[i - 1]);
            let cost = below.cost() + above[i].cost();
            if below.count > 0 && above[i].count > 0 && cost < best.0 {
                best = (cost, Some((axis, i)));
            }
        }
    }
    best.1
}

/// Sorts `items` into two sets, neither empty, and returns where the second begins.
fn divide(items: &mut [Item], depth: u32) -> usize {
    let around =
        |items: &[Item]| items.iter().fold(Aabb::INVALID, |all, item| all.union(&Aabb::from_point(centre(item))));
    let centres = over(items, around, |a, b| a.union(&b));
    if depth < DEPTH_MAX {
        let grid = Grid::of(&centres);
        if let Some((axis, first)) = best(&binned(items, &grid)) {
            return partition(items, |item| Grid::bin(grid.place(item)[axis]) < first);
        }
    }
    let axis = centres.largest_axis();
    let middle = items.len() / 2;
    let key = |item: &Item| (centre(item)[axis], item.first_index);
    items.select_nth_unstable_by(middle, |a, b| {
        let ((a, first), (b, second)) = (key(a), key(b));
        a.total_cmp(&b).then(first.cmp(&second))
    });
    middle
}

/// Those that are `low` come first; returns their number.
fn partition(items: &mut [Item], low: impl Fn(&Item) -> bool) -> usize {
    let (mut i, mut j) = (0, items.len());
    loop {
        while i < j && low(&items[i]) {
            i += 1;
        }
        while i < j && !low(&items[j - 1]) {
            j -= 1;
        }
        if i >= j {
            return i;
        }
        items.swap(i, j - 1);
        i += 1;
        j -= 1;
    }
}
