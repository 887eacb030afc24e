//! Twins from triangles: which half-edge lies on the other side of each half-edge.
//!
//! Half-edge h belongs to triangle h / 3 and goes from `triangles[h]` to `triangles[next(h)]`.

use crate::threads::{Threads, shared};
use crate::{Mesh, NONE};
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

/// The vertices of an edge, the smaller one first.
fn ends(triangles: &[u32], h: u32) -> [u32; 2] {
    let [from, to] = [h, next(h)].map(|x| triangles[x as usize]);
    [from.min(to), from.max(to)]
}

/// Half-edges in buckets by the smaller vertices of their edges. In each bucket they ascend.
struct Buckets {
    /// Where the bucket of each vertex ends, and the next one starts.
    ends: Vec<u32>,
    /// The larger vertices, those of all buckets and some more, at least [`LANES`].
    highs: Vec<u32>,
    half_edges: Vec<u32>,
}

/// Vertices that are compared at once.
const LANES: usize = 8;

/// Words between places that two threads write to, lest they share a line of a cache.
const LINE: usize = 16;

/// A larger bucket is sorted before it is searched, lest a pole cost the square of its edges.
const FEW: usize = 64;

impl Buckets {
    /// Of all half-edges, or of those that rise: that go from the smaller vertex to the larger one. A counting sort.
    fn new(vertices: usize, triangles: &[u32], threads: &Threads, all: bool) -> Self {
        let (corners, _) = triangles.as_chunks::<3>();
        let mut pieces = threads.map_each(threads.pieces_with_arrays(corners.len()), |piece| {
            let mut counts = vec![0u32; vertices];
            for &[a, b, c] in &corners[piece.clone()] {
                for (from, to) in [(a, b), (b, c), (c, a)] {
                    counts[if all { from.min(to) } else { from } as usize] += u32::from(all | (from < to));
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
        let sinks = pieces.len() * LINE;
        let [mut highs, mut half_edges] = [(); 2].map(|()| vec![0; sum as usize + LANES + sinks]);
        let (high, half_edge) = (shared(&mut highs), shared(&mut half_edges));
        let pieces = (sum + LANES as u32..).step_by(LINE).zip(pieces).collect();
        let mut ends = threads.map_each(pieces, |(sink, (piece, mut starts))| {
            for (t, &[a, b, c]) in (piece.start as u32..).zip(&corners[piece]) {
                for (from, to, h) in [(a, b, 3 * t), (b, c, 3 * t + 1), (c, a, 3 * t + 2)] {
                    let start = &mut starts[if all { from.min(to) } else { from } as usize];
                    let is_wanted = all | (from < to);
                    // What is not wanted goes to a place of the piece's own; nothing could predict a branch.
                    let at = if is_wanted { *start } else { sink } as usize;
                    *start += u32::from(is_wanted);
                    high[at].store(from.max(to), Relaxed);
                    half_edge[at].store(h, Relaxed);
                }
            }
            starts
        });
        // Each start has moved to the end of its part.
        Self { ends: ends.pop().unwrap_or_default(), highs, half_edges }
    }

    /// The half-edges of a bucket, each after the larger vertex.
    fn of(&self, vertex: usize) -> impl Iterator<Item = (u32, u32)> {
        let bucket = range(&self.ends, vertex);
        self.highs[bucket.clone()].iter().copied().zip(self.half_edges[bucket].iter().copied())
    }

    /// Sorts the buckets that a search would take long for.
    fn sort_large(&mut self) {
        for vertex in 0..self.ends.len() {
            let bucket = range(&self.ends, vertex);
            if bucket.len() > FEW {
                let mut sorted: Vec<_> = self.of(vertex).collect();
                sorted.sort_unstable();
                for (i, entry) in bucket.zip(sorted) {
                    (self.highs[i], self.half_edges[i]) = entry;
                }
            }
        }
    }
}

/// The bucket of a vertex, as the ends of all say.
#[inline(always)]
fn range(ends: &[u32], vertex: usize) -> Range<usize> {
    let start = if vertex == 0 { 0 } else { ends[vertex - 1] };
    start as usize..ends[vertex] as usize
}

/// Calls `visit` once for each edge with its half-edges in ascending order, edges by their smaller vertex. A vertex of n
/// edges costs n log n.
pub(crate) fn for_each_edge(vertices: usize, triangles: &[u32], mut visit: impl FnMut(&[u32])) {
    let buckets = Buckets::new(vertices, triangles, &Threads::default(), true);
    let (mut bucket, mut edge) = (Vec::new(), Vec::new());
    for vertex in 0..vertices {
        bucket.clear();
        bucket.extend(buckets.of(vertex));
        visit_edges(&mut bucket, &mut edge, &mut visit);
    }
}

/// Calls `visit` for each edge of a bucket: half-edges, each after the larger vertex, which are sorted. `edge` is scratch.
fn visit_edges(bucket: &mut [(u32, u32)], edge: &mut Vec<u32>, mut visit: impl FnMut(&[u32])) {
    bucket.sort_unstable();
    for entries in bucket.chunk_by(|x, y| x.0 == y.0) {
        edge.clear();
        edge.extend(entries.iter().map(|&(_, h)| h));
        visit(edge);
    }
}

/// The rising half-edges, while the falling ones take theirs.
struct Rising<'a> {
    ends: &'a [u32],
    highs: &'a [u32],
    /// [`NONE`] for one that is taken.
    half_edges: &'a [AtomicU32],
}

/// Triangles of which the falling half-edges are listed first, so that the processor is ahead of the memory.
const TRIANGLES: usize = 128;

impl Rising<'_> {
    /// Matches the falling half-edges of some triangles. Returns how many, and the smaller vertices of the edges of those
    /// that cannot be.
    fn take(&self, triangles: &[u32], piece: Range<usize>, twins: &[AtomicU32]) -> (usize, Vec<u32>) {
        let (corners, _) = triangles.as_chunks::<3>();
        let (mut matched, mut odd) = (0, Vec::new());
        let mut falling = [[0; 3]; 3 * TRIANGLES];
        for first in piece.clone().step_by(TRIANGLES) {
            let mut count = 0;
            for (t, &[a, b, c]) in (first as u32..).zip(&corners[first..piece.end.min(first + TRIANGLES)]) {
                for (from, to, h) in [(a, b, 3 * t), (b, c, 3 * t + 1), (c, a, 3 * t + 2)] {
                    falling[count] = [from, to, h];
                    count += usize::from(from >= to);
                }
            }
            for &[high, low, h] in &falling[..count] {
                let entry = self.find(low, high);
                let g = entry.map_or(NONE, |entry| entry.load(Relaxed));
                match entry {
                    Some(entry) if g != NONE && g / 3 != h / 3 => {
                        entry.store(NONE, Relaxed);
                        twins[h as usize].store(g, Relaxed);
                        twins[g as usize].store(h, Relaxed);
                        matched += 1;
                    }
                    _ => odd.push(low),
                }
            }
        }
        (matched, odd)
    }

    /// The first half-edge of the edge of two vertices, if there is one.
    #[inline(always)]
    fn find(&self, low: u32, high: u32) -> Option<&AtomicU32> {
        let Range { start, end } = range(self.ends, low as usize);
        let found = if end - start > FEW {
            start + self.highs[start..end].partition_point(|&v| v < high)
        } else {
            let mut at = start;
            loop {
                let (lanes, _) = self.highs[at..].split_first_chunk::<LANES>()?;
                let bits = (0..).zip(lanes).fold(0u32, |bits, (i, &v)| bits | u32::from(v == high) << i);
                if bits != 0 {
                    break at + bits.trailing_zeros() as usize;
                }
                at += LANES;
                if at >= end {
                    return None;
                }
            }
        };
        (found < end && self.highs[found] == high).then(|| &self.half_edges[found])
    }

    /// The smaller vertices of the edges of those that have not been taken.
    fn rest(&self, triangles: &[u32], piece: Range<usize>) -> Vec<u32> {
        let half_edges = self.half_edges[piece].iter().map(|h| h.load(Relaxed));
        half_edges.filter(|&h| h != NONE).map(|h| triangles[h as usize]).collect()
    }
}

impl Adjacency {
    /// Matches the half-edges of a mesh.
    pub fn new(mesh: &Mesh) -> Self {
        Self::of_triangles(mesh.vertex_count(), mesh.triangles(), &Threads::default())
    }

    /// Matches the half-edges of `triangles`, whose indices must be below `vertices`.
    pub(crate) fn of_triangles(vertices: usize, triangles: &[u32], threads: &Threads) -> Self {
        let mut buckets = Buckets::new(vertices, triangles, threads, false);
        buckets.sort_large();
        let Buckets { ends, highs, mut half_edges } = buckets;
        let count = ends.last().map_or(0, |&end| end as usize);
        let rising = Rising { ends: &ends, highs: &highs, half_edges: shared(&mut half_edges) };
        // Memory is taken when it is first written, which is work for all threads.
        let mut twins = vec![0; triangles.len()];
        let words = shared(&mut twins);
        threads.map(words.len(), |piece| words[piece].iter().for_each(|twin| twin.store(NONE, Relaxed)));
        let taken = threads.map(triangles.len() / 3, |piece| rising.take(triangles, piece, words));
        let rest = threads.map(count, |piece| rising.rest(triangles, piece)).concat();
        // Two threads may have taken the same one.
        let is_taken_twice = taken.iter().map(|(matched, _)| matched).sum::<usize>() + rest.len() != count;
        let mut is_odd = vec![is_taken_twice; vertices];
        for v in taken.into_iter().flat_map(|(_, odd)| odd).chain(rest) {
            is_odd[v as usize] = true;
        }
        let plain: usize = (0..vertices).filter(|&v| !is_odd[v]).map(|v| range(&ends, v).len()).sum();
        let mut adjacency = Self { edges: plain as u32, ..Self::default() };
        if is_odd.contains(&true) {
            adjacency.match_with_care(triangles, words, threads, |v| is_odd[v as usize]);
        }
        Self { twins, ..adjacency }
    }

    /// Counts the edges of odd vertices, and writes their twins.
    fn match_with_care(
        &mut self,
        triangles: &[u32],
        twins: &[AtomicU32],
        threads: &Threads,
        is_odd: impl Fn(u32) -> bool + Sync,
    ) {
        let (corners, _) = triangles.as_chunks::<3>();
        let mut odd = Vec::new();
        let find = |piece: Range<usize>, odd: &mut Vec<_>| {
            for (t, &[a, b, c]) in (piece.start as u32..).zip(&corners[piece]) {
                if is_odd(a) | is_odd(b) | is_odd(c) {
                    let lows = (3 * t..3 * t + 3).map(|h| (ends(triangles, h)[0], h));
                    odd.extend(lows.filter(|&(low, _)| is_odd(low)));
                }
            }
        };
        threads.extend(&mut odd, corners.len(), find, |all, mut part| all.append(&mut part));
        odd.sort_unstable();
        let mut scratch = Vec::new();
        for bucket in odd.chunk_by_mut(|x, y| x.0 == y.0) {
            bucket.iter_mut().for_each(|(low, h)| *low = ends(triangles, *h)[1]);
            visit_edges(bucket, &mut scratch, |edge| {
                self.edges += 1;
                let kind = edge_kind(edge, triangles);
                match kind {
                    EdgeKind::Interior => {}
                    EdgeKind::Boundary => self.boundary += 1,
                    EdgeKind::NonManifold => self.non_manifold += 1,
                    EdgeKind::Inconsistent => self.inconsistent += 1,
                }
                for &h in edge {
                    let other = edge[0] ^ edge[edge.len() - 1] ^ h;
                    let twin = if kind == EdgeKind::Interior { other } else { NONE };
                    twins[h as usize].store(twin, Relaxed);
                }
            });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::collection::vec;
    use proptest::prelude::*;
    use std::collections::BTreeMap;
    use std::num::NonZeroUsize;

    /// From the half-edges of each edge.
    fn expected(triangles: &[u32]) -> Adjacency {
        let mut edges = BTreeMap::<_, Vec<u32>>::new();
        for h in 0..triangles.len() as u32 {
            edges.entry(ends(triangles, h)).or_default().push(h);
        }
        let mut expected = Adjacency { twins: vec![NONE; triangles.len()], ..Adjacency::default() };
        for edge in edges.values() {
            expected.edges += 1;
            match edge_kind(edge, triangles) {
                EdgeKind::Interior => {
                    expected.twins[edge[0] as usize] = edge[1];
                    expected.twins[edge[1] as usize] = edge[0];
                }
                EdgeKind::Boundary => expected.boundary += 1,
                EdgeKind::NonManifold => expected.non_manifold += 1,
                EdgeKind::Inconsistent => expected.inconsistent += 1,
            }
        }
        expected
    }

    fn compare(vertices: usize, triangles: &[u32]) {
        let expected = expected(triangles);
        for threads in 1..=3 {
            let threads = Threads::new(NonZeroUsize::new(threads)).unwrap();
            assert_eq!(Adjacency::of_triangles(vertices, triangles, &threads), expected);
        }
        let mut number = 0;
        for_each_edge(vertices, triangles, |edge| {
            number += 1;
            assert!(edge.is_sorted() && edge.iter().all(|&h| ends(triangles, h) == ends(triangles, edge[0])));
        });
        assert_eq!(number, expected.edges);
    }

    proptest! {
        /// From nearly all edges non-manifold to nearly all on the boundary; triangles that have a corner twice.
        #[test]
        fn the_half_edges_of_any_triangles_are_matched(
            triangles in (2u32..40).prop_flat_map(|vertices| vec(0..vertices, 0..40).prop_map(|mut corners| {
                corners.truncate(corners.len() / 3 * 3);
                corners
            }))
        ) {
            compare(40, &triangles);
        }

        /// Cones of many triangles, the apex being the first vertex or the last, with some of them again or turned.
        #[test]
        fn the_half_edges_of_poles_are_matched(
            [is_first, is_last] in any::<[bool; 2]>(), size in 3u32..300, dirt in vec((0usize..300, any::<bool>()), 0..4)
        ) {
            let mut triangles = Vec::new();
            for (apex, is_apex) in [(0, is_first), (size + 1, is_last)] {
                let cone = |i: u32| if apex == 0 { [i + 1, (i + 1) % size + 1, 0] } else { [(i + 1) % size + 1, i + 1, apex] };
                triangles.extend((0..if is_apex { size } else { 0 }).flat_map(cone));
            }
            for (t, is_turned) in dirt {
                if let Some(corners) = triangles.as_chunks::<3>().0.get(t) {
                    let [a, b, c] = *corners;
                    triangles.extend(if is_turned { [b, a, c] } else { [b, c, a] });
                }
            }
            compare(size as usize + 2, &triangles);
        }
    }

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
