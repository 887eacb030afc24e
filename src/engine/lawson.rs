//! Lawson's sequential algorithm: one non-Delaunay edge after the other, from a stack, so that the next one is near.
//! The paper compares with it; it is the fast path on one thread for those who do not need the order of the parallel
//! phases.

use super::{Answer, Census, Cpu, EdgeCounts, Engine};
use crate::adjacency::{FLAGS, next, prev, unflagged};
use crate::phases::{Diamond, Verdict, keep_non_delaunay, verdict, verdict_of_non_delaunay};
use crate::{Mesh, NONE, Reason};
use std::sync::Arc;

/// Edges that are tested in one go, before those of them that are not Delaunay flip.
const EDGES: usize = 64;

/// The state of the CPU engine, flipped in another order.
pub(crate) struct Lawson {
    cpu: Cpu,
    /// Whether nothing is left to flip.
    has_ended: bool,
    /// Half-edges of edges that were not Delaunay when they were tested last; others may have flipped since.
    pending: Vec<u32>,
    /// Those of them that may not flip.
    blocked: Vec<u32>,
}

impl Lawson {
    pub(crate) fn new(cpu: Cpu) -> Self {
        Self { cpu, has_ended: false, pending: Vec::new(), blocked: Vec::new() }
    }

    /// Flips until nothing is left to flip, or the number of flips, which it returns, is at its limit.
    fn flip_all(&mut self) -> u32 {
        let mut flips = 0;
        let mut has_duplicate = false;
        let end = self.cpu.twins.len() as u32;
        let mut diamonds = [Diamond::default(); EDGES];
        for first in (0..end).step_by(EDGES) {
            let half_edges = first..end.min(first + EDGES as u32);
            let count = Diamond::write(self.cpu.topology(), half_edges, &mut diamonds);
            let is_known = self.test(&diamonds, count);
            has_duplicate |= self.flip_pending(is_known, &mut flips);
        }
        let mut before = 0;
        // A flip elsewhere may have removed the edge that stood in the way.
        while has_duplicate && flips > before {
            before = flips;
            self.pending = std::mem::take(&mut self.blocked);
            has_duplicate = self.flip_pending(false, &mut flips);
        }
        self.has_ended = flips < u32::MAX;
        self.pending.clear();
        self.cpu.settle(std::mem::take(&mut self.blocked), self.has_ended);
        flips
    }

    /// Tests the first `count` edges. Returns whether some are pending now, of which the last is known not to be Delaunay.
    fn test<const N: usize>(&mut self, diamonds: &[Diamond; N], count: usize) -> bool {
        let mut kept = [0; N];
        let count = keep_non_delaunay(&self.cpu.geometry(), &diamonds[..count], &mut kept);
        self.pending.extend(kept[..count].iter().map(|&i| diamonds[i as usize].h));
        count > 0
    }

    /// Flips what is pending, the last of it without a test if it `is_known` not to be Delaunay, and then around that.
    /// Returns whether a duplicate has blocked an edge.
    fn flip_pending(&mut self, mut is_known: bool, flips: &mut u32) -> bool {
        let mut has_duplicate = false;
        while *flips < u32::MAX
            && let Some(h) = self.pending.pop()
        {
            let g = unflagged(self.cpu.twins[h as usize]);
            if g == NONE {
                continue;
            }
            let (geometry, topology) = (self.cpu.geometry(), self.cpu.topology());
            let verdict = if std::mem::take(&mut is_known) {
                verdict_of_non_delaunay(&geometry, topology, &Diamond::new(topology, h))
            } else {
                verdict(&geometry, topology, h)
            };
            match verdict {
                Verdict::Delaunay => {}
                Verdict::Blocked(reason) => {
                    has_duplicate |= reason == Reason::Duplicate;
                    self.blocked.push(h);
                }
                Verdict::Labelled => {
                    flip(&mut self.cpu, h, g);
                    *flips += 1;
                    let (mut diamonds, mut count) = ([Diamond::default(); 4], 0);
                    for diamond in Diamond::around(self.cpu.topology(), [h, g]) {
                        diamonds[count] = diamond;
                        count += 1;
                    }
                    is_known = self.test(&diamonds, count);
                }
            }
        }
        has_duplicate
    }
}

/// Flips the edge of two half-edges, alone. The triangles around it are others: if it may flip, c is not d.
fn flip(cpu: &mut Cpu, h: u32, g: u32) {
    let Cpu { triangles, twins, fans, .. } = cpu;
    let [hn, hp, gn, gp] = [next(h), prev(h), next(g), prev(g)];
    let [c, d] = [triangles[hp as usize], triangles[gp as usize]];
    if !fans.table.is_empty() {
        fans.move_anchor(triangles[hn as usize], hn, g);
        fans.move_anchor(triangles[gn as usize], gn, h);
    }
    for (inner, outer) in [(h, twins[gn as usize]), (g, twins[hn as usize])] {
        twins[inner as usize] = outer;
        if outer != NONE {
            twins[unflagged(outer) as usize] = inner | (outer & FLAGS);
        }
    }
    triangles[hn as usize] = d;
    triangles[gn as usize] = c;
    twins[hn as usize] = gn;
    twins[gn as usize] = hn;
}

impl Engine for Lawson {
    fn batch(&self) -> u32 {
        1
    }

    fn lock(&mut self, half_edges: Vec<u32>) -> Answer<'_, ()> {
        self.cpu.lock(half_edges)
    }

    /// A whole pass counts as one iteration.
    fn iterate(&mut self, _count: u32) -> Answer<'_, Vec<u32>> {
        let flips = if self.has_ended { 0 } else { self.flip_all() };
        Box::pin(std::future::ready(Ok(if flips == 0 { Vec::new() } else { vec![flips] })))
    }

    fn census(&mut self) -> Answer<'_, Census> {
        self.cpu.census()
    }

    fn triangles(&mut self) -> Answer<'_, Vec<u32>> {
        Engine::triangles(&mut self.cpu)
    }

    fn twins(&mut self) -> Answer<'_, Vec<u32>> {
        Engine::twins(&mut self.cpu)
    }

    fn set_positions(&mut self, mesh: Arc<Mesh>) -> Answer<'_, ()> {
        self.has_ended = false;
        self.cpu.set_positions(mesh)
    }

    fn edge_counts(&self) -> EdgeCounts {
        self.cpu.edge_counts()
    }

    fn backend(&self) -> &'static str {
        self.cpu.backend()
    }
}
