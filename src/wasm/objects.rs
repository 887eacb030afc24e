//! The result as a JavaScript object with the field names of `src/js/types.ts`.

use crate::wasm::values::reasons_object;
use crate::{Outcome, Status};
use js_sys::{Object, Uint32Array};
use wasm_bindgen::prelude::*;

#[wasm_bindgen]
extern "C" {
    /// An object that gets its fields one by one, which is faster than a list of names and values.
    #[wasm_bindgen(js_name = Object)]
    type Fields;
    #[wasm_bindgen(method, setter)]
    fn set_indices(this: &Fields, value: JsValue);
    #[wasm_bindgen(method, setter)]
    fn set_status(this: &Fields, value: &str);
    #[wasm_bindgen(method, setter)]
    fn set_backend(this: &Fields, value: &str);
    #[wasm_bindgen(method, setter)]
    fn set_adapter(this: &Fields, value: Option<&str>);
    #[wasm_bindgen(method, setter)]
    fn set_fallback(this: &Fields, value: Option<&str>);
    #[wasm_bindgen(method, setter)]
    fn set_iterations(this: &Fields, value: u32);
    #[wasm_bindgen(method, setter)]
    fn set_flips(this: &Fields, value: f64);
    #[wasm_bindgen(method, setter, js_name = flipsPerIteration)]
    fn set_flips_per_iteration(this: &Fields, value: Uint32Array);
    #[wasm_bindgen(method, setter)]
    fn set_dispatches(this: &Fields, value: f64);
    #[wasm_bindgen(method, setter, js_name = deviceBytes)]
    fn set_device_bytes(this: &Fields, value: f64);
    #[wasm_bindgen(method, setter)]
    fn set_edges(this: &Fields, value: f64);
    #[wasm_bindgen(method, setter, js_name = boundaryEdges)]
    fn set_boundary_edges(this: &Fields, value: f64);
    #[wasm_bindgen(method, setter, js_name = nonManifoldEdges)]
    fn set_non_manifold_edges(this: &Fields, value: f64);
    #[wasm_bindgen(method, setter, js_name = inconsistentEdges)]
    fn set_inconsistent_edges(this: &Fields, value: f64);
    #[wasm_bindgen(method, setter)]
    fn set_remaining(this: &Fields, value: JsValue);
    #[wasm_bindgen(method, setter)]
    fn set_inverted(this: &Fields, value: u32);
    #[wasm_bindgen(method, setter)]
    fn set_flat(this: &Fields, value: u32);
    #[wasm_bindgen(method, setter, js_name = lostEdges)]
    fn set_lost_edges(this: &Fields, value: Uint32Array);
    #[wasm_bindgen(method, setter)]
    fn set_timings(this: &Fields, value: Fields);
    #[wasm_bindgen(method, setter)]
    fn set_upload(this: &Fields, value: f64);
    #[wasm_bindgen(method, setter)]
    fn set_adjacency(this: &Fields, value: f64);
    #[wasm_bindgen(method, setter)]
    fn set_flip(this: &Fields, value: f64);
    #[wasm_bindgen(method, setter)]
    fn set_total(this: &Fields, value: f64);
}

fn fields() -> Fields {
    Object::new().unchecked_into()
}

/// `indices` are the triangles.
pub(super) fn outcome_object(outcome: Outcome, indices: JsValue) -> JsValue {
    let timings = fields();
    timings.set_upload(outcome.timings.upload);
    timings.set_adjacency(outcome.timings.adjacency);
    timings.set_flip(outcome.timings.flip);
    timings.set_total(outcome.timings.total);
    let object = fields();
    object.set_indices(indices);
    object.set_status(match outcome.status {
        Status::Done => "done",
        Status::Stopped => "stopped",
    });
    object.set_backend(outcome.backend.name());
    object.set_adapter(outcome.adapter.as_deref());
    object.set_fallback(outcome.fallback.as_deref());
    object.set_iterations(outcome.iterations);
    object.set_flips(outcome.flips as f64);
    object.set_flips_per_iteration(Uint32Array::from(outcome.flips_per_iteration.as_slice()));
    object.set_dispatches(outcome.dispatches as f64);
    object.set_device_bytes(outcome.device_bytes as f64);
    object.set_edges(outcome.edges as f64);
    object.set_boundary_edges(outcome.boundary_edges as f64);
    object.set_non_manifold_edges(outcome.non_manifold_edges as f64);
    object.set_inconsistent_edges(outcome.inconsistent_edges as f64);
    object.set_remaining(reasons_object(&outcome.remaining));
    object.set_inverted(outcome.inverted);
    object.set_flat(outcome.flat);
    object.set_lost_edges(Uint32Array::from(outcome.lost_edges.as_flattened()));
    object.set_timings(timings);
    object.into()
}
