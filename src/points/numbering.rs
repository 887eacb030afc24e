//! Numbers the triangles by the caller's indices, so that the numbers depend on the set of triangles only.

use super::distribution::Record;
use super::groups::{groups, split, start};
use super::insertion::insertion_sorts;
use super::slots::{GHOST, Slot};
use crate::NONE;
use crate::system::threads::{FEWEST, Threads, Word, shared};
use std::mem::replace;

/// Triangles are sorted into groups by their first index, up to so many, and then each group is sorted in the cache. A
/// group has at least so many indices. Both are exponents of 2.
const MOST_GROUPS: u32 = 10;
const FEWEST_INDICES: u32 = 10;

/// A triangle by the caller's indices, from its smallest, and the half-edge that begins there.
type Row = [u32; 4];

/// The triangles of finished slots by the caller's indices.
pub(super) struct Numbered {
    /// A triangle begins with its smallest index, and they are sorted by their first index and then by their second.
    pub(super) triangles: Vec<u32>,
    /// As long.
    memory: Vec<u32>,
    /// For each slot, 4 times the number of its triangle, and the corner that is now the first.
    numbers: Vec<u32>,
}

/// Numbers the triangles. `indices` has the caller's index of each vertex; all are below `count`.
pub(super) fn numbered(slots: &[Slot], indices: &[u32], count: usize, threads: &Threads) -> Numbered {
    // The triangles are in groups by their first index without its lowest bits.
    let shift = (usize::BITS - count.leading_zeros()).saturating_sub(MOST_GROUPS).max(FEWEST_INDICES);
    let corners = |slot: &Slot| {
        let [a, b, c, _] = slot.corners;
        // The symbolic vertex has the largest number.
        let is_real = a.max(b).max(c) != GHOST;
        is_real.then(|| [indices[a as usize], indices[b as usize], indices[c as usize]])
    };
    let pieces = threads.pieces(slots.len(), FEWEST.max(1 << MOST_GROUPS));
    let sizes = threads.map_each(pieces.clone(), |piece| {
        let mut sizes = vec![0; (count >> shift) + 1];
        for [a, b, c] in slots[piece].iter().filter_map(corners) {
            sizes[(a.min(b).min(c) >> shift) as usize] += 1;
        }
        sizes
    });
    let (starts, group_ends) = starts_of_lists(sizes);
    let total = group_ends.last().map_or(0, |&end| end as usize);
    let [mut triangles, mut memory] = [(); 2].map(|()| threads.zeros(3 * total));
    let mut half_edges = threads.zeros(total);
    let (unsorted, words) = (shared(&mut memory).as_chunks::<3>().0, shared(&mut half_edges));
    threads.map_each(pieces.into_iter().zip(starts).collect(), |(piece, mut ends)| {
        for (slot, at) in (piece.start as u32..).zip(&slots[piece]) {
            if let Some([a, b, c]) = corners(at) {
                let smallest = a.min(b).min(c);
                let turn = u32::from(b == smallest) + 2 * u32::from(c == smallest);
                let end = &mut ends[(smallest >> shift) as usize];
                let [first, second, third] = &unsorted[*end as usize];
                let turned = [[a, b, c], [b, c, a], [c, a, b]][turn as usize];
                first.set(turned[0]);
                second.set(turned[1]);
                third.set(turned[2]);
                words[*end as usize].set(4 * slot + turn);
                *end += 1;
            }
        }
    });
    let mut numbers = threads.collect(slots.len(), |_| NONE);
    let words = shared(&mut numbers);
    let (unsorted, _) = memory.as_chunks::<3>();
    let groups = groups(&group_ends, threads);
    let sorted = split(triangles.as_chunks_mut().0, &group_ends, &groups);
    threads.map_each(groups.into_iter().zip(sorted).collect(), |(groups, mut sorted)| {
        let (mut group, mut ends) = (Vec::new(), vec![0; (1 << shift) + 1]);
        let mut start = start(&group_ends, groups.start);
        for &end in &group_ends[groups] {
            let places = replace(&mut start, end as usize)..end as usize;
            let rows = unsorted[places.clone()].iter().zip(&half_edges[places.clone()]);
            sort(rows.map(|(&[a, b, c], &h)| [a, b, c, h]), &mut group, &mut ends);
            let (these, others) = sorted.split_at_mut(places.len());
            sorted = others;
            for ((&[a, b, c, h], corners), number) in group.iter().zip(these).zip(places.start as u32..) {
                *corners = [a, b, c];
                words[h as usize >> 2].set(4 * number + (h & 3));
            }
        }
    });
    Numbered { triangles, memory, numbers }
}

