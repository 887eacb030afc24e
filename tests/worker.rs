//! Sessions on a device of a worker, in headless Chromium.

#![allow(clippy::unwrap_used, clippy::panic, reason = "what fails here is a failed test")]
#![cfg(target_arch = "wasm32")]

#[path = "wasm/device.rs"]
mod device;

use wasm_bindgen_test::{wasm_bindgen_test, wasm_bindgen_test_configure};

wasm_bindgen_test_configure!(run_in_dedicated_worker);

#[wasm_bindgen_test]
fn there_is_no_window() {
    assert!(web_sys::window().is_none());
    assert_eq!(device::class_of(&js_sys::global()), "DedicatedWorkerGlobalScope");
}
