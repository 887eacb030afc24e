//! Twins from triangles, and whether any vertex has several fans, on the device.

use super::buffers::Buffers;
use super::device::{Buffer, Device};
use crate::Error;
use crate::engine::EdgeCounts;
use crate::mesh::Mesh;
use wgpu::BufferUsages;

/// As in `shaders/adjacency.wgsl`.
pub(super) const BUCKETS_EACH: u32 = 8;
const COUNTERS: usize = 7;

/// What the host learns of the adjacency; the twins stay on the device.
pub(super) struct Found {
    pub(super) counts: EdgeCounts,
    pub(super) has_several_fans: bool,
    /// The most triangles at one vertex.
    pub(super) most_corners: u32,
    pub(super) dispatches: u64,
}

/// What building the adjacency needs beside the buffers of the mesh.
pub(super) struct Scratch {
    params: Buffer,
    buckets: Buffer,
    counters: Buffer,
}

impl Scratch {
    pub(super) fn new(gpu: &Device, mesh: &Mesh) -> Self {
        Self {
            params: gpu.buffer("adjacency params", 4, BufferUsages::UNIFORM),
            buckets: gpu.buffer("buckets", 2 * bucket_count(mesh) as usize, BufferUsages::STORAGE),
            counters: gpu.buffer("counters", COUNTERS, BufferUsages::STORAGE),
        }
    }
}

fn bucket_count(mesh: &Mesh) -> u32 {
    (mesh.vertex_count() as u32).div_ceil(256) * 256
}

/// Fills the twins. The frontier is used too: whatever is in it afterwards has to be cleared.
pub(super) async fn build(
    gpu: &Device,
    mesh: &Mesh,
    buffers: &Buffers,
    scratch: Scratch,
) -> Result<Found, Error> {
    let Scratch { params, buckets, counters } = &scratch;
    let record = || {
        let half_edges = mesh.triangles().len() as u32;
        let vertices = mesh.vertex_count() as u32;
        let words = [half_edges, vertices, bucket_count(mesh), 0];
        gpu.queue.write_buffer(params, 0, bytemuck::cast_slice(&words));
        let whole = [params, &buffers.triangles, &buffers.twins, &buffers.frontier, buckets, counters];
        let bindings = gpu.bind(&gpu.adjacency.layout, &whole.map(|buffer| (buffer, None)));
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let run = |encoder: &mut wgpu::CommandEncoder, kernels: &[(usize, u32)]| {
            let mut pass = encoder.begin_compute_pass(&Default::default());
            pass.set_bind_group(0, &bindings, &[]);
            for &(kernel, items) in kernels {
                pass.set_pipeline(&gpu.adjacency.pipelines[kernel]);
                pass.dispatch_workgroups(gpu.workgroups(items), 1, 1);
            }
        };
        let allocating = bucket_count(mesh) / BUCKETS_EACH;
        run(&mut encoder, &[(0, half_edges), (1, allocating), (2, half_edges), (3, half_edges)]);
        encoder.clear_buffer(buckets, 0, None);
        run(&mut encoder, &[(4, half_edges), (5, vertices)]);
        encoder
    };
    let found = gpu.submit_and_read(record, counters, COUNTERS).await?;
    let [edges, boundary, non_manifold, inconsistent] = [found[1], found[2], found[3], found[4]];
    Ok(Found {
        counts: EdgeCounts { edges, boundary, non_manifold, inconsistent },
        has_several_fans: found[5] > 0,
        most_corners: found[6],
        dispatches: 6,
    })
}
