//! Brings constraints in, also those that cross, and finds the regions that they bound, for `src/js/files.ts`.

use super::{fields, mesh};
use crate::prepare::constraints::crossings::split_in;
use crate::session::locks;
use crate::wasm::values::{JsPositions, left_out_list, object, thrown};
use crate::{Constrained, Error, Mesh, Options, constrained, regions};
use js_sys::{Float64Array, Uint8Array, Uint32Array};
use wasm_bindgen::prelude::*;

#[wasm_bindgen]
extern "C" {
    /// Locks of edges, as in [`Options`].
    #[wasm_bindgen(typescript_type = "Required<import('../files.js').Locks>")]
    pub type JsLocks;

    #[wasm_bindgen(method, getter, js_name = lockedEdges)]
    fn locked_edges(this: &JsLocks) -> Uint32Array;
    #[wasm_bindgen(method, getter, js_name = lockedTriangles)]
    fn locked_triangles(this: &JsLocks) -> Uint32Array;
    #[wasm_bindgen(method, getter)]
    fn groups(this: &JsLocks) -> Uint32Array;
}

/// As [`constrained`], with all locks of [`Options`].
///
/// # Errors
/// Those of [`Mesh::new`](crate::Mesh::new) and [`constrained`](crate::constrained); [`Error::RaggedArray`];
/// [`Error::Option`] for locks that the mesh does not have.
#[wasm_bindgen(unchecked_return_type = "import('../files.js').Constrained")]
pub fn constrain(
    positions: JsPositions,
    indices: &Uint32Array,
    dimension: u32,
    constraints: &Uint32Array,
    locks: &JsLocks,
    skips: bool,
    tolerance: f64,
) -> Result<JsValue, JsValue> {
    let work = || {
        let mesh = mesh(positions, indices, dimension)?;
        let locked_edges = edges(&mesh, locks)?;
        constrained(&mesh, &pairs("constraints", constraints)?, &locked_edges, skips, tolerance, None)
    };
    let result = work().map_err(thrown)?;
    let constraint_edges = Uint32Array::from(result.constraint_edges().as_flattened());
    let Constrained { mesh, locked_edges, crossed_edges, deviation, left_out, .. } = result;
    Ok(object([
        ("indices", Uint32Array::from(mesh.triangles()).into()),
        ("lockedEdges", Uint32Array::from(locked_edges.as_flattened()).into()),
        ("constraintEdges", constraint_edges.into()),
        ("crossedEdges", (crossed_edges as f64).into()),
        ("deviation", deviation.into()),
        ("leftOut", left_out_list(&left_out)),
    ]))
}

/// As [`split_crossings`](crate::split_crossings), with all locks of [`Options`]. `is_double`: whether crossings are
/// rounded to 64-bit floats. The chains follow each other in an array, and another has the index of the end of each.
///
/// # Errors
/// Those of [`Mesh::new`](crate::Mesh::new) and [`split_crossings`](crate::split_crossings); [`Error::RaggedArray`];
/// [`Error::Option`] for locks that the mesh does not have.
#[wasm_bindgen(js_name = splitCrossings, unchecked_return_type = "import('../crossings.js').Split")]
pub fn split_crossings_of(
    positions: JsPositions,
    indices: &Uint32Array,
    dimension: u32,
    is_double: bool,
    constraints: &Uint32Array,
    locks: &JsLocks,
    skips: bool,
) -> Result<JsValue, JsValue> {
    let work = || {
        let mesh = mesh(positions, indices, dimension)?;
        let locked_edges = edges(&mesh, locks)?;
        split_in(&mesh, &pairs("constraints", constraints)?, &locked_edges, skips, is_double)
    };
    let split = work().map_err(thrown)?;
    let ends = split.chains.iter().scan(0, |end, chain| {
        *end += chain.len() as u32;
        Some(*end)
    });
    let ends: Vec<u32> = ends.collect();
    let numbers = |numbers: Vec<u32>| JsValue::from(Uint32Array::from(numbers.as_slice()));
    let of_crossings = split.crossings.iter().map(|crossing| crossing.constraints.map(|i| i as u32));
    let lines = numbers(of_crossings.collect::<Vec<_>>().concat());
    let between: Vec<[u32; 2]> = split.crossings.iter().map(|crossing| crossing.between).collect();
    let at: Vec<f64> = split.crossings.iter().map(|crossing| crossing.at).collect();
    let [positions, indices, _] = fields(&split.mesh);
    Ok(object([
        positions,
        indices,
        ("chains", numbers(split.chains.concat())),
        ("ends", numbers(ends)),
        ("constraintEdges", numbers(split.constraint_edges().concat())),
        ("crossings", lines),
        ("between", numbers(between.concat())),
        ("at", Float64Array::from(at.as_slice()).into()),
        ("deviation", split.deviation.into()),
        ("leftOut", left_out_list(&split.left_out)),
    ]))
}

/// The edges that these locks lock.
fn edges(mesh: &Mesh, locks: &JsLocks) -> Result<Vec<[u32; 2]>, Error> {
    let options = Options {
        locked_edges: pairs("lockedEdges", &locks.locked_edges())?,
        locked_triangles: locks.locked_triangles().to_vec(),
        groups: locks.groups().to_vec(),
        ..Options::default()
    };
    locks::edges(mesh, &options)
}

/// As [`regions()`].
///
/// # Errors
/// Those of [`Mesh::new`](crate::Mesh::new) and [`regions()`]; [`Error::RaggedArray`].
#[wasm_bindgen(js_name = regions, unchecked_return_type = "import('../files.js').Regions")]
pub fn regions_of(
    positions: JsPositions,
    indices: &Uint32Array,
    dimension: u32,
    edges: &Uint32Array,
) -> Result<JsValue, JsValue> {
    let work = || regions(&mesh(positions, indices, dimension)?, &pairs("edges", edges)?);
    let found = work().map_err(thrown)?;
    let inside: Vec<u8> = found.inside.into_iter().map(u8::from).collect();
    Ok(object([
        ("count", found.count.into()),
        ("ofTriangles", Uint32Array::from(found.of_triangles.as_slice()).into()),
        ("inside", Uint8Array::from(inside.as_slice()).into()),
        ("isClosed", found.is_closed.into()),
    ]))
}

fn pairs(array: &'static str, given: &Uint32Array) -> Result<Vec<[u32; 2]>, Error> {
    let numbers = given.to_vec();
    match numbers.as_chunks() {
        (pairs, []) => Ok(pairs.to_vec()),
        _ => Err(Error::RaggedArray { array, length: numbers.len(), stride: 2 }),
    }
}
