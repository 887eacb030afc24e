//! Half-edges sorted by the smaller vertices of their edges: what finds twins, and the edges of meshes that are not manifold.

use crate::NONE;
use crate::threads::{Threads, Word, shared};
use std::ops::Range;
use std::sync::atomic::AtomicU32;

/// Half-edges in buckets by the smaller vertices of their edges. In each bucket they ascend.
pub(super) struct Buckets {
    /// Where the bucket of each vertex ends, and the next one starts.
    pub(super) ends: Vec<u32>,
    /// The larger vertices, those of all buckets and some more, at least [`LANES`].
    pub(super) highs: Vec<u32>,
    pub(super) half_edges: Vec<u32>,
}

/// Vertices that are compared at once.
const LANES: usize = 8;

/// Words between places that two threads write to, lest they share a line of a cache.
const LINE: usize = 16;

/// A larger bucket is sorted before it is searched, lest a pole cost the square of its edges.
const FEW: usize = 64;

impl Buckets {
    /// Of all half-edges, or of those that rise: that go from the smaller vertex to the larger one. A counting sort.
    pub(super) fn new(vertices: usize, triangles: &[u32], threads: &Threads, all: bool) -> Self {
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
                    high[at].set(from.max(to));
                    half_edge[at].set(h);
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
    pub(super) fn sort_large(&mut self) {
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
pub(super) fn range(ends: &[u32], vertex: usize) -> Range<usize> {
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
pub(super) fn visit_edges(bucket: &mut [(u32, u32)], edge: &mut Vec<u32>, mut visit: impl FnMut(&[u32])) {
    bucket.sort_unstable();
    for entries in bucket.chunk_by(|x, y| x.0 == y.0) {
        edge.clear();
        edge.extend(entries.iter().map(|&(_, h)| h));
        visit(edge);
    }
}

/// The rising half-edges, while the falling ones take theirs.
pub(super) struct Rising<'a> {
    pub(super) ends: &'a [u32],
    pub(super) highs: &'a [u32],
    /// [`NONE`] for one that is taken.
    pub(super) half_edges: &'a [AtomicU32],
}

/// Triangles of which the falling half-edges are listed first, so that the processor is ahead of the memory.
const TRIANGLES: usize = 128;

impl Rising<'_> {
    /// Matches the falling half-edges of some triangles. Returns how many, and the smaller vertices of the edges of those
    /// that cannot be.
    pub(super) fn take(
        &self,
        triangles: &[u32],
        piece: Range<usize>,
        twins: &[AtomicU32],
    ) -> (usize, Vec<u32>) {
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
                let g = entry.map_or(NONE, |entry| entry.get());
                match entry {
                    Some(entry) if g != NONE && g / 3 != h / 3 => {
                        entry.set(NONE);
                        twins[h as usize].set(g);
                        twins[g as usize].set(h);
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
    pub(super) fn rest(&self, triangles: &[u32], piece: Range<usize>) -> Vec<u32> {
        let half_edges = self.half_edges[piece].iter().map(|h| h.get());
        half_edges.filter(|&h| h != NONE).map(|h| triangles[h as usize]).collect()
    }
}
