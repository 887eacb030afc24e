//! The Voronoi diagram for the npm package, in the module of the points. Its only caller is `src/js/voronoi.ts`, which has
//! made sure that the lengths fit.

use super::point_values::in_words_of_points;
use crate::system::memory;
use crate::wasm::values::{JsPositions, coded, object};
use crate::{Error, Positions, Triangulation, Voronoi};
use js_sys::{Float64Array, Uint32Array};
use wasm_bindgen::prelude::*;

/// As [`Triangulation::voronoi`]: 2 numbers per point, then a triangulation, then the box. Without one it is the smallest
/// that has all points.
///
/// # Errors
/// Those of [`Triangulation::voronoi`]; [`Error::Option`] for points without a box of their own.
#[wasm_bindgen(unchecked_return_type = "import('../voronoi.js').Voronoi")]
pub fn voronoi(
    points: JsPositions,
    triangles: &Uint32Array,
    twins: &Uint32Array,
    hull: &Uint32Array,
    duplicates: &Uint32Array,
    bounds: Option<Box<[f64]>>,
) -> Result<JsValue, JsValue> {
    let lists = [triangles, twins, hull, duplicates];
    let diagram = || {
        let bytes =
            points.byte_length() + lists.map(|list| f64::from(list.byte_length())).iter().sum::<f64>();
        memory::check(bytes as u64)?;
        let [triangles, twins, hull, duplicates] = lists.map(Uint32Array::to_vec);
        let duplicates = duplicates.as_chunks().0.to_vec();
        let points = Positions::from(points);
        let bounds = match bounds.as_deref() {
            Some(&[left, bottom, right, top]) => [left, bottom, right, top],
            _ => box_of(&points)?,
        };
        Triangulation { triangles, twins, hull, duplicates, ..Triangulation::default() }
            .voronoi(&points, bounds)
    };
    let Voronoi { circumcentres, starts, corners } = diagram().map_err(|error| match error {
        Error::Option { option: "triangulation", message } => {
            coded("invalid-input", &format!("triangulation: {message}"))
        }
        Error::IndexOutOfRange { triangle, index, vertices } => {
            let message =
                format!("triangle {triangle}: index {index} is out of range, there are {vertices} points");
            coded("index-out-of-range", &message)
        }
        error => in_words_of_points(error),
    })?;
    Ok(object([
        ("circumcentres", Float64Array::from(&*circumcentres).into()),
        ("starts", Uint32Array::from(&*starts).into()),
        ("corners", Float64Array::from(&*corners).into()),
    ]))
}

/// The smallest box that has all points, if it has an area.
fn box_of(points: &Positions) -> Result<[f64; 4], Error> {
    let mut bounds = [f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY];
    for (i, x) in points.iter().enumerate() {
        let axis = i % 2;
        bounds[axis] = bounds[axis].min(x);
        bounds[axis + 2] = bounds[axis + 2].max(x);
    }
    let [left, bottom, right, top] = bounds;
    // Coordinates that are not finite have an error of their own.
    if (left < right && bottom < top) || points.iter().any(|x| !x.is_finite()) {
        return Ok(bounds);
    }
    let message = "there are no two points with different x and y; pass the bounds".to_owned();
    Err(Error::Option { option: "bounds", message })
}
