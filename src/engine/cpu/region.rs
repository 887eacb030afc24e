//! Lawson's algorithm on a range of triangles: the whole mesh, or a region that defers the edges on its border.

use crate::mesh::half_edge::{FLAGS, next, prev, unflagged};
use crate::mesh::star::Fans;
use crate::phases::{
    Diamond, Geometry, Topology, Verdict, keep_non_delaunay, makes_duplicate, verdict_of_shape,
};
use crate::system::threads::Threads;
use crate::{NONE, Reason};
use std::ops::Range;

/// Triangles whose edges one pass tests before it flips.
const TRIANGLES: usize = 32;

/// The most edges of `TRIANGLES` triangles.
const EDGES: usize = 3 * TRIANGLES;

/// A range of triangles. The code reads and writes nothing outside it.
pub(super) struct Region<'a> {
    pub(super) geometry: &'a Geometry<'a>,
    pub(super) mesh: TopologyMut<'a>,
    pub(super) work: Work,
    /// The most flips.
    pub(super) limit: u32,
}

/// A [`Topology`] that can change.
pub(super) struct TopologyMut<'a> {
    pub(super) first: u32,
    pub(super) triangles: &'a mut [u32],
    pub(super) twins: &'a mut [u32],
    /// The fans of the whole mesh. A region has none: a mesh is divided only if every vertex has one fan.
    pub(super) fans: Option<&'a mut Fans>,
}

impl TopologyMut<'_> {
    /// Whether every vertex has one fan.
    pub(super) fn has_no_fans(&self) -> bool {
        self.fans.as_ref().is_none_or(|fans| fans.table.is_empty())
    }

    fn get(&self) -> Topology<'_> {
        const NO_FANS: &Fans = &Fans { table: Vec::new() };
        let fans = self.fans.as_deref().unwrap_or(NO_FANS);
        Topology { first: self.first, triangles: self.triangles, twins: self.twins, fans }
    }
}

/// The edges to flip, and the results so far.
#[derive(Default)]
pub(super) struct Work {
    queue: Queue,
    /// Half-edges of edges that may not flip.
    pub(super) blocked: Vec<u32>,
    /// Half-edges of edges that a region defers to the larger region that contains it, Delaunay or not.
    pub(super) deferred: Vec<u32>,
    /// Whether a blocked edge is a duplicate: a flip may remove the edge that blocks it.
    pub(super) has_duplicate: bool,
    pub(super) flips: u32,
}

