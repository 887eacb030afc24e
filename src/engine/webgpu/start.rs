//! What is done before the first iteration: the mesh goes up, its adjacency is built, stars and creases are looked at.

use super::adjacency::{self, COUNTERS, Found};
use super::buffers::Buffers;
use super::faults::refuse;
use super::kernels::Kernel;
use super::limits::{refuse_large_buffer, refuse_large_mesh};
use super::params::{HAS_WINDING, IS_STRICT, Params, Places};
use super::steps::Step;
use super::{Entry, Handle, WebGpu};
use crate::engine::probe::SHORT_STAR;
use crate::engine::upload::Upload;
use crate::engine::{EdgeCounts, Engine};
use crate::mesh::Mesh;
use crate::star::Fans;
use crate::winding::Winding;
use crate::{Error, locks};
use std::sync::Arc;
use web_time::Instant;
use wgpu::BufferUsages;

// Bits of the signs of triangles, as in `embedded.wgsl`.
const NEGATIVE: u32 = 1;
const POSITIVE: u32 = 4;

impl WebGpu {
    /// Uploads the mesh and builds its adjacency.
    ///
    /// # Errors
    /// [`Error::BackendLimit`] for a mesh that is too large for the device; [`Error::Device`].
    pub(crate) async fn new(gpu: Handle, upload: Upload) -> Result<Self, Error> {
        refuse_large_mesh(&gpu, &upload)?;
        let mesh = &upload.mesh;
        let kernels = gpu.phases(upload.form()).await?;
        let allocate = || (Buffers::new(&gpu, &upload), adjacency::Scratch::new(&gpu, mesh));
        let (buffers, scratch) = gpu.allocated(allocate).await?;
        let bindings = gpu.checked(|| buffers.bind(&gpu, &kernels.layout)).await?;
        // Waits for the copies.
        gpu.read(&scratch.counters, 1).await?;
        let start = Instant::now();
        let mut result = Self {
            kernels,
            thresholds: upload.thresholds,
            form: upload.form(),
            params: Params::new(&upload, &Places::new(mesh), gpu.ends_loops_early),
            counts: EdgeCounts::default(),
            bindings,
            bytes: buffers.bytes() + scratch.bytes(),
            buffers,
            state: Entry::default(),
            dispatches: adjacency::DISPATCHES + Kernel::preparation(mesh.dimension()).len() as u64,
            adjacency_ms: 0.0,
            gpu,
        };
        let record = || {
            let mut encoder = result.gpu.device.create_command_encoder(&Default::default());
            adjacency::record(&result.gpu, mesh, &result.buffers, &scratch, &mut encoder);
            result.record_preparation(&mut encoder);
            let signs = 4 * COUNTERS as u64;
            encoder.copy_buffer_to_buffer(&result.buffers.history, 0, &scratch.counters, signs, 4);
            encoder
        };
        let counters = result.gpu.submit_and_read(&record, &scratch.counters, COUNTERS + 1).await?;
        let found = Found::of(&counters);
        if result.gpu.ends_loops_early && found.most_corners > SHORT_STAR {
            let (corners, adapter) = (found.most_corners, &result.gpu.adapter);
            return refuse(format!("a vertex has {corners} triangles, {adapter} ends loops early"));
        }
        result.counts = found.counts;
        if found.has_several_fans {
            result.add_fans(mesh).await?;
        }
        result.begin(mesh, counters[COUNTERS]).await?;
        result.adjacency_ms = start.elapsed().as_secs_f64() * 1e3;
        Ok(result)
    }

    /// Records what the positions say of the input: the turns of the stars and the signs of the triangles in 2D, the
    /// creases in 3D.
    fn record_preparation(&self, encoder: &mut wgpu::CommandEncoder) {
        self.gpu.queue.write_buffer(&self.buffers.uniform, 0, bytemuck::bytes_of(&self.params));
        encoder.clear_buffer(&self.buffers.history, 0, None);
        // The turns of stars are counted in the frontier.
        encoder.clear_buffer(&self.buffers.frontier, 0, None);
        let mut pass = encoder.begin_compute_pass(&Default::default());
        self.at_step(&mut pass, Step::Prepare);
        for &kernel in Kernel::preparation(self.form.dimension) {
            self.dispatch(&mut pass, kernel, self.params.triangles);
        }
        drop(pass);
        // What is left there would be taken for stamps.
        encoder.clear_buffer(&self.buffers.frontier, 0, None);
    }

