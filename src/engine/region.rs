//! Lawson's algorithm on neighbouring triangles: all of a mesh, or a part that leaves its other edges to where it is joined.

use crate::adjacency::{FLAGS, next, prev, unflagged};
use crate::phases::{
    Diamond, Geometry, Topology, Verdict, keep_non_delaunay, makes_duplicate, verdict_of_shape,
};
use crate::star::Fans;
use crate::threads::Threads;
use crate::{NONE, Reason};
use std::ops::Range;

/// Edges that are tested in one go, before those of them that are not Delaunay flip.
const EDGES: usize = 64;

/// Triangles that follow each other, with nothing outside of them read or written.
pub(super) struct Region<'a> {
    pub(super) geometry: &'a Geometry<'a>,
    pub(super) mesh: TopologyMut<'a>,
    pub(super) work: Work,
    /// Flips that are left.
    pub(super) limit: u32,
}

/// The triangulation, as [`Topology`].
pub(super) struct TopologyMut<'a> {
    pub(super) first: u32,
    pub(super) triangles: &'a mut [u32],
    pub(super) twins: &'a mut [u32],
    /// Those of the whole mesh; a part has none, and every star there is embedded that a flip needs to be.
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

/// What is to be done, and what has been.
#[derive(Default)]
pub(super) struct Work {
    /// Half-edges of edges that were not Delaunay when they were tested last; others may have flipped since.
    pub(super) pending: Vec<u32>,
    /// Those of them that may not flip.
    pub(super) blocked: Vec<u32>,
    /// Those of edges that a part leaves to the larger one that it is a half of, Delaunay or not.
    pub(super) left: Vec<u32>,
    /// Whether one of the blocked is so by an edge that may go.
    pub(super) has_duplicate: bool,
    pub(super) flips: u32,
}

