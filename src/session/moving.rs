//! Updates: meshes that move.

use super::choice::{self, cpu_after, engine_for};
use super::{Session, memory_bounds, ms_since};
use crate::engine::{Answer, MOST_ITERATIONS};
use crate::system::threads::Threads;
use crate::{Backend, Counters, EngineKind, Error, Mesh, Positions, Reason, Timings};
use std::sync::Arc;
use web_time::Instant;
#[cfg(not(all(target_arch = "wasm32", feature = "js-session")))]
use {crate::Dimension, crate::mesh::areas::Areas, crate::untangle::may_be_tangled};

impl Session {
    /// Takes over vertices that have moved, and flips for up to `iterations` iterations, at most 64. What is left goes
    /// on in the next update. `positions` are the new positions; with `None` they are those that the caller has written
    /// to the buffer on the GPU, or the present ones.
    ///
    /// A GPU only submits the work: commands that the caller submits after this call see its result. The update tests
    /// every edge on the new positions, flags the creases again, and keeps adjacency, buffers and winding. Edges with a
    /// coordinate that is not finite stay as they are until it is finite. Iterations are numbered on from one update to
    /// the next, so all engines give the same triangles for the same positions and numbers of iterations.
    ///
    /// [`Session::run`], [`Session::advance`], [`Session::step`], [`Session::outcome`], [`Session::edge_states`] and
    /// [`Session::verify`] end the motion: they act as if [`Session::set_positions`] had been called with the present positions.
    /// They untangle triangles that have turned over, as [`Options::untangle`](crate::Options::untangle) says; an update only
    /// flips, on every engine.
    ///
    /// # Errors
    /// [`Error::Option`], [`Error::PositionCount`]; [`Error::BackendLimit`] for 64-bit floats on a GPU;
    /// [`Error::Device`].
    pub fn update(&mut self, positions: Option<Positions>, iterations: u32) -> Result<(), Error> {
        if iterations > MOST_ITERATIONS {
            let message =
                format!("{iterations} iterations are too many for one update: give 0 to {MOST_ITERATIONS}");
            return Err(Error::Option { option: "iterations", message });
        }
        if let Some(positions) = &positions {
            self.check_length(positions)?;
        }
        self.engine.update(positions, iterations)?;
        self.flips_per_iteration.clear();
        self.has_ended = false;
        self.updates = self.updates.saturating_add(1);
        Ok(())
    }

    /// The device and the buffers on the GPU, to write positions for the next [`Session::update`] and to draw without a
    /// copy; `None` on the CPU. The buffers stay the same until the session is dropped, unless it takes another engine:
    /// with `Auto`, or for positions that change between 32-bit and 64-bit floats.
    #[cfg(all(not(target_arch = "wasm32"), feature = "gpu"))]
    pub fn gpu(&self) -> Option<crate::GpuBuffers> {
        self.engine.gpu_buffers()
    }

    /// Whether [`Session::update`] may follow.
    #[cfg(all(target_arch = "wasm32", feature = "js-session"))]
    pub(crate) fn is_settled(&self) -> bool {
        self.engine.is_settled()
    }

    /// Waits until the engine has started. After that, [`Session::update`] never waits.
    ///
    /// # Errors
    /// [`Error::Device`], [`Error::BackendLimit`].
    pub async fn settle(&mut self) -> Result<(), Error> {
        self.ask(|engine| engine.settle()).await
    }

    /// What the updates so far have done. The counts are taken at once; later updates do not change the answer, and
    /// need not wait for it.
    ///
    /// # Errors
    /// [`Error::Device`].
    pub fn counters(&mut self) -> impl Future<Output = Result<Counters, Error>> + use<> {
        let (updates, moved) = (self.updates, self.engine.moved());
        async move {
            let moved = moved.await?;
            let mut remaining = moved.census.blocked;
            remaining[Reason::Stopped] = moved.census.labelled.into();
            Ok(Counters {
                updates,
                flips: moved.flips,
                remaining,
                inverted: moved.areas.inverted,
                flat: moved.areas.flat,
                undecided: moved.areas.undecided,
                non_finite: moved.infinite,
                too_wide: moved.wide,
            })
        }
    }

    /// For each triangle the number of the update in which it last changed, from 1 on; 0 if no update has changed it.
    /// Empty without [`Options::track_changes`](crate::Options::track_changes). [`Session::gpu`] has the same numbers on
    /// the device.
    ///
    /// # Errors
    /// [`Error::Device`], [`Error::OutOfMemory`].
    pub async fn changes(&mut self) -> Result<Vec<u32>, Error> {
        self.check_memory(memory_bounds::COPY)?;
        self.ask(|engine| engine.changes()).await
    }

    /// Ends the motion, if there were updates.
    pub(crate) async fn come_to_rest(&mut self) -> Result<(), Error> {
        if self.updates == 0 {
            return Ok(());
        }
        self.check_memory(memory_bounds::POSITIONS)?;
        let positions = self.ask(|engine| engine.positions()).await?;
        self.replace_positions(positions).await
    }

