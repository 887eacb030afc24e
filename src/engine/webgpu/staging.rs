//! Memory between the host and a device, which is kept from one copy to the next: new memory takes longer than the copy.

use super::device::{Buffer, Device};
use std::sync::Mutex;
use wgpu::BufferUsages;

/// Bytes that a buffer has which is kept.
const FEWEST: u64 = 1 << 16;
pub(super) const MOST: u64 = 1 << 26;

/// A buffer for the next copy, unless it is in use: then there are two for a while.
#[derive(Default)]
pub(super) struct Kept(Mutex<Option<Buffer>>);

impl Kept {
    fn with<T>(&self, f: impl FnOnce(&mut Option<Buffer>) -> T) -> T {
        f(&mut self.0.lock().unwrap_or_else(|poisoned| poisoned.into_inner()))
    }

    /// Takes it, if it has so many bytes; one that is too small goes.
    pub(super) fn take(&self, bytes: u64) -> Option<Buffer> {
        self.with(Option::take).filter(|buffer| buffer.size() >= bytes)
    }

    /// Keeps a buffer, unless it is too large or there is one as large.
    pub(super) fn put(&self, buffer: Buffer) {
        self.with(|kept| {
            let size = kept.as_ref().map_or(0, |kept| kept.size());
            if size < buffer.size() && buffer.size() <= MOST {
                *kept = Some(buffer);
            }
        });
    }
}

impl Device {
    /// A buffer of so many bytes at least: of a size that others will need too, if it may be kept. Not much larger, since a
    /// browser copies all of what is mapped.
    pub(super) fn staging(&self, bytes: u64, usage: BufferUsages) -> Buffer {
        let step = bytes.next_power_of_two() / 8;
        let size = if bytes > MOST { bytes } else { bytes.next_multiple_of(step.max(FEWEST)).max(FEWEST) };
        Buffer(self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("staging"),
            size,
            usage,
            mapped_at_creation: false,
        }))
    }
}
