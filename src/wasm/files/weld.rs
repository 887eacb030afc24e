//! Joins vertices for a run, and splits them again afterwards.

use super::{JsFile, load};
use crate::prepare::weld::first_alike;
use crate::system::memory;
use crate::wasm::values::{JsPositions, thrown};
use crate::{Error, Welded, welded};
use js_sys::{Uint8Array, Uint32Array};
use wasm_bindgen::prelude::*;

/// As [`Welded`], reoriented if the caller asks for it.
#[wasm_bindgen(js_name = Weld)]
pub struct JsWeld {
    welded: Welded,
    turned: u32,
}

#[wasm_bindgen(js_class = Weld)]
impl JsWeld {
    /// As [`welded`]. Each array of `attributes` has the same number of bytes for each vertex; vertices are equal if
    /// all these bytes are.
    ///
    /// # Errors
    /// Those of [`Mesh::new`] and [`welded`].
    pub fn of(
        positions: JsPositions,
        indices: &Uint32Array,
        dimension: u32,
        attributes: Vec<Uint8Array>,
        reorient: bool,
    ) -> Result<JsWeld, JsValue> {
        let weld = || {
            let mesh = super::mesh(positions, indices, dimension)?;
            let count = mesh.vertex_count();
            let mut alike = vec![0; count];
            for array in attributes {
                let bytes = array.to_vec();
                let width = bytes.len() / count.max(1);
                alike = first_alike(alike.into_iter().zip(bytes.chunks(width.max(1))));
            }
            Self::new(welded(&mesh, Some(&alike))?, reorient)
        };
        weld().map_err(thrown)
    }

    /// As [`io::Loaded::welded`](crate::io::Loaded::welded), for the mesh of a file with other triangles.
    ///
    /// # Errors
    /// Those of [`read_mesh`](super::read_mesh) and [`Mesh::new`].
    #[wasm_bindgen(js_name = ofFile)]
    pub fn of_file(
        file: &JsFile,
        indices: &Uint32Array,
        dimension: u32,
        reorient: bool,
    ) -> Result<JsWeld, JsValue> {
        let weld = || {
            let mut loaded = load(file, Some(dimension))?;
            loaded.mesh = loaded.mesh.with_triangles(indices.to_vec())?;
            Self::new(loaded.welded()?, reorient)
        };
        weld().map_err(thrown)
    }

    fn new(welded: Welded, reorient: bool) -> Result<Self, Error> {
        let (welded, turned) = if reorient { welded.reoriented()? } else { (welded, 0) };
        Ok(Self { welded, turned })
    }

    /// The number of reversed triangles.
    #[wasm_bindgen(getter)]
    pub fn turned(&self) -> u32 {
        self.turned
    }

    /// As [`Welded::joined`].
    #[wasm_bindgen(getter)]
    pub fn joined(&self) -> u32 {
        self.welded.joined() as u32
    }

    /// The triangles of [`Welded::mesh`].
    #[wasm_bindgen(getter)]
    pub fn indices(&self) -> Uint32Array {
        Uint32Array::from(self.welded.mesh.triangles())
    }

    /// As [`Welded::places`].
    #[wasm_bindgen(getter)]
    pub fn places(&self) -> Uint32Array {
        Uint32Array::from(self.welded.places.as_slice())
    }

    /// As [`Wedges::locked_edges`](crate::Wedges::locked_edges), two vertices per edge.
    #[wasm_bindgen(getter, js_name = lockedEdges)]
    pub fn locked_edges(&self) -> Uint32Array {
        Uint32Array::from(self.welded.wedges.locked_edges().as_flattened())
    }

    /// As [`Wedges::locked_triangles`](crate::Wedges::locked_triangles).
    #[wasm_bindgen(getter, js_name = lockedTriangles)]
    pub fn locked_triangles(&self) -> Uint32Array {
        Uint32Array::from(self.welded.wedges.locked_triangles())
    }

    /// As [`Welded::split`].
    ///
    /// # Errors
    /// Those of [`Welded::split`].
    pub fn split(&self, indices: &Uint32Array) -> Result<Uint32Array, JsValue> {
        let split = || {
            // Checked before the copy: an exception of JavaScript would leave this object borrowed.
            memory::check(4 * u64::from(indices.byte_length()))?;
            self.welded.split(&indices.to_vec())
        };
        Ok(Uint32Array::from(split().map_err(thrown)?.as_slice()))
    }
}
