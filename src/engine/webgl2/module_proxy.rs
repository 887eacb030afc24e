//! A proxy of the WebGL2 engine, in the module of the other engines. It calls the exports of `src/wasm/webgl2.rs`.

use super::question::Question;
use crate::engine::{Answer, Census, EdgeCounts, Engine, Moved, positions_of};
use crate::mesh::areas::Areas;
use crate::mesh::half_edge;
use crate::{EngineKind, Error, Mesh, Positions};
use js_sys::{Object, Promise, Reflect, Uint32Array};
use std::cell::RefCell;
use std::sync::Arc;
use wasm_bindgen::prelude::*;
use wasm_bindgen_futures::JsFuture;

#[wasm_bindgen]
extern "C" {
    /// Loads the module of the engine at the first call of `create`, and makes a `JsWebGl2`.
    #[wasm_bindgen(typescript_type = "Pick<typeof import('./edgeflip_webgl2.js').WebGl2, 'create'>")]
    #[derive(Clone)]
    pub type WebGl2Module;
    #[wasm_bindgen(method, catch)]
    fn create(
        this: &WebGl2Module,
        positions: JsValue,
        indices: Uint32Array,
        dimension: u32,
        options: &Object,
    ) -> Result<Promise, JsValue>;

    /// `JsWebGl2`.
    type Remote;
    #[wasm_bindgen(method, catch)]
    fn ask(this: &Remote, question: u32, words: Uint32Array) -> Result<Promise, JsValue>;
    #[wasm_bindgen(method, catch, js_name = setPositions)]
    fn set_positions(
        this: &Remote,
        positions: JsValue,
        indices: Uint32Array,
        locked: Option<Uint32Array>,
    ) -> Result<Promise, JsValue>;
    #[wasm_bindgen(method, catch)]
    fn update(this: &Remote, positions: JsValue, iterations: u32, untangles: bool) -> Result<(), JsValue>;
    #[wasm_bindgen(method, getter)]
    fn batch(this: &Remote) -> u32;
    #[wasm_bindgen(method, getter, js_name = edgeCounts)]
    fn edge_counts(this: &Remote) -> Vec<u32>;
    #[wasm_bindgen(method, getter)]
    fn adapter(this: &Remote) -> String;
    #[wasm_bindgen(method, getter)]
    fn dispatches(this: &Remote) -> f64;
    #[wasm_bindgen(method, catch)]
    fn free(this: &Remote) -> Result<(), JsValue>;
}

thread_local! {
    static MODULE: RefCell<Option<WebGl2Module>> = const { RefCell::new(None) };
}

/// Sets the module of the engine.
pub(crate) fn set_webgl2(module: WebGl2Module) {
    MODULE.set(Some(module));
}

/// A mesh on the engine in the other module.
pub(crate) struct Proxy {
    remote: Remote,
    counts: EdgeCounts,
    is_settled: bool,
}

impl Proxy {
    /// As `WebGl::open`. The options are those that JavaScript gave: the other module reads them again.
    ///
    /// # Errors
    /// Those of `WebGl::open`, and [`Error::BackendUnavailable`] if the module cannot be loaded.
    pub(crate) async fn new(mesh: &Mesh, options: &Object) -> Result<Self, Error> {
        let module = MODULE.with_borrow(Clone::clone);
        let module = module.ok_or_else(|| unavailable("its module is not set".to_owned()))?;
        let positions = mesh.positions().to_typed_array();
        // A copy, because the call reads it only when the module is loaded.
        let indices = Uint32Array::from(mesh.triangles());
        let dimension = mesh.dimension().stride() as u32;
        let created = module.create(positions, indices, dimension, options);
        let remote: Remote = answer(created).await?.unchecked_into();
        let counts = remote.edge_counts();
        let counts = EdgeCounts {
            edges: counts[0],
            boundary: counts[1],
            non_manifold: counts[2],
            inconsistent: counts[3],
        };
        Ok(Self { remote, counts, is_settled: false })
    }

    fn ask(&self, question: Question, words: &[u32]) -> Answer<'static, Vec<u32>> {
        let asked = self.remote.ask(question as u32, words.into());
        Box::pin(async { Ok(Uint32Array::new(&answer(asked).await?).to_vec()) })
    }

    fn tell(&self, question: Question, words: &[u32]) -> Answer<'static, ()> {
        let asked = self.ask(question, words);
        Box::pin(async { asked.await.map(drop) })
    }
}

