//! The phases on the CPU, an edge at a time: what the last test of each edge said is kept, and an edge is tested again
//! only where one of its triangles has flipped.

use super::{Answer, Census, EdgeCounts, Engine};
use crate::adjacency::{next, prev, unflagged};
use crate::embedded::Embedded;
use crate::locks;
use crate::mesh::{Dimension, Mesh};
use crate::phases::{
    Geometry, Selected, Topology, Verdict, flag_creases, flip, keep_non_delaunay, key, move_anchors, verdict,
    verdict_of_non_delaunay, yields,
};
use crate::star::Fans;
use crate::threads::{Threads, shared};
use crate::winding::Winding;
use crate::{Adjacency, NONE, Reason};
use std::ops::Range;
use std::sync::Arc;
use std::sync::atomic::{AtomicU8, AtomicU32, Ordering::Relaxed};

/// Edges that are tested in one go.
const EDGES: usize = 1024;

/// The state of a mesh between two iterations.
pub(crate) struct Cpu {
    threads: Threads,
    mesh: Arc<Mesh>,
    cos: f64,
    winding: Winding,
    embedded: Embedded,
    counts: EdgeCounts,
    pub(crate) triangles: Vec<u32>,
    pub(crate) twins: Vec<u32>,
    pub(crate) fans: Fans,
    /// Of each half-edge what the last test of its edge said, by its [`code`].
    verdicts: Vec<AtomicU8>,
    /// The lower half-edges of the edges that may flip, or could but for a duplicate.
    candidates: Vec<u32>,
    /// A half-edge of each edge that the last iteration has flipped; `None` before the first.
    flipped: Option<Vec<u32>>,
    /// Those edges by triangle.
    selected: Selected,
    /// For each vertex whose star is not known to be embedded the last iteration, plus one, in which an edge there came
    /// or went.
    changed: Vec<AtomicU32>,
    iteration: u32,
}

impl Cpu {
    /// Builds the adjacency; `cos` is the cosine of β.
    pub(crate) fn new(mesh: Arc<Mesh>, cos: f64, threads: Threads) -> Self {
        let adjacency = Adjacency::of_triangles(mesh.vertex_count(), mesh.triangles(), &threads);
        let winding = Winding::new(&mesh, &adjacency.twins, &threads);
        let embedded = Embedded::new(&mesh, &adjacency.twins, &winding, &threads);
        let counts = EdgeCounts::from(&adjacency);
        let triangles = mesh.triangles().to_vec();
        let fans = Fans::new(mesh.vertex_count(), &triangles, &adjacency.twins, |v| embedded.at(v));
        let mut twins = adjacency.twins;
        if mesh.dimension() == Dimension::Three {
            flag_creases(mesh.positions(), &triangles, &mut twins, cos, &threads);
        }
        Self {
            threads,
            cos,
            winding,
            embedded,
            counts,
            fans,
            verdicts: std::iter::repeat_with(AtomicU8::default).take(triangles.len()).collect(),
            candidates: Vec::new(),
            flipped: None,
            selected: Selected::new(triangles.len() / 3),
            changed: std::iter::repeat_with(AtomicU32::default).take(mesh.vertex_count()).collect(),
            iteration: 0,
            triangles,
            twins,
            mesh,
        }
    }

