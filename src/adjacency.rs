//! Twins from triangles: which half-edge lies on the other side of each half-edge.
//!
//! Half-edge h belongs to triangle h / 3 and goes from `triangles[h]` to `triangles[next(h)]`.

use crate::threads::{Threads, shared};
use crate::{Mesh, NONE};
use std::array;
use std::ops::Range;
use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

/// The half-edge after `h` in its triangle.
#[inline]
pub fn next(h: u32) -> u32 {
    if h % 3 == 2 { h - 2 } else { h + 1 }
}

/// The half-edge before `h` in its triangle.
#[inline]
pub fn prev(h: u32) -> u32 {
    if h.is_multiple_of(3) { h + 2 } else { h - 1 }
}

/// Set in both entries of an engine's twins for an edge that was over β in the input: it stays, whatever its
/// angle becomes. The flag moves with the half-edges.
pub(crate) const CREASE: u32 = 1 << 31;

/// The same for an edge that the user has locked.
pub(crate) const LOCKED: u32 = 1 << 30;

/// All flags. Half-edges are below the lowest.
pub(crate) const FLAGS: u32 = CREASE | LOCKED;

/// The half-edge that an entry of an engine's twins names, without its flags.
#[inline]
pub(crate) fn unflagged(entry: u32) -> u32 {
    if entry == NONE { NONE } else { entry & !FLAGS }
}

/// The half-edges of a mesh matched in pairs, and how many edges there are of each kind.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Adjacency {
    /// For each half-edge the one on the other side; [`NONE`] on the boundary and on frozen edges.
    pub twins: Vec<u32>,
    /// Edges in all: pairs of vertices joined by a half-edge.
    pub edges: u32,
    /// Edges with one half-edge.
    pub boundary: u32,
    /// Frozen edges with three or more half-edges, or two in one triangle.
    pub non_manifold: u32,
    /// Frozen edges with two half-edges in the same direction.
    pub inconsistent: u32,
}

/// What an edge is, by its half-edges.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum EdgeKind {
    Interior,
    Boundary,
    NonManifold,
    Inconsistent,
}

/// The kind of the edge that these half-edges, all between the same two vertices, make up.
pub(crate) fn edge_kind(half_edges: &[u32], triangles: &[u32]) -> EdgeKind {
    match *half_edges {
        [_] => EdgeKind::Boundary,
        [h, g] if h / 3 != g / 3 => {
            if triangles[h as usize] == triangles[g as usize] {
                EdgeKind::Inconsistent
            } else {
                EdgeKind::Interior
            }
        }
        _ => EdgeKind::NonManifold,
    }
}

/// The half-edges in buckets by the smaller vertex of their edges, by a counting sort: in each bucket they ascend.
struct Buckets {
    /// Where the bucket of each vertex ends in `half_edges`, and the next one starts.
    ends: Vec<u32>,
    half_edges: Vec<u32>,
}

impl Buckets {
    fn new(vertices: usize, triangles: &[u32], threads: &Threads) -> Self {
        let (corners, _) = triangles.as_chunks::<3>();
        let mut pieces = threads.map_each(threads.pieces_with_arrays(corners.len()), |piece| {
            let mut counts = vec![0u32; vertices];
            for &[a, b, c] in &corners[piece.clone()] {
                for low in [a.min(b), b.min(c), c.min(a)] {
                    counts[low as usize] += 1;
                }
            }
            (piece, counts)
        });
        // Each count becomes a start: of the part of the bucket that is of the piece.
        let mut sum = 0;
        for low in 0..vertices {
            for (_, starts) in &mut pieces {
                sum += std::mem::replace(&mut starts[low], sum);
            }
        }
        let mut half_edges = vec![0u32; triangles.len()];
        let words = shared(&mut half_edges);
        let mut ends = threads.map_each(pieces, |(piece, mut starts)| {
            for (t, &[a, b, c]) in (piece.start as u32..).zip(&corners[piece]) {
                for (low, h) in [(a.min(b), 3 * t), (b.min(c), 3 * t + 1), (c.min(a), 3 * t + 2)] {
                    let at = &mut starts[low as usize];
                    words[*at as usize].store(h, Relaxed);
                    *at += 1;
                }
            }
            starts
        });
        // Each start has moved to the end of its part.
        Self { ends: ends.pop().unwrap_or_default(), half_edges }
    }