impl Region<'_> {
    /// Tests all edges, and flips until nothing is left to flip: first in each half, on several threads, down to parts of
    /// up to so many triangles, and then what touches both.
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
            let mut left = Vec::new();
            for mut half in halves {
                left.append(&mut half.left);
                self.work.blocked.append(&mut half.blocked);
                self.work.flips += half.flips;
            }
            self.flip_some(&left);
        }
        self.work.left.append(&mut self.work.pending);
    }

    /// Tests all edges, and flips until nothing is left to flip.
    fn flip_each(&mut self) {
        let mut diamonds = [Diamond::default(); EDGES];
        let end = self.mesh.first + self.mesh.twins.len() as u32;
        for first in (self.mesh.first..end).step_by(EDGES) {
            let half_edges = first..end.min(first + EDGES as u32);
            let mesh = self.mesh.get();
            let count = Diamond::write(mesh, half_edges.clone(), &mut diamonds);
            self.leave(half_edges);
            let is_known = self.test(&diamonds, count);
            self.flip_pending(is_known);
        }
    }

    /// Tests these edges, and flips until nothing is left to flip. Leaves those to triangles outside of the part.
    fn flip_some(&mut self, half_edges: &[u32]) {
        let mut diamonds = [Diamond::default(); EDGES];
        for half_edges in half_edges.chunks(EDGES) {
            let (mesh, mut count) = (self.mesh.get(), 0);
            for &h in half_edges {
                if mesh.has(unflagged(mesh.twin(h))) {
                    diamonds[count] = Diamond::new(mesh, h);
                    count += 1;
                } else if mesh.leaves(h) {
                    self.work.left.push(h);
                }
            }
            let is_known = self.test(&diamonds, count);
            self.flip_pending(is_known);
        }
    }

    /// Leaves the edges to triangles behind the part; other parts do so with those before it. Such a half-edge stays where
    /// it is.
    fn leave(&mut self, half_edges: Range<u32>) {
        let end = self.mesh.first + self.mesh.twins.len() as u32;
        let behind = (NONE & !FLAGS) - end;
        let is_behind = |twin: u32| (twin & !FLAGS).wrapping_sub(end) < behind;
        let twins = &self.mesh.twins[(half_edges.start - self.mesh.first) as usize..][..half_edges.len()];
        if twins.iter().fold(false, |any, &twin| any | is_behind(twin)) {
            let twins = half_edges.zip(twins);
            self.work.left.extend(twins.filter(|&(_, &twin)| is_behind(twin)).map(|(h, _)| h));
        }
    }

    /// Tests the first `count` edges. Returns whether some are pending now, of which the last is known not to be Delaunay.
    fn test<const N: usize>(&mut self, diamonds: &[Diamond; N], count: usize) -> bool {
        let mut kept = [0; N];
        let count = keep_non_delaunay(self.geometry, &diamonds[..count], &mut kept);
        self.work.pending.extend(kept[..count].iter().map(|&i| diamonds[i as usize].h));
        count > 0
    }

    /// Flips what is pending, the last of it without a test if it `is_known` not to be Delaunay, and then around that.
    pub(super) fn flip_pending(&mut self, mut is_known: bool) {
        while self.work.flips < self.limit
            && let Some(h) = self.work.pending.pop()
        {
            let mesh = self.mesh.get();
            let g = unflagged(mesh.twin(h));
            // Its edge has moved, and one of the boundary has come: those to other triangles stay where they are.
            if !mesh.has(g) {
                continue;
            }
            let diamond = Diamond::new(mesh, h);
            if !std::mem::take(&mut is_known) && keep_non_delaunay(self.geometry, &[diamond], &mut [0]) == 0 {
                continue;
            }
            match self.verdict(&diamond) {
                Some(Verdict::Labelled) => {
                    self.flip(h, g);
                    let (mut diamonds, mut count) = ([Diamond::default(); 4], 0);
                    let mesh = self.mesh.get();
                    for diamond in Diamond::around(mesh, [h, g]) {
                        diamonds[count] = diamond;
                        count += 1;
                    }
                    is_known = self.test(&diamonds, count);
                }
                Some(verdict) => {
                    self.work.has_duplicate |= verdict == Verdict::Blocked(Reason::Duplicate);
                    self.work.blocked.push(h);
                }
                None => self.work.left.push(h),
            }
        }
    }

    /// Whether an edge that is not Delaunay may flip. `None` where that, or the flip, takes more than the part.
    fn verdict(&self, diamond: &Diamond) -> Option<Verdict> {
        let shape = verdict_of_shape(self.geometry, diamond);
        let (h, [_, _, c, d]) = (diamond.h, diamond.corners);
        let mesh = self.mesh.get();
        if shape != Verdict::Labelled {
            return Some(shape);
        }
        if self.mesh.fans.is_some() {
            let is_duplicate = makes_duplicate(self.geometry, mesh, h);
            return Some(if is_duplicate { Verdict::Blocked(Reason::Duplicate) } else { shape });
        }
        let is_embedded = self.geometry.embedded.at(c) | self.geometry.embedded.at(d);
        let is_inside = !mesh.leaves(next(h)) & !mesh.leaves(next(unflagged(diamond.twin)));
        (is_embedded && is_inside).then_some(shape)
    }

    /// Flips the edge of two half-edges, alone. The triangles around it are others: if it may flip, c is not d.
    fn flip(&mut self, h: u32, g: u32) {
        self.work.flips += 1;
        let TopologyMut { first, triangles, twins, fans } = &mut self.mesh;
        let at = |x: u32| (x - *first) as usize;
        let [hn, hp, gn, gp] = [next(h), prev(h), next(g), prev(g)];
        let [c, d] = [triangles[at(hp)], triangles[at(gp)]];
        if let Some(fans) = fans
            && !fans.table.is_empty()
        {
            fans.move_anchor(triangles[at(hn)], hn, g);
            fans.move_anchor(triangles[at(gn)], gn, h);
        }
        for (inner, outer) in [(h, twins[at(gn)]), (g, twins[at(hn)])] {
            twins[at(inner)] = outer;
            if outer != NONE {
                twins[at(unflagged(outer))] = inner | (outer & FLAGS);
            }
        }
        triangles[at(hn)] = d;
        triangles[at(gn)] = c;
        twins[at(hn)] = gn;
        twins[at(gn)] = hn;
    }
}
