//! Builds the twins on the device, and finds out whether any vertex has several fans.

use super::buffer::Buffer;
use super::buffers::{Buffers, frontier_words};
use super::device::Device;
use crate::engine::EdgeCounts;
use crate::mesh::Mesh;
use wgpu::BufferUsages;

/// The same in `shaders/webgpu/adjacency.wgsl`.
pub(super) const COUNTERS: usize = 5;
pub(super) const UNWALKED: usize = 4;
/// Kernels that [`record`] dispatches.
pub(super) const DISPATCHES: u64 = 4;

/// What the host reads back of the adjacency. The twins stay on the device.
pub(super) struct Found {
    pub(super) counts: EdgeCounts,
    pub(super) has_several_fans: bool,
}

/// Buffers for the adjacency only. The word behind the counters is for the signs of the triangles.
pub(super) struct Scratch {
    params: Buffer,
    corners: Buffer,
    pub(super) counters: Buffer,
}

impl Scratch {
    pub(super) fn new(gpu: &Device, mesh: &Mesh) -> Self {
        Self {
            params: gpu.buffer("adjacency params", 4, BufferUsages::UNIFORM),
            corners: gpu.buffer("corners", mesh.vertex_count(), BufferUsages::STORAGE),
            counters: gpu.buffer("counters", COUNTERS + 1, BufferUsages::STORAGE),
        }
    }

    /// Their size on the device.
    pub(super) fn bytes(&self) -> u64 {
        [&self.params, &self.corners, &self.counters].map(|buffer| buffer.size()).iter().sum()
    }
}

/// Records the kernels that fill the twins. Their table of edges is in the frontier: the caller has to clear it
/// afterwards.
pub(super) fn record(
    gpu: &Device,
    mesh: &Mesh,
    buffers: &Buffers,
    scratch: &Scratch,
    encoder: &mut wgpu::CommandEncoder,
) {
    let Scratch { params, corners, counters } = scratch;
    let half_edges = mesh.triangles().len() as u32;
    let vertices = mesh.vertex_count() as u32;
    let words = [half_edges, vertices, frontier_words(mesh.triangle_count()) as u32, 0];
    gpu.queue.write_buffer(params, 0, bytemuck::cast_slice(&words));
    let whole = [params, &buffers.triangles, &buffers.twins, corners, &buffers.frontier, counters];
    let bindings = gpu.bind(&gpu.adjacency.layout, &whole.map(|buffer| (buffer, None)));
    encoder.clear_buffer(corners, 0, None);
    encoder.clear_buffer(counters, 0, None);
    let mut pass = encoder.begin_compute_pass(&Default::default());
    pass.set_bind_group(0, &bindings, &[]);
    for (pipeline, items) in
        gpu.adjacency.pipelines.iter().zip([half_edges, half_edges, half_edges, vertices])
    {
        pass.set_pipeline(pipeline);
        pass.dispatch_workgroups(gpu.workgroups(items), 1, 1);
    }
}

impl Found {
    /// Decodes the counters.
    pub(super) fn of(counters: &[u32]) -> Self {
        let [edges, boundary, non_manifold, inconsistent] = [0, 1, 2, 3].map(|i| counters[i]);
        Self {
            counts: EdgeCounts { edges, boundary, non_manifold, inconsistent },
            has_several_fans: counters[UNWALKED] > 0,
        }
    }
}
