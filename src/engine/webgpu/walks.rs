//! The adjacency in buffers for kernels of the caller, which walk around vertices.

use super::WebGpu;
use super::buffer::Buffer;
use super::buffers::Buffers;
use super::compile::compile_short;
use super::device::Device;
use super::faults::watch;
use super::kernels::{Kernels, Plan};
use wgpu::BufferUsages;

/// The buffers, and the kernels that write them.
pub(super) struct Walks {
    /// The twin of each half-edge, without flags.
    pub(super) twins: Buffer,
    /// A half-edge of each vertex.
    pub(super) starts: Buffer,
    kernels: Kernels,
    bindings: wgpu::BindGroup,
    /// The lengths of the buffers.
    counts: [u32; 2],
}

impl Walks {
    fn new(gpu: &Device, of: &Buffers, counts: [u32; 2]) -> Self {
        let kernels = compile_short(&Plan::walks(), &gpu.device);
        let [twins, starts] = counts.map(|words| gpu.buffer("walks", words as usize, BufferUsages::STORAGE));
        // The kernels find the lengths by those of the bindings.
        let [half_edges, vertices] = counts.map(|words| Some(4 * u64::from(words)));
        let bound = [(&of.triangles, None), (&of.twins, None), (&twins, half_edges), (&starts, vertices)];
        let bindings = gpu.bind(&kernels.layout, &bound);
        Self { twins, starts, kernels, bindings, counts }
    }

    /// Records the kernels, after those that change the triangles.
    pub(super) fn record(&self, gpu: &Device, encoder: &mut wgpu::CommandEncoder) {
        encoder.clear_buffer(&self.starts, 0, None);
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_bind_group(0, &self.bindings, &[]);
        for (pipeline, count) in self.kernels.pipelines.iter().zip(self.counts) {
            pass.set_pipeline(pipeline);
            // An empty buffer is not bound as an empty one.
            pass.dispatch_workgroups(gpu.workgroups(count).min(count), 1, 1);
        }
    }
}

impl WebGpu {
    /// Writes the adjacency now, and from now on after all that changes the triangles. `check_allocation` tells whether
    /// there is memory for the buffers.
    pub(super) fn begin_walks(&mut self) {
        let gpu = self.gpu.clone();
        let ((), caught) = watch(&gpu.device, || {
            let walks = Walks::new(&gpu, &self.buffers, [3 * self.params.triangles, self.params.vertices]);
            self.bytes += walks.twins.size() + walks.starts.size();
            self.walks = Some(walks);
            self.write_walks();
        });
        self.faults.push(caught);
        self.dispatches += self.walk_dispatches();
    }

    /// Writes the adjacency of the present triangles, if it is asked for.
    pub(super) fn write_walks(&self) {
        if self.walks.is_some() {
            let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
            self.record_walks(&mut encoder);
            self.gpu.submit(encoder.finish());
        }
    }

    pub(super) fn record_walks(&self, encoder: &mut wgpu::CommandEncoder) {
        if let Some(walks) = &self.walks {
            walks.record(&self.gpu, encoder);
        }
    }

    /// How many dispatches [`Self::record_walks`] records.
    pub(super) fn walk_dispatches(&self) -> u64 {
        self.walks.as_ref().map_or(0, |_| 2)
    }
}
