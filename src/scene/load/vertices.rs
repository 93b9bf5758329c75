//! Corners become vertices: corners that agree in everything share one.

use std::collections::HashMap;

/// "None" among indices.
pub const NONE: u32 = u32::MAX;

/// Vertices of one position that are looked through one by one. Where more share it they are found by their hash, so that
/// a million faces around one point take no longer than any others.
const CHAIN_MAX: usize = 32;

/// The vertices so far. A key is the index of a position and N - 1 further words that tell vertices there apart; NONE is
/// the absence of a word.
pub struct Vertices<const N: usize> {
    /// Words of the keys by vertex. A list ends with the last vertex that has its word.
    words: [Vec<u32>; N],
    /// The latest vertex of each position.
    latest: Vec<u32>,
    /// The one before, by vertex; ends like the lists above.
    earlier: Vec<u32>,
    crowded: HashMap<[u32; N], u32>,
}

impl<const N: usize> Vertices<N> {
    pub fn new() -> Self {
        Self { words: [const { Vec::new() }; N], latest: Vec::new(), earlier: Vec::new(), crowded: HashMap::new() }
    }

    pub fn len(&self) -> usize {
        self.words[0].len()
    }

    /// The position of `vertex`.
    #[inline]
    pub fn position(&self, vertex: u32) -> usize {
        self.words[0][vertex as usize] as usize
    }

    /// The vertex of `key`, new if there is none; there are `positions` positions so far. None if 32 bits cannot count it.
    #[inline]
    pub fn find_or_add(&mut self, key: [u32; N], positions: usize) -> Option<u32> {
        let position = key[0] as usize;
        if self.latest.len() <= position {
            self.latest.resize(positions.max(position + 1), NONE);
        }
        let latest = self.latest[position];
        let (mut vertex, mut steps) = (latest, 0);
        while vertex != NONE {
            if (1..N).all(|k| at(&self.words[k], vertex) == key[k]) {
                return Some(vertex);
            }
            steps += 1;
            vertex = at(&self.earlier, vertex);
        }
        if steps >= CHAIN_MAX
            && let Some(vertex) = self.crowded.get(&key)
        {
            return Some(*vertex);
        }
        let vertex = u32::try_from(self.len()).ok().filter(|vertex| *vertex != NONE)?;
        for (list, word) in self.words.iter_mut().zip(key) {
            put(list, vertex, word);
        }
        if steps >= CHAIN_MAX {
            self.crowded.insert(key, vertex);
        } else {
            put(&mut self.earlier, vertex, latest);
            self.latest[position] = vertex;
        }
        Some(vertex)
    }

    /// The words of all keys, each list as long as there are vertices, or empty where no vertex has that word.
    pub fn into_words(self) -> [Vec<u32>; N] {
        let count = self.len();
        self.words.map(|mut list| {
            if !list.is_empty() {
                list.resize(count, NONE);
            }
            list
        })
    }
}

#[inline]
fn at(list: &[u32], vertex: u32) -> u32 {
    list.get(vertex as usize).copied().unwrap_or(NONE)
}

#[inline]
fn put(list: &mut Vec<u32>, vertex: u32, word: u32) {
    if word != NONE {
        list.resize(vertex as usize, NONE);
        list.push(word);
    }
}

/// Whether index i is i.
pub fn are_in_order(indices: &[u32]) -> bool {
    indices.iter().zip(0..).all(|(index, at)| *index == at)
}

/// What each vertex has of `source`, by its indices; `default` where that is NONE. Empty if no vertex has any.
pub fn gather<T: Copy>(indices: &[u32], source: Vec<T>, default: T) -> Vec<T> {
    if indices.len() == source.len() && are_in_order(indices) {
        return source;
    }
    indices.iter().map(|index| if *index == NONE { default } else { source[*index as usize] }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_keys_are_one_vertex_however_many_share_a_position() {
        let mut vertices = Vertices::<3>::new();
        let keys: Vec<[u32; 3]> = (0..300).map(|i| [i % 3, i / 3, [NONE, i][i as usize % 2]]).collect();
        let first: Vec<u32> = keys.iter().map(|key| vertices.find_or_add(*key, 3).unwrap()).collect();
        assert_eq!(first, (0..300).collect::<Vec<u32>>());
        let again: Vec<u32> = keys.iter().map(|key| vertices.find_or_add(*key, 3).unwrap()).collect();
        assert_eq!(first, again);
        let words = vertices.into_words();
        assert!(keys.iter().enumerate().all(|(i, key)| [words[0][i], words[1][i], words[2][i]] == *key));
    }

    #[test]
    fn words_that_no_vertex_has_take_no_room() {
        let mut vertices = Vertices::<3>::new();
        (0..5).for_each(|i| assert_eq!(vertices.find_or_add([i, NONE, NONE], 5), Some(i)));
        assert_eq!(vertices.into_words(), [vec![0, 1, 2, 3, 4], vec![], vec![]]);
    }
}
