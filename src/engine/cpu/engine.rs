//! The phases on the CPU, edge by edge, on several threads. Lists hold the edges that are not Delaunay. An edge is
//! tested again only if one of its triangles has flipped.

use super::motion::Motion;
use super::region::TopologyMut;
use crate::engine::{Census, EdgeCounts};
use crate::mesh::arrangement::Arrangement;
use crate::mesh::embedded::Embedded;
use crate::mesh::half_edge::{self, CREASE, FLAGS, LOCKED, prev, unflagged};
use crate::mesh::recent::Joined;
use crate::mesh::star::Fans;
use crate::mesh::winding::{Outline, Winding};
use crate::phases::{
    Around, Diamond, Geometry, Selected, Thresholds, Topology, Verdict, flag_creases, flip,
    keep_non_delaunay, key, makes_duplicate, move_anchors, verdict, verdict_of_shape, yields,
};
use crate::system::threads::{Threads, Word, shared};
use crate::{Dimension, Mesh, NONE};
use std::hint::black_box;
use std::ops::Range;
use std::sync::Arc;

/// Edges that one pass tests.
const EDGES: usize = 256;

/// The fewest candidates of a part. With fewer, one thread finishes before another starts.
const FEWEST: usize = if cfg!(debug_assertions) { 4 } else { 512 };

/// An edge by its half-edges, as [`Arrangement::ordered`] has them.
type Edge = [u32; 2];

/// Flag in the second half-edge of a candidate: its flip would make an edge that exists.
const DUPLICATE: u32 = LOCKED;

/// Flag in the second half-edge of a candidate: after other flips, its flip may make an edge that exists.
const GUARDED: u32 = CREASE;

/// Some of the edges that are not Delaunay, for one thread. No bit of the result depends on how the edges are divided
/// into parts.
#[derive(Default)]
struct Part {
    /// Edges that may flip, or are blocked only as duplicates.
    candidates: Vec<Edge>,
    /// One half-edge of each edge that is blocked for another reason; also of some edges that no longer exist.
    blocked: Vec<u32>,
    /// Edges that the last iteration has flipped.
    flipped: Vec<Edge>,
    /// The surroundings of each flipped edge.
    around: Vec<Around>,
    /// Half-edges that won the bid for their own triangle only.
    vain: Vec<u32>,
}

/// Brings words into the cache before they are used. The loop is so short that the processor fetches many of them at
/// the same time.
#[inline(always)]
fn touch(words: impl Iterator<Item = u32>) {
    black_box(words.fold(0, |all, word| all ^ word));
}

/// The state of a mesh between two iterations.
pub(crate) struct Cpu {
    pub(super) threads: Threads,
    /// The mesh in the order of `arrangement`, as everything below.
    pub(super) mesh: Arc<Mesh>,
    pub(super) arrangement: Arrangement,
    pub(super) thresholds: Thresholds,
    pub(super) winding: Winding,
    pub(super) embedded: Embedded,
    /// Filled in if the winding depends on the components.
    pub(super) outline: Option<Outline>,
    pub(super) counts: EdgeCounts,
    pub(crate) triangles: Vec<u32>,
    pub(crate) twins: Vec<u32>,
    pub(crate) fans: Fans,
    parts: Vec<Part>,
    /// More blocked edges, from parts that `deal` has replaced.
    blocked: Vec<Vec<u32>>,
    /// Whether `parts` and `blocked` have all edges that are not Delaunay. False before the first iteration.
    is_known: bool,
    /// The edges that flip, by triangle. `label` makes it when it tests all edges.
    selected: Selected,
    /// For each vertex whose star is not known to be embedded: one plus the index of the last iteration that added or
    /// removed an edge at this vertex. `label` makes it when it tests all edges.
    changed: Vec<u32>,
    pub(super) iteration: u32,
    /// What the updates have made of the mesh.
    pub(super) moving: Motion,
}

impl Cpu {
    /// Builds the adjacency.
    #[cfg(any(test, feature = "gpu"))]
    pub(crate) fn new(mesh: Arc<Mesh>, thresholds: Thresholds, threads: Threads) -> Self {
        Self::with(Arrangement::default(), mesh, thresholds, threads)
    }

    /// The same, after arranging a mesh whose neighbours are far from each other in memory.
    pub(crate) fn arranged(mesh: Arc<Mesh>, thresholds: Thresholds, threads: Threads) -> Self {
        let threads = threads.for_triangles(mesh.triangle_count());
        threads.clone().enter(|| match Arrangement::of(&mesh, &threads) {
            Some((arrangement, mesh)) => Self::with(arrangement, Arc::new(mesh), thresholds, threads),
            None => Self::with(Arrangement::default(), mesh, thresholds, threads),
        })
    }

