//! Buffers on a device, and staging buffers that are kept for the next copies.

use super::pool::Shared;
#[cfg(target_arch = "wasm32")]
use futures_channel::oneshot;
use std::sync::Mutex;
#[cfg(target_arch = "wasm32")]
use std::{cell::RefCell, collections::VecDeque};

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

/// A buffer, and how many words of it are written.
pub(super) type Begun = (Buffer, usize);

/// Arrays that are on their way to the device before the other buffers of their mesh are made.
#[derive(Default)]
pub(super) struct Sent {
    pub(super) triangles: Option<Begun>,
    /// Only of 32-bit floats.
    pub(super) positions: Option<Begun>,
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

/// Staging buffers for writes that the device still copies from, or that are being mapped for the first time.
#[cfg(target_arch = "wasm32")]
#[derive(Default)]
pub(super) struct Busy(RefCell<VecDeque<oneshot::Receiver<()>>>);

#[cfg(target_arch = "wasm32")]
impl Busy {
    /// How many are busy, as far as known.
    pub(super) fn count(&self) -> usize {
        self.0.borrow().len()
    }

    /// The receiver hears when a buffer is kept for writes again, or that it never will.
    pub(super) fn add(&self, receiver: oneshot::Receiver<()>) {
        let mut all = self.0.borrow_mut();
        all.retain_mut(|receiver| matches!(receiver.try_recv(), Ok(None)));
        all.push_back(receiver);
    }

    /// Waits for the buffer that has been busy longest. Returns whether there was any.
    pub(super) async fn wait(&self) -> bool {
        let first = self.0.borrow_mut().pop_front();
        match first {
            Some(receiver) => {
                let _ = receiver.await;
                true
            }
            None => false,
        }
    }
}
