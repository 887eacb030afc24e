//! Buffers of sessions that have ended, for the next session with a mesh of the same size: allocating the buffers of a
//! large mesh takes longer than to flip its edges.

#[cfg(target_arch = "wasm32")]
use super::browser::set_timeout;
#[cfg(target_arch = "wasm32")]
use std::cell::Cell;
use std::sync::{Mutex, MutexGuard};
#[cfg(target_arch = "wasm32")]
use wasm_bindgen::prelude::*;

/// The most bytes that are kept. A page shares the memory with all others.
const MOST: u64 = if cfg!(target_arch = "wasm32") { 1 << 28 } else { 1 << 30 };
/// The size from which a buffer that was not kept drops all that is kept, so that its memory can be used.
const LARGE: u64 = 1 << 20;
/// In a browser, what is kept is dropped after so many milliseconds without a session.
#[cfg(target_arch = "wasm32")]
const IDLE_MS: i32 = 2000;

/// A pool, as its device and the buffers in use hold it.
#[cfg(not(target_arch = "wasm32"))]
pub(super) type Shared = std::sync::Arc<Pool>;
/// In a browser it belongs to one thread.
#[cfg(target_arch = "wasm32")]
pub(super) type Shared = std::rc::Rc<Pool>;

/// The buffers of one device.
pub(super) struct Pool {
    /// `None` after the memory of the device was exhausted.
    kept: Mutex<Option<Vec<wgpu::Buffer>>>,
    /// How often the last buffer in use came back.
    #[cfg(target_arch = "wasm32")]
    pauses: Cell<u32>,
}

impl Default for Pool {
    fn default() -> Self {
        Self {
            kept: Mutex::new(Some(Vec::new())),
            #[cfg(target_arch = "wasm32")]
            pauses: Cell::default(),
        }
    }
}

impl Pool {
    fn kept(&self) -> MutexGuard<'_, Option<Vec<wgpu::Buffer>>> {
        self.kept.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
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

    /// Keeps a buffer, or destroys it. Its owner still holds the pool.
    pub(super) fn put(self: &Shared, buffer: wgpu::Buffer) {
        match self.kept().as_mut() {
            Some(kept) if kept.iter().map(wgpu::Buffer::size).sum::<u64>() + buffer.size() <= MOST => {
                kept.push(buffer);
            }
            _ => buffer.destroy(),
        }
        #[cfg(target_arch = "wasm32")]
        self.drop_later();
    }

    /// If this was the last buffer in use, drops what is kept after a while, unless a session takes a buffer until then.
    #[cfg(target_arch = "wasm32")]
    fn drop_later(self: &Shared) {
        // The device holds the pool too.
        let is_idle = |pool: &Shared| Shared::strong_count(pool) <= 2;
        if !is_idle(self) {
            return;
        }
        let pause = self.pauses.get().wrapping_add(1);
        self.pauses.set(pause);
        let pool = Shared::downgrade(self);
        let drop_all = move || {
            if let Some(pool) = pool.upgrade().filter(|pool| is_idle(pool) && pool.pauses.get() == pause) {
                pool.kept().iter_mut().flat_map(|kept| kept.drain(..)).for_each(|buffer| buffer.destroy());
            }
        };
        set_timeout(&Closure::once_into_js(drop_all), IDLE_MS);
    }

    /// Destroys what is kept, and keeps nothing from now on: the memory is exhausted, or a buffer has none.
    pub(super) fn close(&self) {
        self.kept().take().into_iter().flatten().for_each(|buffer| buffer.destroy());
    }
}

/// The garbage collector of a browser would free the buffers much later.
#[cfg(target_arch = "wasm32")]
impl Drop for Pool {
    fn drop(&mut self) {
        self.close();
    }
}
