//! Numbers the triangles by the caller's indices, so that the numbers depend on the set of triangles only.

use super::slots::{GHOST, Slot};
use crate::NONE;

/// The most groups of first indices, into which the triangles are sorted before each group is sorted in the cache.
const MOST_GROUPS_LOG2: u32 = 10;

/// A triangle by the caller's indices, from its smallest, and the half-edge that begins there.
#[derive(Clone, Copy, Default)]
struct Row {
    corners: [u32; 3],
    half_edge: u32,
}

/// The triangles of finished slots, and their twins. `indices` has the caller's index of each vertex; all are below
/// `count`. A triangle begins with its smallest index, and they are sorted by their first index and then by their second.
pub(super) fn numbered(slots: &[Slot], indices: &[u32], count: usize) -> (Vec<u32>, Vec<u32>) {
    let (rows, group_ends, shift) = grouped(slots, indices, count);
    let mut triangles = Vec::with_capacity(3 * rows.len());
    // For each slot, 4 times the number of its triangle, and the corner that is now the first.
    let mut numbers = vec![NONE; slots.len()];
    let (mut scratch, mut ends) = (Vec::new(), Vec::new());
    let mut start = 0;
    for (group, &end) in group_ends.iter().enumerate() {
        let first = (group as u32) << shift;
        sort_group(&rows[start..end as usize], &mut scratch, &mut ends, first, 1 << shift);
        for row in &scratch {
            let number = triangles.len() as u32 / 3;
            numbers[row.half_edge as usize >> 2] = 4 * number + (row.half_edge & 3);
            triangles.extend(row.corners);
        }
        start = end as usize;
    }
    let mut twins = vec![0; triangles.len()];
    for (slot, &number) in slots.iter().zip(&numbers) {
        if number != NONE {
            let at = 3 * (number >> 2) as usize;
            let turn = number as usize & 3;
            for (corner, twin) in twins[at..at + 3].iter_mut().enumerate() {
                let h = slot.twins[AFTER[turn + corner]];
                let number = numbers[h as usize >> 2];
                *twin = if number == NONE { NONE } else { half_edge(number, h) };
            }
        }
    }
    (triangles, twins)
}

/// Corners modulo 3.
const AFTER: [usize; 5] = [0, 1, 2, 0, 1];

/// The new number of a half-edge of a triangle with this entry in the numbers.
#[inline(always)]
fn half_edge(number: u32, h: u32) -> u32 {
    3 * (number >> 2) + AFTER[(3 + (h & 3) - (number & 3)) as usize % 3] as u32
}

/// The triangles in groups by their first index without its lowest bits: the rows, the end of each group, and how many
/// bits.
fn grouped(slots: &[Slot], indices: &[u32], count: usize) -> (Vec<Row>, Vec<u32>, u32) {
    let shift = (usize::BITS - count.leading_zeros()).saturating_sub(MOST_GROUPS_LOG2);
    let mut ends = vec![0; (count >> shift) + 1];
    let row_of = |(slot, at): (u32, &Slot)| {
        let [a, b, c, _] = at.corners;
        // The symbolic vertex has the largest number.
        if a.max(b).max(c) == GHOST {
            return None;
        }
        let [a, b, c] = [a, b, c].map(|vertex| indices[vertex as usize]);
        let (corners, turn) = if a < b && a < c {
            ([a, b, c], 0)
        } else if b < c {
            ([b, c, a], 1)
        } else {
            ([c, a, b], 2)
        };
        Some(Row { corners, half_edge: 4 * slot + turn })
    };
    let rows_of = || (0..).zip(slots).filter_map(row_of);
    rows_of().for_each(|row| ends[(row.corners[0] >> shift) as usize] += 1);
    let mut sum = 0;
    for end in &mut ends {
        let size = *end;
        *end = sum;
        sum += size;
    }
    let mut rows = vec![Row::default(); sum as usize];
    for row in rows_of() {
        let end = &mut ends[(row.corners[0] >> shift) as usize];
        rows[*end as usize] = row;
        *end += 1;
    }
    (rows, ends, shift)
}

/// Sorts the rows of a group, whose first indices are from `first`, below `first + span`. The result is in `sorted`.
fn sort_group(rows: &[Row], sorted: &mut Vec<Row>, ends: &mut Vec<u32>, first: u32, span: usize) {
    ends.clear();
    ends.resize(span + 1, 0);
    let offset = |row: &Row| (row.corners[0] - first) as usize;
    rows.iter().for_each(|row| ends[offset(row) + 1] += 1);
    let mut sum = 0;
    for end in ends.iter_mut() {
        sum += *end;
        *end = sum;
    }
    sorted.clear();
    sorted.resize(rows.len(), Row::default());
    for row in rows {
        let end = &mut ends[offset(row)];
        sorted[*end as usize] = *row;
        *end += 1;
    }
    let second = |row: &Row| row.corners[1];
    let mut start = 0;
    for &end in &ends[..span] {
        match &mut sorted[start..end as usize] {
            [] | [_] => {}
            [p, q] => {
                if second(q) < second(p) {
                    std::mem::swap(p, q);
                }
            }
            several => several.sort_unstable_by_key(second),
        }
        start = end as usize;
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
