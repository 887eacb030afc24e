//! The adjacency in buffers for kernels of the caller, which walk around vertices.

use super::buffer::Buffer;
use super::buffers::Buffers;
use super::compile::compile_now;
use super::device::Device;
use super::kernels::{Kernels, Plan};
use crate::Mesh;
use wgpu::BufferUsages;

/// Kernels that [`Walks::record`] dispatches.
pub(super) const DISPATCHES: u64 = 2;

/// The buffers, and the kernels that write them.
pub(super) struct Walks {
    /// The twin of each half-edge, without flags.
    pub(super) twins: Buffer,
    /// A half-edge of each vertex.
    pub(super) starts: Buffer,
    pipelines: Vec<wgpu::ComputePipeline>,
    bindings: wgpu::BindGroup,
}

impl Walks {
    #[inline(never)]
    pub(super) fn new(gpu: &Device, mesh: &Mesh, of: &Buffers) -> Box<Self> {
        let Kernels { layout, pipelines, .. } = compile_now(&Plan::walks(), &gpu.device);
        let (half_edges, vertices) = (mesh.triangles().len(), mesh.vertex_count());
        let buffer = |words| gpu.buffer("walks", words, BufferUsages::STORAGE);
        let (twins, starts) = (buffer(half_edges), buffer(vertices));
        // The kernels find the lengths by those of the bindings.
        let whole = |words| Some(4 * words as u64);
        let bound = [
            (&of.triangles, None),
            (&of.twins, None),
            (&twins, whole(half_edges)),
            (&starts, whole(vertices)),
        ];
        let bindings = gpu.bind(&layout, &bound);
        Box::new(Self { twins, starts, pipelines, bindings })
    }

    /// Their size on the device.
    pub(super) fn bytes(&self) -> u64 {
        self.twins.size() + self.starts.size()
    }

    /// Records the kernels, behind those that change the triangles.
    pub(super) fn record(&self, gpu: &Device, counts: [u32; 2], encoder: &mut wgpu::CommandEncoder) {
        encoder.clear_buffer(&self.starts, 0, None);
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_bind_group(0, &self.bindings, &[]);
        for (pipeline, count) in self.pipelines.iter().zip(counts) {
            pass.set_pipeline(pipeline);
            // The binding of an empty buffer is not empty.
            pass.dispatch_workgroups(gpu.workgroups(count).min(count), 1, 1);
        }
    }
}
