//! Numbers the triangles by the caller's indices, so that the numbers depend on the set of triangles only.

use super::insertion::insertion_sorts;
use super::slots::{GHOST, Slot};
use crate::NONE;
use std::array;

/// Triangles are sorted into groups by their first index, up to so many, and then each group is sorted in the cache. A
/// group has at least so many indices. Both are exponents of 2.
const MOST_GROUPS: u32 = 10;
const FEWEST_INDICES: u32 = 10;

/// A triangle by the caller's indices, from its smallest, and the half-edge that begins there.
type Row = [u32; 4];

/// The triangles of finished slots, and their twins. `indices` has the caller's index of each vertex; all are below
/// `count`. A triangle begins with its smallest index, and they are sorted by their first index and then by their second.
pub(super) fn numbered(slots: &[Slot], indices: &[u32], count: usize) -> (Vec<u32>, Vec<u32>) {
    // The triangles are in groups by their first index without its lowest bits.
    let shift = (usize::BITS - count.leading_zeros()).saturating_sub(MOST_GROUPS).max(FEWEST_INDICES);
    let mut group_ends = vec![0; (count >> shift) + 1];
    let corners = |slot: &Slot| {
        let [a, b, c, _] = slot.corners;
        // The symbolic vertex has the largest number.
        let is_real = a.max(b).max(c) != GHOST;
        is_real.then(|| [indices[a as usize], indices[b as usize], indices[c as usize]])
    };
    for [a, b, c] in slots.iter().filter_map(corners) {
        group_ends[(a.min(b).min(c) >> shift) as usize] += 1;
    }
    let total = starts_of(&mut group_ends) as usize;
    let [mut triangles, mut twins] = [vec![0; 3 * total], vec![0; 3 * total]];
    // The twins are not known yet, and the triangles are in their place until they are sorted.
    let (unsorted, _) = twins.as_chunks_mut::<3>();
    let mut half_edges = vec![0; total];
    for (slot, at) in (0..).zip(slots) {
        if let Some([a, b, c]) = corners(at) {
            let smallest = a.min(b).min(c);
            let turn = u32::from(b == smallest) + 2 * u32::from(c == smallest);
            let end = &mut group_ends[(smallest >> shift) as usize];
            unsorted[*end as usize] = [[a, b, c], [b, c, a], [c, a, b]][turn as usize];
            half_edges[*end as usize] = 4 * slot + turn;
            *end += 1;
        }
    }
    // For each slot, 4 times the number of its triangle, and the corner that is now the first.
    let mut numbers = vec![NONE; slots.len()];
    let (mut group, mut ends) = (Vec::new(), vec![0; (1 << shift) + 1]);
    let mut start = 0;
    for &end in &group_ends {
        let places = start as usize..end as usize;
        let rows = unsorted[places.clone()].iter().zip(&half_edges[places.clone()]);
        sort(rows.map(|(&[a, b, c], &h)| [a, b, c, h]), &mut group, &mut ends);
        let (sorted, _) = triangles.as_chunks_mut::<3>();
        for ((&[a, b, c, h], corners), number) in group.iter().zip(&mut sorted[places]).zip(start..) {
            *corners = [a, b, c];
            numbers[h as usize >> 2] = 4 * number + (h & 3);
        }
        start = end;
    }
    let (all, _) = twins.as_chunks_mut::<3>();
    for (slot, &number) in slots.iter().zip(&numbers) {
        if number != NONE {
            let turn = number as usize & 3;
            // Not `map`, which is not always inlined.
            all[number as usize >> 2] = array::from_fn(|corner| {
                let h = slot.twins[AFTER[turn + corner]];
                let number = numbers[h as usize >> 2];
                let turned = AFTER[(3 + (h & 3) - (number & 3)) as usize] as u32;
                if number == NONE { NONE } else { 3 * (number >> 2) + turned }
            });
        }
    }
    (triangles, twins)
}

/// Corners modulo 3.
const AFTER: [usize; 7] = [0, 1, 2, 0, 1, 2, 0];

/// Turns sizes into starts. Returns the sum.
fn starts_of(sizes: &mut [u32]) -> u32 {
    let mut sum = 0;
    for size in sizes {
        sum += std::mem::replace(size, sum);
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
        sorted.sort_unstable();
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
