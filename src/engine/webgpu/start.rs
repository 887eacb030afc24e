//! The work before the first iteration: uploads the mesh, builds its adjacency, and prepares stars, signs and creases.

use super::WebGpu;
use super::adjacency::{self, COUNTERS, Found, Scratch};
#[cfg(not(all(target_arch = "wasm32", feature = "js")))]
use super::buffer::Sent;
use super::buffers::Buffers;
use super::faults::{refuse, watch};
use super::history::{ALL, ENTRIES, Entry, FLIPPED, SEVERAL_FANS};
use super::kernels::Kernel;
use super::known::Known;
use super::limits::{refuse_large_buffer, refuse_large_mesh};
use super::params::{
    DEVICE_WORDS, NEGATIVE, POSITIVE, Params, TopologyOffsets, WINDING_BITS, WINDING_CLOCKWISE,
    WINDING_COUNTER_CLOCKWISE, WINDING_UNKNOWN,
};
use super::run::IS_NATIVE;
use super::shared::Handle;
use super::steps::Step;
use super::walks::Walks;
use crate::Error;
use crate::engine::gpu::probe::SHORT_STAR;
use crate::engine::gpu::upload::Upload;
use crate::engine::{EdgeCounts, Engine};
use crate::mesh::Mesh;
use crate::mesh::half_edge;
use crate::mesh::star::Fans;
use crate::mesh::winding::Outline;
use std::sync::Arc;
use web_time::Instant;
use wgpu::BufferUsages;

impl WebGpu {
    /// Uploads the mesh and builds its adjacency.
    ///
    /// # Errors
    /// [`Error::BackendLimit`] for a mesh that is too large for the device; [`Error::Device`]. In a browser, the first
    /// question to the engine may return [`Error::BackendLimit`] instead.
    pub(crate) async fn new(gpu: Handle, upload: Upload) -> Result<Self, Error> {
        // Natively a wait is short, and separates the timings. If loops end early, the host has to check the mesh
        // first.
        let waits = cfg!(not(target_arch = "wasm32")) || gpu.ends_loops_early;
        Self::begun(gpu, upload, waits).await
    }

    /// As [`Self::new`]. `waits`: whether the host reads the counters before the first iteration.
    pub(in crate::engine) async fn begun(gpu: Handle, upload: Upload, waits: bool) -> Result<Self, Error> {
        refuse_large_mesh(&gpu, &upload)?;
        let kernels = gpu.phases(upload.form()).await?;
        #[cfg(all(target_arch = "wasm32", feature = "js"))]
        let (sent, mut faults) = gpu.take_sent();
        #[cfg(not(all(target_arch = "wasm32", feature = "js")))]
        let (sent, mut faults) = (Sent::default(), Vec::new());
        let create = || {
            let (buffers, written) = Buffers::new(&gpu, &upload, sent);
            let walks = upload.gives_adjacency.then(|| Walks::new(&gpu, &upload.mesh, &buffers));
            (buffers, written, walks, Scratch::new(&gpu, &upload.mesh))
        };
        let ((buffers, written, walks, scratch), created) = watch(&gpu.device, create);
        faults.push(created);
        faults.extend(buffers.upload(&gpu, &upload, written).await);
        let mut start = Instant::now();
        let begin = || {
            let mesh = &upload.mesh;
            // The mesh travels to the device while the host records the work on it.
            #[cfg(not(target_arch = "wasm32"))]
            let travelling = gpu.queue.submit([]);
            let params = Params::new(&upload, &TopologyOffsets::new(mesh), gpu.ends_loops_early);
            let bytes = buffers.bytes() + scratch.bytes() + walks.as_ref().map_or(0, |walks| walks.bytes());
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            buffers.clear(&mut encoder);
            adjacency::record(&gpu, mesh, &buffers, &scratch, &mut encoder);
            let result = Self {
                bindings: buffers.bind(&gpu, &kernels.layout),
                topology_words: params.fans,
                winding: WINDING_UNKNOWN,
                turned: super::Turned::default(),
                kernels,
                thresholds: upload.thresholds,
                form: upload.form(),
                params,
                counts: EdgeCounts::default(),
                bytes,
                buffers,
                walks,
                counters: scratch.counters,
                input: None,
                unsettled: None,
                faults,
                waits,
                stays: false,
                reserved: None,
                known: Known::default(),
                state: Entry::default(),
                dispatches: adjacency::DISPATCHES,
                adjacency_ms: 0.0,
                gpu: gpu.clone(),
            };
            result.record_walks(&mut encoder);
            result.record_preparation(&mut encoder);
            let commands = encoder.finish();
            #[cfg(not(target_arch = "wasm32"))]
            gpu.finish_copies(travelling);
            start = Instant::now();
            gpu.submit(commands);
            result
        };
        let (mut result, caught) = watch(&gpu.device, begin);
        result.faults.push(caught);
        result.dispatches += result.walk_dispatches();
        if waits {
            result.check_allocation().await?;
        }
        result.begin(upload.mesh).await?;
        if waits {
            result.adjacency_ms = start.elapsed().as_secs_f64() * 1e3;
        }
        Ok(result)
    }