impl Drop for Proxy {
    fn drop(&mut self) {
        // `free` throws only after a trap in the other module, which may still hold the object.
        let _ = self.remote.free();
    }
}

async fn answer(asked: Result<Promise, JsValue>) -> Result<JsValue, Error> {
    let answer = async { JsFuture::from(asked?).await };
    answer.await.map_err(error_of)
}

fn error_of(thrown: JsValue) -> Error {
    let text = |name: &str| Reflect::get(&thrown, &name.into()).ok().and_then(|text| text.as_string());
    let message = text("message").unwrap_or_default();
    match text("code").as_deref() {
        Some("backend-limit") => Error::BackendLimit { backend: EngineKind::WebGl, message },
        Some("backend-unavailable" | "load-failed") => unavailable(message),
        _ => Error::Device { message },
    }
}

fn unavailable(message: String) -> Error {
    Error::BackendUnavailable { backend: EngineKind::WebGl, message }
}

impl Engine for Proxy {
    fn batch(&self) -> u32 {
        self.remote.batch()
    }

    fn lock(&mut self, half_edges: Vec<u32>) -> Answer<'_, ()> {
        self.tell(Question::Lock, &half_edges)
    }

    fn iterate(&mut self, count: u32) -> Answer<'_, Vec<u32>> {
        self.ask(Question::Iterate, &[count])
    }

    fn census(&mut self) -> Answer<'_, Census> {
        let counts = self.ask(Question::Census, &[]);
        Box::pin(async { Ok(Census::of_counts(&counts.await?)) })
    }

    fn areas(&mut self) -> Answer<'_, Areas> {
        let counts = self.ask(Question::Areas, &[]);
        Box::pin(async { Ok(Areas::of_counts(&counts.await?)) })
    }

    fn triangles(&mut self) -> Answer<'_, Vec<u32>> {
        self.ask(Question::Triangles, &[])
    }

    fn twins(&mut self) -> Answer<'_, Vec<u32>> {
        self.ask(Question::Twins, &[])
    }

    fn set_positions(&mut self, mesh: Arc<Mesh>, twins: Option<Vec<u32>>) -> Answer<'_, ()> {
        Box::pin(async move {
            let (positions, triangles) = (mesh.positions().to_typed_array(), mesh.triangles().into());
            let locked = twins.map(|twins| half_edge::locked(&twins).as_slice().into());
            answer(self.remote.set_positions(positions, triangles, locked)).await?;
            self.is_settled = false;
            Ok(())
        })
    }

    fn is_settled(&self) -> bool {
        self.is_settled
    }

    fn settle(&mut self) -> Answer<'_, ()> {
        Box::pin(async {
            self.tell(Question::Settle, &[]).await?;
            self.is_settled = true;
            Ok(())
        })
    }

    fn update(
        &mut self,
        positions: Option<Positions>,
        iterations: u32,
        untangles: bool,
    ) -> Result<(), Error> {
        let array = positions.as_ref().map_or(JsValue::UNDEFINED, Positions::to_typed_array);
        self.remote.update(array, iterations, untangles).map_err(error_of)
    }

    fn moved(&mut self) -> Answer<'static, Moved> {
        let counts = self.ask(Question::Moved, &[]);
        Box::pin(async { Ok(Moved::of_counts(&counts.await?)) })
    }

    fn track_changes(&mut self) -> Answer<'_, ()> {
        self.tell(Question::TrackChanges, &[])
    }

    fn changes(&mut self) -> Answer<'_, Vec<u32>> {
        self.ask(Question::Changes, &[])
    }

    fn positions(&mut self) -> Answer<'_, Positions> {
        let bits = self.ask(Question::Positions, &[]);
        Box::pin(async { Ok(positions_of(bits.await?)) })
    }

    fn edge_counts(&self) -> EdgeCounts {
        self.counts
    }

    fn backend(&self) -> EngineKind {
        EngineKind::WebGl
    }

    fn adapter(&self) -> Option<String> {
        Some(self.remote.adapter())
    }

    fn dispatches(&self) -> u64 {
        self.remote.dispatches() as u64
    }
}
