//! Which samples a film holds.

use super::MergeError;
use std::fmt;
use std::ops::Range;

/// Samples a pixel may have after all merges; with `SUM_BITS` it keeps every sum inside 64 bits.
pub const MAX_SAMPLES: u32 = 1 << 24;

/// A set of sample indices as sorted, disjoint, non-empty ranges that do not touch.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SampleRanges(Vec<Range<u32>>);

impl SampleRanges {
    /// From ranges in any order; an error if they overlap. Empty ranges vanish.
    pub fn new(ranges: impl IntoIterator<Item = Range<u32>>) -> Result<Self, MergeError> {
        let mut set = Self::default();
        for range in ranges {
            set.insert(range)?;
        }
        Ok(set)
    }

    /// Adds a range; an error if some of it is here already or if the whole would exceed `MAX_SAMPLES`.
    pub fn insert(&mut self, range: Range<u32>) -> Result<(), MergeError> {
        if range.is_empty() {
            return Ok(());
        }
        self.check(&Self(vec![range.clone()]))?;
        let at = self.0.partition_point(|r| r.start < range.start);
        self.0.insert(at, range);
        self.join(at);
        if at > 0 {
            self.join(at - 1);
        }
        Ok(())
    }

    /// Joins range `at` with its successor if they touch.
    fn join(&mut self, at: usize) {
        if at + 1 < self.0.len() && self.0[at].end == self.0[at + 1].start {
            self.0[at].end = self.0[at + 1].end;
            self.0.remove(at + 1);
        }
    }

    /// Whether `other` could be added.
    pub fn check(&self, other: &Self) -> Result<(), MergeError> {
        if let Some(both) = self.overlap(other) {
            let (left, right) = (self.to_string(), other.to_string());
            return Err(MergeError::Overlap { start: both.start, end: both.end, left, right });
        }
        let total = self.total() + other.total();
        if total > u64::from(MAX_SAMPLES) { Err(MergeError::TooMany { total }) } else { Ok(()) }
    }

    /// The first samples that both sets hold.
    pub fn overlap(&self, other: &Self) -> Option<Range<u32>> {
        let (mut left, mut right) = (self.0.iter().peekable(), other.0.iter().peekable());
        while let (Some(a), Some(b)) = (left.peek(), right.peek()) {
            let both = a.start.max(b.start)..a.end.min(b.end);
            if !both.is_empty() {
                return Some(both);
            }
            if a.end <= b.end {
                left.next()
            } else {
                right.next()
            };
        }
        None
    }

    /// What of `range` is not in the set, in ascending order.
    pub fn missing(&self, range: Range<u32>) -> Vec<Range<u32>> {
        let mut missing = Vec::new();
        let mut start = range.start;
        for here in &self.0 {
            if start < here.start.min(range.end) {
                missing.push(start..here.start.min(range.end));
            }
            start = start.max(here.end);
        }
        if start < range.end {
            missing.push(start..range.end);
        }
        missing
    }

    pub fn contains(&self, sample: u32) -> bool {
        self.0.iter().any(|r| r.contains(&sample))
    }

    /// Number of samples.
    pub fn total(&self) -> u64 {
        self.0.iter().map(|r| u64::from(r.end - r.start)).sum()
    }

    pub fn as_slice(&self) -> &[Range<u32>] {
        &self.0
    }
}

impl fmt::Display for SampleRanges {
    /// `0..16, 32..48`, or `none`
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.0.is_empty() {
            return f.write_str("none");
        }
        for (i, range) in self.0.iter().enumerate() {
            let comma = if i == 0 { "" } else { ", " };
            write!(f, "{comma}{}..{}", range.start, range.end)?;
        }
        Ok(())
    }
}
