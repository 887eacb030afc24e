//! The repair of triangles that have turned over, for the npm package, in a module of its own that is loaded when a mesh
//! needs it. The modules of the engines call `untangle` through `session::untangler`, and `src/js/prepare.ts` calls
//! `untangleFirst`.

use crate::session::{self, Untangler};
use crate::system::threads::Threads;
use crate::wasm::values::{JsPositions, mesh_of, object, thrown};
use crate::{Dimension, Error, Mesh, Options};
use js_sys::Uint32Array;
use std::sync::Arc;
use wasm_bindgen::prelude::*;

#[wasm_bindgen]
extern "C" {
    /// The locks of [`Options`].
    #[wasm_bindgen(typescript_type = "import('../settings.js').Settings")]
    pub type JsLocks;

    #[wasm_bindgen(method, getter, js_name = lockedEdges)]
    fn locked_edges(this: &JsLocks) -> Option<Vec<u32>>;
    #[wasm_bindgen(method, getter, js_name = lockedTriangles)]
    fn locked_triangles(this: &JsLocks) -> Option<Vec<u32>>;
    #[wasm_bindgen(method, getter)]
    fn groups(this: &JsLocks) -> Option<Vec<u32>>;
}

/// As [`Untangler`].
#[wasm_bindgen(js_name = Untangler)]
#[derive(Default)]
pub struct JsUntangler(Untangler);

#[wasm_bindgen(js_class = Untangler)]
impl JsUntangler {
    /// For a mesh in the plane.
    #[wasm_bindgen(constructor)]
    pub fn new() -> Self {
        Self::default()
    }

    /// As [`Untangler::repaired`], with 2 vertices per edge: the words of what comes out. The mesh has been checked. Its
    /// positions are `singles` or `doubles`; the others are empty.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    #[allow(clippy::too_many_arguments, reason = "JavaScript passes the arrays of another module on")]
    pub fn repaired(
        &mut self,
        singles: Vec<f32>,
        doubles: Vec<f64>,
        triangles: Vec<u32>,
        twins: &[u32],
        locked_edges: &[u32],
        locks: usize,
        lost: &[u32],
    ) -> Result<Vec<u32>, JsValue> {
        let positions = if doubles.is_empty() { singles.into() } else { doubles.into() };
        let mesh = Mesh::of_checked(Dimension::Two, positions, triangles);
        let locked = (locked_edges.as_chunks().0, locks);
        let repaired = self.0.repaired(&mesh, twins, locked, lost.as_chunks().0).map_err(thrown)?;
        Ok(repaired.map_or(Vec::new(), |repaired| repaired.words()))
    }
}

/// As [`session::untangle::begin`], for a mesh in the plane. Returns `undefined` if nothing changes.
///
/// # Errors
/// Those of [`Mesh::new`](crate::Mesh::new) and [`session::untangle::begin`]; [`Error::RaggedArray`].
#[wasm_bindgen(js_name = untangleFirst, unchecked_return_type = "import('../untangler.js').Begun | undefined")]
pub fn untangle_first(
    positions: JsPositions,
    indices: &Uint32Array,
    locks: &JsLocks,
) -> Result<JsValue, JsValue> {
    let begin = || {
        let before = Arc::new(mesh_of(positions, indices, 2, &Threads::one())?);
        let ends = locks.locked_edges().unwrap_or_default();
        let (locked_edges, []) = ends.as_chunks() else {
            return Err(Error::RaggedArray { array: "lockedEdges", length: ends.len(), stride: 2 });
        };
        let mut options = Options {
            locked_edges: locked_edges.to_vec(),
            locked_triangles: locks.locked_triangles().unwrap_or_default(),
            groups: locks.groups().unwrap_or_default(),
            ..Options::default()
        };
        let mut mesh = before.clone();
        let lost = session::untangle::begin(&mut mesh, &mut options)?;
        if Arc::ptr_eq(&mesh, &before) {
            return Ok(JsValue::UNDEFINED);
        }
        Ok(object([
            ("indices", array(mesh.triangles())),
            ("lockedEdges", array(options.locked_edges.as_flattened())),
            ("lostEdges", array(lost.as_flattened())),
        ]))
    };
    begin().map_err(thrown)
}

fn array(words: &[u32]) -> JsValue {
    Uint32Array::from(words).into()
}