    pub(super) fn geometry(&self) -> Geometry<'_> {
        Geometry {
            dimension: self.mesh.dimension(),
            positions: self.mesh.positions(),
            cos: self.cos,
            winding: &self.winding,
            embedded: &self.embedded,
        }
    }

    pub(super) fn topology(&self) -> Topology<'_> {
        Topology { triangles: &self.triangles, twins: &self.twins, fans: &self.fans }
    }

    /// Label: tests the edges around those that have flipped, which are Delaunay now, and all edges before the first
    /// iteration; looks for duplicates again where one may have come or gone.
    pub(super) fn label(&mut self) {
        let mut candidates = Vec::new();
        if let Some(flipped) = &self.flipped {
            let before = &self.candidates;
            self.threads.extend(&mut candidates, before.len(), |piece, found| {
                self.keep_candidates(&before[piece], found);
            });
            self.threads.extend(&mut candidates, flipped.len(), |piece, found| {
                self.test_around(&flipped[piece], found);
            });
            self.threads
                .map(flipped.len(), |piece| flipped[piece].iter().for_each(|&h| self.selected.release(h)));
        } else {
            self.threads.extend(&mut candidates, self.twins.len(), |piece, found| {
                self.test_all(piece.start as u32..piece.end as u32, found);
            });
        }
        self.candidates = candidates;
        self.flipped.get_or_insert_default().clear();
    }

    /// Tests the edges whose lower half-edges are in `range`.
    fn test_all(&self, range: Range<u32>, found: &mut Vec<u32>) {
        let mut edges = [0; EDGES];
        for first in range.clone().step_by(EDGES) {
            let mut count = 0;
            for h in first..range.end.min(first + EDGES as u32) {
                let g = unflagged(self.twins[h as usize]);
                edges[count] = h;
                count += usize::from(h < g && g != NONE);
            }
            self.test(&mut edges[..count], found);
        }
    }

    /// Finds the candidates of which no triangle has flipped.
    fn keep_candidates(&self, candidates: &[u32], found: &mut Vec<u32>) {
        for &h in candidates {
            let g = self.twins[h as usize];
            if self.selected.is_free(h) && self.selected.is_free(g) {
                if [h, g].iter().all(|&x| self.has_changed(self.triangles[prev(x) as usize])) {
                    self.judge_non_delaunay(h);
                }
                found.push(h);
            }
        }
    }

    /// Tests the edges around those that have flipped.
    fn test_around(&self, flipped: &[u32], found: &mut Vec<u32>) {
        let mut edges = [0; EDGES];
        for flipped in flipped.chunks(EDGES / 4) {
            let mut count = 0;
            for &h in flipped {
                let g = self.selected.twin(h);
                for x in [h, prev(h), g, prev(g)] {
                    let y = unflagged(self.twins[x as usize]);
                    if y != NONE {
                        let is_outside = self.selected.is_free(y);
                        // The new edge is Delaunay anyway; nothing could predict a branch.
                        let known = if is_outside { y } else { next(h) };
                        self.verdicts[known as usize].store(DELAUNAY, Relaxed);
                        // Between two that have flipped, one of them tests.
                        edges[count] = x.min(y);
                        count += usize::from(is_outside | (x < y));
                    }
                }
            }
            self.test(&mut edges[..count], found);
        }
    }

    /// Tests edges, of which nothing is known yet, and finds those that could flip, but for a duplicate.
    fn test(&self, edges: &mut [u32], found: &mut Vec<u32>) {
        let count = keep_non_delaunay(&self.geometry(), self.topology(), edges);
        for &h in &edges[..count] {
            let verdict = self.judge_non_delaunay(h);
            if matches!(verdict, Verdict::Labelled | Verdict::Blocked(Reason::Duplicate)) {
                found.push(h);
            }
        }
    }

    fn judge_non_delaunay(&self, h: u32) -> Verdict {
        let verdict = verdict_of_non_delaunay(&self.geometry(), self.topology(), h);
        self.set_verdict(h, verdict);
        verdict
    }

    fn set_verdict(&self, h: u32, verdict: Verdict) {
        for x in [h, unflagged(self.twins[h as usize])] {
            self.verdicts[x as usize].store(code(verdict), Relaxed);
        }
    }

    /// Whether an edge at `v` has come or gone in the last iteration, as far as that is of interest.
    fn has_changed(&self, v: u32) -> bool {
        self.iteration > 0 && self.changed[v as usize].load(Relaxed) == self.iteration
    }

    /// Select: the edges that flip are those with the smallest key in both their triangles, but for those that yield.
    fn select(&mut self) {
        let mut flips = self.flipped.take().unwrap_or_default();
        self.threads.extend(&mut flips, self.candidates.len(), |piece, flips| {
            let before = flips.len();
            let mut count = before;
            flips.resize(before + piece.len(), 0);
            for &h in &self.candidates[piece] {
                flips[count] = h;
                count += usize::from(self.is_best(h));
            }
            flips.truncate(count);
            for &h in &flips[before..] {
                self.selected.choose(h, self.twins[h as usize]);
            }
        });
        let mut yielding = Vec::new();
        self.threads.extend(&mut yielding, flips.len(), |piece, yielding| {
            yielding.extend(flips[piece].iter().filter(|&&h| self.yields(h)));
        });
        for &h in &yielding {
            self.selected.release(h);
        }
        if !yielding.is_empty() {
            flips.retain(|&h| !self.selected.is_free(h));
        }
        self.flipped = Some(flips);
    }

    /// Whether the edge of `h` may flip and has the smallest key of all that may in its two triangles. Without a
    /// branch, which nothing could predict.
    #[inline(always)]
    fn is_best(&self, h: u32) -> bool {
        let g = self.twins[h as usize];
        let mine = key(h, self.iteration);
        let is_labelled = |x: u32| self.verdicts[x as usize].load(Relaxed) == LABELLED;
        let loses = |x: u32| is_labelled(x) & (key(x.min(self.twins[x as usize]), self.iteration) < mine);
        is_labelled(h) & !(loses(next(h)) | loses(prev(h)) | loses(next(g)) | loses(prev(g)))
    }

    fn yields(&self, h: u32) -> bool {
        let g = self.selected.twin(h);
        if [h, g].iter().any(|&x| self.embedded.at(self.triangles[prev(x) as usize])) {
            return false;
        }
        yields(self.topology(), self.iteration, h, g, |t| self.selected.pair(t))
    }

    /// Flip with Update. Returns the number of flips.
    fn flip(&mut self) -> u32 {
        let Self {
            threads, triangles, twins, fans, verdicts, selected, changed, embedded, iteration, ..
        } = self;
        let flips = self.flipped.as_deref().unwrap_or_default();
        *iteration += 1;
        move_anchors(fans, triangles, selected, flips);
        let (triangles, twins) = (shared(triangles), shared(twins));
        threads.map(flips.len(), |piece| {
            for &h in &flips[piece] {
                let g = selected.twin(h);
                for x in [h, prev(h), g, prev(g)] {
                    let v = triangles[x as usize].load(Relaxed);
                    if !embedded.at(v) {
                        changed[v as usize].store(*iteration, Relaxed);
                    }
                }
                forget(verdicts, h, g);
                flip(triangles, twins, selected, h);
            }
        });
        flips.len() as u32
    }

    /// The verdict of every interior edge, counted.
    pub(crate) fn count(&mut self) -> Census {
        self.label();
        let counted = self.threads.map(self.verdicts.len(), |piece| {
            let mut halves = [0; CODES];
            for verdict in &self.verdicts[piece] {
                let code = verdict.load(Relaxed);
                if code != DELAUNAY {
                    halves[code as usize] += 1;
                }
            }
            halves
        });
        let edges = |code: u8| counted.iter().map(|halves| halves[code as usize]).sum::<u32>() / 2;
        let mut census = Census { labelled: edges(LABELLED), ..Census::default() };
        for reason in Reason::ALL {
            census.blocked[reason] = u64::from(edges(code(Verdict::Blocked(reason))));
        }
        census
    }
}

