//! Sorts half-edges by the smaller vertex of their edges. This finds twins, and all half-edges of each edge, however
//! many triangles share it.

use super::half_edge::triangle_of;
use crate::system::threads::{FEWEST, Threads, Word, shared};
use std::ops::Range;
use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

/// Half-edges in buckets, one bucket per smaller vertex. The order in a bucket depends on the threads.
pub(super) struct Buckets {
    /// For each vertex, the index at which its bucket ends and the next one starts.
    pub(super) ends: Vec<u32>,
    /// The larger vertex of the edge of each half-edge, bucket after bucket, and at least [`LANES`] more words.
    pub(super) highs: Vec<u32>,
    pub(super) half_edges: Vec<u32>,
}

/// Vertices that one comparison handles.
const LANES: usize = 8;

/// Triangles per block. A first loop lists the half-edges of a block, so that the memory accesses of the second loop
/// overlap.
const TRIANGLES: usize = 128;

/// A bucket with more half-edges is sorted before a search; otherwise a vertex of n edges would cost n² steps.
const FEW: usize = 64;

impl Buckets {
    /// Sorts all half-edges, or only the rising ones: those from the smaller vertex to the larger. A counting sort.
    pub(super) fn new(vertices: usize, triangles: &[u32], threads: &Threads, all: bool) -> Self {
        let (corners, _) = triangles.as_chunks::<3>();
        let mut ends = threads.zeros(vertices);
        let words = shared(&mut ends);
        let is_alone = threads.is_one();
        threads.map(corners.len(), |piece| {
            for &[a, b, c] in &corners[piece] {
                for (from, to) in [(a, b), (b, c), (c, a)] {
                    let word = &words[if all { from.min(to) } else { from } as usize];
                    let is_wanted = all | (from < to);
                    if is_alone {
                        word.set(word.get() + u32::from(is_wanted));
                    } else if is_wanted {
                        word.fetch_add(1, Relaxed);
                    }
                }
            }
        });
        let sum = become_starts(words, threads);
        let [mut highs, mut half_edges] = [(); 2].map(|()| threads.zeros(sum as usize + LANES + 1));
        let lists = [shared(&mut highs), shared(&mut half_edges)];
        if is_alone {
            scatter(corners, words, lists, all, sum + LANES as u32);
        } else {
            threads.map(corners.len(), |piece| scatter_concurrently(corners, piece, words, lists, all));
        }
        // The scatter has moved each start to the end of its bucket.
        Self { ends, highs, half_edges }
    }

    /// The entries of a bucket: the larger vertex, then the half-edge.
    fn of(&self, vertex: usize) -> impl Iterator<Item = (u32, u32)> {
        let bucket = range(&self.ends, vertex);
        self.highs[bucket.clone()].iter().copied().zip(self.half_edges[bucket].iter().copied())
    }

    /// Sorts the large buckets.
    pub(super) fn sort_large(&mut self, threads: &Threads) {
        let is_large = |&vertex: &usize| range(&self.ends, vertex).len() > FEW;
        let large = threads.map(self.ends.len(), |piece| piece.filter(is_large).collect::<Vec<_>>());
        for vertex in large.into_iter().flatten() {
            let mut sorted: Vec<_> = self.of(vertex).collect();
            sorted.sort_unstable();
            for (i, entry) in range(&self.ends, vertex).zip(sorted) {
                (self.highs[i], self.half_edges[i]) = entry;
            }
        }
    }
}

/// Writes the wanted half-edges and their larger vertices to the starts of their buckets, and advances the starts.
fn scatter(corners: &[[u32; 3]], starts: &[AtomicU32], lists: [&[AtomicU32]; 2], all: bool, sink: u32) {
    let [highs, half_edges] = lists;
    for (t, &[a, b, c]) in (0..).zip(corners) {
        for (from, to, h) in [(a, b, 3 * t), (b, c, 3 * t + 1), (c, a, 3 * t + 2)] {
            let word = &starts[if all { from.min(to) } else { from } as usize];
            let (start, is_wanted) = (word.get(), all | (from < to));
            // Unwanted half-edges go to the sink: a branch would be unpredictable.
            let at = if is_wanted { start } else { sink } as usize;
            word.set(start + u32::from(is_wanted));
            highs[at].set(from.max(to));
            half_edges[at].set(h);
        }
    }
}

