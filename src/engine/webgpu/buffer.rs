//! A buffer on a device, and one that is kept from one copy to the next.

use std::sync::Mutex;

/// The most bytes that a buffer has which is kept.
pub(super) const MOST_KEPT: u64 = 1 << 26;

/// A buffer that is destroyed when it goes: in a browser the garbage collector would take its time.
pub(super) struct Buffer(pub(super) wgpu::Buffer);

impl std::ops::Deref for Buffer {
    type Target = wgpu::Buffer;
    fn deref(&self) -> &wgpu::Buffer {
        &self.0
    }
}

impl Drop for Buffer {
    fn drop(&mut self) {
        self.0.destroy();
    }
}

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
            if size < buffer.size() && buffer.size() <= MOST_KEPT {
                *kept = Some(buffer);
            }
        });
    }
}
