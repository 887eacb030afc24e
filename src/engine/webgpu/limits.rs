//! Refuses meshes that are too large for the buffers of the device.

use super::buffers::frontier_words;
use super::device::Device;
use super::faults::refuse;
use crate::Error;
use crate::engine::gpu::upload::Upload;

/// Refuses a mesh that the device cannot hold.
pub(super) fn refuse_large_mesh(gpu: &Device, upload: &Upload) -> Result<(), Error> {
    let mesh = &upload.mesh;
    refuse_large_buffer(gpu, upload.words().len().max(frontier_words(mesh.triangle_count())))
}

pub(super) fn refuse_large_buffer(gpu: &Device, words: usize) -> Result<(), Error> {
    let (bytes, limit) = (4 * words as u64, gpu.largest_binding());
    if bytes > limit {
        return refuse(format!("it takes a buffer of {bytes} bytes; {} allows at most {limit}", gpu.adapter));
    }
    Ok(())
}