/// The same for a piece of the triangles, while other threads handle other pieces.
fn scatter_concurrently(
    corners: &[[u32; 3]],
    piece: Range<usize>,
    starts: &[AtomicU32],
    [highs, half_edges]: [&[AtomicU32]; 2],
    all: bool,
) {
    let mut wanted = [[0; 3]; 3 * TRIANGLES];
    for first in piece.clone().step_by(TRIANGLES) {
        let mut count = 0;
        for (t, &[a, b, c]) in (first as u32..).zip(&corners[first..piece.end.min(first + TRIANGLES)]) {
            for (from, to, h) in [(a, b, 3 * t), (b, c, 3 * t + 1), (c, a, 3 * t + 2)] {
                wanted[count] = [if all { from.min(to) } else { from }, from.max(to), h];
                count += usize::from(all | (from < to));
            }
        }
        // All additions come first, because each atomic addition waits for earlier writes.
        for [low, ..] in &mut wanted[..count] {
            *low = starts[*low as usize].fetch_add(1, Relaxed);
        }
        for &[at, high, h] in &wanted[..count] {
            highs[at as usize].set(high);
            half_edges[at as usize].set(h);
        }
    }
}

/// Replaces each count by the sum of the counts before it. Returns the total.
fn become_starts(counts: &[AtomicU32], threads: &Threads) -> u32 {
    let pieces = threads.pieces(counts.len(), FEWEST);
    let sums = threads.map_each(pieces.clone(), |piece| counts[piece].iter().map(Word::get).sum::<u32>());
    let mut end = 0;
    let starts = sums.into_iter().map(|sum| {
        end += sum;
        end - sum
    });
    threads.map_each(pieces.into_iter().zip(starts).collect(), |(piece, mut start)| {
        for count in &counts[piece] {
            let end = start + count.get();
            count.set(start);
            start = end;
        }
    });
    end
}

/// The index range of the bucket of a vertex.
#[inline(always)]
pub(super) fn range(ends: &[u32], vertex: usize) -> Range<usize> {
    let start = if vertex == 0 { 0 } else { ends[vertex - 1] };
    start as usize..ends[vertex] as usize
}

/// Calls `visit` once for each edge, with its half-edges in ascending order. The edges come in the order of their
/// smaller vertices. A vertex with n edges costs n log n.
pub(crate) fn for_each_edge(vertices: usize, triangles: &[u32], mut visit: impl FnMut(&[u32])) {
    let buckets = Buckets::new(vertices, triangles, &Threads::default(), true);
    let (mut bucket, mut edge) = (Vec::new(), Vec::new());
    for vertex in 0..vertices {
        bucket.clear();
        bucket.extend(buckets.of(vertex));
        visit_edges(&mut bucket, &mut edge, &mut visit);
    }
}

/// Sorts the entries of a bucket (larger vertex, half-edge) and calls `visit` for each edge. `edge` is scratch memory.
pub(super) fn visit_edges(bucket: &mut [(u32, u32)], edge: &mut Vec<u32>, mut visit: impl FnMut(&[u32])) {
    bucket.sort_unstable();
    for entries in bucket.chunk_by(|x, y| x.0 == y.0) {
        edge.clear();
        edge.extend(entries.iter().map(|&(_, h)| h));
        visit(edge);
    }
}

/// A bit for each of `words`, set if it equals `word`.
#[cfg(not(target_feature = "simd128"))]
#[inline(always)]
fn equals(words: &[u32; LANES], word: u32) -> u32 {
    (0..).zip(words).fold(0, |bits, (i, &other)| bits | u32::from(other == word) << i)
}

/// The same; the compiler would not vectorize it.
#[cfg(target_feature = "simd128")]
#[inline(always)]
fn equals(words: &[u32; LANES], word: u32) -> u32 {
    use std::arch::wasm32::{u32x4_bitmask, u32x4_eq, u32x4_splat, v128};
    let [low, high]: [v128; 2] = zerocopy::transmute!(*words);
    let word = u32x4_splat(word);
    u32::from(u32x4_bitmask(u32x4_eq(low, word))) | u32::from(u32x4_bitmask(u32x4_eq(high, word))) << 4
}

/// Flag of a rising half-edge that a falling one has taken as its twin.
const TAKEN: u32 = 1 << 31;

/// The rising half-edges, while the falling ones take their twins from them.
pub(super) struct Rising<'a> {
    pub(super) ends: &'a [u32],
    pub(super) highs: &'a [u32],
    /// Those that are taken have the flag [`TAKEN`].
    pub(super) half_edges: &'a [AtomicU32],
}

