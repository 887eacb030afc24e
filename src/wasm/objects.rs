//! The result as a JavaScript object, in the words of the npm package: the field names of `src/js/types.ts`.

use crate::wasm::values::{backend_name, object, reasons_object};
use crate::{Outcome, Status};
use js_sys::{JsString, Uint32Array};
use wasm_bindgen::JsValue;

/// `indices` are the triangles.
pub(super) fn outcome_object(outcome: Outcome, indices: JsValue) -> JsValue {
    let count = |n: u64| JsValue::from(n as f64);
    let text = |text: &Option<String>| text.as_deref().map_or(JsValue::UNDEFINED, JsValue::from);
    // It quotes errors, in the words of Rust.
    let fallback = outcome.fallback.as_deref().map_or(JsValue::UNDEFINED, |why| {
        JsString::from(why).replace("backend gpu ", "backend webgpu ").into()
    });
    let status = match outcome.status {
        Status::Done => "done",
        Status::Stopped => "stopped",
    };
    let timings = object([
        ("upload", outcome.timings.upload.into()),
        ("adjacency", outcome.timings.adjacency.into()),
        ("flip", outcome.timings.flip.into()),
        ("total", outcome.timings.total.into()),
    ]);
    object([
        ("indices", indices),
        ("status", status.into()),
        ("backend", backend_name(outcome.backend).into()),
        ("adapter", text(&outcome.adapter)),
        ("fallback", fallback),
        ("iterations", outcome.iterations.into()),
        ("flips", count(outcome.flips)),
        ("flipsPerIteration", Uint32Array::from(outcome.flips_per_iteration.as_slice()).into()),
        ("dispatches", count(outcome.dispatches)),
        ("deviceBytes", count(outcome.device_bytes)),
        ("edges", count(outcome.edges)),
        ("boundaryEdges", count(outcome.boundary_edges)),
        ("nonManifoldEdges", count(outcome.non_manifold_edges)),
        ("inconsistentEdges", count(outcome.inconsistent_edges)),
        ("remaining", reasons_object(&outcome.remaining)),
        ("timings", timings),
    ])
}