    /// The buckets of some vertices, each with its vertex.
    fn of(&self, vertices: Range<usize>) -> impl Iterator<Item = (u32, &[u32])> {
        let mut start = if vertices.start == 0 { 0 } else { self.ends[vertices.start - 1] as usize };
        (vertices.start as u32..).zip(&self.ends[vertices]).map(move |(vertex, &end)| {
            let bucket = &self.half_edges[start..end as usize];
            start = end as usize;
            (vertex, bucket)
        })
    }
}

/// The vertex of half-edge `h`'s edge that is not `low`.
fn other_end(triangles: &[u32], low: u32, h: u32) -> u32 {
    triangles[h as usize] ^ triangles[next(h) as usize] ^ low
}

/// Calls `visit` once for each edge with its half-edges in ascending order, edges by their smaller vertex. A vertex of n
/// edges costs n log n.
pub(crate) fn for_each_edge(vertices: usize, triangles: &[u32], mut visit: impl FnMut(&[u32])) {
    let mut sorted = Vec::new();
    for (low, bucket) in Buckets::new(vertices, triangles, &Threads::default()).of(0..vertices) {
        visit_edges(triangles, low, bucket, &mut sorted, &mut visit);
    }
}

/// The same for the edges of one bucket. `sorted` is scratch.
fn visit_edges(
    triangles: &[u32],
    low: u32,
    bucket: &[u32],
    sorted: &mut Vec<u32>,
    visit: &mut impl FnMut(&[u32]),
) {
    let end = |h: u32| other_end(triangles, low, h);
    sorted.clear();
    sorted.extend(bucket);
    sorted.sort_unstable_by_key(|&h| (end(h), h));
    for edge in sorted.chunk_by(|&x, &y| end(x) == end(y)) {
        visit(edge);
    }
}

/// Writes the twins of a bucket of at most `N` half-edges, compared each with each, and returns the number of its
/// edges with one half-edge and with two; `None`, and nothing written, where one of them would be frozen.
fn match_few<const N: usize>(
    triangles: &[u32],
    low: u32,
    bucket: &[u32],
    twins: &[AtomicU32],
) -> Option<[u32; 2]> {
    // What is no half-edge is equal to none: no other end is `low`, but in a triangle that has a corner twice.
    let mut ends = [low; N];
    let mut outwards = 0u32;
    for (i, &h) in bucket.iter().enumerate() {
        ends[i] = other_end(triangles, low, h);
        outwards |= u32::from(triangles[h as usize] == low) << i;
    }
    let mut partners = [NONE; N];
    let mut is_odd = false;
    let mut alone = 0;
    for (i, &h) in bucket.iter().enumerate() {
        let equal = (0..N).fold(0u32, |bits, j| bits | u32::from(ends[j] == ends[i]) << j);
        let others = equal & !(1 << i);
        alone += u32::from(others == 0);
        let j = others.trailing_zeros();
        let g = bucket.get(j as usize).copied().unwrap_or(NONE);
        // More than two, two in one direction, in one triangle, or from a corner to itself.
        is_odd |= others & others.wrapping_sub(1) != 0
            || (others != 0 && (outwards >> i ^ outwards >> (j & 31)) & 1 == 0)
            || h / 3 == g / 3
            || ends[i] == low;
        partners[i] = g;
    }
    if is_odd {
        return None;
    }
    for (&h, partner) in bucket.iter().zip(partners) {
        twins[h as usize].store(partner, Relaxed);
    }
    Some([alone, (bucket.len() as u32 - alone) / 2])
}

impl Adjacency {
    /// Matches the half-edges of a mesh.
    pub fn new(mesh: &Mesh) -> Self {
        Self::of_triangles(mesh.vertex_count(), mesh.triangles(), &Threads::default())
    }

    /// Matches the half-edges of `triangles`, whose indices must be below `vertices`.
    pub(crate) fn of_triangles(vertices: usize, triangles: &[u32], threads: &Threads) -> Self {
        let buckets = Buckets::new(vertices, triangles, threads);
        // Memory is taken when it is first written, which is work for all threads.
        let mut twins = vec![0; triangles.len()];
        let words = shared(&mut twins);
        threads.map(words.len(), |piece| words[piece].iter().for_each(|twin| twin.store(NONE, Relaxed)));
        let counts = threads.map(vertices, |piece| match_buckets(triangles, buckets.of(piece), words));
        let [edges, boundary, non_manifold, inconsistent] =
            counts.into_iter().fold([0; 4], |sums, counts| array::from_fn(|kind| sums[kind] + counts[kind]));
        Self { twins, edges, boundary, non_manifold, inconsistent }
    }
}

