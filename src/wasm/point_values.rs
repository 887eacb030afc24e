//! Conversions of points and triangulations, for the modules of `edgeflip/points`.

use crate::system::memory;
use crate::wasm::values::{JsPositions, coded, left_out_list, object, thrown};
use crate::{Error, Positions, Triangulation};
use js_sys::Uint32Array;
use wasm_bindgen::prelude::*;

#[wasm_bindgen(typescript_custom_section)]
const ARRAYS: &str = "type Arrays = Omit<import('../triangulation.js').Triangulation, 'threads' | 'hint'>;";

/// Copies an array of coordinates after a check that there is enough memory.
pub(super) fn positions(points: JsPositions) -> Result<Positions, Error> {
    memory::check(points.byte_length() as u64)?;
    Ok(points.into())
}

pub(super) fn triangulation_object(triangulation: &Triangulation) -> JsValue {
    let Triangulation { triangles, twins, hull, duplicates, constraint_edges, left_out } = triangulation;
    let array = |words: &[u32]| JsValue::from(Uint32Array::from(words));
    object([
        ("triangles", array(triangles)),
        ("twins", array(twins)),
        ("hull", array(hull)),
        ("duplicates", array(duplicates.as_flattened())),
        ("constraintEdges", array(constraint_edges.as_flattened())),
        ("leftOut", left_out_list(left_out)),
    ])
}

/// The exception for an error. What other modules call a vertex is a point here.
pub(super) fn in_words_of_points(error: Error) -> JsValue {
    match error {
        Error::NonFinite { vertex, .. } => {
            let message = error.to_string();
            let place = format!("vertex {vertex}");
            let rest = message.strip_prefix(&*place).unwrap_or(&message);
            coded(error.code(), &format!("point {vertex}{rest}"))
        }
        Error::PositionCount { length, expected } => {
            let message =
                format!("points has {length} numbers, but the points of the session take {expected}");
            coded(error.code(), &message)
        }
        // That of a point, which is no option.
        Error::Option { option: "index", message } => coded("invalid-input", &message),
        error => thrown(error),
    }
}
