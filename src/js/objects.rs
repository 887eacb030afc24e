//! Results and errors as JavaScript objects, in the words of the npm package: the field names of
//! `src/js/types.ts`, `webgpu` for the GPU engine, `indices` for the triangles.

use crate::{Error, Outcome, Reasons, Status};
use js_sys::{Array, Object, Uint32Array};
use wasm_bindgen::{JsCast, JsValue};

/// A plain object.
pub(super) fn object<const N: usize>(fields: [(&str, JsValue); N]) -> JsValue {
    let entries: Array = fields.into_iter().map(|(name, value)| Array::of2(&name.into(), &value)).collect();
    // Fails only on what is no list of pairs.
    Object::from_entries(&entries).map_or_else(|error| error, JsValue::from)
}

/// The reasons with at least one edge.
pub(super) fn reasons_object(reasons: &Reasons) -> JsValue {
    let entries: Array = reasons
        .iter()
        .map(|(reason, edges)| Array::of2(&reason.name().into(), &(edges as f64).into()))
        .collect();
    Object::from_entries(&entries).map_or_else(|error| error, JsValue::from)
}

/// The engine's name in JavaScript.
pub(super) fn backend(name: &'static str) -> &'static str {
    if name == "gpu" { "webgpu" } else { name }
}

pub(super) fn outcome_object(outcome: &Outcome) -> JsValue {
    let count = |n: u64| JsValue::from(n as f64);
    let text = |text: &Option<String>| text.as_deref().map_or(JsValue::UNDEFINED, JsValue::from);
    // It quotes an error, in the words of Rust.
    let fallback = outcome.fallback.as_ref().map(|why| why.replacen("backend gpu ", "backend webgpu ", 1));
    let status = match outcome.status {
        Status::Done => "done",
        Status::Stopped => "stopped",
    };
    let timings = object([
        ("adjacency", outcome.timings.adjacency.into()),
        ("flip", outcome.timings.flip.into()),
        ("total", outcome.timings.total.into()),
    ]);
    object([
        ("indices", Uint32Array::from(outcome.triangles.as_slice()).into()),
        ("status", status.into()),
        ("backend", backend(outcome.backend).into()),
        ("adapter", text(&outcome.adapter)),
        ("fallback", text(&fallback)),
        ("iterations", outcome.iterations.into()),
        ("flips", count(outcome.flips)),
        ("flipsPerIteration", Uint32Array::from(outcome.flips_per_iteration.as_slice()).into()),
        ("dispatches", count(outcome.dispatches)),
        ("edges", count(outcome.edges)),
        ("boundaryEdges", count(outcome.boundary_edges)),
        ("nonManifoldEdges", count(outcome.non_manifold_edges)),
        ("inconsistentEdges", count(outcome.inconsistent_edges)),
        ("remaining", reasons_object(&outcome.remaining)),
        ("timings", timings),
    ])
}

/// What a call throws: an `Error` with a `code`.
pub(super) fn thrown(error: Error) -> JsValue {
    let code = error.code();
    let thrown = js_sys::Error::new(&in_words_of_javascript(error).to_string());
    // Setting a field of a new object does not fail.
    let _ = js_sys::Reflect::set(thrown.unchecked_ref(), &"code".into(), &code.into());
    thrown.into()
}

fn in_words_of_javascript(error: Error) -> Error {
    match error {
        Error::BackendUnavailable { backend: name, message } => {
            Error::BackendUnavailable { backend: backend(name), message }
        }
        Error::BackendLimit { backend: name, message } => {
            Error::BackendLimit { backend: backend(name), message }
        }
        Error::RaggedArray { array: "triangles", length, stride } => {
            Error::RaggedArray { array: "indices", length, stride }
        }
        Error::Option { option: "max_normal_angle", message } => {
            Error::Option { option: "maxNormalAngle", message }
        }
        error => error,
    }
}