    /// The locked half-edges.
    pub(super) fn locked(&self) -> Vec<u32> {
        half_edge::locked(&self.arrangement.named_twins(&self.twins, &self.threads))
    }

    /// Becomes a new engine, arranged for `mesh`, with these locked half-edges.
    pub(super) fn begin_again(&mut self, mesh: Arc<Mesh>, locked: Vec<u32>) {
        // Frees the memory that the new engine needs.
        (self.triangles, self.twins, self.blocked) = (Vec::new(), Vec::new(), Vec::new());
        self.arrangement = Arrangement::default();
        let changes = vec![0; self.moving.changes.len()];
        *self = Self::arranged(mesh, self.thresholds, self.threads.clone());
        half_edge::lock(&mut self.twins, &self.arrangement.half_edges(locked));
        self.moving.changes = changes;
    }

    pub(super) fn with(
        arrangement: Arrangement,
        mesh: Arc<Mesh>,
        thresholds: Thresholds,
        threads: Threads,
    ) -> Self {
        let threads = threads.for_triangles(mesh.triangle_count());
        threads.clone().enter(|| Self::prepared(arrangement, mesh, thresholds, threads))
    }

    fn prepared(arrangement: Arrangement, mesh: Arc<Mesh>, thresholds: Thresholds, threads: Threads) -> Self {
        let Joined { adjacency, winding, embedded, outline } = Joined::new(&mesh, &threads);
        let counts = EdgeCounts::from(&adjacency);
        let triangles = threads.copied(mesh.triangles());
        let fans = embedded.fans(&mesh, &adjacency.twins, &threads);
        let mut twins = adjacency.twins;
        if mesh.dimension() == Dimension::Three {
            flag_creases(mesh.positions(), &triangles, &mut twins, thresholds.cos, false, &threads);
        }
        Self {
            thresholds,
            winding,
            embedded,
            outline,
            counts,
            fans,
            parts: Vec::new(),
            blocked: Vec::new(),
            is_known: false,
            selected: Selected::default(),
            changed: Vec::new(),
            iteration: 0,
            moving: Motion::default(),
            triangles,
            twins,
            mesh,
            arrangement,
            threads,
        }
    }

