//! Lawson's sequential algorithm: one non-Delaunay edge after the other, from a stack, so that the next one is near.
//! The paper compares with it; it is the fast path on one thread for those who do not need the order of the parallel
//! phases.

use super::{Answer, Census, Cpu, EdgeCounts, Engine};
use crate::adjacency::{prev, unflagged};
use crate::phases::Verdict;
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
        let mut stack = Vec::new();
        loop {
            let (before, mut duplicates) = (flips, false);
            for first in 0..self.cpu.twins.len() as u32 {
                let g = unflagged(self.cpu.twins[first as usize]);
                if g != NONE && first < g {
                    stack.push(first);
                }
                while let Some(h) = stack.pop() {
                    let g = unflagged(self.cpu.twins[h as usize]);
                    if g == NONE {
                        continue;
                    }
                    match self.cpu.judge(h) {
                        Verdict::Labelled if flips == u32::MAX => {
                            self.cpu.set_tested(false);
                            return flips;
                        }
                        Verdict::Labelled => {
                            self.cpu.flip_one(h);
                            flips += 1;
                            stack.extend([h, prev(h), g, prev(g)]);
                        }
                        Verdict::Blocked(Reason::Duplicate) => duplicates = true,
                        _ => {}
                    }
                }
            }
            // A flip elsewhere may have removed the edge that stood in the way.
            if !duplicates || flips == before {
                self.cpu.set_tested(true);
                return flips;
            }
        }
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
