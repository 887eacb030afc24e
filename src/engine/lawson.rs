//! Lawson's sequential algorithm: one non-Delaunay edge after the other, from a stack. The paper compares with
//! it; it is the fast path on one thread for those who do not need the order of the parallel phases.

use super::{Answer, Census, Cpu, EdgeCounts, Engine};
use crate::adjacency::{prev, unflagged};
use crate::phases::{Verdict, flip, verdict};
use crate::{Mesh, NONE, Reason};
use std::sync::Arc;

/// The state of the CPU engine, flipped in another order.
pub(crate) struct Lawson {
    cpu: Cpu,
}

impl Lawson {
    pub(crate) fn new(cpu: Cpu) -> Self {
        Self { cpu }
    }

    /// Flips until nothing is left to flip, or the number of flips, which it returns, is at its limit.
    fn flip_all(&mut self) -> u32 {
        let mut flips = 0;
        loop {
            let mut stack: Vec<u32> = (0..self.cpu.triangles.len() as u32)
                .filter(|&h| self.cpu.twins[h as usize] != NONE && h < unflagged(self.cpu.twins[h as usize]))
                .collect();
            let (before, mut duplicates) = (flips, false);
            while let Some(h) = stack.pop() {
                let g = unflagged(self.cpu.twins[h as usize]);
                if g == NONE {
                    continue;
                }
                match verdict(&self.cpu.geometry(), self.cpu.topology(), h) {
                    Verdict::Labelled => {
                        self.flip_one(h, g);
                        flips += 1;
                        if flips == u32::MAX {
                            return flips;
                        }
                        stack.extend([h, prev(h), g, prev(g)]);
                    }
                    Verdict::Blocked(Reason::Duplicate) => duplicates = true,
                    _ => {}
                }
            }
            // A flip elsewhere may have removed the edge that stood in the way.
            if !duplicates || flips == before {
                return flips;
            }
        }
    }

    fn flip_one(&mut self, h: u32, g: u32) {
        let Cpu { triangles, twins, fans, selected, .. } = &mut self.cpu;
        let (t, u) = (h as usize / 3, g as usize / 3);
        (selected[t], selected[u]) = (g, h);
        flip(triangles, twins, fans, selected, [h.min(g) / 3].into_iter());
        (selected[t], selected[u]) = (NONE, NONE);
    }
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
        let flips = self.flip_all();
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
        self.cpu.set_positions(mesh)
    }

    fn edge_counts(&self) -> EdgeCounts {
        self.cpu.edge_counts()
    }

    fn backend(&self) -> &'static str {
        self.cpu.backend()
    }
}
