//! Results as JavaScript objects, in the words of the npm package: the field names of `src/js/types.ts`.

use crate::js_values::{backend_name, object};
use crate::quality::Audit;
use crate::{Outcome, Reasons, Status};
use js_sys::{Array, Uint32Array};
use wasm_bindgen::JsValue;

/// The reasons with at least one edge.
pub(super) fn reasons_object(reasons: &Reasons) -> JsValue {
    object(reasons.iter().map(|(reason, edges)| (reason.name(), (edges as f64).into())))
}

pub(super) fn audit_object(audit: &Audit) -> JsValue {
    let violations: Array =
        audit.violations.iter().map(|violation| JsValue::from(violation.to_string())).collect();
    let ends = audit.remaining.iter().map(|(reason, _)| {
        let ends: Vec<u32> = audit.remaining_for(reason).flatten().collect();
        (reason.name(), Uint32Array::from(ends.as_slice()).into())
    });
    object([
        ("clean", audit.is_clean().into()),
        ("violations", violations.into()),
        ("unlisted", (audit.unlisted as f64).into()),
        ("remaining", reasons_object(&audit.remaining)),
        ("remainingEdges", object(ends)),
    ])
}

pub(super) fn outcome_object(outcome: &Outcome) -> JsValue {
    let count = |n: u64| JsValue::from(n as f64);
    let text = |text: &Option<String>| text.as_deref().map_or(JsValue::UNDEFINED, JsValue::from);
    // It quotes errors, in the words of Rust.
    let fallback = outcome.fallback.as_ref().map(|why| why.replace("backend gpu ", "backend webgpu "));
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
        ("indices", Uint32Array::from(outcome.triangles.as_slice()).into()),
        ("status", status.into()),
        ("backend", backend_name(outcome.backend).into()),
        ("adapter", text(&outcome.adapter)),
        ("fallback", text(&fallback)),
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
