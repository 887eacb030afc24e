//! What the device cannot take: a mesh too large for its buffers, or coordinates that it cannot decide exactly.

use super::device::Device;
use super::faults::refuse;
use crate::Error;
use crate::engine::span::refuse_wide_span;
use crate::mesh::Mesh;

/// Refuses a mesh that the device cannot hold, or whose coordinates it cannot decide exactly.
pub(super) fn refuse_beyond_limits(gpu: &Device, mesh: &Mesh) -> Result<(), Error> {
    let buckets = 2 * mesh.vertex_count().next_multiple_of(256);
    refuse_large_buffer(gpu, mesh.positions().len().max(mesh.triangles().len()).max(buckets))?;
    refuse_wide_span("gpu", mesh)
}

pub(super) fn refuse_large_buffer(gpu: &Device, words: usize) -> Result<(), Error> {
    let (bytes, limit) = (4 * words as u64, gpu.largest_binding());
    if bytes > limit {
        return refuse(format!("it needs a buffer of {bytes} bytes, {} binds at most {limit}", gpu.adapter));
    }
    Ok(())
}
