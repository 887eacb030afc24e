//! The phases on the CPU, an edge at a time and on several threads: the edges that are not Delaunay are kept in lists,
//! and an edge is tested again only where one of its triangles has flipped.

use super::region::TopologyMut;
use super::{Answer, Census, EdgeCounts, Engine};
use crate::adjacency::{CREASE, FLAGS, LOCKED, prev, unflagged};
use crate::embedded::Embedded;
use crate::locks;
use crate::mesh::{Dimension, Mesh};
use crate::phases::{
    Around, Diamond, Geometry, Selected, Thresholds, Topology, Verdict, flag_creases, flip,
    keep_non_delaunay, key, makes_duplicate, move_anchors, verdict, verdict_of_shape, yields,
};
use crate::star::Fans;
use crate::threads::{Threads, Word, shared};
use crate::winding::Winding;
use crate::{Adjacency, NONE};
use std::hint::black_box;
use std::ops::Range;
use std::sync::Arc;
use std::sync::atomic::AtomicU32;

/// Edges that are tested in one go.
const EDGES: usize = 256;

/// An edge by its half-edges, the lower one first.
type Edge = [u32; 2];

/// In the second half-edge of a candidate: it makes an edge that exists.
const DUPLICATE: u32 = LOCKED;

/// In the second half-edge of a candidate: it may make such an edge after other flips.
const GUARDED: u32 = CREASE;

/// The edges that are not Delaunay.
#[derive(Default)]
struct Found {
    /// Those that may flip, or could but for a duplicate.
    candidates: Vec<Edge>,
    /// A half-edge of each of the others, beside some of edges that have gone since.
    blocked: Vec<u32>,
}

impl Found {
    fn append(&mut self, parts: Vec<Self>, threads: &Threads) {
        let (candidates, blocked) = parts.into_iter().map(|part| (part.candidates, part.blocked)).unzip();
        threads.append_all(&mut self.candidates, candidates);
        threads.append_all(&mut self.blocked, blocked);
    }
}

/// Reads words ahead of their use: in a loop so short, the processor waits for many of them at once.
#[inline(always)]
fn touch(words: impl Iterator<Item = u32>) {
    black_box(words.fold(0, |all, word| all ^ word));
}

fn geometry_of<'a>(
    mesh: &'a Mesh,
    winding: &'a Winding,
    embedded: &'a Embedded,
    thresholds: Thresholds,
) -> Geometry<'a> {
    Geometry { dimension: mesh.dimension(), positions: mesh.positions(), thresholds, winding, embedded }
}

/// The state of a mesh between two iterations.
pub(crate) struct Cpu {
    pub(super) threads: Threads,
    mesh: Arc<Mesh>,
    thresholds: Thresholds,
    winding: Winding,
    embedded: Embedded,
    counts: EdgeCounts,
    pub(crate) triangles: Vec<u32>,
    pub(crate) twins: Vec<u32>,
    pub(crate) fans: Fans,
    found: Found,
    /// The edges that the last iteration has flipped; `None` before the first.
    flipped: Option<Vec<Edge>>,
    /// What is around each of those now, and some more.
    around: Vec<Around>,
    /// Those edges by triangle.
    selected: Selected,
    /// For each vertex whose star is not known to be embedded the last iteration, plus one, in which an edge there came
    /// or went.
    changed: Vec<AtomicU32>,
    iteration: u32,
}

impl Cpu {
    /// Builds the adjacency.
    pub(crate) fn new(mesh: Arc<Mesh>, thresholds: Thresholds, threads: Threads) -> Self {
        let threads = threads.for_triangles(mesh.triangle_count());
        threads.clone().enter(|| Self::prepared(mesh, thresholds, threads))
    }