    /// Waits for the faults of allocating the buffers, unless that was done.
    ///
    /// # Errors
    /// Those of [`Device::allocated`](super::Device::allocated).
    pub(super) async fn check_allocation(&mut self) -> Result<(), Error> {
        for caught in std::mem::take(&mut self.faults) {
            self.gpu.judge_allocation(caught.await)?;
        }
        Ok(())
    }

    /// Records the kernels that depend on the positions: in 2D the turns of the stars and the signs of the triangles,
    /// in 3D the creases. They also begin the history, unless the host has to help first.
    #[inline(never)]
    pub(super) fn record_preparation(&self, encoder: &mut wgpu::CommandEncoder) {
        let Buffers { uniform, history, frontier, .. } = &self.buffers;
        self.write_params();
        let bytes = |words: usize| 4 * words as u64;
        // Later updates add to the flips of the earlier ones.
        let first = if self.params.update > 1 { FLIPPED } else { ENTRIES };
        encoder.clear_buffer(history, 0, Some(bytes(first)));
        encoder.clear_buffer(history, bytes(ENTRIES), None);
        let fans = bytes(adjacency::UNWALKED);
        encoder.copy_buffer_to_buffer(&self.counters, fans, history, bytes(SEVERAL_FANS), bytes(1));
        // Updates count from 1 again.
        if let Some(offset) = self.changes_offset().filter(|_| self.params.update == 0) {
            encoder.clear_buffer(&self.buffers.topology, offset, Some(bytes(self.params.triangles as usize)));
        }
        // The kernels count the turns of stars in the buffer of the frontier.
        encoder.clear_buffer(frontier, 0, None);
        let mut pass = encoder.begin_compute_pass(&Default::default());
        self.at_step(&mut pass, Step::Prepare);
        for &kernel in Kernel::preparation(self.form.dimension) {
            if kernel == Kernel::Mark {
                self.record_untangling(&mut pass);
            }
            self.dispatch(&mut pass, kernel, self.params.triangles);
        }
        drop(pass);
        // The phases would take these counts for stamps.
        encoder.clear_buffer(frontier, 0, None);
        // The signs, for the kernels and for the host.
        encoder.copy_buffer_to_buffer(history, 0, uniform, 0, bytes(DEVICE_WORDS));
        encoder.copy_buffer_to_buffer(history, 0, &self.counters, bytes(COUNTERS), bytes(1));
    }

    fn prepare(&self) {
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        self.record_preparation(&mut encoder);
        self.record_walks(&mut encoder);
        self.gpu.submit(encoder.finish());
    }

    /// The entry that the device writes if it needs no help of the host: as if an iteration before the first had flipped
    /// edges, and all triangles are due.
    pub(super) fn first_state(&self) -> Entry {
        [self.params.triangles, 0, ALL, 1]
    }

    /// Begins the iterations. The device already has the triangles and the commands that prepare them.
    async fn begin(&mut self, mesh: Arc<Mesh>) -> Result<(), Error> {
        self.dispatches += Kernel::preparation(self.form.dimension).len() as u64;
        self.params.first = 0;
        self.state = self.first_state();
        self.known = Known::default();
        self.input = IS_NATIVE.then(|| mesh.clone());
        self.unsettled = Some(mesh);
        if self.waits { self.settle().await } else { Ok(()) }
    }

    /// Reads the counters, unless the host has read them.
    pub(super) async fn settle(&mut self) -> Result<(), Error> {
        self.check_allocation().await?;
        if let Some(mesh) = self.unsettled.clone() {
            let counters = self.gpu.read(&self.counters, COUNTERS + 1).await?;
            self.settle_by(&mesh, &counters).await?;
        }
        Ok(())
    }

    /// Takes over the counters. Computes the fans of the mesh or the windings of its components, if the device needs
    /// them; returns whether it did. In that case no iteration has run.
    pub(super) async fn settle_by(&mut self, mesh: &Mesh, counters: &[u32]) -> Result<bool, Error> {
        let (found, signs) = (Found::of(counters), counters[COUNTERS]);
        if self.gpu.ends_loops_early {
            let (corners, adapter) = (most_corners(mesh), &self.gpu.adapter);
            if corners > SHORT_STAR {
                return refuse(format!(
                    "a vertex has {corners} triangles; {adapter} allows {SHORT_STAR}, as it ends loops early"
                ));
            }
        }
        self.counts = found.counts;
        let needs_fans = found.has_several_fans && self.params.fans_length == 0;
        let is_clockwise = signs & NEGATIVE != 0;
        let needs_windings = is_clockwise && signs & POSITIVE != 0;
        let needs_help = needs_fans || needs_windings;
        let twins = if needs_help { self.twins().await? } else { Vec::new() };
        if needs_fans {
            self.add_fans(mesh, &twins).await?;
        }
        if needs_windings {
            self.add_windings(mesh, &twins).await?;
        } else {
            self.winding = if is_clockwise { WINDING_CLOCKWISE } else { WINDING_COUNTER_CLOCKWISE };
        }
        self.unsettled = None;
        Ok(needs_help)
    }

