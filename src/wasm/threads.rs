//! The threads of a module: of the CPU engine, and of the triangulation of points. Each worker has an instance of it, and
//! the instances share their memory.

use crate::wasm::values::coded;
use rayon::{ThreadBuilder, ThreadPool, ThreadPoolBuilder};
use std::sync::{Mutex, OnceLock};
use wasm_bindgen::prelude::*;

/// The threads that no worker has taken yet.
static WAITING: Mutex<Vec<ThreadBuilder>> = Mutex::new(Vec::new());

static POOL: OnceLock<ThreadPool> = OnceLock::new();

/// Makes this worker the first of `count` threads, and returns the memory of this instance. Each other worker has to
/// call [`work`] in an instance on the same memory.
///
/// # Errors
/// If rayon cannot build its pool.
#[wasm_bindgen(js_name = startThreads, unchecked_return_type = "WebAssembly.Memory")]
pub fn start_threads(count: usize) -> Result<JsValue, JsValue> {
    let builder = ThreadPoolBuilder::new().num_threads(count).use_current_thread().spawn_handler(|thread| {
        WAITING.lock().map_err(|_| std::io::ErrorKind::Other)?.push(thread);
        Ok(())
    });
    let pool = builder.build().map_err(|error| coded("internal", &error.to_string()))?;
    // The pool is never dropped, so its threads run for ever. It is set only once.
    let _ = POOL.set(pool);
    Ok(wasm_bindgen::memory())
}

/// Makes this worker one of the threads. Never returns.
#[wasm_bindgen]
pub fn work() {
    let thread = WAITING.lock().ok().and_then(|mut waiting| waiting.pop());
    if let Some(thread) = thread {
        thread.run();
    }
}

/// Vertex indices, which the client copies from the shared memory.
#[cfg(feature = "js-threads")]
#[wasm_bindgen]
pub struct Indices(pub(crate) Vec<u32>);

#[cfg(feature = "js-threads")]
#[wasm_bindgen]
impl Indices {
    /// The address and the number of the indices.
    pub fn place(&self) -> Vec<usize> {
        vec![self.0.as_ptr().addr(), self.0.len()]
    }
}
