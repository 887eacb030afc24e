//! Groups of neighbouring parts, for several threads.

use crate::system::threads::{FEWEST, Threads};
use std::mem::replace;
use std::ops::Range;

/// Groups of the parts that have these ends. All groups have about as many items, unless a part has more.
pub(super) fn groups(ends: &[u32], threads: &Threads) -> Vec<Range<usize>> {
    let count = ends.last().map_or(0, |&end| end as usize);
    let mut first = 0;
    let group = |piece: Range<usize>| {
        let last = ends.partition_point(|&end| end as usize <= piece.end);
        replace(&mut first, last)..last
    };
    threads.pieces(count, FEWEST).into_iter().map(group).collect()
}

/// Where a part starts.
pub(super) fn start(ends: &[u32], part: usize) -> usize {
    if part == 0 { 0 } else { ends[part - 1] as usize }
}

/// The items of each group.
pub(super) fn split<'a, T>(
    mut items: &'a mut [T],
    ends: &[u32],
    groups: &[Range<usize>],
) -> Vec<&'a mut [T]> {
    let mut split = Vec::with_capacity(groups.len());
    for group in groups {
        let (these, others) = items.split_at_mut(start(ends, group.end) - start(ends, group.start));
        split.push(these);
        items = others;
    }
    split
}
