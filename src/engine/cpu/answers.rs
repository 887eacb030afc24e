//! What a session asks of the CPU engine.

use super::engine::Cpu;
use super::motion::Motion;
use crate::engine::{Answer, Census, EdgeCounts, Engine, Moved};
use crate::mesh::areas::Areas;
use crate::mesh::embedded::Embedded;
use crate::mesh::half_edge;
use crate::phases::flag_creases;
use crate::{Dimension, EngineKind, Error, Mesh, Positions};
use std::sync::Arc;

impl Engine for Cpu {
    fn lock(&mut self, half_edges: Vec<u32>) -> Answer<'_, ()> {
        half_edge::lock(&mut self.twins, &self.arrangement.half_edges(half_edges));
        Box::pin(std::future::ready(Ok(())))
    }

    fn iterate(&mut self, count: u32) -> Answer<'_, Vec<u32>> {
        let threads = self.threads.clone();
        let flips = threads.enter(|| self.run(count));
        Box::pin(std::future::ready(Ok(flips)))
    }

    fn census(&mut self) -> Answer<'_, Census> {
        Box::pin(std::future::ready(Ok(self.count())))
    }

    fn areas(&mut self) -> Answer<'_, Areas> {
        Box::pin(std::future::ready(Ok(self.count_areas())))
    }

    fn triangles(&mut self) -> Answer<'_, Vec<u32>> {
        let triangles = self.arrangement.named_triangles(&self.triangles, &self.threads);
        Box::pin(std::future::ready(Ok(triangles)))
    }

    #[cfg(not(target_arch = "wasm32"))]
    fn take_triangles(&mut self) -> Answer<'_, Vec<u32>> {
        if !self.arrangement.is_empty() {
            return Engine::triangles(self);
        }
        Box::pin(std::future::ready(Ok(std::mem::take(&mut self.triangles))))
    }

    fn twins(&mut self) -> Answer<'_, Vec<u32>> {
        Box::pin(std::future::ready(Ok(self.arrangement.named_twins(&self.twins, &self.threads))))
    }

    fn set_positions(&mut self, mesh: Arc<Mesh>, twins: Option<Vec<u32>>) -> Answer<'_, ()> {
        let has_others = twins.is_some();
        if let Some(twins) = twins {
            if !self.arrangement.is_empty() {
                self.begin_again(mesh, half_edge::locked(&twins));
                return Box::pin(std::future::ready(Ok(())));
            }
            (self.triangles, self.twins) = (self.threads.copied(mesh.triangles()), twins);
        }
        let mesh = self.arrangement.mesh(mesh, &self.triangles, &self.threads);
        let Self { thresholds, winding, embedded, outline, triangles, twins, threads, .. } = self;
        let guess = Some(std::mem::take(winding));
        (*winding, *embedded) = Embedded::with_winding(&mesh, twins, guess, outline, threads);
        if mesh.dimension() == Dimension::Three {
            flag_creases(mesh.positions(), triangles, twins, thresholds.cos, false, threads);
        }
        // Each vertex has as many fans as before.
        if has_others && !self.fans.table.is_empty() {
            self.fans = embedded.fans(&mesh, twins, threads);
        }
        self.settle(Vec::new(), false);
        self.iteration = 0;
        let changes = vec![0; self.moving.changes.len()];
        self.moving = Motion { changes, ..Motion::default() };
        self.mesh = mesh;
        Box::pin(std::future::ready(Ok(())))
    }

    fn update(
        &mut self,
        positions: Option<Positions>,
        iterations: u32,
        untangles: bool,
    ) -> Result<(), Error> {
        let threads = self.threads.clone();
        let flips = threads.enter(|| {
            self.moving.updates = self.moving.updates.wrapping_add(1).max(1);
            self.move_to(positions, untangles);
            self.iteration = self.moving.next;
            self.moving.next = self.moving.next.wrapping_add(iterations);
            self.run(iterations)
        });
        self.add_flips(flips.into_iter().map(|count| count as usize).sum());
        Ok(())
    }

    fn moved(&mut self) -> Answer<'static, Moved> {
        Box::pin(std::future::ready(Ok(self.count_moved())))
    }

    fn track_changes(&mut self) -> Answer<'_, ()> {
        self.moving.changes = vec![0; self.triangles.len() / 3];
        Box::pin(std::future::ready(Ok(())))
    }

    fn changes(&mut self) -> Answer<'_, Vec<u32>> {
        Box::pin(std::future::ready(Ok(self.arrangement.named_words(&self.moving.changes))))
    }

    fn positions(&mut self) -> Answer<'_, Positions> {
        Box::pin(std::future::ready(Ok(self
            .arrangement
            .named_positions(self.geometry().positions, &self.threads))))
    }

    fn batch(&self) -> u32 {
        1
    }

    fn edge_counts(&self) -> EdgeCounts {
        self.counts
    }

    fn backend(&self) -> EngineKind {
        EngineKind::Cpu
    }
}