    /// The same once more, for positions that have moved or a winding that is known now. Returns the signs.
    async fn prepare(&mut self) -> Result<u32, Error> {
        self.dispatches += Kernel::preparation(self.form.dimension).len() as u64;
        let record = || {
            let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
            self.record_preparation(&mut encoder);
            encoder
        };
        Ok(self.gpu.submit_and_read(&record, &self.buffers.history, 1).await?[0])
    }

    /// Begins the iterations: the mesh has the triangles that are on the device, which have these signs.
    async fn begin(&mut self, mesh: &Mesh, signs: u32) -> Result<(), Error> {
        self.params.first = 0;
        // As if an iteration before had flipped something and built no list.
        self.state = [self.params.triangles, 0, 0, 1];
        let is_mixed = signs & NEGATIVE != 0 && signs & POSITIVE != 0;
        let clockwise = if is_mixed {
            // Components of both windings, and dirty ones, are rare: the host has time.
            let twins = self.gpu.read(&self.buffers.twins, mesh.triangles().len()).await?;
            Winding::of_components(mesh, &twins).clockwise
        } else if signs & NEGATIVE != 0 {
            vec![u32::MAX; mesh.triangle_count().div_ceil(32)]
        } else {
            Vec::new()
        };
        let is_strict = signs == POSITIVE || signs == NEGATIVE;
        self.params.found =
            if clockwise.is_empty() { 0 } else { HAS_WINDING } | if is_strict { IS_STRICT } else { 0 };
        self.gpu.checked(|| self.gpu.write(&self.buffers.topology, &clockwise)).await?;
        if is_mixed {
            self.params.knows_winding = 1;
            self.prepare().await?;
            self.params.knows_winding = 0;
        }
        Ok(())
    }

    /// Vertices of several fans are rare too: their table is appended to the topology.
    async fn add_fans(&mut self, mesh: &Mesh) -> Result<(), Error> {
        let twins = self.gpu.read(&self.buffers.twins, mesh.triangles().len()).await?;
        let table = Fans::new(mesh.vertex_count(), mesh.triangles(), &twins).table;
        let before = self.params.fans as usize;
        refuse_large_buffer(&self.gpu, before + table.len())?;
        self.params.fans_length = table.len() as u32;
        let gpu = &self.gpu;
        let longer = || gpu.buffer("topology", before + table.len(), BufferUsages::STORAGE);
        let topology = std::mem::replace(&mut self.buffers.topology, gpu.allocated(longer).await?);
        let copy = || {
            gpu.queue.write_buffer(&self.buffers.topology, 4 * before as u64, bytemuck::cast_slice(&table));
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            encoder.copy_buffer_to_buffer(&topology, 0, &self.buffers.topology, 0, 4 * before as u64);
            gpu.queue.submit([encoder.finish()]);
            self.buffers.bind(gpu, &self.kernels.layout)
        };
        self.bindings = gpu.checked(copy).await?;
        Ok(())
    }

    /// Whoever locks edges has named them on the host, which has time for the twins too.
    pub(super) async fn flag_locked(&mut self, half_edges: Vec<u32>) -> Result<(), Error> {
        let mut twins = self.twins().await?;
        locks::flag(&mut twins, &half_edges);
        self.gpu.checked(|| self.gpu.write(&self.buffers.twins, &twins)).await
    }

    pub(super) async fn move_vertices(&mut self, mesh: Arc<Mesh>) -> Result<(), Error> {
        let upload = Upload::new(self.backend(), mesh, self.thresholds)?;
        if upload.form() == self.form {
            self.gpu.checked(|| self.buffers.write_positions(&self.gpu, &upload)).await?;
            self.params.deviation = upload.deviation;
            self.dispatches = 0;
            let signs = self.prepare().await?;
            return self.begin(&upload.mesh, signs).await;
        }
        let mut moved = Self::new(self.gpu.clone(), upload).await?;
        let locked = locks::flagged(&self.twins().await?);
        if !locked.is_empty() {
            moved.flag_locked(locked).await?;
        }
        *self = moved;
        Ok(())
    }
}
