//! The loop around an engine: it takes options, runs iterations and counts what remains.

mod ask;
mod choice;
mod cost;
#[cfg(not(target_arch = "wasm32"))]
mod early;
pub(crate) mod edge_states;
mod fallback;
pub(crate) mod locks;
mod memory_bounds;
mod moving;
#[cfg(not(target_arch = "wasm32"))]
pub(crate) mod one_call;
#[cfg_attr(not(feature = "gpu"), path = "no_gpu.rs")]
mod open_gpu;
pub(crate) mod options;
pub(crate) mod outcome;
mod repaired;
#[cfg(test)]
mod tests;
pub(crate) mod untangle;
#[cfg_attr(all(target_arch = "wasm32", feature = "js-session"), path = "untangler_proxy.rs")]
mod untangler;

use crate::engine::Engine;
use crate::mesh::areas::Areas;
use crate::mesh::embedded::Embedded;
use crate::mesh::star::Fans;
use crate::mesh::winding::{Outline, Winding};
use crate::phases::{Geometry, Thresholds, Topology, frozen};
use crate::session::edge_states::edge_states;
use crate::session::locks::BroughtIn;
use crate::system::memory;
use crate::{
    Dimension, EdgeState, Edges, EngineKind, Error, Iteration, LeftOut, Mesh, Options, Order, Outcome,
    Positions, Reason, Status, Timings,
};
use choice::{Choice, first_engine};
#[cfg(not(target_arch = "wasm32"))]
pub use early::{EarlyGpu, close_gpu};
use std::borrow::Cow;
use std::ops::ControlFlow;
use std::sync::Arc;
use untangle::Held;
#[cfg(all(target_arch = "wasm32", feature = "js-session"))]
pub use untangler::UntangleModule;
#[cfg(all(target_arch = "wasm32", feature = "js-untangle"))]
pub(crate) use untangler::Untangler;
#[cfg(all(target_arch = "wasm32", feature = "js-session"))]
pub(crate) use untangler::set_untangler;
use web_time::Instant;
#[cfg(all(target_arch = "wasm32", feature = "js"))]
pub(crate) use {choice::why_cpu, cost::Job, open_gpu::send};
#[cfg(all(target_arch = "wasm32", feature = "js"))]
use {js_sys::Uint32Array, wasm_bindgen::JsValue};

/// A mesh on an engine, step by step.
pub struct Session {
    mesh: Arc<Mesh>,
    options: Options,
    engine: Box<dyn Engine>,
    /// Why `Auto` chose the CPU, or started there.
    fallback: Option<String>,
    /// Whether the session may change from the CPU to a GPU that becomes ready.
    may_change: bool,
    flips_per_iteration: Vec<u32>,
    has_ended: bool,
    /// Updates since the last other change of the positions.
    updates: u64,
    constraints: BroughtIn,
    held: Held,
    timings: Timings,
    /// Whether the triangles stay on the device until somebody asks for them.
    #[cfg(all(target_arch = "wasm32", feature = "js"))]
    pub(crate) stays: bool,
}

impl Session {
    /// Checks the options and prepares an engine for `mesh`: a mesh, an `Arc` of one, or a reference, which is copied.
    ///
    /// # Errors
    /// [`Error::Option`]; [`Error::OutOfMemory`] if a run on the CPU would need too much memory;
    /// [`Error::BackendUnavailable`], [`Error::BackendLimit`] or [`Error::Device`] if the options request a GPU. With
    /// `Auto` the CPU takes over instead.
    pub async fn new(mesh: impl Into<Arc<Mesh>>, mut options: Options) -> Result<Self, Error> {
        options.check()?;
        let mut mesh = mesh.into();
        let held = untangle::at_start(&mut mesh, &mut options)?;
        let start = Instant::now();
        let constraints = locks::bring_in(&mut mesh, &mut options)?;
        let constraints_ms = if constraints.before.is_some() { ms_since(start) } else { 0.0 };
        let start = Instant::now();
        let Choice { engine, fallback, may_change } = first_engine(&mesh, &mut options).await?;
        let set_up = ms_since(start);
        let adjacency = engine.adjacency_ms().unwrap_or(set_up);
        Ok(Self {
            mesh,
            options,
            engine,
            fallback,
            may_change,
            flips_per_iteration: Vec::new(),
            has_ended: false,
            updates: 0,
            constraints,
            held,
            timings: Timings {
                constraints: constraints_ms,
                upload: set_up - adjacency,
                adjacency,
                ..Timings::default()
            },
            #[cfg(all(target_arch = "wasm32", feature = "js"))]
            stays: false,
        })
    }