/// What Lawson's algorithm needs of it.
impl Cpu {
    /// Tests the edge of half-edge `h`.
    pub(super) fn judge(&mut self, h: u32) -> Verdict {
        let verdict = verdict(&self.geometry(), self.topology(), h);
        self.set_verdict(h, verdict);
        verdict
    }

    /// Flips one edge that may flip, by one of its half-edges.
    pub(super) fn flip_one(&mut self, h: u32) {
        let Self { triangles, twins, fans, verdicts, selected, .. } = self;
        let g = twins[h as usize];
        selected.choose(h, g);
        move_anchors(fans, triangles, selected, &[h]);
        flip(shared(triangles), shared(twins), selected, h);
        selected.release(h);
        forget(verdicts, h, g);
    }

    /// Says whether the last test of every edge still holds; else the next iteration tests all of them.
    pub(super) fn set_tested(&mut self, is_tested: bool) {
        self.candidates.clear();
        self.flipped = is_tested.then(Vec::new);
    }
}

const DELAUNAY: u8 = 0;
const LABELLED: u8 = 1;
const CODES: usize = 2 + Reason::ALL.len();

/// A verdict as a byte.
fn code(verdict: Verdict) -> u8 {
    match verdict {
        Verdict::Delaunay => DELAUNAY,
        Verdict::Labelled => LABELLED,
        Verdict::Blocked(reason) => 2 + reason as u8,
    }
}

/// Takes all edges of the triangles of two half-edges for Delaunay.
fn forget(verdicts: &[AtomicU8], h: u32, g: u32) {
    for t in [h as usize / 3, g as usize / 3] {
        for verdict in &verdicts[3 * t..3 * t + 3] {
            verdict.store(DELAUNAY, Relaxed);
        }
    }
}

impl Engine for Cpu {
    fn lock(&mut self, half_edges: Vec<u32>) -> Answer<'_, ()> {
        locks::flag(&mut self.twins, &half_edges);
        Box::pin(std::future::ready(Ok(())))
    }

    fn iterate(&mut self, count: u32) -> Answer<'_, Vec<u32>> {
        let mut flips = Vec::new();
        while (flips.len() as u32) < count {
            self.label();
            self.select();
            match self.flip() {
                0 => break,
                flipped => flips.push(flipped),
            }
        }
        Box::pin(std::future::ready(Ok(flips)))
    }

    fn census(&mut self) -> Answer<'_, Census> {
        Box::pin(std::future::ready(Ok(self.count())))
    }

    fn triangles(&mut self) -> Answer<'_, Vec<u32>> {
        Box::pin(std::future::ready(Ok(self.triangles.clone())))
    }

    fn twins(&mut self) -> Answer<'_, Vec<u32>> {
        Box::pin(std::future::ready(Ok(self.twins.clone())))
    }

    fn set_positions(&mut self, mesh: Arc<Mesh>) -> Answer<'_, ()> {
        self.winding = Winding::new(&mesh, &self.twins, &self.threads);
        self.embedded = Embedded::new(&mesh, &self.twins, &self.winding, &self.threads);
        if mesh.dimension() == Dimension::Three {
            flag_creases(mesh.positions(), &self.triangles, &mut self.twins, self.cos, &self.threads);
        }
        self.verdicts.fill_with(AtomicU8::default);
        self.candidates.clear();
        self.flipped = None;
        self.selected = Selected::new(self.triangles.len() / 3);
        self.changed.fill_with(AtomicU32::default);
        self.iteration = 0;
        self.mesh = mesh;
        Box::pin(std::future::ready(Ok(())))
    }

    fn batch(&self) -> u32 {
        1
    }

    fn edge_counts(&self) -> EdgeCounts {
        self.counts
    }

    fn backend(&self) -> &'static str {
        "cpu"
    }
}

impl From<&Adjacency> for EdgeCounts {
    fn from(adjacency: &Adjacency) -> Self {
        let &Adjacency { edges, boundary, non_manifold, inconsistent, .. } = adjacency;
        Self { edges, boundary, non_manifold, inconsistent }
    }
}
