//! The audit of a session for the npm package, in a module of its own: most pages never load it. Its only caller is
//! `FlipSession.verify` in `src/js/session.ts`.

use crate::system::threads::Threads;
use crate::wasm::options::{JsOptions, without_lists};
use crate::wasm::values::{JsPositions, mesh_of, object, reasons_object, thrown};
use crate::{Options, quality};
use js_sys::{Array, Uint32Array};
use wasm_bindgen::prelude::*;

/// As [`quality::audit`]. `locked_edges` has all edges that the options lock, and `constraints` those that were brought in
/// after `indices`, 2 vertices per edge; `options` has no lists.
///
/// # Errors
/// Those of [`Mesh::new`](crate::Mesh::new); [`Error::OutOfMemory`](crate::Error::OutOfMemory).
#[wasm_bindgen(unchecked_return_type = "import('../types.js').Audit")]
pub fn audit(
    positions: JsPositions,
    indices: &Uint32Array,
    dimension: u32,
    triangles: &Uint32Array,
    locked_edges: &Uint32Array,
    options: &JsOptions,
    constraints: &Uint32Array,
) -> Result<JsValue, JsValue> {
    let check = || {
        let input = mesh_of(positions, indices, dimension, &Threads::one())?;
        let [locked_edges, constraints] =
            [locked_edges, constraints].map(|ends| ends.to_vec().as_chunks().0.to_vec());
        let options = Options { locked_edges, constraints, ..without_lists(options)? };
        Ok(quality::audit(&input, &triangles.to_vec(), &options))
    };
    let audit = check().map_err(thrown)?;
    let violations: Array =
        audit.violations.iter().map(|violation| JsValue::from(violation.to_string())).collect();
    let ends = audit.remaining.iter().map(|(reason, _)| {
        let ends: Vec<u32> = audit.remaining_for(reason).flatten().collect();
        (reason.name(), Uint32Array::from(ends.as_slice()).into())
    });
    Ok(object([
        ("clean", audit.is_clean().into()),
        ("violations", violations.into()),
        ("unlisted", (audit.unlisted as f64).into()),
        ("remaining", reasons_object(&audit.remaining)),
        ("remainingEdges", object(ends)),
    ]))
}
