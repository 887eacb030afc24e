//! The exports that only the module with the GPU engines has: the choice of `'auto'`, and a session's objects on a GPU.

use super::options::{self, JsOptions};
use super::session::JsSession;
use super::values::{dimension_of, thrown};
use crate::Session;
use crate::engine;
pub use crate::engine::{GpuDevice, WebGl2Module};
use crate::session::{self, Job};
use wasm_bindgen::prelude::*;

/// Sets the object that loads the WebGL2 engine.
#[wasm_bindgen(js_name = setWebGl2)]
pub fn set_webgl2(module: WebGl2Module) {
    engine::set_webgl2(module);
}

/// Why `'auto'` takes the CPU engine on `threads` threads for a mesh, if that is known without asking for a GPU.
///
/// # Errors
/// [`Error::Option`](crate::Error::Option).
#[wasm_bindgen(js_name = whyCpu)]
pub fn why_cpu(
    triangles: usize,
    dimension: u32,
    is_double: bool,
    threads: usize,
    options: &JsOptions,
) -> Result<Option<String>, JsValue> {
    let job = Job { triangles, dimension: dimension_of(dimension), threads };
    let options = options::without_lists(options).map_err(thrown)?;
    Ok(session::why_cpu(job, is_double, &options))
}

#[wasm_bindgen(js_class = Session)]
impl JsSession {
    /// The engine's GPUDevice and its buffers, if it runs on one.
    #[wasm_bindgen(
        getter,
        unchecked_return_type = "import('../session-buffers.js').SessionBuffers | undefined"
    )]
    pub fn gpu(&self) -> JsValue {
        self.get(Session::shared_objects)
    }
}
