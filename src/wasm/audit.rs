//! The audit of a session for the npm package, in a module of its own: most pages never load it. Its only caller is
//! `FlipSession.verify` in `src/js/session.ts`.

use crate::Options;
use crate::quality::{self, Named, Problems, audit_named};
use crate::system::threads::Threads;
use crate::wasm::options::{JsOptions, without_lists};
use crate::wasm::values::{JsPositions, mesh_of, object, reasons_object, thrown};
use js_sys::{Array, Uint32Array};
use wasm_bindgen::prelude::*;

#[wasm_bindgen]
extern "C" {
    /// Constraints that came in before the run, and what they have become.
    #[wasm_bindgen(typescript_type = "import('../prepare.js').Before")]
    pub type JsBefore;

    #[wasm_bindgen(method, getter)]
    fn constraints(this: &JsBefore) -> Uint32Array;
    #[wasm_bindgen(method, getter, js_name = constraintEdges)]
    fn constraint_edges(this: &JsBefore) -> Uint32Array;
    #[wasm_bindgen(method, getter, js_name = leftOut)]
    fn left_out(this: &JsBefore) -> Uint32Array;
    #[wasm_bindgen(method, getter)]
    fn tolerance(this: &JsBefore) -> f64;
}

/// As [`quality::audit_outcome`]. `locked_edges` has all edges that the options lock, 2 vertices per edge; `options` has no
/// lists. `before`: what came in after `indices`, if there were constraints.
///
/// # Errors
/// Those of [`Mesh::new`](crate::Mesh::new); [`Error::OutOfMemory`](crate::Error::OutOfMemory).
#[wasm_bindgen(unchecked_return_type = "import('../audit.js').Audit")]
pub fn audit(
    positions: JsPositions,
    indices: &Uint32Array,
    dimension: u32,
    triangles: &Uint32Array,
    locked_edges: &Uint32Array,
    options: &JsOptions,
    before: Option<JsBefore>,
) -> Result<JsValue, JsValue> {
    let check = || {
        let input = mesh_of(positions, indices, dimension, &Threads::one())?;
        let pairs = |ends: &Uint32Array| ends.to_vec().as_chunks().0.to_vec();
        let (locked_edges, triangles) = (pairs(locked_edges), triangles.to_vec());
        let options = Options { locked_edges, ..without_lists(options)? };
        let Some(before) = before else { return Ok(quality::audit(&input, &triangles, &options)) };
        let left_out: Vec<usize> = before.left_out().to_vec().into_iter().map(|i| i as usize).collect();
        let skips_constraints = !left_out.is_empty();
        let options = Options {
            constraints: pairs(&before.constraints()),
            constraint_tolerance: before.tolerance(),
            skips_constraints,
            ..options
        };
        let named = Named { edges: &pairs(&before.constraint_edges()), left_out, lost_edges: &[] };
        Ok(audit_named(&input, &triangles, &options, Some(named)))
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
        ("invertedTriangles", Uint32Array::from(audit.inverted.as_slice()).into()),
        ("flatTriangles", Uint32Array::from(audit.flat.as_slice()).into()),
    ]))
}

/// As [`quality::problems`].
///
/// # Errors
/// Those of [`Mesh::new`](crate::Mesh::new); [`Error::OutOfMemory`](crate::Error::OutOfMemory).
#[wasm_bindgen(unchecked_return_type = "import('../audit.js').Problems")]
pub fn problems(positions: JsPositions, indices: &Uint32Array, dimension: u32) -> Result<JsValue, JsValue> {
    let mesh = mesh_of(positions, indices, dimension, &Threads::one()).map_err(thrown)?;
    let Problems { outside, coincident, crossing } = quality::problems(&mesh);
    let array = |words: &[u32]| JsValue::from(Uint32Array::from(words));
    Ok(object([
        ("outside", array(&outside)),
        ("coincident", array(coincident.as_flattened())),
        ("crossing", array(crossing.as_flattened().as_flattened())),
    ]))
}
