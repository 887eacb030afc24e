//! The result as a JavaScript object with the field names of `src/js/types.ts`.

use crate::wasm::values::{object, reasons_object};
use crate::{Outcome, Status};
use js_sys::Uint32Array;
use wasm_bindgen::JsValue;

/// `indices` are the triangles.
pub(super) fn outcome_object(outcome: Outcome, indices: JsValue) -> JsValue {
    let count = |n: u64| JsValue::from(n as f64);
    let text = |text: &Option<String>| text.as_deref().map_or(JsValue::UNDEFINED, JsValue::from);
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
        ("backend", outcome.backend.name().into()),
        ("adapter", text(&outcome.adapter)),
        ("fallback", text(&outcome.fallback)),
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
