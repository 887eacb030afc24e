//! The WebGL2 engine for the module of the engines, which calls it as `engine::proxy` does: in a module of its own, that
//! is loaded when the engine is taken.

use crate::engine::{self, Engine, WebGl};
use crate::js_values::{JsPositions, coded, parse_dimension, thrown};
use crate::phases::Thresholds;
use crate::{Dimension, Error, Mesh};
use js_sys::Uint32Array;
use std::sync::Arc;
use wasm_bindgen::prelude::*;

/// Says where the programs come from: a function that returns a promise of their module.
#[wasm_bindgen(js_name = setShaderLoader)]
pub fn set_shader_loader(
    #[wasm_bindgen(unchecked_param_type = "() => Promise<unknown>")] loader: js_sys::Function,
) {
    engine::set_shader_loader(loader);
}

/// A mesh on the engine.
#[wasm_bindgen(js_name = WebGl2)]
pub struct JsWebGl2 {
    engine: WebGl,
    dimension: Dimension,
}

#[wasm_bindgen(js_class = WebGl2)]
impl JsWebGl2 {
    /// On the context that all share; `cos` is the cosine of β, `deviation` what diagonals may be apart.
    ///
    /// # Errors
    /// Where there is no context, it is a software one that is not taken, it fails its self-test, or it cannot take the
    /// mesh.
    pub async fn create(
        positions: JsPositions,
        indices: Vec<u32>,
        dimension: f64,
        cos: f64,
        deviation: f32,
        takes_software: bool,
    ) -> Result<JsWebGl2, JsValue> {
        let create = async {
            let dimension = parse_dimension(dimension)?;
            let mesh = Arc::new(Mesh::new(dimension, positions, indices)?);
            Ok(Self {
                engine: WebGl::open(mesh, Thresholds { cos, deviation }, takes_software).await?,
                dimension,
            })
        };
        create.await.map_err(bare)
    }

    /// As the engine's.
    ///
    /// # Errors
    /// Where the context is lost.
    pub async fn lock(&mut self, half_edges: Vec<u32>) -> Result<(), JsValue> {
        self.engine.lock(half_edges).await.map_err(bare)
    }

    /// As the engine's.
    ///
    /// # Errors
    /// Where the context is lost.
    pub async fn iterate(&mut self, count: u32) -> Result<Uint32Array, JsValue> {
        array(self.engine.iterate(count).await)
    }

    /// As the shaders count.
    ///
    /// # Errors
    /// Where the context is lost.
    pub async fn census(&mut self) -> Result<Uint32Array, JsValue> {
        array(self.engine.census_counts().await)
    }

    /// As the engine's.
    ///
    /// # Errors
    /// Where the context is lost.
    pub async fn triangles(&mut self) -> Result<Uint32Array, JsValue> {
        array(self.engine.triangles().await)
    }

    /// As the engine's.
    ///
    /// # Errors
    /// Where the context is lost.
    pub async fn twins(&mut self) -> Result<Uint32Array, JsValue> {
        array(self.engine.twins().await)
    }

    /// As the engine's: `indices` are the triangles as they are now.
    ///
    /// # Errors
    /// Where it cannot take the positions; where the context is lost.
    #[wasm_bindgen(js_name = setPositions)]
    pub async fn set_positions(&mut self, positions: JsPositions, indices: Vec<u32>) -> Result<(), JsValue> {
        let mesh = Mesh::new(self.dimension, positions, indices).map_err(bare)?;
        self.engine.set_positions(Arc::new(mesh)).await.map_err(bare)
    }

    /// How many iterations to ask for at a time.
    #[wasm_bindgen(getter)]
    pub fn batch(&self) -> u32 {
        self.engine.batch()
    }

    /// All edges, those of the boundary, the non-manifold and the inconsistent ones.
    #[wasm_bindgen(getter, js_name = edgeCounts)]
    pub fn edge_counts(&self) -> Vec<u32> {
        let counts = self.engine.edge_counts();
        vec![counts.edges, counts.boundary, counts.non_manifold, counts.inconsistent]
    }

    /// The renderer's name.
    #[wasm_bindgen(getter)]
    pub fn adapter(&self) -> String {
        self.engine.adapter().unwrap_or_default()
    }

    /// Passes so far.
    #[wasm_bindgen(getter)]
    pub fn dispatches(&self) -> f64 {
        self.engine.dispatches() as f64
    }
}

fn array(words: Result<Vec<u32>, Error>) -> Result<Uint32Array, JsValue> {
    Ok(Uint32Array::from(words.map_err(bare)?.as_slice()))
}

/// An `Error` with a `code` whose message is that of the variant alone: the other module makes the variant of it again.
fn bare(error: Error) -> JsValue {
    let code = error.code();
    match error {
        Error::BackendUnavailable { message, .. }
        | Error::BackendLimit { message, .. }
        | Error::Device { message } => coded(code, &message),
        error => thrown(error),
    }
}