impl Rising<'_> {
    /// The number of rising half-edges.
    pub(super) fn count(&self) -> usize {
        self.ends.last().map_or(0, |&end| end as usize)
    }

    /// The entries of a vertex: the larger vertex, the half-edge, and whether it is taken.
    pub(super) fn of(&self, vertex: u32) -> impl Iterator<Item = (u32, u32, bool)> {
        let entries = range(self.ends, vertex as usize).map(|i| (self.highs[i], self.half_edges[i].get()));
        entries.map(|(high, entry)| (high, entry & !TAKEN, entry & TAKEN != 0))
    }

    /// Matches half-edges in pairs and writes their twins. Returns the unmatched half-edges, each as a pair: the
    /// smaller vertex of its edge, and the half-edge. At a frozen edge it may match the first two half-edges.
    pub(super) fn match_all(
        &self,
        triangles: &[u32],
        twins: &[AtomicU32],
        threads: &Threads,
    ) -> Vec<(u32, u32)> {
        let half_edges = &self.half_edges[..self.count()];
        let (mut matched, mut unmatched) = (0, Vec::new());
        for (count, mut falling) in
            threads.map(triangles.len() / 3, |piece| self.take(triangles, piece, twins))
        {
            matched += count;
            unmatched.append(&mut falling);
        }
        for mut rising in threads.map(half_edges.len(), |piece| self.rest(triangles, piece)) {
            matched += rising.len();
            unmatched.append(&mut rising);
        }
        // Two threads may have taken the same rising half-edge. Then one thread matches everything again.
        if !cfg!(feature = "threads") || matched == half_edges.len() {
            return unmatched;
        }
        half_edges.iter().for_each(|h| h.set(h.get() & !TAKEN));
        self.match_all(triangles, twins, &Threads::one())
    }

    /// Matches the falling half-edges of a piece of the triangles. Returns how many it matched, and the unmatched ones.
    fn take(&self, triangles: &[u32], piece: Range<usize>, twins: &[AtomicU32]) -> (usize, Vec<(u32, u32)>) {
        let (corners, _) = triangles.as_chunks::<3>();
        let (mut matched, mut unmatched) = (0, Vec::new());
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
                let g = entry.map_or(TAKEN, |entry| entry.get());
                match entry {
                    Some(entry) if g & TAKEN == 0 && triangle_of(g) != triangle_of(h) => {
                        entry.set(g | TAKEN);
                        twins[h as usize].set(g);
                        twins[g as usize].set(h);
                        matched += 1;
                    }
                    _ => unmatched.push((low, h)),
                }
            }
        }
        (matched, unmatched)
    }

    /// The first rising half-edge from `low` to `high`, if there is one.
    #[inline(always)]
    fn find(&self, low: u32, high: u32) -> Option<&AtomicU32> {
        let Range { start, end } = range(self.ends, low as usize);
        if end - start > FEW {
            let found = start + self.highs[start..end].partition_point(|&v| v < high);
            return (found < end && self.highs[found] == high).then(|| &self.half_edges[found]);
        }
        for at in (start..end).step_by(LANES) {
            let bits = equals(self.highs[at..].first_chunk()?, high);
            if bits != 0 {
                let found = at + bits.trailing_zeros() as usize;
                return (found < end).then(|| &self.half_edges[found]);
            }
        }
        None
    }

    /// The rising half-edges that have not been taken.
    fn rest(&self, triangles: &[u32], piece: Range<usize>) -> Vec<(u32, u32)> {
        let rest = self.half_edges[piece].iter().map(|h| h.get()).filter(|&h| h & TAKEN == 0);
        rest.map(|h| (triangles[h as usize], h)).collect()
    }
}

#[cfg(all(test, feature = "threads"))]
mod tests {
    use super::*;
    use crate::{Adjacency, NONE};

    /// Simulates a race in which two threads have taken the same half-edge.
    #[test]
    fn a_half_edge_that_two_threads_have_taken_is_matched_again() {
        let triangles = [0, 1, 2, 0, 2, 3, 3, 2, 4, 2, 1, 4];
        let buckets = Buckets::new(5, &triangles, &Threads::one(), false);
        let expected = Adjacency::of_triangles(5, &triangles, &Threads::one());
        for taken in 0..buckets.ends[4] as usize {
            let mut half_edges = buckets.half_edges.clone();
            half_edges[taken] |= TAKEN;
            let mut twins = vec![NONE; triangles.len()];
            let (ends, highs) = (&buckets.ends, &buckets.highs);
            let rising = Rising { ends, highs, half_edges: shared(&mut half_edges) };
            let unmatched = rising.match_all(&triangles, shared(&mut twins), &Threads::default());
            assert_eq!(twins, expected.twins);
            assert_eq!(unmatched.len() as u32, expected.boundary);
        }
    }
}
