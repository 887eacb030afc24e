//! Lawson's algorithm flips one non-Delaunay edge after another, from a queue. The triangles enter the queue a few at a
//! time, so that consecutive edges are near each other in memory. The paper that the README cites compares its phases
//! with this algorithm. On the CPU, this algorithm is faster than the phases.
//!
//! Each thread flips inside a region of the mesh, then across the border of two regions. The regions, and so the flips,
//! are the same for any number of threads.

use super::engine::Cpu;
use super::region::{Region, Work};
use crate::engine::{Answer, Census, EdgeCounts, Engine, Moved};
use crate::mesh::areas::Areas;
use crate::mesh::arrangement::Arrangement;
use crate::mesh::half_edge;
use crate::{EngineKind, Error, Mesh, Positions};
use std::sync::Arc;

/// The most regions: several per thread on most machines, so that no thread waits long for another.
const REGIONS: usize = 64;

/// A region with at most this many triangles is not divided, so that few triangles are near a border. In debug builds
/// the number is small, so that tests with small meshes have several regions.
const FEWEST: usize = if cfg!(debug_assertions) { 16 } else { 1 << 15 };

/// Lawson's algorithm on the state of the CPU engine.
pub(crate) struct Lawson {
    cpu: Cpu,
    /// Whether no edge is left to flip.
    has_ended: bool,
}

impl Lawson {
    pub(crate) fn new(cpu: Cpu) -> Self {
        Self { cpu, has_ended: false }
    }

    /// Flips until no edge is left to flip, or until `u32::MAX` flips. Returns the number of flips.
    fn flip_all(&mut self) -> u32 {
        let threads = self.cpu.threads.clone();
        let (geometry, mesh) = self.cpu.parts();
        let mut whole = Region { geometry: &geometry, mesh, work: Work::default(), limit: u32::MAX };
        let triangles = whole.mesh.triangles.len() / 3;
        // A region smaller than the mesh sees only its own triangles, and would miss other fans of a vertex.
        let is_cut = whole.mesh.has_no_fans();
        let size = if is_cut { triangles.div_ceil(REGIONS).max(FEWEST) } else { triangles };
        whole.flip_parts(size, &threads);
        let mut before = 0;
        // A flip elsewhere may have removed the edge that stood in the way.
        while std::mem::take(&mut whole.work.has_duplicate) && whole.work.flips > before {
            before = whole.work.flips;
            let blocked = std::mem::take(&mut whole.work.blocked);
            whole.flip_some(&blocked);
        }
        let Work { flips, blocked, .. } = whole.work;
        self.has_ended = flips < u32::MAX;
        self.cpu.settle(blocked, self.has_ended);
        flips
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
        let threads = self.cpu.threads.clone();
        let flips = if self.has_ended { 0 } else { threads.enter(|| self.flip_all()) };
        Box::pin(std::future::ready(Ok(if flips == 0 { Vec::new() } else { vec![flips] })))
    }

    fn census(&mut self) -> Answer<'_, Census> {
        self.cpu.census()
    }

    fn areas(&mut self) -> Answer<'_, Areas> {
        self.cpu.areas()
    }

    fn triangles(&mut self) -> Answer<'_, Vec<u32>> {
        Engine::triangles(&mut self.cpu)
    }

    #[cfg(not(target_arch = "wasm32"))]
    fn take_triangles(&mut self) -> Answer<'_, Vec<u32>> {
        self.cpu.take_triangles()
    }

    fn twins(&mut self) -> Answer<'_, Vec<u32>> {
        Engine::twins(&mut self.cpu)
    }

    fn set_positions(&mut self, mesh: Arc<Mesh>, twins: Option<Vec<u32>>) -> Answer<'_, ()> {
        self.has_ended = false;
        // The order of the flips depends on the arrangement.
        if self.cpu.arrangement.is_empty() && !Arrangement::is_needed(&mesh) {
            return self.cpu.set_positions(mesh, twins);
        }
        let locked = twins.map_or_else(|| self.cpu.locked(), |twins| half_edge::locked(&twins));
        self.cpu.begin_again(mesh, locked);
        Box::pin(std::future::ready(Ok(())))
    }

    /// Flips to the end, because there are no iterations to count; with none, it only takes over the positions.
    fn update(
        &mut self,
        positions: Option<Positions>,
        iterations: u32,
        untangles: bool,
    ) -> Result<(), Error> {
        let threads = self.cpu.threads.clone();
        threads.enter(|| {
            self.cpu.move_to(positions, untangles);
            self.has_ended = false;
            if iterations > 0 {
                let flips = self.flip_all();
                self.cpu.add_flips(flips as usize);
            }
        });
        Ok(())
    }

    fn moved(&mut self) -> Answer<'static, Moved> {
        self.cpu.moved()
    }

    fn track_changes(&mut self) -> Answer<'_, ()> {
        self.cpu.track_changes()
    }

    fn changes(&mut self) -> Answer<'_, Vec<u32>> {
        self.cpu.changes()
    }

    fn positions(&mut self) -> Answer<'_, Positions> {
        self.cpu.positions()
    }

    fn edge_counts(&self) -> EdgeCounts {
        self.cpu.edge_counts()
    }

    fn backend(&self) -> EngineKind {
        self.cpu.backend()
    }
}