/// Writes the twins of some buckets, where there are any, and returns the number of their edges: all, those on the
/// boundary, the non-manifold and the inconsistent ones.
fn match_buckets<'a>(
    triangles: &[u32],
    buckets: impl Iterator<Item = (u32, &'a [u32])>,
    twins: &[AtomicU32],
) -> [u32; 4] {
    let mut counts = [0; 4];
    let mut sorted = Vec::new();
    for (low, bucket) in buckets {
        let matched = match bucket.len() {
            0..=8 => match_few::<8>(triangles, low, bucket, twins),
            9..=16 => match_few::<16>(triangles, low, bucket, twins),
            _ => None,
        };
        if let Some([boundary, interior]) = matched {
            counts[0] += boundary + interior;
            counts[1] += boundary;
            continue;
        }
        visit_edges(triangles, low, bucket, &mut sorted, &mut |half_edges| {
            counts[0] += 1;
            match edge_kind(half_edges, triangles) {
                EdgeKind::Boundary => counts[1] += 1,
                EdgeKind::NonManifold => counts[2] += 1,
                EdgeKind::Inconsistent => counts[3] += 1,
                EdgeKind::Interior => {
                    let (h, g) = (half_edges[0], half_edges[1]);
                    twins[h as usize].store(g, Relaxed);
                    twins[g as usize].store(h, Relaxed);
                }
            }
        });
    }
    counts
}

#[cfg(test)]
mod tests {
    use super::*;

    fn matched(vertices: usize, triangles: &[u32]) -> Adjacency {
        Adjacency::of_triangles(vertices, triangles, &Threads::default())
    }

    #[test]
    fn half_edges_leave_room_for_flags() {
        let last = 3 * crate::MAX_TRIANGLES as u32 - 1;
        assert!(last < LOCKED && last | FLAGS < crate::phases::BLOCKED);
        assert_eq!([unflagged(last | FLAGS), unflagged(NONE)], [last, NONE]);
    }

    /// ```text
    ///  3-----2
    ///  | \ 1 |     triangles 0: (0, 1, 3), 1: (1, 2, 3)
    ///  | 0 \ |
    ///  0-----1
    /// ```
    #[test]
    fn two_triangles_share_one_edge() {
        let adjacency = matched(4, &[0, 1, 3, 1, 2, 3]);
        assert_eq!(adjacency.twins, [NONE, 5, NONE, NONE, NONE, 1]);
        assert_eq!((adjacency.edges, adjacency.boundary), (5, 4));
    }

    /// Three triangles at the edge 0-1, like the pages of a book.
    #[test]
    fn an_edge_of_three_triangles_is_frozen() {
        let adjacency = matched(5, &[0, 1, 2, 1, 0, 3, 0, 1, 4]);
        assert_eq!(adjacency.twins, [NONE; 9]);
        assert_eq!((adjacency.edges, adjacency.boundary, adjacency.non_manifold), (7, 6, 1));
    }

    #[test]
    fn an_edge_between_triangles_turned_against_each_other_is_frozen() {
        let adjacency = matched(4, &[0, 1, 2, 0, 1, 3]);
        assert_eq!(adjacency.twins, [NONE; 6]);
        assert_eq!((adjacency.boundary, adjacency.inconsistent), (4, 1));
    }

    /// (0, 0, 1) has the edge 0-1 twice and the edge 0-0.
    #[test]
    fn a_triangle_is_not_its_own_neighbour() {
        let adjacency = matched(2, &[0, 0, 1]);
        assert_eq!(adjacency.twins, [NONE; 3]);
        assert_eq!((adjacency.boundary, adjacency.non_manifold), (1, 1));
    }

    #[test]
    fn unreferenced_vertices_have_no_edges() {
        assert_eq!(matched(7, &[]), Adjacency::default());
        assert_eq!(matched(9, &[8, 4, 6]).boundary, 3);
    }
}