impl Region<'_> {
    /// Tests all edges, and flips until no edge is left to flip. Divides the region down to `size` triangles and flips
    /// both halves in parallel, then the edges across their border.
    pub(super) fn flip_parts(&mut self, size: usize, threads: &Threads) {
        let TopologyMut { first, triangles, twins, .. } = &mut self.mesh;
        let count = triangles.len() / 3;
        if count <= size {
            self.flip_each();
        } else {
            let middle = 3 * (count / 2);
            let (triangles, twins) = (triangles.split_at_mut(middle), twins.split_at_mut(middle));
            let halves = [(*first, triangles.0, twins.0), (*first + middle as u32, triangles.1, twins.1)];
            let halves = halves.map(|(first, triangles, twins)| Region {
                geometry: self.geometry,
                mesh: TopologyMut { first, triangles, twins, fans: None },
                work: Work::default(),
                limit: self.limit / 3,
            });
            let halves = threads.map_each(halves.into(), |mut half| {
                half.flip_parts(size, threads);
                half.work
            });
            let mut deferred = Vec::new();
            for mut half in halves {
                deferred.append(&mut half.deferred);
                self.work.blocked.append(&mut half.blocked);
                self.work.has_duplicate |= half.has_duplicate;
                self.work.flips += half.flips;
            }
            self.flip_some(&deferred);
        }
    }

    /// Tests all edges, and flips until no edge is left to flip.
    fn flip_each(&mut self) {
        let end = self.mesh.twins.len() / 3;
        for first in (0..end).step_by(TRIANGLES) {
            let piece = first..end.min(first + TRIANGLES);
            let free = self.work.queue.free_slots(EDGES);
            let count = Diamond::write(self.mesh.get(), piece.clone(), free);
            self.defer(piece);
            self.test(count);
            self.flip_queue();
        }
    }

    /// Tests these edges, and flips until no edge is left to flip. Defers edges on the border of the region.
    pub(super) fn flip_some(&mut self, half_edges: &[u32]) {
        for half_edges in half_edges.chunks(EDGES) {
            let (mesh, free) = (self.mesh.get(), self.work.queue.free_slots(EDGES));
            let mut count = 0;
            for &h in half_edges {
                if mesh.has(unflagged(mesh.twin(h))) {
                    free[count] = Diamond::new(mesh, h);
                    count += 1;
                } else if mesh.leaves(h) {
                    self.work.deferred.push(h);
                }
            }
            self.test(count);
            self.flip_queue();
        }
    }

    /// Defers the edges between these triangles and triangles after the region. The regions before this one defer the
    /// edges to their triangles. No flip moves these half-edges, because `verdict` defers a flip that would.
    fn defer(&mut self, piece: Range<usize>) {
        let first = self.mesh.first + 3 * piece.start as u32;
        let end = self.mesh.first + self.mesh.twins.len() as u32;
        let behind = (NONE & !FLAGS) - end;
        let is_behind = |twin: u32| (twin & !FLAGS).wrapping_sub(end) < behind;
        let twins = &self.mesh.twins[3 * piece.start..3 * piece.end];
        if twins.iter().fold(false, |any, &twin| any | is_behind(twin)) {
            let twins = (first..).zip(twins);
            self.work.deferred.extend(twins.filter(|&(_, &twin)| is_behind(twin)).map(|(h, _)| h));
        }
    }

    /// Tests `count` edges in the slots behind the queue, and appends those that are not Delaunay to the queue.
    fn test(&mut self, count: usize) {
        let queue = &mut self.work.queue;
        queue.end += keep_non_delaunay(self.geometry, &mut queue.slots[queue.end..][..count]);
    }

    /// Flips the edges in the queue, and the edges around them.
    fn flip_queue(&mut self) {
        while self.work.flips < self.limit
            && let Some(Diamond { h, vertices, .. }) = self.work.queue.pop()
        {
            let mesh = self.mesh.get();
            let g = unflagged(mesh.twin(h));
            // After a flip, `h` may be on a boundary edge. It is never on the border of the region, because the
            // half-edges there do not move.
            if !mesh.has(g) {
                continue;
            }
            let diamond = Diamond::new(mesh, h);
            // If the vertices differ, a flip beside this edge has tested the edge again. They are compared word by
            // word: one wide read would wait for the narrow writes.
            if (0..4).fold(0, |bits, i| bits | vertices[i] ^ diamond.vertices[i]) != 0 {
                continue;
            }
            match self.verdict(&diamond) {
                Some(Verdict::Labelled) => {
                    let count = self.flip(&diamond);
                    self.test(count);
                }
                Some(verdict) => {
                    self.work.has_duplicate |= verdict == Verdict::Blocked(Reason::Duplicate);
                    self.work.blocked.push(h);
                }
                None => self.work.deferred.push(h),
            }
        }
        while let Some(diamond) = self.work.queue.pop() {
            self.work.deferred.push(diamond.h);
        }
    }

    /// Whether an edge that is not Delaunay may flip. `None` where the answer or the flip needs triangles outside the
    /// region.
    fn verdict(&self, diamond: &Diamond) -> Option<Verdict> {
        let shape = verdict_of_shape(self.geometry, diamond);
        if shape != Verdict::Labelled {
            return Some(shape);
        }
        let (h, [_, _, c, d]) = (diamond.h, diamond.vertices);
        let mesh = self.mesh.get();
        let is_duplicate = if self.mesh.fans.is_some() {
            makes_duplicate(self.geometry, mesh, h)
        } else if mesh.leaves(next(h)) || mesh.leaves(next(unflagged(diamond.twin))) {
            return None;
        } else {
            let is_embedded = self.geometry.embedded.at(c) || self.geometry.embedded.at(d);
            !is_embedded && makes_duplicate_inside(mesh, h)?
        };
        Some(if is_duplicate { Verdict::Blocked(Reason::Duplicate) } else { shape })
    }

    /// Flips one edge, and writes the edges around it to the slots behind the queue. Returns their number. An edge that
    /// may flip has different opposite vertices c and d. So no triangle beyond these edges is one of the two that flip.
    #[inline(always)]
    fn flip(&mut self, diamond: &Diamond) -> usize {
        self.work.flips += 1;
        let TopologyMut { first, triangles, twins, fans } = &mut self.mesh;
        let at = |x: u32| (x - *first) as usize;
        let &Diamond { h, twin, vertices: [a, b, c, d] } = diamond;
        let g = twin & !FLAGS;
        let [hn, hp, gn, gp] = [next(h), prev(h), next(g), prev(g)];
        if let Some(fans) = fans
            && !fans.table.is_empty()
        {
            fans.move_anchor(b, hn, g);
            fans.move_anchor(a, gn, h);
        }
        let outer = [gn, hp, hn, gp].map(|x| twins[at(x)]);
        for (inner, outer) in [(h, outer[0]), (g, outer[2])] {
            twins[at(inner)] = outer;
            if outer != NONE {
                twins[at(outer & !FLAGS)] = inner | (outer & FLAGS);
            }
        }
        triangles[at(hn)] = d;
        triangles[at(gn)] = c;
        twins[at(hn)] = gn;
        twins[at(gn)] = hn;
        let free = self.work.queue.free_slots(4);
        Diamond::write_around(self.mesh.get(), [h, hp, g, gp], outer, diamond.vertices, free)
    }
}

