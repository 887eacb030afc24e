//! The phases on the CPU, an edge at a time: what the last test of each edge said is kept, and an edge is tested again
//! only where one of its triangles has flipped.

use super::{Answer, Census, EdgeCounts, Engine};
use crate::adjacency::{next, prev, unflagged};
use crate::embedded::Embedded;
use crate::locks;
use crate::mesh::{Dimension, Mesh};
use crate::phases::{
    Geometry, Selected, Topology, Verdict, flag_creases, flip, keep_non_delaunay, key, verdict,
    verdict_of_non_delaunay, yields,
};
use crate::star::Fans;
use crate::winding::Winding;
use crate::{Adjacency, NONE, Reason};
use std::sync::Arc;

/// Edges that are tested in one go.
const EDGES: usize = 1024;

/// A triangle without an edge that flips.
const FREE: Selected = [NONE; 2];

/// The state of a mesh between two iterations.
pub(crate) struct Cpu {
    mesh: Arc<Mesh>,
    cos: f64,
    winding: Winding,
    embedded: Embedded,
    counts: EdgeCounts,
    pub(crate) triangles: Vec<u32>,
    pub(crate) twins: Vec<u32>,
    pub(crate) fans: Fans,
    /// Of each half-edge what the last test of its edge said.
    verdicts: Vec<Verdict>,
    /// The lower half-edges of the edges that may flip, or could but for a duplicate.
    candidates: Vec<u32>,
    /// A half-edge of each edge that the last iteration has flipped; `None` before the first.
    flipped: Option<Vec<u32>>,
    /// Those edges by triangle.
    selected: Vec<Selected>,
    /// For each vertex whose star is not known to be embedded the last iteration, plus one, in which an edge there came
    /// or went.
    changed: Vec<u32>,
    iteration: u32,
}