    pub(super) fn check_length(&self, positions: &Positions) -> Result<(), Error> {
        let (length, expected) = (positions.len(), self.mesh.positions().len());
        if length == expected { Ok(()) } else { Err(Error::PositionCount { length, expected }) }
    }

    /// Boxed, so that this code is compiled only once.
    pub(super) fn replace_positions(&mut self, positions: Positions) -> Answer<'_, ()> {
        Box::pin(self.replace(positions))
    }

    async fn replace(&mut self, positions: Positions) -> Result<(), Error> {
        let start = Instant::now();
        self.check_length(&positions)?;
        positions.refuse_non_finite(self.mesh.dimension(), &Threads::one())?;
        let triangles = self.triangles().await?;
        let mut mesh = Arc::new(Mesh::new(self.mesh.dimension(), positions, triangles)?);
        self.take_moved(&mut mesh).await?;
        self.mesh = mesh;
        self.constraints.before = None;
        self.flips_per_iteration.clear();
        self.has_ended = false;
        self.timings = Timings { adjacency: ms_since(start), ..Timings::default() };
        self.updates = 0;
        Ok(())
    }

    /// Gives the engine the positions of a mesh and, if its triangles are not those of the engine, their twins.
    pub(super) async fn take_positions(
        &mut self,
        mesh: &Arc<Mesh>,
        twins: Option<Vec<u32>>,
    ) -> Result<(), Error> {
        if self.may_change && choice::changes_to_gpu(mesh, &self.options, (0.0, 0.0)) {
            let choice = engine_for(mesh, &self.options).await?;
            self.take(choice);
        } else {
            match self.engine.set_positions(mesh.clone(), twins).await {
                Err(error @ (Error::BackendLimit { .. } | Error::Device { .. }))
                    if self.options.backend == Backend::Auto =>
                {
                    let why = format!("after the vertices moved: {error}");
                    let choice = cpu_after(why, mesh, &self.options).await?;
                    self.take(choice);
                }
                answer => answer?,
            }
            if self.engine.backend() == EngineKind::Gpu {
                self.fallback = None;
            }
        }
        Ok(())
    }
}

#[cfg(not(all(target_arch = "wasm32", feature = "js-session")))]
impl Session {
    /// Gives the engine a mesh whose vertices have moved, with other triangles if it needs them.
    pub(super) async fn take_moved(&mut self, mesh: &mut Arc<Mesh>) -> Result<(), Error> {
        let may_untangle = mesh.dimension() == Dimension::Two && self.options.untangle != Some(false);
        if !may_untangle {
            return self.take_positions(mesh, None).await;
        }
        let enough = self.check_memory(memory_bounds::UNTANGLE);
        // The CPU finds the signs of all triangles anyway. It has the new positions then, so no error may follow.
        let tells_signs = self.engine.backend() == EngineKind::Cpu && enough.is_ok();
        if tells_signs {
            self.take_positions(mesh, None).await?;
        }
        if self.is_tangled(mesh, tells_signs).await? {
            enough?;
            self.untangle(mesh).await?;
        } else if !tells_signs {
            self.take_positions(mesh, None).await?;
        }
        Ok(())
    }

    /// Whether the mesh may need other triangles. `tells_signs`: whether the engine has its positions, and tells the signs
    /// of its triangles in no time.
    async fn is_tangled(&mut self, mesh: &Mesh, tells_signs: bool) -> Result<bool, Error> {
        if !self.held.lost.is_empty() || !tells_signs {
            return Ok(!self.held.lost.is_empty() || may_be_tangled(mesh));
        }
        Ok(self.ask(|engine| engine.areas()).await? != Areas::default())
    }

    /// Replaces the triangles that have turned over, and gives the engine the mesh.
    async fn untangle(&mut self, mesh: &mut Arc<Mesh>) -> Result<(), Error> {
        let before = (self.held.clone(), self.options.clone(), self.constraints.locks);
        let present = self.ask(|engine| engine.twins()).await?;
        let mut twins = None;
        if let Some(untangled) = self.held.untangled(mesh, present) {
            *mesh = Arc::new(mesh.flipped(untangled.triangles));
            twins = Some(untangled.twins);
            self.held.take_over(untangled.lost, &mut self.options, &mut self.constraints.locks);
        }
        let taken = self.take_positions(mesh, twins).await;
        if taken.is_err() {
            (self.held, self.options, self.constraints.locks) = before;
        }
        taken
    }
}

#[cfg(all(target_arch = "wasm32", feature = "js-session"))]
impl Session {
    /// Gives the engine a mesh whose vertices have moved.
    pub(super) async fn take_moved(&mut self, mesh: &mut Arc<Mesh>) -> Result<(), Error> {
        self.take_positions(mesh, None).await
    }
}
