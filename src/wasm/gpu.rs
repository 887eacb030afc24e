//! The exports that only the module with the GPU engines has: the choice of `'auto'`, and a session's objects on a GPU.

use super::options::{self, JsOptions};
use super::session::JsSession;
use super::values::{dimension_of, thrown};
use crate::Session;
use crate::engine::{self, SharedObjects};
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
    /// The engine's GPUDevice, if it runs on one.
    #[wasm_bindgen(getter, unchecked_return_type = "import('../types.js').GpuDevice | undefined")]
    pub fn device(&self) -> JsValue {
        self.shared_objects().map_or(JsValue::UNDEFINED, |objects| objects.device)
    }

    /// The GPUBuffer with the positions.
    #[wasm_bindgen(getter, js_name = positionBuffer, unchecked_return_type = "import('../types.js').GpuBuffer | undefined")]
    pub fn position_buffer(&self) -> JsValue {
        self.shared_objects().map_or(JsValue::UNDEFINED, |objects| objects.positions)
    }

    /// The GPUBuffer with the triangles.
    #[wasm_bindgen(getter, js_name = indexBuffer, unchecked_return_type = "import('../types.js').GpuBuffer | undefined")]
    pub fn index_buffer(&self) -> JsValue {
        self.shared_objects().map_or(JsValue::UNDEFINED, |objects| objects.triangles)
    }
}

#[wasm_bindgen(js_class = Session)]
impl JsSession {
    /// The GPUBuffer with the changes and their offset in bytes, if they are tracked.
    #[wasm_bindgen(getter, js_name = changeBuffer, unchecked_return_type = "[import('../types.js').GpuBuffer, number] | undefined")]
    pub fn change_buffer(&self) -> JsValue {
        let changes = self.shared_objects().and_then(|objects| objects.changes);
        changes
            .map_or(JsValue::UNDEFINED, |(buffer, offset)| js_sys::Array::of2(&buffer, &offset.into()).into())
    }
}

impl JsSession {
    fn shared_objects(&self) -> Option<SharedObjects> {
        self.get(Session::shared_objects)
    }
}
