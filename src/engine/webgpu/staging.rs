//! Staging buffers. They are kept from copy to copy, since allocating takes longer than copying.

use super::buffer::Buffer;
use super::device::Device;
use wgpu::BufferUsages;

/// The smallest staging buffer, in bytes.
pub(super) const FEWEST: u64 = 1 << 16;

impl Device {
    /// A buffer of at least `bytes` bytes. Its size is rounded up, so that slightly longer copies fit too. It is rounded
    /// up only a little, since a browser copies all bytes of a mapped range.
    pub(super) fn staging(&self, bytes: u64, usage: BufferUsages) -> Buffer {
        let step = bytes.next_power_of_two() / 8;
        let size = bytes.next_multiple_of(step.max(FEWEST)).max(FEWEST);
        Buffer::new(self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("staging"),
            size,
            usage,
            mapped_at_creation: false,
        }))
    }
}
