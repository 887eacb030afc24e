//! The triangulation of points for the npm package, in a module of its own. Its only caller is `src/js/points.ts`, which
//! has made sure that the length is even.

use crate::system::memory;
use crate::wasm::values::{JsPositions, coded, object, thrown};
use crate::{Error, Triangulation};
use js_sys::Uint32Array;
use wasm_bindgen::prelude::*;

/// As [`triangulate`](crate::triangulate): 2 numbers per point.
///
/// # Errors
/// Those of [`triangulate`](crate::triangulate).
#[wasm_bindgen(unchecked_return_type = "Omit<import('../points.js').Triangulation, 'hint'>")]
pub fn triangulate(points: JsPositions) -> Result<JsValue, JsValue> {
    let triangulate = || {
        memory::check(points.byte_length() as u64)?;
        crate::triangulate(&points.into())
    };
    let Triangulation { triangles, twins, hull, duplicates } = triangulate().map_err(in_words_of_points)?;
    let array = |words: &[u32]| JsValue::from(Uint32Array::from(words));
    Ok(object([
        ("triangles", array(&triangles)),
        ("twins", array(&twins)),
        ("hull", array(&hull)),
        ("duplicates", array(duplicates.as_flattened())),
    ]))
}

/// The exception for an error. What other modules call a vertex is a point here.
pub(super) fn in_words_of_points(error: Error) -> JsValue {
    match error {
        Error::NonFinite { .. } => coded(error.code(), &error.to_string().replacen("vertex", "point", 1)),
        error => thrown(error),
    }
}