    /// Adds the windings of the components, found by the host, and prepares the stars again. Meshes that need them are
    /// rare: they have components of both windings, or triangles of both signs in one component.
    async fn add_windings(&mut self, mesh: &Mesh, twins: &[u32]) -> Result<(), Error> {
        let clockwise = Outline::new(mesh.triangles(), twins).winding(mesh).clockwise;
        self.dispatches += Kernel::preparation(self.form.dimension).len() as u64 + self.walk_dispatches();
        (self.winding, self.params.winding) = (WINDING_BITS, WINDING_BITS);
        let calls = || {
            self.gpu.write(&self.buffers.topology, &clockwise);
            self.prepare();
        };
        self.gpu.checked(calls).await
    }

    /// Appends the table of fans, found by the host, to the topology. Vertices with several fans are rare.
    async fn add_fans(&mut self, mesh: &Mesh, twins: &[u32]) -> Result<(), Error> {
        let table = Fans::new(mesh.vertex_count(), mesh.triangles(), twins).table;
        // Set last, after everything that can fail.
        self.params.fans = self.append_to_topology(&table).await?;
        self.params.fans_length = table.len() as u32;
        Ok(())
    }

    /// Appends words to the topology, in a longer buffer. Returns their offset.
    pub(super) async fn append_to_topology(&mut self, words: &[u32]) -> Result<u32, Error> {
        let (gpu, before) = (&self.gpu, self.topology_words as usize);
        let length = before + words.len();
        refuse_large_buffer(gpu, length)?;
        let longer = || gpu.buffer("topology", length, BufferUsages::STORAGE);
        let topology = std::mem::replace(&mut self.buffers.topology, gpu.allocated(longer).await?);
        let copy = || {
            gpu.queue.write_buffer(&self.buffers.topology, 4 * before as u64, bytemuck::cast_slice(words));
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            encoder.copy_buffer_to_buffer(&topology, 0, &self.buffers.topology, 0, 4 * before as u64);
            gpu.submit(encoder.finish());
            self.buffers.bind(gpu, &self.kernels.layout)
        };
        self.bindings = gpu.checked(copy).await?;
        self.topology_words = length as u32;
        Ok(before as u32)
    }

    /// Flags locked edges on the host: reads the twins, and writes them back.
    pub(super) async fn flag_locked(&mut self, half_edges: Vec<u32>) -> Result<(), Error> {
        self.known = Known::default();
        let mut twins = self.twins().await?;
        half_edge::lock(&mut twins, &half_edges);
        self.gpu.checked(|| self.gpu.write(&self.buffers.twins, &twins)).await
    }

    /// With `twins`, the mesh has other triangles than the device: the host has untangled it. The device does not do
    /// that itself.
    pub(super) async fn move_vertices(
        &mut self,
        mesh: Arc<Mesh>,
        twins: Option<Vec<u32>>,
    ) -> Result<(), Error> {
        let mut upload = Upload::new(self.backend(), mesh, self.thresholds)?;
        upload.gives_adjacency = self.walks.is_some();
        if upload.form() == self.form {
            let fans = match &twins {
                Some(twins) if self.params.fans_length > 0 => {
                    Fans::new(upload.mesh.vertex_count(), upload.mesh.triangles(), twins).table
                }
                _ => Vec::new(),
            };
            self.params.deviation = upload.deviation;
            (self.params.winding, self.params.update, self.params.untangles) = (WINDING_UNKNOWN, 0, 0);
            let calls = || {
                if let Some(twins) = &twins {
                    self.gpu.write(&self.buffers.triangles, upload.mesh.triangles());
                    self.gpu.write(&self.buffers.twins, twins);
                    let at = 4 * u64::from(self.params.fans);
                    self.gpu.queue.write_buffer(&self.buffers.topology, at, bytemuck::cast_slice(&fans));
                }
                self.buffers.write_positions(&self.gpu, &upload);
                self.prepare();
            };
            self.gpu.checked(calls).await?;
            self.dispatches = self.walk_dispatches();
            return self.begin(upload.mesh).await;
        }
        let mut moved = Self::begun(self.gpu.clone(), upload, self.waits).await?;
        let locked = half_edge::locked(&match twins {
            Some(twins) => twins,
            None => self.twins().await?,
        });
        if !locked.is_empty() {
            moved.flag_locked(locked).await?;
        }
        if self.changes_offset().is_some() {
            moved.begin_changes().await?;
        }
        *self = moved;
        Ok(())
    }
}

/// The most corners at one vertex.
fn most_corners(mesh: &Mesh) -> u32 {
    let mut corners = vec![0; mesh.vertex_count()];
    for &v in mesh.triangles() {
        corners[v as usize] += 1;
    }
    corners.into_iter().max().unwrap_or(0)
}