/// Whether a flip makes an edge that exists, in a mesh whose vertices have one fan each. `None` if both walks leave the
/// region before either gives the answer. As [`makes_duplicate`], it walks both stars in turns.
fn makes_duplicate_inside(mesh: Topology, h: u32) -> Option<bool> {
    let ends = [prev(h), prev(unflagged(mesh.twin(h)))];
    let [c, d] = ends.map(|h| mesh.vertex(h));
    if c == d {
        return Some(true);
    }
    let [mut at_c, mut at_d] = [Walk::new(ends[0], d), Walk::new(ends[1], c)];
    while at_c.is_inside || at_d.is_inside {
        for walk in [&mut at_c, &mut at_d] {
            if walk.is_inside
                && let Some(is_joined) = walk.step(mesh)
            {
                return Some(is_joined);
            }
        }
    }
    None
}

/// A walk around a vertex, from triangle to triangle of a region, in search of an edge to the vertex `to`.
struct Walk {
    start: u32,
    at: u32,
    to: u32,
    clockwise: bool,
    /// Whether it has not left the region.
    is_inside: bool,
}

impl Walk {
    fn new(start: u32, to: u32) -> Self {
        Self { start, at: start, to, clockwise: false, is_inside: true }
    }

    /// Visits one triangle. Returns whether the edge exists, once that is known.
    #[inline(always)]
    fn step(&mut self, mesh: Topology) -> Option<bool> {
        let side = prev(self.at);
        if mesh.vertex(next(self.at)) == self.to || mesh.vertex(side) == self.to {
            return Some(true);
        }
        if !self.clockwise {
            self.at = unflagged(mesh.twin(side));
            if self.at == self.start {
                return Some(false);
            }
            // The fan is open: the walk returns to its start and turns clockwise.
            self.clockwise = self.at == NONE;
        }
        if self.clockwise {
            let from = if self.at == NONE { self.start } else { self.at };
            match unflagged(mesh.twin(from)) {
                NONE => return Some(false),
                twin => self.at = next(twin),
            }
        }
        self.is_inside = mesh.has(self.at);
        None
    }
}

/// A queue of edges that were not Delaunay when they were tested. It is first in, first out, so the processor can start
/// on the next edge while it tests the edges around the last one.
#[derive(Default)]
struct Queue {
    slots: Vec<Diamond>,
    first: usize,
    /// The slots from here on are not in the queue.
    end: usize,
}

