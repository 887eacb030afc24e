//! Updates: meshes that move.

use super::choice::{self, cpu_after, engine_for};
use super::repaired::Repaired;
use super::{Session, memory_bounds, ms_since};
use crate::engine::{Answer, MOST_ITERATIONS};
use crate::mesh::areas::Areas;
use crate::mesh::winding::Winding;
use crate::system::threads::Threads;
use crate::{Backend, Counters, Dimension, EngineKind, Error, Mesh, Positions, Reason, Timings};
use std::mem;
use std::sync::Arc;
use web_time::Instant;

impl Session {
    /// Takes over vertices that have moved, untangles triangles of a mesh in the plane that have turned over, as far as a
    /// fixed number of rounds does, and flips for up to `iterations` iterations, at most 64. What is left goes on in the
    /// next update. `positions` are the new positions; with `None` they are those that the caller has written
    /// to the buffer on the GPU, or the present ones.
    ///
    /// A GPU only submits the work: commands that the caller submits after this call see its result. The update tests
    /// every edge on the new positions, flags the creases again, and keeps adjacency, buffers and winding. Edges with a
    /// coordinate that is not finite stay as they are until it is finite. Iterations are numbered on from one update to
    /// the next, so all engines give the same triangles for the same positions and numbers of iterations.
    ///
    /// [`Session::run`], [`Session::advance`], [`Session::step`], [`Session::outcome`], [`Session::edge_states`] and
    /// [`Session::verify`] end the motion: they act as if [`Session::set_positions`] had been called with the present positions.
    /// They untangle what updates have left, as [`Options::untangle`](crate::Options::untangle) says, also at locked edges:
    /// an update lifts no vertex of such an edge. It only flips if more than half of the triangles are turned over, or in a
    /// mesh of far more vertices than triangles. With [`Options::untangle`](crate::Options::untangle) as `Some(false)` an
    /// update only flips.
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
        self.engine.update(positions, iterations, self.may_change(&self.mesh))?;
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
        self.words(memory_bounds::COPY, |engine| engine.changes()).await
    }

    /// Ends the motion, if there were updates.
    pub(crate) async fn come_to_rest(&mut self) -> Result<(), Error> {
        if self.updates == 0 {
            return Ok(());
        }
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
        self.check_memory(memory_bounds::POSITIONS)?;
        self.check_length(&positions)?;
        let dimension = self.mesh.dimension();
        positions.refuse_non_finite(dimension, &Threads::one())?;
        let triangles = self.triangles().await?;
        let mesh = Mesh::of_checked(dimension, positions.narrowed(), triangles);
        self.mesh = self.take_moved(mesh).await?;
        self.constraints.before = None;
        self.flips_per_iteration.clear();
        self.has_ended = false;
        self.timings = Timings { adjacency: ms_since(start), ..Timings::default() };
        self.updates = 0;
        Ok(())
    }

    /// Gives the engine the positions of a mesh and, if its triangles are not those of the engine, their twins.
    async fn take_positions(&mut self, mesh: &Arc<Mesh>, twins: Option<Vec<u32>>) -> Result<(), Error> {
        if self.may_change && choice::changes_to_gpu(mesh, &self.options, (0.0, 0.0)) {
            let choice = engine_for(mesh, &self.options).await?;
            self.take(choice);
            return Ok(());
        }
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
        Ok(())
    }
}

impl Session {
    /// Whether triangles of a mesh that turn over get others.
    fn may_change(&self, mesh: &Mesh) -> bool {
        mesh.dimension() == Dimension::Two && self.options.untangle != Some(false)
    }

    /// Gives the engine a mesh whose vertices have moved, with other triangles if it needs them.
    async fn take_moved(&mut self, mut mesh: Mesh) -> Result<Arc<Mesh>, Error> {
        let may_change = self.may_change(&mesh);
        let bytes = memory_bounds::UNTANGLE;
        // The CPU finds the signs of all triangles anyway. In the npm package, the module of the repair may be missing: then
        // the engine must not have changed.
        #[cfg(not(all(target_arch = "wasm32", feature = "js-session")))]
        let bytes = if may_change
            && self.engine.backend() == EngineKind::Cpu
            && self.held.lost.is_empty()
            && !self.held.was_tangled
            && self.check_memory(bytes).is_ok()
        {
            let moved = Arc::new(mesh);
            self.take_positions(&moved, None).await?;
            if self.ask(|engine| engine.areas()).await? == Areas::default() {
                return Ok(moved);
            }
            mesh = Arc::unwrap_or_clone(moved);
            0
        } else {
            bytes
        };
        // After a repair, another one is likely, which finds out by itself.
        let may_be_tangled =
            may_change && (!self.held.lost.is_empty() || self.held.was_tangled || may_be_tangled(&mesh));
        let (mut twins, mut replaced) = (None, None);
        if may_be_tangled {
            let mut present = self.words(bytes, |engine| engine.twins()).await?;
            if self.held.untangler.is_needed(&mesh, &present, self.held.lost.len())?
                && let Some(mut repaired) = self.repaired(&mesh, &present)?
            {
                mesh = mesh.with_slots(&repaired.slots, &mut present);
                twins = Some(present);
                self.exchange(&mut repaired);
                replaced = Some(repaired);
            }
        }
        self.held.was_tangled = replaced.is_some();
        let mesh = Arc::new(mesh);
        let taken = self.take_positions(&mesh, twins).await;
        if let (Err(_), Some(mut replaced)) = (&taken, replaced) {
            self.exchange(&mut replaced);
        }
        taken.map(|()| mesh)
    }

    fn repaired(&mut self, mesh: &Mesh, twins: &[u32]) -> Result<Option<Repaired>, Error> {
        let locked = (self.options.locked_edges.as_slice(), self.constraints.locks);
        self.held.untangler.repaired(mesh, twins, locked, &self.held.lost)
    }

    /// Takes over the locked edges of a repair, and gives the present ones for them.
    fn exchange(&mut self, repaired: &mut Repaired) {
        mem::swap(&mut self.held.lost, &mut repaired.lost);
        mem::swap(&mut self.options.locked_edges, &mut repaired.locked_edges);
        mem::swap(&mut self.constraints.locks, &mut repaired.locks);
    }
}

/// Whether triangles of a mesh in the plane may have turned over: whether their signs differ, or one is zero.
fn may_be_tangled(mesh: &Mesh) -> bool {
    let triangles = (mesh.dimension(), mesh.positions(), mesh.triangles());
    // As if all components were counter-clockwise.
    let Areas { inverted, flat, .. } = Areas::of(triangles, &Winding::default(), false, &Threads::one());
    flat > 0 || inverted > 0 && inverted < mesh.triangle_count() as u32
}