impl Cpu {
    /// Builds the adjacency; `cos` is the cosine of β.
    pub(crate) fn new(mesh: Arc<Mesh>, cos: f64) -> Self {
        let adjacency = Adjacency::new(&mesh);
        let winding = Winding::new(&mesh, &adjacency.twins);
        let embedded = Embedded::new(&mesh, &adjacency.twins, &winding);
        let counts = EdgeCounts::from(&adjacency);
        let triangles = mesh.triangles().to_vec();
        let fans = Fans::new(mesh.vertex_count(), &triangles, &adjacency.twins, |v| embedded.at(v));
        let mut twins = adjacency.twins;
        if mesh.dimension() == Dimension::Three {
            flag_creases(mesh.positions(), &triangles, &mut twins, cos);
        }
        Self {
            cos,
            winding,
            embedded,
            counts,
            fans,
            verdicts: vec![Verdict::Delaunay; triangles.len()],
            candidates: Vec::new(),
            flipped: None,
            selected: vec![FREE; triangles.len() / 3],
            changed: vec![0; mesh.vertex_count()],
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
        let mut edges = [0; EDGES];
        let Some(flipped) = self.flipped.take() else {
            for first in (0..self.twins.len() as u32).step_by(EDGES) {
                let mut count = 0;
                for h in first..self.twins.len().min(first as usize + EDGES) as u32 {
                    let g = unflagged(self.twins[h as usize]);
                    edges[count] = h;
                    count += usize::from(h < g && g != NONE);
                }
                self.test(&mut edges[..count]);
            }
            self.flipped = Some(Vec::new());
            return;
        };
        let mut candidates = std::mem::take(&mut self.candidates);
        candidates.retain(|&h| {
            let g = self.twins[h as usize];
            let stays = self.selected[h as usize / 3] == FREE && self.selected[g as usize / 3] == FREE;
            if stays && [h, g].iter().all(|&x| self.has_changed(self.triangles[prev(x) as usize])) {
                self.judge_non_delaunay(h);
            }
            stays
        });
        self.candidates = candidates;
        for flipped in flipped.chunks(EDGES / 4) {
            let mut count = 0;
            for &h in flipped {
                let [_, g] = self.selected[h as usize / 3];
                for x in [h, prev(h), g, prev(g)] {
                    let y = unflagged(self.twins[x as usize]);
                    if y != NONE {
                        let is_outside = self.selected[y as usize / 3] == FREE;
                        // The new edge is Delaunay anyway; nothing could predict a branch.
                        self.verdicts[if is_outside { y } else { next(h) } as usize] = Verdict::Delaunay;
                        // Between two that have flipped, one of them tests.
                        edges[count] = x.min(y);
                        count += usize::from(is_outside | (x < y));
                    }
                }
            }
            self.test(&mut edges[..count]);
        }
        for &h in &flipped {
            release(&mut self.selected, h);
        }
        self.flipped = Some(flipped);
        self.flipped.iter_mut().for_each(Vec::clear);
    }

    /// Tests edges, of which nothing is known yet; those that could flip, but for a duplicate, become candidates.
    fn test(&mut self, edges: &mut [u32]) {
        let count = keep_non_delaunay(&self.geometry(), self.topology(), edges);
        for &h in &edges[..count] {
            let verdict = self.judge_non_delaunay(h);
            if matches!(verdict, Verdict::Labelled | Verdict::Blocked(Reason::Duplicate)) {
                self.candidates.push(h);
            }
        }
    }

    fn judge_non_delaunay(&mut self, h: u32) -> Verdict {
        let verdict = verdict_of_non_delaunay(&self.geometry(), self.topology(), h);
        self.set_verdict(h, verdict);
        verdict
    }

    fn set_verdict(&mut self, h: u32, verdict: Verdict) {
        let g = unflagged(self.twins[h as usize]);
        (self.verdicts[h as usize], self.verdicts[g as usize]) = (verdict, verdict);
    }

    /// Whether an edge at `v` has come or gone in the last iteration, as far as that is of interest.
    fn has_changed(&self, v: u32) -> bool {
        self.iteration > 0 && self.changed[v as usize] == self.iteration
    }

    /// Select: the edges that flip are those with the smallest key in both their triangles, but for those that yield.
    fn select(&mut self) {
        let mut flips = self.flipped.take().unwrap_or_default();
        flips.resize(self.candidates.len(), 0);
        let mut count = 0;
        for &h in &self.candidates {
            flips[count] = h;
            count += usize::from(self.is_best(h));
        }
        flips.truncate(count);
        for &h in &flips {
            choose(&mut self.selected, h, self.twins[h as usize]);
        }
        let yielding: Vec<u32> = flips.iter().copied().filter(|&h| self.yields(h)).collect();
        for &h in &yielding {
            release(&mut self.selected, h);
        }
        if !yielding.is_empty() {
            flips.retain(|&h| self.selected[h as usize / 3] != FREE);
        }
        self.flipped = Some(flips);
    }

    /// Whether the edge of `h` may flip and has the smallest key of all that may in its two triangles. Without a
    /// branch, which nothing could predict.
    #[inline(always)]
    fn is_best(&self, h: u32) -> bool {
        let g = self.twins[h as usize];
        let mine = key(h, self.iteration);
        let is_labelled = |x: u32| self.verdicts[x as usize] == Verdict::Labelled;
        let loses = |x: u32| is_labelled(x) & (key(x.min(self.twins[x as usize]), self.iteration) < mine);
        is_labelled(h) & !(loses(next(h)) | loses(prev(h)) | loses(next(g)) | loses(prev(g)))
    }

    fn yields(&self, h: u32) -> bool {
        let [_, g] = self.selected[h as usize / 3];
        if [h, g].iter().any(|&x| self.embedded.at(self.triangles[prev(x) as usize])) {
            return false;
        }
        let mutual = |t: u32| {
            let [x, y] = self.selected[t as usize];
            (x != NONE).then_some((x, y))
        };
        yields(self.topology(), self.iteration, h, g, mutual)
    }

    /// Flip with Update. Returns the number of flips.
    fn flip(&mut self) -> u32 {
        let Self { triangles, twins, fans, verdicts, selected, changed, embedded, iteration, .. } = self;
        let flips = self.flipped.as_deref().unwrap_or_default();
        *iteration += 1;
        for &h in flips {
            let [_, g] = selected[h as usize / 3];
            for x in [h, prev(h), g, prev(g)] {
                let v = triangles[x as usize];
                if !embedded.at(v) {
                    changed[v as usize] = *iteration;
                }
            }
            forget(verdicts, h, g);
        }
        flip(triangles, twins, fans, selected, flips);
        flips.len() as u32
    }

    /// The verdict of every interior edge, counted.
    pub(crate) fn count(&mut self) -> Census {
        self.label();
        let mut halves = Census::default();
        for &verdict in &self.verdicts {
            match verdict {
                Verdict::Delaunay => {}
                Verdict::Labelled => halves.labelled += 1,
                Verdict::Blocked(reason) => halves.blocked[reason] += 1,
            }
        }
        halves.labelled /= 2;
        for reason in Reason::ALL {
            halves.blocked[reason] /= 2;
        }
        halves
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
        choose(selected, h, g);
        flip(triangles, twins, fans, selected, &[h]);
        release(selected, h);
        forget(verdicts, h, g);
    }

    /// Says whether the last test of every edge still holds; else the next iteration tests all of them.
    pub(super) fn set_tested(&mut self, is_tested: bool) {
        self.candidates.clear();
        self.flipped = is_tested.then(Vec::new);
    }
}

/// Selects the edge of two half-edges.
fn choose(selected: &mut [Selected], h: u32, g: u32) {
    (selected[h as usize / 3], selected[g as usize / 3]) = ([h, g], [g, h]);
}

/// Takes back that the edge of `h` is selected.
fn release(selected: &mut [Selected], h: u32) {
    let [_, g] = selected[h as usize / 3];
    (selected[h as usize / 3], selected[g as usize / 3]) = (FREE, FREE);
}

/// Takes all edges of the triangles of two half-edges for Delaunay.
fn forget(verdicts: &mut [Verdict], h: u32, g: u32) {
    for t in [h as usize / 3, g as usize / 3] {
        verdicts[3 * t..3 * t + 3].fill(Verdict::Delaunay);
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
        self.winding = Winding::new(&mesh, &self.twins);
        self.embedded = Embedded::new(&mesh, &self.twins, &self.winding);
        if mesh.dimension() == Dimension::Three {
            flag_creases(mesh.positions(), &self.triangles, &mut self.twins, self.cos);
        }
        self.verdicts.fill(Verdict::Delaunay);
        self.candidates.clear();
        self.flipped = None;
        self.selected.fill(FREE);
        self.changed.fill(0);
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