    /// Runs one iteration, and counts the non-Delaunay edges of the whole mesh before it. `None` when no edge is left
    /// to flip, or at the limit on iterations.
    ///
    /// # Errors
    /// [`Error::Device`], [`Error::BackendLimit`], [`Error::OutOfMemory`].
    pub async fn step(&mut self) -> Result<Option<Iteration>, Error> {
        self.come_to_rest().await?;
        if !self.may_continue() {
            return Ok(None);
        }
        let start = Instant::now();
        let census = self.census().await?;
        let index = self.flips_per_iteration.len() as u32;
        self.iterate(1).await?;
        let ms = ms_since(start);
        Ok(self.flips_per_iteration.get(index as usize).map(|&flips| Iteration {
            index,
            labelled: census.labelled,
            flips,
            blocked: census.blocked,
            ms,
        }))
    }

    /// Runs to the end. It calls `watch` after every batch of iterations with the numbers of iterations and flips so
    /// far; [`ControlFlow::Break`] stops the run after a complete iteration.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`]; [`Error::Device`] and [`Error::BackendLimit`], unless the backend is `Auto`: then the
    /// CPU takes over.
    pub async fn run(&mut self, mut watch: impl FnMut(u32, u64) -> ControlFlow<()>) -> Result<(), Error> {
        self.come_to_rest().await?;
        while self.may_continue() {
            self.advance().await?;
            if watch(self.iterations(), self.flips()).is_break() {
                break;
            }
        }
        Ok(())
    }

    /// Runs one batch of iterations, of the size that the engine prefers. Returns whether the run may continue: edges
    /// may be left to flip, and the limit on iterations is not reached.
    ///
    /// # Errors
    /// Those of [`Session::run`].
    pub async fn advance(&mut self) -> Result<bool, Error> {
        self.come_to_rest().await?;
        #[cfg(all(target_arch = "wasm32", feature = "js"))]
        self.engine.set_stays(self.stays);
        if self.may_continue() {
            self.iterate(self.engine.batch().min(self.iterations_left())).await?;
        }
        if self.may_change && self.may_continue() {
            self.change_to_gpu().await;
        }
        Ok(self.may_continue())
    }

    /// Replaces the positions of all vertices: `Vec<f32>` or `Vec<f64>`, 2 or 3 numbers per vertex. The session then
    /// equals a new one on these positions and the present triangles, bit for bit: it counts iterations and flips from
    /// 0, flags the creases again, and the audit compares with this state. Adjacency, device and buffers stay. The call
    /// reads the triangles back once.
    ///
    /// In the plane, if triangles have turned over, other triangles replace them first, unless
    /// [`Options::untangle`] is `Some(false)`.
    ///
    /// # Errors
    /// [`Error::PositionCount`], [`Error::NonFinite`], [`Error::OutOfMemory`]; [`Error::BackendLimit`] where the GPU
    /// cannot decide the new positions exactly; [`Error::Device`]. After an error the session is unchanged. With `Auto`
    /// the CPU takes over from a GPU that refuses or fails.
    pub async fn set_positions(&mut self, positions: impl Into<Positions>) -> Result<(), Error> {
        self.replace_positions(positions.into()).await
    }

    /// The present triangles: 3 vertex indices per triangle.
    ///
    /// # Errors
    /// [`Error::Device`], [`Error::OutOfMemory`].
    pub async fn triangles(&mut self) -> Result<Vec<u32>, Error> {
        self.words(memory_bounds::COPY, |engine| engine.triangles()).await
    }

    /// The result so far: reads the triangles back and counts the edges that are not Delaunay.
    ///
    /// # Errors
    /// [`Error::Device`], [`Error::OutOfMemory`].
    pub async fn outcome(&mut self) -> Result<Outcome, Error> {
        let start = Instant::now();
        self.come_to_rest().await?;
        let triangles = self.triangles().await?;
        let outcome = self.summary(start, &|| Cow::Borrowed(&triangles)).await?;
        Ok(Outcome { triangles, ..outcome })
    }