impl Numbered {
    /// The triangles, and for each half-edge its twin.
    pub(super) fn with_twins(self, slots: &[Slot], threads: &Threads) -> (Vec<u32>, Vec<u32>) {
        let Self { triangles, memory: mut twins, numbers } = self;
        let (all, _) = shared(&mut twins).as_chunks::<3>();
        threads.map(slots.len(), |piece| {
            for (slot, &number) in slots[piece.clone()].iter().zip(&numbers[piece]) {
                if number != NONE {
                    let turn = number as usize & 3;
                    for (corner, twin) in all[number as usize >> 2].iter().enumerate() {
                        let h = slot.twins[AFTER[turn + corner]];
                        let number = numbers[h as usize >> 2];
                        let turned = AFTER[(3 + (h & 3) - (number & 3)) as usize] as u32;
                        twin.set(if number == NONE { NONE } else { 3 * (number >> 2) + turned });
                    }
                }
            }
        });
        (triangles, twins)
    }
}

/// Corners modulo 3.
const AFTER: [usize; 7] = [0, 1, 2, 0, 1, 2, 0];

/// Where each group of each list starts, if each group has the items of the first list, of the second and so on; and where
/// each group ends. `lists` has the sizes of the groups.
fn starts_of_lists(mut lists: Vec<Vec<u32>>) -> (Vec<Vec<u32>>, Vec<u32>) {
    let groups = lists.first().map_or(0, Vec::len);
    let mut sum = 0;
    let mut end_of = |group: usize| {
        for list in &mut lists {
            sum += replace(&mut list[group], sum);
        }
        sum
    };
    let ends = (0..groups).map(&mut end_of).collect();
    (lists, ends)
}

/// Turns sizes into starts. Returns the sum.
fn starts_of(sizes: &mut [u32]) -> u32 {
    let mut sum = 0;
    for size in sizes {
        sum += replace(size, sum);
    }
    sum
}

/// Sorts the rows of a group. The lowest bits of their first indices are below the length of `ends`, a power of two and 1.
fn sort(rows: impl ExactSizeIterator<Item = Row> + Clone, sorted: &mut Vec<Row>, ends: &mut [u32]) {
    let mask = ends.len() as u32 - 2;
    ends.fill(0);
    rows.clone().for_each(|row| ends[(row[0] & mask) as usize] += 1);
    starts_of(ends);
    sorted.clear();
    sorted.resize(rows.len(), [0; 4]);
    for row in rows {
        let end = &mut ends[(row[0] & mask) as usize];
        sorted[*end as usize] = row;
        *end += 1;
    }
    let is_before = |p: &Row, q: &Row| p[0] == q[0] && p[1] < q[1];
    if !insertion_sorts(sorted, is_before) {
        let rows = sorted.clone();
        let record = |(i, &[first, second, ..]): (u32, &Row)| Record::of([first, second, i]);
        let mut records: Vec<Record> = (0..).zip(&rows).map(record).collect();
        Record::sort(&mut records);
        for (row, Record { index, .. }) in sorted.iter_mut().zip(records) {
            *row = rows[index as usize];
        }
    }
}

/// The vertices of a hull by the caller's indices, from the smallest.
pub(super) fn numbered_hull(mut vertices: Vec<u32>, indices: &[u32]) -> Vec<u32> {
    for vertex in &mut vertices {
        *vertex = indices[*vertex as usize];
    }
    let smallest = (0..vertices.len()).min_by_key(|&i| vertices[i]).unwrap_or(0);
    vertices.rotate_left(smallest);
    vertices
}
