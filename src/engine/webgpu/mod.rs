//! The phases as compute shaders, through wgpu: natively and in the browser.
//!
//! An iteration is four dispatches: Label, exact arithmetic for the edges that Label leaves undecided, Select, and Flip
//! with update. One submission has a batch of iterations and a tail: a single kernel that runs many iterations while
//! few triangles are due. An iteration does nothing if the iteration before flipped no edge. The device writes a
//! history: the flips of each iteration. The host reads the history after each submission.
//!
//! In a browser, one wait for the GPU takes longer than most runs. There the host submits the first iterations without
//! waiting for the preparation. The same submission also copies the results that the session will ask for. Natively the
//! host waits for each, which separates the timings, and submits the counts behind the iterations.

mod adjacency;
#[cfg(target_arch = "wasm32")]
mod ahead;
#[cfg(feature = "baseline")]
pub(super) mod baseline;
#[cfg(target_arch = "wasm32")]
mod browser;
mod buffer;
mod buffers;
mod compile;
mod copies;
mod device;
mod faults;
mod history;
#[cfg(all(target_arch = "wasm32", feature = "js"))]
mod host;
mod kernels;
mod known;
mod limits;
#[cfg(target_arch = "wasm32")]
mod mapped;
mod moving;
#[cfg(not(target_arch = "wasm32"))]
mod own_device;
mod params;
mod pool;
mod probe;
mod programs;
mod run;
#[cfg(all(target_arch = "wasm32", feature = "js"))]
mod sent;
mod shared;
mod sources;
mod staging;
mod start;
mod steps;
#[cfg(test)]
mod tests;
mod turned;
mod untangle;
mod walks;
mod words;

#[cfg(all(target_arch = "wasm32", feature = "js"))]
pub use browser::GpuDevice;
pub(crate) use device::Device;
#[cfg(test)]
pub(crate) use kernels::Kernel;
#[cfg(not(target_arch = "wasm32"))]
pub use own_device::GpuDevice;
pub(crate) use shared::{GivenDevice, Handle};

#[cfg(not(target_arch = "wasm32"))]
use super::GpuBuffers;
use super::{Answer, Census, EdgeCounts, Engine, Moved};
#[cfg(test)]
use crate::NONE;
use crate::engine::gpu::Form;
use crate::mesh::areas::Areas;
#[cfg(test)]
use crate::mesh::half_edge::unflagged;
use crate::phases::Thresholds;
use crate::{EngineKind, Error, Mesh, Positions};
use buffer::Buffer;
use buffers::Buffers;
use faults::Caught;
use history::{BATCH, Entry, TAIL};
use kernels::Kernels;
#[cfg(test)]
use kernels::Plan;
use known::Known;
use params::Params;
use std::sync::Arc;
use turned::Turned;
use walks::Walks;
#[cfg(all(target_arch = "wasm32", feature = "js"))]
use wasm_bindgen::JsValue;
use words::{Reserved, vector};

/// A mesh on the device.
pub(crate) struct WebGpu {
    gpu: Handle,
    kernels: Arc<Kernels>,
    thresholds: Thresholds,
    form: Form,
    params: Params,
    counts: EdgeCounts,
    bindings: wgpu::BindGroup,
    /// The length of the topology.
    topology_words: u32,
    /// The winding, once the host knows it.
    winding: u32,
    turned: Turned,
    buffers: Buffers,
    /// The adjacency for the caller, if it has asked for it.
    walks: Option<Box<Walks>>,
    /// The counters of the adjacency, then the signs of the triangles.
    counters: Buffer,
    /// Natively the mesh, while its triangles are those on the device: no edge has flipped.
    input: Option<Arc<Mesh>>,
    /// The mesh, until the host has read the counters.
    unsettled: Option<Arc<Mesh>>,
    /// The faults of allocating and writing the buffers, until the host has checked them.
    faults: Vec<Caught>,
    /// Whether the host reads the counters before the first iteration. If not, it reads results in advance.
    waits: bool,
    /// Whether the triangles stay on the device until somebody asks for them.
    stays: bool,
    /// Memory for the triangles, if a run has begun that will be asked for them, or if another thread makes it.
    reserved: Option<Reserved>,
    /// Results that the host has read in advance.
    known: Known,
    state: Entry,
    dispatches: u64,
    adjacency_ms: f64,
    /// The peak size of its buffers.
    bytes: u64,
}

