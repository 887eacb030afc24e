//! Brings constraints in, for `src/js/files.ts`.

use super::mesh;
use crate::session::locks;
use crate::wasm::values::{JsPositions, object, thrown};
use crate::{Error, Options};
use js_sys::{Array, Uint32Array};
use std::sync::Arc;
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

/// As [`Session::new`](crate::Session::new) with [`Options::constraints`].
///
/// # Errors
/// Those of [`Mesh::new`](crate::Mesh::new) and [`constrained`](crate::constrained); [`Error::RaggedArray`];
/// [`Error::Option`] for the dimension and for locks that the mesh does not have.
#[wasm_bindgen(unchecked_return_type = "import('../files.js').Constrained")]
pub fn constrain(
    positions: JsPositions,
    indices: &Uint32Array,
    dimension: f64,
    constraints: &Uint32Array,
    locks: &JsLocks,
    skips: bool,
) -> Result<JsValue, JsValue> {
    let work = || {
        let mesh = Arc::new(mesh(positions, indices, dimension)?);
        let mut options = Options {
            constraints: pairs("constraints", constraints)?,
            skips_constraints: skips,
            locked_edges: pairs("lockedEdges", &locks.locked_edges())?,
            locked_triangles: locks.locked_triangles().to_vec(),
            groups: locks.groups().to_vec(),
            ..Options::default()
        };
        options.locked_edges = locks::edges(&mesh, &options)?;
        let (mesh, flips, left_out) = locks::bring_in(mesh, &mut options)?;
        Ok((mesh, options.locked_edges, flips, left_out))
    };
    let (mesh, locked_edges, flips, left_out) = work().map_err(thrown)?;
    let left_out = left_out.into_iter().map(|(index, reason)| {
        JsValue::from(object([("index", (index as f64).into()), ("reason", reason.into())]))
    });
    Ok(object([
        ("indices", Uint32Array::from(mesh.triangles()).into()),
        ("lockedEdges", Uint32Array::from(locked_edges.as_flattened()).into()),
        ("flips", (flips as f64).into()),
        ("leftOut", left_out.collect::<Array>().into()),
    ]))
}

fn pairs(array: &'static str, given: &Uint32Array) -> Result<Vec<[u32; 2]>, Error> {
    let numbers = given.to_vec();
    match numbers.as_chunks() {
        (pairs, []) => Ok(pairs.to_vec()),
        _ => Err(Error::RaggedArray { array, length: numbers.len(), stride: 2 }),
    }
}
