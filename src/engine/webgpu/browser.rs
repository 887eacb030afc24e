//! The browser's WebGPU objects: how to find them, and calls that wgpu does not offer.

use js_sys::{Array, JsString, Object, Promise, Reflect};
use wasm_bindgen::prelude::*;
use wasm_bindgen_futures::JsFuture;

#[wasm_bindgen]
extern "C" {
    /// A GPUDevice of the page.
    #[wasm_bindgen(js_name = GPUDevice)]
    #[derive(Clone, Debug, PartialEq)]
    pub type GpuDevice;
    #[wasm_bindgen(method, getter, js_name = adapterInfo)]
    pub(super) fn adapter_info(this: &GpuDevice) -> Option<GpuAdapterInfo>;
    #[wasm_bindgen(method, getter)]
    pub(super) fn lost(this: &GpuDevice) -> Promise;
    #[wasm_bindgen(method, js_name = pushErrorScope)]
    fn push_error_scope(this: &GpuDevice, filter: &str);
    #[wasm_bindgen(method, js_name = popErrorScope)]
    fn pop_error_scope(this: &GpuDevice) -> Promise;

    #[wasm_bindgen(js_name = GPUAdapterInfo)]
    pub(super) type GpuAdapterInfo;
    #[wasm_bindgen(method, getter)]
    fn vendor(this: &GpuAdapterInfo) -> JsString;
    #[wasm_bindgen(method, getter)]
    fn architecture(this: &GpuAdapterInfo) -> JsString;
    #[wasm_bindgen(method, getter)]
    fn description(this: &GpuAdapterInfo) -> JsString;
    #[wasm_bindgen(method, getter, js_name = isFallbackAdapter)]
    pub(super) fn is_fallback_adapter(this: &GpuAdapterInfo) -> Option<bool>;

    /// Calls a function after some milliseconds.
    #[wasm_bindgen(js_name = setTimeout)]
    pub(super) fn set_timeout(callback: &JsValue, ms: i32);

    /// GPUError and GPUDeviceLostInfo.
    pub(super) type HasMessage;
    #[wasm_bindgen(method, getter)]
    pub(super) fn message(this: &HasMessage) -> String;
}

/// The navigator of a window or a worker. Elsewhere, as in Node, there is none, and making an instance of wgpu would
/// panic.
pub(super) fn navigator() -> Option<Object> {
    match js_sys::global().dyn_into::<web_sys::Window>() {
        Ok(window) => Some(window.navigator().into()),
        Err(global) => {
            let worker = global.dyn_into::<web_sys::WorkerGlobalScope>().ok()?;
            Some(worker.navigator().into())
        }
    }
}

/// Whether wgpu can look for an adapter.
pub(super) fn has_webgpu() -> bool {
    let gpu = navigator().and_then(|navigator| Reflect::get(&navigator, &"gpu".into()).ok());
    gpu.is_some_and(|gpu| gpu.is_object())
}

impl GpuDevice {
    /// Whether it is the browser's device behind a device of wgpu.
    #[cfg(feature = "js")]
    pub(super) fn is_of(&self, device: &wgpu::Device) -> bool {
        Self::of(device).as_ref() == Some(self)
    }

    /// The browser's device behind a device of wgpu.
    pub(super) fn of(device: &wgpu::Device) -> Option<Self> {
        Some(JsValue::from(device.as_webgpu()?.clone()).unchecked_into())
    }

    pub(super) fn push_error_scopes(&self) {
        for filter in ["validation", "internal", "out-of-memory"] {
            self.push_error_scope(filter);
        }
    }

    /// The errors that the scopes caught, in the reverse order of [`Self::push_error_scopes`].
    pub(super) fn pop_error_scopes(&self) -> [JsFuture; 3] {
        [(); 3].map(|()| JsFuture::from(self.pop_error_scope()))
    }

    /// Vendor, architecture and description, such as `nvidia ampere`. Empty where the browser does not tell them.
    pub(super) fn adapter_name(&self) -> String {
        let info = self.adapter_info();
        let words = info.map(|info| Array::of3(&info.vendor(), &info.architecture(), &info.description()));
        words.map_or_else(String::new, |words| words.join(" ").trim().into())
    }
}