    fn prepared(mesh: Arc<Mesh>, thresholds: Thresholds, threads: Threads) -> Self {
        let adjacency = Adjacency::of_triangles(mesh.vertex_count(), mesh.triangles(), &threads);
        let (winding, embedded) = Embedded::with_winding(&mesh, &adjacency.twins, &threads);
        let counts = EdgeCounts::from(&adjacency);
        let triangles = mesh.triangles().to_vec();
        let fans = embedded.fans(&mesh, &adjacency.twins, &threads);
        let mut twins = adjacency.twins;
        if mesh.dimension() == Dimension::Three {
            flag_creases(mesh.positions(), &triangles, &mut twins, thresholds.cos, &threads);
        }
        Self {
            threads,
            thresholds,
            winding,
            embedded,
            counts,
            fans,
            found: Found::default(),
            flipped: None,
            around: Vec::new(),
            selected: Selected::new(triangles.len() / 3),
            changed: std::iter::repeat_with(AtomicU32::default).take(mesh.vertex_count()).collect(),
            iteration: 0,
            triangles,
            twins,
            mesh,
        }
    }

    pub(super) fn geometry(&self) -> Geometry<'_> {
        let Self { mesh, winding, embedded, thresholds, .. } = self;
        geometry_of(mesh, winding, embedded, *thresholds)
    }

    pub(super) fn topology(&self) -> Topology<'_> {
        Topology { first: 0, triangles: &self.triangles, twins: &self.twins, fans: &self.fans }
    }

    /// Label: tests the edges around those that have flipped, which are Delaunay now, and all edges before the first
    /// iteration; looks for duplicates again where one may have come or gone.
    pub(super) fn label(&mut self) {
        let Found { candidates, blocked } = std::mem::take(&mut self.found);
        let mut found = Found { blocked, ..Found::default() };
        let append = |found: &mut Found, parts| found.append(parts, &self.threads);
        if let Some(flipped) = &self.flipped {
            let keep =
                |piece: Range<usize>, found: &mut Found| self.keep_candidates(&candidates[piece], found);
            self.threads.extend(&mut found, candidates.len(), keep, append);
            let test = |piece: Range<usize>, found: &mut Found| {
                self.test_around(&flipped[piece.clone()], &self.around[piece], found);
            };
            self.threads.extend(&mut found, flipped.len(), test, append);
        } else {
            found.blocked.clear();
            self.threads.extend(
                &mut found,
                self.twins.len() / 3,
                |piece, found| self.test_all(piece, found),
                append,
            );
        }
        self.found = found;
        self.flipped.get_or_insert_default().clear();
    }

    /// Tests the edges whose lower half-edges are of these triangles.
    fn test_all(&self, range: Range<usize>, found: &mut Found) {
        let mut diamonds = [Diamond::default(); EDGES];
        for first in range.clone().step_by(EDGES / 3) {
            let piece = first..range.end.min(first + EDGES / 3);
            let count = Diamond::write(self.topology(), piece, &mut diamonds);
            self.test(&mut diamonds[..count], found);
        }
    }

    /// Finds the candidates of which no triangle has flipped.
    fn keep_candidates(&self, candidates: &[Edge], found: &mut Found) {
        for &[h, twin] in candidates {
            let g = unflagged(twin);
            if self.selected.is_free(h) && self.selected.is_free(g) {
                let is_open = twin & GUARDED != 0
                    && [h, g].iter().all(|&x| self.has_changed(self.triangles[prev(x) as usize]));
                found.candidates.push(if is_open { self.guarded([h, g]) } else { [h, twin] });
            }
        }
    }

    /// Tests the edges around those that have flipped, whose triangles are free again.
    fn test_around(&self, flipped: &[Edge], around: &[Around], found: &mut Found) {
        let mesh = self.topology();
        let mut diamonds = [Diamond::default(); EDGES];
        for (flipped, around) in flipped.chunks(EDGES / 4).zip(around.chunks(EDGES / 4)) {
            let far = around.iter().flat_map(|[outer, _]| outer).map(|twin| (twin & !FLAGS) as usize);
            touch(far.map(|g| *self.triangles.get(g).unwrap_or(&0)));
            let mut count = 0;
            for (&[h, g], &[outer, corners]) in flipped.iter().zip(around) {
                self.selected.release([h, g]);
                let (sides, room) = ([h, prev(h), g, prev(g)], &mut diamonds[count..]);
                count += Diamond::write_around(mesh, sides, outer, corners, room);
            }
            self.test(&mut diamonds[..count], found);
        }
    }

    fn test(&self, diamonds: &mut [Diamond], found: &mut Found) {
        let geometry = self.geometry();
        let count = keep_non_delaunay(&geometry, diamonds);
        for diamond in &diamonds[..count] {
            let (h, g, [_, _, c, d]) = (diamond.h, unflagged(diamond.twin), diamond.corners);
            let edge = [h.min(g), h.max(g)];
            match verdict_of_shape(&geometry, diamond) {
                Verdict::Labelled if self.embedded.at(c) | self.embedded.at(d) => found.candidates.push(edge),
                Verdict::Labelled => found.candidates.push(self.guarded(edge)),
                _ => found.blocked.push(h),
            }
        }
    }

    /// A candidate, once it is known whether it makes a duplicate.
    fn guarded(&self, [h, g]: Edge) -> Edge {
        let is_duplicate = makes_duplicate(&self.geometry(), self.topology(), h);
        [h, g | GUARDED | if is_duplicate { DUPLICATE } else { 0 }]
    }

    /// Whether an edge at `v` has come or gone in the last iteration, as far as that is of interest.
    fn has_changed(&self, v: u32) -> bool {
        self.iteration > 0 && self.changed[v as usize].get() == self.iteration
    }

    /// Select: the edges that flip are those with the smallest key in both their triangles, but for those that yield.
    fn select(&mut self) {
        let Self { threads, selected, iteration, found: Found { candidates, .. }, .. } = &*self;
        threads.map(candidates.len(), |piece| {
            for &[h, twin] in &candidates[piece] {
                if twin & DUPLICATE == 0 {
                    selected.bid([h, unflagged(twin)], key(h, *iteration));
                }
            }
        });
        let append = |all: &mut Vec<Edge>, parts| threads.append_all(all, parts);
        let mut flips = Vec::new();
        let win = |piece: Range<usize>, flips: &mut Vec<Edge>| {
            let mut count = flips.len();
            flips.resize(count + piece.len(), [0; 2]);
            for &[h, twin] in &candidates[piece] {
                flips[count] = [h, twin];
                let has_won = selected.has_won([h, unflagged(twin)], key(h, *iteration));
                count += usize::from(has_won & (twin & DUPLICATE == 0));
            }
            flips.truncate(count);
        };
        threads.extend(&mut flips, candidates.len(), win, append);
        threads.map(candidates.len(), |piece| {
            candidates[piece].iter().for_each(|&[h, twin]| selected.release([h, unflagged(twin)]));
        });
        threads.map(flips.len(), |piece| {
            flips[piece].iter().for_each(|&[h, twin]| selected.choose([h, unflagged(twin)]));
        });
        let mut yielding = Vec::new();
        let yields = |piece: Range<usize>, yielding: &mut Vec<Edge>| {
            let guarded = flips[piece].iter().filter(|[_, twin]| twin & GUARDED != 0);
            let guarded = guarded.map(|&[h, twin]| [h, unflagged(twin)]);
            yielding.extend(
                guarded.filter(|&[h, g]| yields(self.topology(), *iteration, h, g, |t| selected.pair(t))),
            );
        };
        threads.extend(&mut yielding, flips.len(), yields, append);
        if !yielding.is_empty() {
            yielding.iter().for_each(|&edge| selected.release(edge));
            flips.retain(|&[h, _]| !selected.is_free(h));
        }
        flips.iter_mut().for_each(|[_, twin]| *twin = unflagged(*twin));
        self.flipped = Some(flips);
    }

    /// Flip with Update. Returns the number of flips.
    fn flip(&mut self) -> u32 {
        let Self { threads, triangles, twins, fans, selected, changed, embedded, iteration, around, .. } =
            self;
        let flips = self.flipped.as_deref().unwrap_or_default();
        *iteration += 1;
        move_anchors(fans, triangles, selected, flips);
        let (triangles, twins) = (shared(triangles), shared(twins));
        if around.len() < flips.len() {
            drop(std::mem::take(around));
            *around = vec![Around::default(); flips.len()];
        }
        threads.fill(flips, &mut around[..flips.len()], |flips, around| {
            for (flips, around) in flips.chunks(EDGES / 4).zip(around.chunks_mut(EDGES / 4)) {
                let own = flips.iter().flatten().map(|&x| x as usize);
                touch(own.map(|x| twins[x].get() ^ triangles[x].get()));
                for (&edge, around) in flips.iter().zip(around) {
                    *around = flip(triangles, twins, selected, edge);
                    for v in around[1] {
                        if !embedded.at(v) {
                            changed[v as usize].set(*iteration);
                        }
                    }
                }
            }
        });
        flips.len() as u32
    }

    /// Counts the edges that are not Delaunay: tests those again that have been found so.
    pub(crate) fn count(&mut self) -> Census {
        self.label();
        let Found { candidates, blocked } = &self.found;
        let mut census = Census::default();
        if candidates.is_empty() & blocked.is_empty() {
            return census;
        }
        let mut is_counted = vec![false; self.twins.len()];
        for &h in candidates.iter().map(|[h, _]| h).chain(blocked) {
            let g = unflagged(self.twins[h as usize]);
            if g == NONE || std::mem::replace(&mut is_counted[h.min(g) as usize], true) {
                continue;
            }
            match verdict(&self.geometry(), self.topology(), h) {
                Verdict::Delaunay => {}
                Verdict::Labelled => census.labelled += 1,
                Verdict::Blocked(reason) => census.blocked[reason] += 1,
            }
        }
        census
    }
}

