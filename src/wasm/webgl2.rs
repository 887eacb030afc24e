//! The WebGL2 engine, in a module of its own that is loaded on first use. The module of the other engines calls it
//! through `engine::webgl2::module_proxy`.

use crate::Error;
use crate::engine::{self, Engine, Question, WebGl};
use crate::phases::Thresholds;
use crate::system::promise::promise;
use crate::system::threads::Threads;
use crate::wasm::options::{JsOptions, without_lists};
use crate::wasm::values::{JsPositions, coded, mesh_of, thrown};
use js_sys::{Promise, Uint32Array};
use std::cell::RefCell;
use std::rc::Rc;
use std::sync::Arc;
use wasm_bindgen::prelude::*;

/// Sets the function that loads the shaders. It returns a promise of their JavaScript module.
#[wasm_bindgen(js_name = setShaderLoader)]
pub fn set_shader_loader(
    #[wasm_bindgen(unchecked_param_type = "() => Promise<unknown>")] loader: js_sys::Function,
) {
    engine::set_shader_loader(loader);
}

/// A mesh on the engine. A call holds the engine while it runs, so a call that ends with a trap never returns it.
#[wasm_bindgen(js_name = WebGl2)]
pub struct JsWebGl2 {
    engine: Rc<RefCell<Option<WebGl>>>,
    dimension: u32,
}

impl JsWebGl2 {
    /// Calls the engine, and returns a promise of the answer, which `give` converts to a JavaScript value.
    fn call<T>(
        &self,
        question: impl AsyncFnOnce(&mut WebGl) -> Result<T, Error> + 'static,
        give: impl FnOnce(T) -> JsValue + 'static,
    ) -> Promise {
        let shared = self.engine.clone();
        promise(async move {
            let mut engine = shared.take().ok_or_else(ended)?;
            let answer = question(&mut engine).await;
            shared.replace(Some(engine));
            answer.map(give).map_err(bare)
        })
    }

    /// Does not hold the engine until the answer is there.
    fn count_moved(&self) -> Promise {
        let mut engine = self.engine.borrow_mut();
        let counted = engine.as_mut().ok_or_else(ended).and_then(|engine| engine.count_moved().map_err(bare));
        promise(async move { counted?.await.map(array).map_err(bare) })
    }

    fn get<T: Default>(&self, value: impl FnOnce(&WebGl) -> T) -> T {
        self.engine.borrow().as_ref().map(value).unwrap_or_default()
    }
}

#[wasm_bindgen(js_class = WebGl2)]
impl JsWebGl2 {
    /// Opens an engine on the WebGL2 context, which all engines share. It uses only the thresholds of `options`.
    ///
    /// Rejects if there is no context, if the self-test fails, or if the engine cannot accept the mesh.
    #[wasm_bindgen(unchecked_return_type = "Promise<WebGl2>")]
    pub fn create(
        positions: JsPositions,
        indices: &Uint32Array,
        dimension: u32,
        options: &JsOptions,
    ) -> Promise {
        let mesh = mesh_of(positions, indices, dimension, &Threads::one());
        let options = without_lists(options);
        let create = async move {
            let engine = WebGl::open(Arc::new(mesh?), Thresholds::from(&options?)).await?;
            Ok(Self { engine: Rc::new(RefCell::new(Some(engine))), dimension })
        };
        promise(async { create.await.map(JsValue::from).map_err(bare) })
    }

    /// Asks the engine a `Question`, with its words, and returns words. `Question::Moved` asks before it returns. Like
    /// all methods below, it rejects if the context is lost.
    #[wasm_bindgen(unchecked_return_type = "Promise<Uint32Array>")]
    pub fn ask(&self, question: u32, words: Uint32Array) -> Promise {
        match Question::of_number(question) {
            Some(Question::Moved) => self.count_moved(),
            question => self.call(async move |engine| answer(engine, question, &words).await, array),
        }
    }

    /// As `Engine::set_positions`. `indices` are the present triangles, or others with these locked half-edges. Also
    /// rejects if the engine cannot accept the positions.
    #[wasm_bindgen(js_name = setPositions, unchecked_return_type = "Promise<void>")]
    pub fn set_positions(
        &self,
        positions: JsPositions,
        indices: Uint32Array,
        locked: Option<Uint32Array>,
    ) -> Promise {
        let dimension = self.dimension;
        let set = async move |engine: &mut WebGl| {
            let mesh = mesh_of(positions, &indices, dimension, &Threads::one())?;
            engine.move_vertices(Arc::new(mesh), locked.map(|locked| locked.to_vec())).await
        };
        self.call(set, |()| JsValue::UNDEFINED)
    }

    /// As `Engine::update`. Copies the positions before it returns.
    ///
    /// # Errors
    /// Those of `Engine::update`.
    pub fn update(
        &self,
        positions: Option<JsPositions>,
        iterations: u32,
        untangles: bool,
    ) -> Result<(), JsValue> {
        let mut engine = self.engine.borrow_mut();
        let engine = engine.as_mut().ok_or_else(ended)?;
        engine.update(positions.map(Into::into), iterations, untangles).map_err(bare)
    }

    /// As `Engine::batch`.
    #[wasm_bindgen(getter)]
    pub fn batch(&self) -> u32 {
        self.get(WebGl::batch)
    }

    /// The numbers of all edges, boundary edges, non-manifold edges and inconsistent edges.
    #[wasm_bindgen(getter, js_name = edgeCounts)]
    pub fn edge_counts(&self) -> Vec<u32> {
        let counts = self.get(WebGl::edge_counts);
        vec![counts.edges, counts.boundary, counts.non_manifold, counts.inconsistent]
    }

    /// The name of the GPU.
    #[wasm_bindgen(getter)]
    pub fn adapter(&self) -> String {
        self.get(WebGl::adapter).unwrap_or_default()
    }

    /// Passes so far.
    #[wasm_bindgen(getter)]
    pub fn dispatches(&self) -> f64 {
        self.get(|engine| engine.dispatches() as f64)
    }
}

fn ended() -> JsValue {
    coded("device-failed", "the engine ended when a call of it crashed")
}

/// The answer to a question. An unknown question, of another version, has none.
async fn answer(
    engine: &mut WebGl,
    question: Option<Question>,
    words: &Uint32Array,
) -> Result<Vec<u32>, Error> {
    match question {
        Some(Question::Lock) => engine.lock(words.to_vec()).await.map(|()| Vec::new()),
        Some(Question::Iterate) => engine.iterate(words.get_index(0)).await,
        Some(Question::Census) => engine.census_counts().await,
        Some(Question::Areas) => engine.count_areas().await,
        Some(Question::Triangles) => engine.triangles().await,
        Some(Question::Twins) => engine.twins().await,
        Some(Question::Settle) => engine.settle().await.map(|()| Vec::new()),
        Some(Question::TrackChanges) => engine.track_changes().await.map(|()| Vec::new()),
        Some(Question::Changes) => engine.changes().await,
        Some(Question::Positions) => engine.read_positions().await,
        Some(Question::Moved) | None => Ok(Vec::new()),
    }
}

fn array(words: Vec<u32>) -> JsValue {
    Uint32Array::from(words.as_slice()).into()
}

/// An `Error` with a `code` and the message of the variant alone. The proxy makes the variant from it again.
fn bare(error: Error) -> JsValue {
    let code = error.code();
    match error {
        Error::BackendUnavailable { message, .. }
        | Error::BackendLimit { message, .. }
        | Error::Device { message } => coded(code, &message),
        error => thrown(error),
    }
}