impl Engine for WebGpu {
    fn batch(&self) -> u32 {
        BATCH + TAIL
    }

    fn lock(&mut self, half_edges: Vec<u32>) -> Answer<'_, ()> {
        Box::pin(self.flag_locked(half_edges))
    }

    fn iterate(&mut self, count: u32) -> Answer<'_, Vec<u32>> {
        Box::pin(self.run(count))
    }

    fn census(&mut self) -> Answer<'_, Census> {
        Box::pin(async { Ok(self.count().await?.0) })
    }

    fn areas(&mut self) -> Answer<'_, Areas> {
        Box::pin(async { Ok(self.count().await?.1) })
    }

    fn triangles(&mut self) -> Answer<'_, Vec<u32>> {
        let triangles = self.known_triangles();
        Box::pin(async { triangles.await.map(vector) })
    }

    #[cfg(all(target_arch = "wasm32", feature = "js"))]
    fn set_stays(&mut self, stays: bool) {
        self.stays = stays;
    }

    #[cfg(all(target_arch = "wasm32", feature = "js"))]
    fn set_spare(&mut self, spare: Option<js_sys::Object>) {
        let words = 3 * self.params.triangles as usize;
        self.reserved = spare.map(|promise| words::promised(promise, words));
    }

    #[cfg(all(target_arch = "wasm32", feature = "js"))]
    fn triangles_array(&mut self) -> Answer<'_, js_sys::Uint32Array> {
        self.known_triangles()
    }

    fn twins(&mut self) -> Answer<'_, Vec<u32>> {
        let twins = self.read(|buffers| &buffers.twins, None);
        Box::pin(async { twins.await.map(vector) })
    }

    fn set_positions(&mut self, mesh: Arc<Mesh>, twins: Option<Vec<u32>>) -> Answer<'_, ()> {
        Box::pin(self.move_vertices(mesh, twins))
    }

    #[cfg(all(target_arch = "wasm32", feature = "js-session"))]
    fn is_settled(&self) -> bool {
        self.unsettled.is_none()
    }

    fn settle(&mut self) -> Answer<'_, ()> {
        Box::pin(Self::settle(self))
    }

    fn update(
        &mut self,
        positions: Option<Positions>,
        iterations: u32,
        untangles: bool,
    ) -> Result<(), Error> {
        self.submit_update(positions, iterations, untangles)
    }

    fn moved(&mut self) -> Answer<'static, Moved> {
        self.count_moved()
    }

    fn track_changes(&mut self) -> Answer<'_, ()> {
        Box::pin(self.begin_changes())
    }

    fn changes(&mut self) -> Answer<'_, Vec<u32>> {
        Box::pin(self.read_changes())
    }

    fn positions(&mut self) -> Answer<'_, Positions> {
        Box::pin(self.read_positions())
    }

    fn edge_counts(&self) -> EdgeCounts {
        self.counts
    }

    fn backend(&self) -> EngineKind {
        EngineKind::Gpu
    }

    fn adapter(&self) -> Option<String> {
        Some(self.gpu.adapter.clone())
    }

    fn dispatches(&self) -> u64 {
        self.dispatches
    }

    fn device_bytes(&self) -> u64 {
        self.bytes
    }

    fn adjacency_ms(&self) -> Option<f64> {
        Some(self.adjacency_ms)
    }

    #[cfg(not(target_arch = "wasm32"))]
    fn gpu_buffers(&self) -> Option<GpuBuffers> {
        Some(GpuBuffers {
            device: self.gpu.device.clone(),
            queue: self.gpu.queue.clone(),
            positions: self.buffers.floats.as_ref().unwrap_or(&self.buffers.positions).given(),
            triangles: self.buffers.triangles.given(),
            changes: self.changes_offset().map(|offset| (self.buffers.topology.given(), offset)),
            twins: self.walks.as_ref().map(|walks| walks.twins.given()),
            vertex_half_edges: self.walks.as_ref().map(|walks| walks.starts.given()),
        })
    }

    #[cfg(all(target_arch = "wasm32", feature = "js"))]
    fn shared_objects(&self) -> JsValue {
        let Some(device) = self.gpu.device.as_webgpu() else { return JsValue::UNDEFINED };
        let object = |buffer: &Buffer| JsValue::from(buffer.given().as_webgpu());
        let mut fields = vec![
            ("device", device.into()),
            ("positions", object(self.buffers.floats.as_ref().unwrap_or(&self.buffers.positions))),
            ("indices", object(&self.buffers.triangles)),
        ];
        if let Some(offset) = self.changes_offset() {
            let buffer = object(&self.buffers.topology);
            let changes = [("buffer", buffer), ("offset", (offset as u32).into())];
            fields.push(("changes", ahead::object(&changes)));
        }
        if let Some(walks) = &self.walks {
            fields.push(("twins", object(&walks.twins)));
            fields.push(("vertexHalfEdges", object(&walks.starts)));
        }
        ahead::object(&fields)
    }
}

