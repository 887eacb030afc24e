//! Twins from triangles, and whether any vertex has several fans, on the device.

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

/// Fills `twins`, and uses `scratch`, of as many words as there are half-edges, which it leaves cleared.
pub(super) async fn build(
    gpu: &Device,
    mesh: &Mesh,
    triangles: &Buffer,
    twins: &Buffer,
    scratch: &Buffer,
) -> Result<Found, Error> {
    let half_edges = mesh.triangles().len() as u32;
    let vertices = mesh.vertex_count() as u32;
    let bucket_count = vertices.div_ceil(256) * 256;
    let params = gpu.buffer("adjacency params", 4, BufferUsages::UNIFORM);
    gpu.queue.write_buffer(&params, 0, bytemuck::cast_slice(&[half_edges, vertices, bucket_count, 0]));
    let buckets = gpu.buffer("buckets", 2 * bucket_count as usize, BufferUsages::STORAGE);
    let counters = gpu.buffer("counters", COUNTERS, BufferUsages::STORAGE);
    let whole = [&params, triangles, twins, scratch, &buckets, &counters].map(|buffer| (buffer, None));
    let bindings = gpu.bind(&gpu.adjacency.layout, &whole);

    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let run = |encoder: &mut wgpu::CommandEncoder, kernels: &[(usize, u32)]| {
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_bind_group(0, &bindings, &[]);
        for &(kernel, items) in kernels {
            pass.set_pipeline(&gpu.adjacency.pipelines[kernel]);
            pass.dispatch_workgroups(gpu.workgroups(items), 1, 1);
        }
    };
    let allocating = bucket_count / BUCKETS_EACH;
    run(&mut encoder, &[(0, half_edges), (1, allocating), (2, half_edges), (3, half_edges)]);
    encoder.clear_buffer(&buckets, 0, None);
    run(&mut encoder, &[(4, half_edges), (5, vertices)]);
    encoder.clear_buffer(scratch, 0, None);
    let found = gpu.submit_and_read(encoder, &counters, COUNTERS).await?;
    let [edges, boundary, non_manifold, inconsistent] = [found[1], found[2], found[3], found[4]];
    Ok(Found {
        counts: EdgeCounts { edges, boundary, non_manifold, inconsistent },
        has_several_fans: found[5] > 0,
        most_corners: found[6],
        dispatches: 6,
    })
}