    pub(in crate::engine) fn geometry(&self) -> Geometry<'_> {
        let &Self { ref mesh, ref winding, ref embedded, thresholds, .. } = self;
        self.moving.geometry(mesh, winding, embedded, thresholds)
    }

    pub(in crate::engine) fn topology(&self) -> Topology<'_> {
        Topology { first: 0, triangles: &self.triangles, twins: &self.twins, fans: &self.fans }
    }

    /// Label: tests the edges around the flipped edges, or all edges before the first iteration. The flipped edges
    /// themselves are Delaunay now. Tests for duplicates again where an edge may have come or gone.
    pub(in crate::engine) fn label(&mut self) {
        let mut parts = std::mem::take(&mut self.parts);
        if self.is_known {
            self.threads.each(&mut parts, |part| self.keep_candidates(&mut part.candidates));
            self.threads.each(&mut parts, |part| self.test_around(part));
        } else {
            self.blocked.clear();
            self.selected = Selected::new(self.twins.len() / 3, &self.threads);
            self.changed = self.threads.zeros(self.mesh.vertex_count());
            parts = self.threads.map(self.twins.len() / 3, |piece| self.test_all(piece));
        }
        self.is_known = true;
        self.parts = parts;
        self.deal();
    }

    /// Tests the edges whose lower half-edge belongs to a triangle in `range`.
    fn test_all(&self, range: Range<usize>) -> Part {
        let mut part = Part::default();
        let mut diamonds = [Diamond::default(); EDGES];
        for first in range.clone().step_by(EDGES / 3) {
            let piece = first..range.end.min(first + EDGES / 3);
            let count = Diamond::write(self.topology(), piece, &mut diamonds);
            self.test(&mut diamonds[..count], &mut part.candidates, &mut part.blocked);
        }
        part
    }

    /// Keeps the candidates none of whose triangles has flipped.
    fn keep_candidates(&self, candidates: &mut Vec<Edge>) {
        let mut count = 0;
        for i in 0..candidates.len() {
            let [h, twin] = candidates[i];
            let g = unflagged(twin);
            let is_kept = self.selected.is_free(h) & self.selected.is_free(g);
            let is_open = is_kept
                && twin & GUARDED != 0
                && [h, g].iter().all(|&x| self.has_changed(self.triangles[prev(x) as usize]));
            candidates[count] = if is_open { self.guarded([h, g]) } else { [h, twin] };
            count += usize::from(is_kept);
        }
        candidates.truncate(count);
    }

    /// Tests the edges around the flipped edges, and releases the triangles of the flipped edges.
    fn test_around(&self, part: &mut Part) {
        let Part { candidates, blocked, flipped, around, .. } = part;
        let mesh = self.topology();
        let mut diamonds = [Diamond::default(); EDGES];
        for (flipped, around) in flipped.chunks(EDGES / 4).zip(around.chunks(EDGES / 4)) {
            let far = around.iter().flat_map(|[outer, _]| outer).map(|twin| (twin & !FLAGS) as usize);
            touch(far.map(|g| *self.triangles.get(g).unwrap_or(&0)));
            let mut count = 0;
            for (&[h, g], &[outer, vertices]) in flipped.iter().zip(around) {
                self.selected.release(h);
                self.selected.release(g);
                let (sides, free) = ([h, prev(h), g, prev(g)], &mut diamonds[count..]);
                count += Diamond::write_around(mesh, sides, outer, vertices, free);
            }
            self.test(&mut diamonds[..count], candidates, blocked);
        }
        flipped.clear();
    }

    fn test(&self, diamonds: &mut [Diamond], candidates: &mut Vec<Edge>, blocked: &mut Vec<u32>) {
        let geometry = self.geometry();
        let count = keep_non_delaunay(&geometry, diamonds);
        for diamond in &diamonds[..count] {
            let (h, g, [_, _, c, d]) = (diamond.h, unflagged(diamond.twin), diamond.vertices);
            let edge = self.arrangement.ordered([h, g]);
            match verdict_of_shape(&geometry, diamond) {
                Verdict::Labelled if self.embedded.at(c) | self.embedded.at(d) => candidates.push(edge),
                Verdict::Labelled => candidates.push(self.guarded(edge)),
                _ => blocked.push(h),
            }
        }
    }

    /// Divides the candidates again if one part has many more than the others, or if every part has few.
    fn deal(&mut self) {
        let sizes = self.parts.iter().map(|part| part.candidates.len());
        let (total, most) = (sizes.clone().sum(), sizes.max().unwrap_or(0));
        let pieces = self.threads.pieces(total, FEWEST);
        if self.parts.len() < 2 * pieces.len() && most <= 2 * pieces[0].len() {
            return;
        }
        let parts = std::mem::take(&mut self.parts);
        self.parts = self.threads.map_each(pieces, |Range { start, end }| {
            let (mut candidates, mut before) = (Vec::with_capacity(end - start), 0);
            for part in &parts {
                let within = |at: usize| at.saturating_sub(before).min(part.candidates.len());
                candidates.extend_from_slice(&part.candidates[within(start)..within(end)]);
                before += part.candidates.len();
            }
            Part { candidates, ..Part::default() }
        });
        self.blocked.extend(parts.into_iter().map(|part| part.blocked).filter(|blocked| !blocked.is_empty()));
    }

    /// A candidate, flagged as guarded, and as a duplicate if its flip would make an edge that exists.
    fn guarded(&self, [h, g]: Edge) -> Edge {
        let is_duplicate = makes_duplicate(&self.geometry(), self.topology(), h);
        [h, g | GUARDED | if is_duplicate { DUPLICATE } else { 0 }]
    }

    /// Whether the last iteration added or removed an edge at `v`. Tracked only for stars not known to be embedded.
    fn has_changed(&self, v: u32) -> bool {
        self.iteration > 0 && self.changed[v as usize] == self.iteration
    }

    /// Select: an edge flips if it has the smallest key in both its triangles and does not yield.
    fn select(&mut self) {
        let mut parts = std::mem::take(&mut self.parts);
        let Self { threads, selected, arrangement, iteration, .. } = &*self;
        let key = |h: u32| key(arrangement.name(h), *iteration);
        let is_alone = threads.is_one();
        threads.each(&mut parts, |part| {
            for &[h, twin] in &part.candidates {
                if twin & DUPLICATE == 0 {
                    selected.bid([h, unflagged(twin)], key(h), is_alone);
                }
            }
        });
        threads.each(&mut parts, |Part { candidates, flipped, vain, .. }| {
            let (mut wins, mut halves) = ([[0; 2]; EDGES], [0; EDGES]);
            for candidates in candidates.chunks(EDGES) {
                let mut counts = [0; 2];
                for &[h, twin] in candidates {
                    let g = unflagged(twin);
                    let may = twin & DUPLICATE == 0;
                    let [has_h, has_g] = [h, g].map(|x| may & selected.has_won(x, key(h)));
                    wins[counts[0]] = [h, twin];
                    counts[0] += usize::from(has_h & has_g);
                    halves[counts[1]] = if has_h { h } else { g };
                    counts[1] += usize::from(has_h ^ has_g);
                }
                flipped.extend_from_slice(&wins[..counts[0]]);
                vain.extend_from_slice(&halves[..counts[1]]);
            }
        });
        let guarded = threads.each(&mut parts, |Part { flipped, vain, .. }| {
            vain.drain(..).for_each(|x| selected.release(x));
            flipped.iter().for_each(|&[h, twin]| selected.choose([h, unflagged(twin)]));
            flipped.iter().fold(0, |all, [_, twin]| all | twin) & GUARDED != 0
        });
        let find_yielding = |part: &mut Part| {
            let mut is_yielding = false;
            for [h, twin] in part.flipped.iter_mut().filter(|[_, twin]| twin & GUARDED != 0) {
                *twin = unflagged(*twin);
                let key = |edge: Edge| key(arrangement.ordered(edge)[0]);
                if yields(self.topology(), key, [*h, *twin], |t| selected.pair(t)) {
                    *twin |= DUPLICATE;
                    is_yielding = true;
                }
            }
            is_yielding
        };
        if guarded.contains(&true) && threads.each(&mut parts, find_yielding).contains(&true) {
            threads.each(&mut parts, |part| {
                part.flipped.retain(|&[h, twin]| {
                    let is_yielding = twin & DUPLICATE != 0;
                    if is_yielding {
                        selected.release(h);
                        selected.release(unflagged(twin));
                    }
                    !is_yielding
                });
            });
        }
        self.parts = parts;
    }

    /// Flip and update. Returns the number of flips.
    fn flip(&mut self) -> u32 {
        let Self { threads, triangles, twins, fans, selected, changed, embedded, .. } = self;
        let Self { iteration, parts, moving, .. } = self;
        *iteration += 1;
        for part in &*parts {
            move_anchors(fans, triangles, selected, &part.flipped);
        }
        let (triangles, twins, changed) = (shared(triangles), shared(twins), shared(changed));
        threads.each(parts, |Part { flipped, around, .. }| {
            around.clear();
            around.reserve_exact(flipped.len());
            for flipped in flipped.chunks(EDGES / 4) {
                let own = flipped.iter().flatten().map(|&x| x as usize);
                touch(own.map(|x| twins[x].get() ^ triangles[x].get()));
                around.extend(flipped.iter().map(|&edge| {
                    let around = flip(triangles, twins, selected, edge);
                    for v in around[1] {
                        if !embedded.at(v) {
                            changed[v as usize].set(*iteration);
                        }
                    }
                    around
                }));
            }
        });
        let Motion { changes, updates, .. } = moving;
        if !changes.is_empty() {
            for half_edge in parts.iter().flat_map(|part| part.flipped.as_flattened()) {
                changes[unflagged(*half_edge) as usize / 3] = *updates;
            }
        }
        parts.iter().map(|part| part.flipped.len() as u32).sum()
    }

    /// Runs up to `count` iterations, and returns the flips of each.
    pub(super) fn run(&mut self, count: u32) -> Vec<u32> {
        let mut flips = Vec::new();
        while (flips.len() as u32) < count {
            self.label();
            self.select();
            match self.flip() {
                0 => break,
                flipped => flips.push(flipped),
            }
        }
        flips
    }

    /// Counts the edges that are not Delaunay, by testing the edges in the lists again.
    pub(crate) fn count(&mut self) -> Census {
        self.label();
        let candidates = self.parts.iter().flat_map(|part| &part.candidates).map(|[h, _]| h);
        let blocked = self.parts.iter().map(|part| &part.blocked).chain(&self.blocked).flatten();
        let mut found = candidates.chain(blocked).peekable();
        let mut census = Census::default();
        if found.peek().is_none() {
            return census;
        }
        let mut is_counted = vec![false; self.twins.len()];
        for &h in found {
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

/// What Lawson's algorithm needs.
impl Cpu {
    pub(super) fn parts(&mut self) -> (Geometry<'_>, TopologyMut<'_>) {
        let Self { mesh, winding, embedded, thresholds, triangles, twins, fans, moving, .. } = self;
        let geometry = moving.geometry(mesh, winding, embedded, *thresholds);
        (geometry, TopologyMut { first: 0, triangles, twins, fans: Some(fans) })
    }

    /// Resets the lists after flips outside of the phases. If `is_known`, every edge that is not Delaunay is in
    /// `blocked`.
    pub(super) fn settle(&mut self, blocked: Vec<u32>, is_known: bool) {
        self.parts.clear();
        self.blocked = vec![blocked];
        self.is_known = is_known;
    }
}
