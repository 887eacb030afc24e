//! What the npm package calls for the audit of a session, in a module of its own: most pages never load it. Its only
//! caller is `FlipSession.verify` in `src/js/session.ts`.

use crate::js_values::{JsPositions, object, parse_dimension, reasons_object, thrown};
use crate::{Mesh, quality};
use js_sys::{Array, Uint32Array};
use wasm_bindgen::prelude::*;

/// As [`quality::audit`].
///
/// # Errors
/// Those of [`Mesh::new`]; [`Error::Option`] for the dimension.
#[wasm_bindgen(unchecked_return_type = "import('../types.js').Audit")]
pub fn audit(
    positions: JsPositions,
    indices: Vec<u32>,
    dimension: f64,
    triangles: &[u32],
    max_normal_angle: f64,
    locked_edges: &[u32],
) -> Result<JsValue, JsValue> {
    let check = || {
        let input = Mesh::new(parse_dimension(dimension)?, positions, indices)?;
        Ok(quality::audit(&input, triangles, max_normal_angle, locked_edges.as_chunks().0))
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
