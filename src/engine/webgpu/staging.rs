//! Memory between the host and a device, which is kept from one copy to the next: new memory takes longer than the copy.

use super::buffer::{Buffer, MOST_KEPT};
use super::device::Device;
use wgpu::BufferUsages;

/// The fewest bytes that a buffer has which is kept.
const FEWEST: u64 = 1 << 16;

impl Device {
    /// A buffer of so many bytes at least: of a size that others will need too, if it may be kept. Not much larger, since a
    /// browser copies all of what is mapped.
    pub(super) fn staging(&self, bytes: u64, usage: BufferUsages) -> Buffer {
        let step = bytes.next_power_of_two() / 8;
        let size =
            if bytes > MOST_KEPT { bytes } else { bytes.next_multiple_of(step.max(FEWEST)).max(FEWEST) };
        Buffer(self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("staging"),
            size,
            usage,
            mapped_at_creation: false,
        }))
    }
}
