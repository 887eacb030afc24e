//! Builds the twins on the device, and finds out whether any vertex has several fans.

use super::buffer::Buffer;
use super::buffers::Buffers;
use super::device::Device;
use crate::engine::EdgeCounts;
use crate::mesh::Mesh;
use wgpu::BufferUsages;

/// The same in `shaders/webgpu/adjacency.wgsl`.
pub(super) const BUCKETS_EACH: u32 = 8;
pub(super) const COUNTERS: usize = 7;
pub(super) const SEVERAL_FANS: usize = 5;
/// Kernels that [`record`] dispatches.
pub(super) const DISPATCHES: u64 = 6;

/// What the host reads back of the adjacency. The twins stay on the device.
pub(super) struct Found {
    pub(super) counts: EdgeCounts,
    pub(super) has_several_fans: bool,
    /// The most triangles at one vertex.
    pub(super) most_corners: u32,
}

/// Buffers for the adjacency only. The word behind the counters is for the signs of the triangles.
pub(super) struct Scratch {
    params: Buffer,
    buckets: Buffer,
    pub(super) counters: Buffer,
}

impl Scratch {
    pub(super) fn new(gpu: &Device, mesh: &Mesh) -> Self {
        Self {
            params: gpu.buffer("adjacency params", 4, BufferUsages::UNIFORM),
            buckets: gpu.buffer("buckets", 2 * bucket_count(mesh) as usize, BufferUsages::STORAGE),
            counters: gpu.buffer("counters", COUNTERS + 1, BufferUsages::STORAGE),
        }
    }

    /// Their size on the device.
    pub(super) fn bytes(&self) -> u64 {
        [&self.params, &self.buckets, &self.counters].map(|buffer| buffer.size()).iter().sum()
    }
}

fn bucket_count(mesh: &Mesh) -> u32 {
    (mesh.vertex_count() as u32).div_ceil(256) * 256
}

/// Records the kernels that fill the twins. They also use the frontier: the caller has to clear it afterwards.
pub(super) fn record(
    gpu: &Device,
    mesh: &Mesh,
    buffers: &Buffers,
    scratch: &Scratch,
    encoder: &mut wgpu::CommandEncoder,
) {
    let Scratch { params, buckets, counters } = scratch;
    let half_edges = mesh.triangles().len() as u32;
    let vertices = mesh.vertex_count() as u32;
    let words = [half_edges, vertices, bucket_count(mesh), 0];
    gpu.queue.write_buffer(params, 0, bytemuck::cast_slice(&words));
    let whole = [params, &buffers.triangles, &buffers.twins, &buffers.frontier, buckets, counters];
    let bindings = gpu.bind(&gpu.adjacency.layout, &whole.map(|buffer| (buffer, None)));
    let run = |encoder: &mut wgpu::CommandEncoder, kernels: &[(usize, u32)]| {
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_bind_group(0, &bindings, &[]);
        for &(kernel, items) in kernels {
            pass.set_pipeline(&gpu.adjacency.pipelines[kernel]);
            pass.dispatch_workgroups(gpu.workgroups(items), 1, 1);
        }
    };
    let allocating = bucket_count(mesh) / BUCKETS_EACH;
    run(encoder, &[(0, half_edges), (1, allocating), (2, half_edges), (3, half_edges)]);
    encoder.clear_buffer(buckets, 0, None);
    run(encoder, &[(4, half_edges), (5, vertices)]);
}

impl Found {
    /// Decodes the counters.
    pub(super) fn of(counters: &[u32]) -> Self {
        let [edges, boundary, non_manifold, inconsistent] = [1, 2, 3, 4].map(|i| counters[i]);
        Self {
            counts: EdgeCounts { edges, boundary, non_manifold, inconsistent },
            has_several_fans: counters[SEVERAL_FANS] > 0,
            most_corners: counters[6],
        }
    }
}
