//! Sessions on the CPU engine's threads, in a module of its own whose instances share their memory: one in each worker.

use crate::wasm::values::coded;
use rayon::{ThreadBuilder, ThreadPool, ThreadPoolBuilder};
use std::sync::{Mutex, OnceLock};
use wasm_bindgen::prelude::*;

/// The threads that no worker has taken yet.
static WAITING: Mutex<Vec<ThreadBuilder>> = Mutex::new(Vec::new());

static POOL: OnceLock<ThreadPool> = OnceLock::new();

/// Makes this worker the first of so many threads. Each of the others has to call [`work`], in an instance on the memory
/// that this gives.
///
/// # Errors
/// Where they cannot be had.
#[wasm_bindgen(js_name = startThreads, unchecked_return_type = "WebAssembly.Memory")]
pub fn start_threads(count: usize) -> Result<JsValue, JsValue> {
    let builder = ThreadPoolBuilder::new().num_threads(count).use_current_thread().spawn_handler(|thread| {
        WAITING.lock().map_err(|_| std::io::ErrorKind::Other)?.push(thread);
        Ok(())
    });
    let pool = builder.build().map_err(|error| coded("internal", &error.to_string()))?;
    // A module has one pool.
    let _ = POOL.set(pool);
    Ok(wasm_bindgen::memory())
}

/// Makes this worker one of the threads: it works for ever.
#[wasm_bindgen]
pub fn work() {
    let thread = WAITING.lock().ok().and_then(|mut waiting| waiting.pop());
    if let Some(thread) = thread {
        thread.run();
    }
}

/// Vertex indices, which the page copies: it can read the memory.
#[wasm_bindgen]
pub struct Indices(pub(crate) Vec<u32>);

#[wasm_bindgen]
impl Indices {
    /// Where they are in memory, and how many they are.
    pub fn place(&self) -> Vec<usize> {
        vec![self.0.as_ptr().addr(), self.0.len()]
    }
}
