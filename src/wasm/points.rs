//! The triangulation of points for the npm package, in modules of its own: on one thread, and on several. Their only
//! callers are `src/js/points.ts` and `src/js/points-thread.ts`; the former has made sure that the length is even.

use super::point_values::{in_words_of_points, positions, triangulation_object};
use crate::PointOptions;
use crate::wasm::values::JsPositions;
use wasm_bindgen::prelude::*;

/// As [`triangulate_with`](crate::triangulate_with): 2 numbers per point, and pairs of points.
///
/// # Errors
/// Those of [`triangulate_with`](crate::triangulate_with).
#[wasm_bindgen(unchecked_return_type = "Arrays")]
pub fn triangulate(
    points: JsPositions,
    constraints: Option<Vec<u32>>,
    skips_constraints: bool,
) -> Result<JsValue, JsValue> {
    let constraints = constraints.unwrap_or_default().as_chunks().0.to_vec();
    let options = PointOptions { constraints, skips_constraints, ..PointOptions::default() };
    let triangulate = || crate::triangulate_with(&positions(points)?, &options);
    triangulate().map(|triangulation| triangulation_object(&triangulation)).map_err(in_words_of_points)
}
