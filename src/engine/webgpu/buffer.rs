//! Buffers on a device, and staging buffers that are kept for the next copies.

use super::pool::Shared;
use std::sync::Mutex;

/// The most bytes of staging buffers that are kept.
const MOST_KEPT: u64 = 1 << 27;

/// A buffer that is destroyed on drop, or kept for the next session. In a browser, the garbage collector would free it
/// much later.
pub(super) struct Buffer {
    raw: wgpu::Buffer,
    /// Where it is kept.
    pool: Mutex<Option<Shared>>,
}

impl Buffer {
    /// A buffer that is destroyed on drop.
    pub(super) fn new(raw: wgpu::Buffer) -> Self {
        Self { raw, pool: Mutex::default() }
    }

    /// Keeps it on drop.
    pub(super) fn pooled(raw: wgpu::Buffer, pool: Shared) -> Self {
        Self { raw, pool: Mutex::new(Some(pool)) }
    }

    fn take_pool(&self) -> Option<Shared> {
        self.pool.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).take()
    }

    /// The buffer, for code that may use it at any time: it is not kept on drop.
    #[cfg(any(not(target_arch = "wasm32"), feature = "js"))]
    pub(super) fn given(&self) -> wgpu::Buffer {
        self.take_pool();
        self.raw.clone()
    }
}

impl std::ops::Deref for Buffer {
    type Target = wgpu::Buffer;
    fn deref(&self) -> &wgpu::Buffer {
        &self.raw
    }
}

impl Drop for Buffer {
    fn drop(&mut self) {
        if let Some(pool) = self.take_pool() {
            return pool.put(self.raw.clone());
        }
        self.raw.destroy();
    }
}

/// Staging buffers for the next copies. While all are in use, a further copy makes its own buffer.
#[derive(Default)]
pub(super) struct Kept(Mutex<Vec<Buffer>>);

impl Kept {
    fn with<T>(&self, f: impl FnOnce(&mut Vec<Buffer>) -> T) -> T {
        f(&mut self.0.lock().unwrap_or_else(|poisoned| poisoned.into_inner()))
    }

    /// How many are kept.
    #[cfg(target_arch = "wasm32")]
    pub(super) fn count(&self) -> usize {
        self.with(|kept| kept.len())
    }

    /// Takes the smallest buffer of at least `bytes` bytes. If there is none, drops one: it is too small.
    pub(super) fn take(&self, bytes: u64) -> Option<Buffer> {
        self.with(|kept| {
            let fits = (0..kept.len()).filter(|&i| kept[i].size() >= bytes);
            if let Some(i) = fits.min_by_key(|&i| kept[i].size()) {
                return Some(kept.swap_remove(i));
            }
            kept.pop();
            None
        })
    }

    /// Keeps `buffer`, unless that would be more than [`MOST_KEPT`] bytes.
    pub(super) fn put(&self, buffer: Buffer) {
        self.with(|kept| {
            if kept.iter().map(|kept| kept.size()).sum::<u64>() + buffer.size() <= MOST_KEPT {
                kept.push(buffer);
            }
        });
    }
}