/// Runs one phase at a time, for the tests.
#[cfg(test)]
impl WebGpu {
    /// Runs one phase of the next iteration. Returns the number of flips after the flip phase.
    pub(crate) async fn run_phase(&mut self, kernel: Kernel) -> Result<u32, Error> {
        self.forget();
        let history = self.read_history(&|pass| self.dispatch(pass, kernel, self.params.triangles)).await?;
        Ok(self.take_over(&history).last().copied().unwrap_or(0))
    }

    /// The numbers of interior edges that the filter decides and does not decide.
    pub(crate) async fn tiers(&self) -> Result<[u32; 2], Error> {
        let compiled = compile::compile(&[Plan::tiers(self.form)], &self.gpu.device).await;
        let [kernels] = &compiled.unwrap_or_default()[..] else {
            return Err(Error::Device { message: "the tiers do not compile".to_owned() });
        };
        let record = |pass: &mut wgpu::ComputePass| {
            pass.set_pipeline(&kernels.pipelines[0]);
            pass.dispatch_workgroups(self.gpu.workgroups(self.params.triangles), 1, 1);
        };
        let counts = self.begin_counts(&record).finished(&self.gpu).await?.words(0)?;
        Ok([counts[0], counts[1]])
    }

    /// After an iteration of fewer than `flips` flips, the next one visits a list of triangles; else it sweeps over all
    /// triangles. A small limit makes even small meshes do both.
    pub(crate) fn set_list_below(&mut self, flips: u32) {
        self.params.list_below = flips;
    }

    /// Drops the results read in advance.
    pub(crate) fn forget(&mut self) {
        self.known = Known::default();
    }

    /// `best` and `selected`, the choices of each triangle.
    pub(crate) async fn choices(&self) -> Result<(Vec<u32>, Vec<u32>), Error> {
        let count = self.params.triangles as usize;
        let mut best = self.gpu.read(&self.buffers.choices, 2 * count).await?;
        let mut selected: Vec<u32> = best.split_off(count).into_iter().map(unflagged).collect();
        if !self.has_selection().await? {
            let best_of = |h: u32| best.get(h as usize / 3).copied().unwrap_or(NONE);
            let is_selected = |t: usize| best_of(best[t]) as usize / 3 == t;
            selected = (0..count).map(|t| if is_selected(t) { best[t] } else { NONE }).collect();
        }
        Ok((best, selected))
    }

    /// Whether some star is not known to be embedded, or the mesh is in space.
    pub(crate) async fn has_selection(&self) -> Result<bool, Error> {
        let signs = self.gpu.read(&self.buffers.uniform, 1).await?[0];
        Ok(self.form.dimension == crate::Dimension::Three || signs & params::UNEMBEDDED != 0)
    }

    pub(crate) async fn fans(&self) -> Result<Vec<u32>, Error> {
        let words = (self.params.fans + self.params.fans_length) as usize;
        Ok(self.gpu.read(&self.buffers.topology, words).await?.split_off(self.params.fans as usize))
    }
}