impl Queue {
    fn pop(&mut self) -> Option<Diamond> {
        if self.first == self.end {
            (self.first, self.end) = (0, 0);
            return None;
        }
        self.first += 1;
        Some(self.slots[self.first - 1])
    }

    /// `count` free slots behind the end.
    #[inline(always)]
    fn free_slots(&mut self, count: usize) -> &mut [Diamond] {
        if self.slots.len() < self.end + count {
            self.add_slots(count);
        }
        &mut self.slots[self.end..][..count]
    }

    #[cold]
    fn add_slots(&mut self, count: usize) {
        self.slots.copy_within(self.first..self.end, 0);
        (self.first, self.end) = (0, self.end - self.first);
        // Twice as many as needed, so that this is rare.
        let length = self.slots.len().max(2 * (self.end + count));
        self.slots.resize(length, Diamond::default());
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "what fails here is a failed test")]

    use super::*;
    use crate::families;
    use crate::mesh::embedded::Embedded;
    use crate::mesh::winding::Winding;
    use crate::phases::Thresholds;
    use crate::{Adjacency, Options};
    use proptest::prelude::*;
    use std::collections::VecDeque;

    /// For every region of surfaces with many duplicates: an answer of the region is the answer of the whole mesh, and
    /// the whole mesh as a region always answers.
    #[test]
    fn a_region_finds_the_duplicates_of_the_whole() {
        let (mut known, mut unknown) = ([0, 0], 0);
        for spec in ["uvsphere 5", "pillow 3", "pole 12"] {
            let mesh = families::by_name(spec).unwrap();
            let (triangles, twins) = (mesh.triangles(), Adjacency::new(&mesh).twins);
            let (winding, embedded) = (Winding::default(), Embedded::default());
            let thresholds = Thresholds::from(&Options::default());
            let (dimension, positions) = (mesh.dimension(), mesh.positions());
            let geometry = Geometry {
                dimension,
                positions,
                thresholds,
                winding: &winding,
                embedded: &embedded,
                has_infinite: false,
            };
            let fans = Fans::default();
            let whole = Topology { first: 0, triangles, twins: &twins, fans: &fans };
            let count = triangles.len();
            for (first, end) in
                (0..count).step_by(3).flat_map(|a| (a + 3..=count).step_by(3).map(move |b| (a, b)))
            {
                let (triangles, twins) = (&triangles[first..end], &twins[first..end]);
                let part = Topology { first: first as u32, triangles, twins, fans: &fans };
                for h in (first as u32..end as u32).filter(|&h| part.has(unflagged(part.twin(h)))) {
                    let expected = makes_duplicate(&geometry, whole, h);
                    match makes_duplicate_inside(part, h) {
                        Some(found) => {
                            assert_eq!(found, expected, "{spec}: {h} in {first}..{end}");
                            known[usize::from(found)] += 1;
                        }
                        None => {
                            assert!(end - first < count, "{spec}: {h}");
                            unknown += 1;
                        }
                    }
                }
            }
        }
        assert!(known.iter().all(|&count| count > 20) && unknown > 20, "{known:?}, {unknown}");
    }

    proptest! {
        /// Each step writes edges behind the queue, appends some of them, and pops some.
        #[test]
        fn the_queue_is_first_in_first_out(
            steps in proptest::collection::vec((0usize..20, 0usize..20, 0usize..12), 0..60)
        ) {
            let (mut queue, mut expected) = (Queue::default(), VecDeque::new());
            let mut numbers = 0..;
            for (written, appended, leaving) in steps {
                let appended = appended.min(written);
                for (slot, h) in queue.free_slots(written).iter_mut().zip(&mut numbers) {
                    slot.h = h;
                }
                let new = queue.slots[queue.end..][..appended].iter().map(|diamond| diamond.h);
                expected.extend(new);
                queue.end += appended;
                for _ in 0..leaving {
                    prop_assert_eq!(queue.pop().map(|diamond| diamond.h), expected.pop_front());
                }
            }
        }
    }
}