    /// As [`Session::outcome`], with the triangles in a JavaScript array. If they stay on the device, the array is
    /// empty. They are read back even so if edges are frozen, because those are counted here.
    #[cfg(all(target_arch = "wasm32", feature = "js"))]
    pub(crate) async fn outcome_array(&mut self) -> Result<(Outcome, Uint32Array), Error> {
        let start = Instant::now();
        self.come_to_rest().await?;
        let counts = self.engine.edge_counts();
        let array = if self.stays && counts.non_manifold + counts.inconsistent == 0 {
            Uint32Array::default()
        } else {
            self.triangles_array().await?
        };
        let outcome = self.summary(start, &|| Cow::Owned(array.to_vec())).await?;
        Ok((outcome, array))
    }

    /// As [`Session::triangles`], in a JavaScript array.
    #[cfg(all(target_arch = "wasm32", feature = "js"))]
    pub(crate) async fn triangles_array(&mut self) -> Result<Uint32Array, Error> {
        self.check_memory(memory_bounds::COPY)?;
        self.ask(|engine| engine.triangles_array()).await
    }

    /// The outcome without the triangles. It calls `triangles` only to count frozen edges.
    async fn summary<'a>(
        &mut self,
        start: Instant,
        triangles: &dyn Fn() -> Cow<'a, [u32]>,
    ) -> Result<Outcome, Error> {
        let census = self.census().await?;
        let Areas { inverted, flat, .. } = self.ask(|engine| engine.areas()).await?;
        let counts = self.engine.edge_counts();
        let mut remaining = census.blocked;
        remaining[Reason::Stopped] = u64::from(census.labelled);
        if counts.non_manifold + counts.inconsistent > 0 {
            let frozen = frozen::count_non_delaunay(&self.mesh, &triangles());
            for reason in [Reason::NonManifold, Reason::Inconsistent] {
                remaining[reason] = frozen[reason];
            }
        }
        let Timings { constraints, upload, adjacency, flip, .. } = self.timings;
        Ok(Outcome {
            triangles: Vec::new(),
            status: if census.labelled == 0 { Status::Done } else { Status::Stopped },
            backend: self.engine.backend(),
            adapter: self.engine.adapter(),
            fallback: self.fallback.clone(),
            iterations: self.flips_per_iteration.len() as u32,
            flips: self.flips(),
            crossed_edges: self.constraints.crossed_edges,
            constraint_deviation: self.constraints.deviation,
            constraint_edges: self.constraint_edges().to_vec(),
            left_out: self.constraints.left_out.clone(),
            lost_edges: self.held.lost.clone(),
            flips_per_iteration: self.flips_per_iteration.clone(),
            dispatches: self.engine.dispatches(),
            device_bytes: self.engine.device_bytes(),
            edges: u64::from(counts.edges),
            boundary_edges: u64::from(counts.boundary),
            non_manifold_edges: u64::from(counts.non_manifold),
            inconsistent_edges: u64::from(counts.inconsistent),
            remaining,
            inverted,
            flat,
            timings: Timings {
                total: constraints + upload + adjacency + flip + ms_since(start),
                ..self.timings
            },
        })
    }

    /// The present edges.
    ///
    /// # Errors
    /// [`Error::Device`], [`Error::OutOfMemory`].
    pub async fn edges(&mut self) -> Result<Edges, Error> {
        let (triangles, twins) = self.joined().await?;
        Ok(Edges::from_twins(&triangles, &twins))
    }

    /// The present state of the edge of each half-edge: 3 per triangle, in the order of [`Session::triangles`]. The two
    /// half-edges of an edge have the same state.
    ///
    /// # Errors
    /// [`Error::Device`], [`Error::OutOfMemory`].
    pub async fn edge_states(&mut self) -> Result<Vec<EdgeState>, Error> {
        self.come_to_rest().await?;
        let (triangles, twins) = self.joined().await?;
        let winding = match self.mesh.dimension() {
            Dimension::Two => Outline::new(&triangles, &twins).winding(&self.mesh),
            Dimension::Three => Winding::default(),
        };
        let geometry = Geometry {
            dimension: self.mesh.dimension(),
            positions: self.mesh.positions(),
            thresholds: Thresholds::from(&self.options),
            winding: &winding,
            embedded: &Embedded::default(),
            has_infinite: false,
        };
        let vertices = self.mesh.vertex_count();
        let fans = &Fans::new(vertices, &triangles, &twins);
        let topology = Topology { first: 0, triangles: &triangles, twins: &twins, fans };
        let iteration = (self.options.order == Order::Reproducible).then(|| self.iterations());
        Ok(edge_states(&geometry, topology, vertices, iteration))
    }

    /// An upper bound on the bytes that a session on the CPU takes in addition to the mesh, from its start to its
    /// outcome. With less memory, [`Session::new`] fails with [`Error::OutOfMemory`].
    pub fn bytes(mesh: &Mesh, options: &Options) -> u64 {
        memory_bounds::bytes(mesh, options)
    }

    /// Iterations so far.
    pub fn iterations(&self) -> u32 {
        self.flips_per_iteration.len() as u32
    }

    /// Flips so far.
    pub fn flips(&self) -> u64 {
        self.flips_per_iteration.iter().map(|&n| u64::from(n)).sum::<u64>()
    }

    /// The present engine.
    #[cfg(all(target_arch = "wasm32", feature = "js-session"))]
    pub(crate) fn backend(&self) -> EngineKind {
        self.engine.backend()
    }

    /// What the audit compares with: the mesh given to `new`, or made when positions changed last, and its options.
    pub(crate) fn input(&self) -> (&Mesh, &Options) {
        self.constraints
            .before
            .as_ref()
            .map_or((&self.mesh, &self.options), |(mesh, options)| (mesh, options))
    }

    /// As [`Outcome::constraint_edges`].
    pub(crate) fn constraint_edges(&self) -> &[[u32; 2]] {
        self.options.locked_edges.get(self.constraints.locks..).unwrap_or_default()
    }

    pub(crate) fn left_out(&self) -> &[LeftOut] {
        &self.constraints.left_out
    }

    /// The device and the buffers that a page can use, or undefined.
    #[cfg(all(target_arch = "wasm32", feature = "js"))]
    pub(crate) fn shared_objects(&self) -> JsValue {
        self.engine.shared_objects()
    }

    fn may_continue(&self) -> bool {
        !self.has_ended && self.iterations_left() > 0
    }

    fn iterations_left(&self) -> u32 {
        let done = self.flips_per_iteration.len() as u32;
        self.options.iterations_left(done)
    }

    /// Checks that `bytes` bytes per triangle are available. Without the check, the call could run out of memory and
    /// end the session; with the check, an error leaves the session unchanged.
    fn check_memory(&self, bytes: u64) -> Result<(), Error> {
        memory::check(bytes * self.mesh.triangle_count() as u64)
    }

    async fn iterate(&mut self, count: u32) -> Result<(), Error> {
        // Later iterations use the memory of the first.
        if self.flips_per_iteration.is_empty() && self.engine.backend() == EngineKind::Cpu {
            memory::check(memory_bounds::of_run(&self.mesh, &self.options))?;
        }
        let start = Instant::now();
        let flips = self.ask(|engine| engine.iterate(count)).await?;
        self.has_ended = (flips.len() as u32) < count;
        self.flips_per_iteration.extend(flips);
        self.timings.flip += ms_since(start);
        Ok(())
    }

    /// Changes to a GPU that has become ready, if the estimate says that the GPU would finish first from here. The GPU
    /// then repeats the iterations so far. If the GPU fails, the CPU continues.
    async fn change_to_gpu(&mut self) {
        let Timings { upload, adjacency, flip, .. } = self.timings;
        if !choice::changes_to_gpu(&self.mesh, &self.options, (upload + adjacency, flip)) {
            return;
        }
        self.may_change = false;
        let start = Instant::now();
        match choice::gpu_after(self.iterations(), &self.mesh, &self.options).await {
            Ok(engine) => {
                self.engine = engine;
                self.fallback = Some("the cpu began, until the gpu was ready".to_owned());
            }
            Err(error) => self.fallback = Some(error.to_string()),
        }
        self.timings.flip += ms_since(start);
    }

    fn take(&mut self, choice: Choice) {
        Choice { engine: self.engine, fallback: self.fallback, may_change: self.may_change } = choice;
    }
}

fn ms_since(start: Instant) -> f64 {
    start.elapsed().as_secs_f64() * 1e3
}
