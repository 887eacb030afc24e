//! Buffers of sessions that have ended, for the next session with a mesh of the same size: allocating the buffers of a
//! large mesh takes longer than to flip its edges.

use std::sync::{Mutex, MutexGuard};

/// The most bytes that are kept.
const MOST: u64 = 1 << 30;
/// The size from which a buffer that was not kept drops all that is kept, so that its memory can be used.
const LARGE: u64 = 1 << 20;

/// The buffers of one device; `None` after its memory was exhausted.
pub(super) struct Pool(Mutex<Option<Vec<wgpu::Buffer>>>);

impl Default for Pool {
    fn default() -> Self {
        Self(Mutex::new(Some(Vec::new())))
    }
}

impl Pool {
    fn kept(&self) -> MutexGuard<'_, Option<Vec<wgpu::Buffer>>> {
        self.0.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
    }

    /// Takes a buffer. It holds what a session has left in it.
    pub(super) fn take(&self, size: u64, usage: wgpu::BufferUsages) -> Option<wgpu::Buffer> {
        let mut kept = self.kept();
        let kept = kept.as_mut()?;
        let found = kept.iter().position(|buffer| buffer.size() == size && buffer.usage() == usage);
        if found.is_none() && size >= LARGE {
            kept.drain(..).for_each(|buffer| buffer.destroy());
        }
        found.map(|i| kept.swap_remove(i))
    }

    /// Keeps a buffer, or destroys it.
    pub(super) fn put(&self, buffer: wgpu::Buffer) {
        match self.kept().as_mut() {
            Some(kept) if kept.iter().map(wgpu::Buffer::size).sum::<u64>() + buffer.size() <= MOST => {
                kept.push(buffer);
            }
            _ => buffer.destroy(),
        }
    }

    /// Destroys what is kept, and keeps nothing from now on: the memory is exhausted, or a buffer has none.
    pub(super) fn close(&self) {
        self.kept().take().into_iter().flatten().for_each(|buffer| buffer.destroy());
    }
}
