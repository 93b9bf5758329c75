//! What a ray is inside of, where clear bodies overlap: there the medium of the highest rank is alone, the others are not.
//!
//! A medium's rank is 1 to 255, 0 stands for none (the outside). A list holds four ranks, one a byte, the highest first.
//! Source: Schmidt and Budge 2002, "Simple Nested Dielectrics in Ray Traced Images".

/// The highest rank of a list, 0 if it is empty.
#[inline]
pub fn interior_top(list: u32) -> u32 {
    list >> 24
}

/// The list of a ray that has entered a medium of rank `rank` (1 to 255). Of five the lowest is forgotten.
#[inline]
pub fn interior_add(list: u32, rank: u32) -> u32 {
    if rank > (list >> 24) {
        return (rank << 24) | (list >> 8);
    }
    if rank > ((list >> 16) & 255) {
        return (list & 0xff00_0000) | (rank << 16) | ((list >> 8) & 0xffff);
    }
    if rank > ((list >> 8) & 255) {
        return (list & 0xffff_0000) | (rank << 8) | ((list >> 8) & 255);
    }
    if rank > (list & 255) { (list & 0xffff_ff00) | rank } else { list }
}

/// The list of a ray that has left a medium of rank `rank` (1 to 255) once; the list itself if it was not inside.
#[inline]
pub fn interior_remove(list: u32, rank: u32) -> u32 {
    if rank == (list >> 24) {
        return list << 8;
    }
    if rank == ((list >> 16) & 255) {
        return (list & 0xff00_0000) | ((list & 0xffff) << 8);
    }
    if rank == ((list >> 8) & 255) {
        return (list & 0xffff_0000) | ((list & 255) << 8);
    }
    if rank == (list & 255) { list & 0xffff_ff00 } else { list }
}

/// The list of a ray that an interface to a medium of rank `rank` (0: no medium) has let in (`entering`) or out.
#[inline]
pub fn cross_interface(list: u32, rank: u32, entering: bool) -> u32 {
    if rank == 0 {
        return list;
    }
    if entering { interior_add(list, rank) } else { interior_remove(list, rank) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ranks(list: u32) -> [u32; 4] {
        [list >> 24, (list >> 16) & 255, (list >> 8) & 255, list & 255]
    }

    #[test]
    fn lists_are_sorted_and_remember_the_four_highest() {
        let mut list = 0;
        for (rank, wanted) in [
            (7, [7, 0, 0, 0]),
            (9, [9, 7, 0, 0]),
            (3, [9, 7, 3, 0]),
            (8, [9, 8, 7, 3]),
            (8, [9, 8, 8, 7]),
            (255, [255, 9, 8, 8]),
            (1, [255, 9, 8, 8]),
        ] {
            list = interior_add(list, rank);
            assert_eq!(ranks(list), wanted, "after {rank}");
        }
        assert_eq!(interior_top(list), 255);
    }

    #[test]
    fn leaving_undoes_entering_in_any_order() {
        let all = [5, 200, 31, 32];
        let full = all.into_iter().fold(0, interior_add);
        for (first, second) in [(0, 1), (1, 3), (2, 0), (3, 2)] {
            let left = interior_remove(interior_remove(full, all[first]), all[second]);
            let rest = (0..4).filter(|i| *i != first && *i != second).fold(0, |list, i| interior_add(list, all[i]));
            assert_eq!(left, rest, "without {} and {}", all[first], all[second]);
        }
        assert_eq!(interior_remove(full, 6), full, "never entered");
        let twice = interior_add(interior_add(0, 4), 4);
        assert_eq!(interior_remove(twice, 4), interior_add(0, 4), "entered twice, left once");
        assert_eq!((interior_remove(0, 4), interior_top(0)), (0, 0));
    }
}