/// What Lawson's algorithm needs of it.
impl Cpu {
    pub(super) fn parts(&mut self) -> (Geometry<'_>, TopologyMut<'_>) {
        let Self { mesh, winding, embedded, thresholds, triangles, twins, fans, .. } = self;
        let geometry = geometry_of(mesh, winding, embedded, *thresholds);
        (geometry, TopologyMut { first: 0, triangles, twins, fans: Some(fans) })
    }

    /// After flips of others: all edges are Delaunay but some of these, or else, as at first, none is known.
    pub(super) fn settle(&mut self, others: Vec<u32>, is_known: bool) {
        self.found = Found { blocked: others, ..Found::default() };
        self.flipped = is_known.then(Vec::new);
    }
}

impl Engine for Cpu {
    fn lock(&mut self, half_edges: Vec<u32>) -> Answer<'_, ()> {
        locks::flag(&mut self.twins, &half_edges);
        Box::pin(std::future::ready(Ok(())))
    }

    fn iterate(&mut self, count: u32) -> Answer<'_, Vec<u32>> {
        let threads = self.threads.clone();
        let mut flips = Vec::new();
        threads.enter(|| {
            while (flips.len() as u32) < count {
                self.label();
                self.select();
                match self.flip() {
                    0 => break,
                    flipped => flips.push(flipped),
                }
            }
        });
        Box::pin(std::future::ready(Ok(flips)))
    }

    fn census(&mut self) -> Answer<'_, Census> {
        Box::pin(std::future::ready(Ok(self.count())))
    }

    fn triangles(&mut self) -> Answer<'_, Vec<u32>> {
        let mut triangles = Vec::new();
        self.threads.append(&mut triangles, &self.triangles);
        Box::pin(std::future::ready(Ok(triangles)))
    }

    fn twins(&mut self) -> Answer<'_, Vec<u32>> {
        Box::pin(std::future::ready(Ok(self.twins.clone())))
    }

    fn set_positions(&mut self, mesh: Arc<Mesh>) -> Answer<'_, ()> {
        (self.winding, self.embedded) = Embedded::with_winding(&mesh, &self.twins, &self.threads);
        if mesh.dimension() == Dimension::Three {
            flag_creases(
                mesh.positions(),
                &self.triangles,
                &mut self.twins,
                self.thresholds.cos,
                &self.threads,
            );
        }
        self.found = Found::default();
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
