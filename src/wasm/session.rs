//! What the npm package calls, and no one else: the hand-written TypeScript in `src/js/` is its public face.
//! Arguments arrive checked in type, not in value. Everything that is thrown is an `Error` with a `code`.

use super::objects::outcome_object;
use super::options;
pub use super::options::JsOptions;
#[cfg(feature = "js")]
use crate::Mesh;
#[cfg(feature = "js")]
use crate::engine;
#[cfg(feature = "js")]
pub use crate::engine::{GpuDevice, WebGl2Module};
#[cfg(feature = "js")]
use crate::session::{self, Job};
use crate::system::memory;
use crate::system::promise::promise;
use crate::system::threads::Threads;
#[cfg(all(feature = "js-threads", not(feature = "js")))]
use crate::wasm::threads::Indices;
pub use crate::wasm::values::JsPositions;
#[cfg(feature = "js")]
use crate::wasm::values::parse_dimension;
use crate::wasm::values::{coded, mesh_of, object, reasons_object, thrown};
use crate::{Error, Session};
#[cfg(feature = "js")]
use js_sys::Reflect;
use js_sys::{Array, Promise, Uint8Array, Uint32Array};
use std::cell::RefCell;
use std::rc::Rc;
use std::sync::Arc;
use wasm_bindgen::prelude::*;

/// An error with the mesh that was refused.
#[cfg(feature = "js")]
fn with_mesh(error: JsValue, mesh: &Mesh) -> JsValue {
    let arrays: Array = [
        mesh.positions().to_typed_array(),
        Uint32Array::from(mesh.triangles()).into(),
        (mesh.dimension().stride() as u32).into(),
    ]
    .iter()
    .collect();
    // Setting a field of an error does not fail.
    let _ = Reflect::set(&error, &"mesh".into(), &arrays);
    error
}

/// Vertex indices, as JavaScript gets them from an engine that has them in the memory of the module.
#[cfg(not(any(feature = "js-threads", feature = "js")))]
type Indices = Uint32Array;

/// Says where the WebGL2 engine comes from.
#[cfg(feature = "js")]
#[wasm_bindgen(js_name = setWebGl2)]
pub fn set_webgl2(module: WebGl2Module) {
    engine::set_webgl2(module);
}

/// Why `'auto'` takes the CPU on so many threads for a mesh, without asking for a GPU, if it does.
///
/// # Errors
/// [`Error::Option`] for the dimension, and for an option.
#[cfg(feature = "js")]
#[wasm_bindgen(js_name = whyCpu)]
pub fn why_cpu(
    triangles: usize,
    dimension: f64,
    is_double: bool,
    threads: usize,
    options: &JsOptions,
) -> Result<Option<String>, JsValue> {
    let job = parse_dimension(dimension).map(|dimension| Job { triangles, dimension, threads });
    let why = || Ok(session::why_cpu(job?, is_double, &options::without_lists(options)?));
    why().map_err(thrown)
}

/// Why a session answers nothing any more.
const ENDED: &str = "the session ended when a call of it crashed or ran out of memory; begin a new one";

/// A mesh on an engine. One call at a time: each must have answered before the next. A call has the session while it
/// goes on; one that ends with an exception or a trap never gives it back.
#[wasm_bindgen(js_name = Session)]
pub struct JsSession(Rc<RefCell<Option<Session>>>);

impl JsSession {
    /// Asks the session, and gives JavaScript what `give` makes of the answer.
    fn ask<T>(
        &self,
        question: impl AsyncFnOnce(&mut Session) -> Result<T, Error> + 'static,
        give: impl FnOnce(T) -> JsValue + 'static,
    ) -> Promise {
        let place = self.0.clone();
        promise(async move {
            let mut session = place.take().ok_or_else(|| coded("freed", ENDED))?;
            let answer = question(&mut session).await;
            place.replace(Some(session));
            answer.map(give).map_err(thrown)
        })
    }

    fn get<T: Default>(&self, value: impl FnOnce(&Session) -> T) -> T {
        self.0.borrow().as_ref().map(value).unwrap_or_default()
    }
}

#[wasm_bindgen(js_class = Session)]
impl JsSession {
    /// As [`Session::new`]. The arrays are copied before it returns.
    ///
    /// # Errors
    /// Those of [`Mesh::new`](crate::Mesh::new) and [`Session::new`]; `backend-unavailable`, with the reasons alone, where the options leave
    /// the CPU. Where another engine or another try may take it, a promise gives the mesh back with the error: `mesh`, the
    /// first arguments of another call.
    #[wasm_bindgen(unchecked_return_type = "Promise<Session>")]
    pub fn create(
        positions: JsPositions,
        indices: &Uint32Array,
        dimension: f64,
        options: JsOptions,
    ) -> Result<Promise, JsValue> {
        let open = || {
            let mesh = mesh_of(positions, indices, dimension, &Threads::default())?;
            Ok((mesh, options::read(&options)?))
        };
        let (mesh, chosen) = open().map_err(thrown)?;
        let mesh = Arc::new(mesh);
        #[cfg(feature = "js")]
        let leaves_cpu = chosen.leaves_cpu.is_some();
        Ok(promise(async move {
            match Session::new(mesh.clone(), chosen).await {
                Ok(session) => Ok(Self(Rc::new(RefCell::new(Some(session)))).into()),
                #[cfg(feature = "js")]
                Err(error @ (Error::Device { .. } | Error::OutOfMemory { .. })) => {
                    let refused = match error {
                        Error::Device { message } if leaves_cpu => coded("backend-unavailable", &message),
                        error => thrown(error),
                    };
                    Err(with_mesh(refused, &mesh))
                }
                Err(error) => Err(thrown(error)),
            }
        }))
    }

    /// As [`Session::step`].
    #[wasm_bindgen(unchecked_return_type = "Promise<import('../types.js').Iteration | undefined>")]
    pub fn step(&self) -> Promise {
        self.ask(Session::step, |step| {
            step.map_or(JsValue::UNDEFINED, |iteration| {
                object([
                    ("index", iteration.index.into()),
                    ("labelled", iteration.labelled.into()),
                    ("flips", iteration.flips.into()),
                    ("blocked", reasons_object(&iteration.blocked)),
                    ("ms", iteration.ms.into()),
                ])
            })
        })
    }

    /// As [`Session::advance`].
    #[wasm_bindgen(unchecked_return_type = "Promise<boolean>")]
    pub fn advance(&self) -> Promise {
        self.ask(Session::advance, JsValue::from)
    }

    /// As [`Session::set_positions`].
    #[wasm_bindgen(js_name = setPositions, unchecked_return_type = "Promise<void>")]
    pub fn set_positions(&self, positions: JsPositions) -> Promise {
        // Copied in the promise: an exception here would leave the session borrowed.
        let set = async |session: &mut Session| {
            memory::check(positions.byte_length() as u64)?;
            session.set_positions(positions).await
        };
        self.ask(set, |()| JsValue::UNDEFINED)
    }

    /// As [`Session::triangles`].
    #[wasm_bindgen(unchecked_return_type = "Promise<Uint32Array>")]
    pub fn triangles(&self) -> Promise {
        #[cfg(feature = "js")]
        return self.ask(Session::triangles_array, JsValue::from);
        #[cfg(not(feature = "js"))]
        self.ask(Session::triangles, |triangles| indices(triangles).into())
    }

    /// As [`Session::outcome`].
    #[wasm_bindgen(
        unchecked_return_type = "Promise<Omit<import('../types.js').Result, 'turnedTriangles' | 'joinedVertices' | 'seamEdges'>>"
    )]
    pub fn outcome(&self) -> Promise {
        #[cfg(feature = "js")]
        return self.ask(Session::outcome_array, |(outcome, array)| outcome_object(outcome, array.into()));
        #[cfg(not(feature = "js"))]
        self.ask(Session::outcome, |mut outcome| {
            let triangles = std::mem::take(&mut outcome.triangles);
            outcome_object(outcome, indices(triangles).into())
        })
    }

    /// As [`Session::edges`].
    #[wasm_bindgen(unchecked_return_type = "Promise<import('../types.js').Edges>")]
    pub fn edges(&self) -> Promise {
        self.ask(Session::edges, |edges| {
            let array = |words: &[u32]| Uint32Array::from(words).into();
            object([
                ("v1", array(&edges.v1)),
                ("v2", array(&edges.v2)),
                ("ta", array(&edges.ta)),
                ("tb", array(&edges.tb)),
            ])
        })
    }

    /// As [`Session::edge_states`]: the number of each state.
    #[wasm_bindgen(js_name = edgeStates, unchecked_return_type = "Promise<Uint8Array>")]
    pub fn edge_states(&self) -> Promise {
        self.ask(Session::edge_states, |states| {
            let numbers: Vec<u8> = states.into_iter().map(|state| state as u8).collect();
            Uint8Array::from(numbers.as_slice()).into()
        })
    }

    /// What [`Session::verify`] checks, as the arguments of `audit` in `src/wasm/audit.rs`.
    #[wasm_bindgen(js_name = auditInput, unchecked_return_type = "Promise<Parameters<typeof import('./edgeflip_audit.js').audit>>")]
    pub fn audit_input(&self) -> Promise {
        let input = async |session: &mut Session| {
            let triangles = session.triangles().await?;
            let (mesh, options) = session.input();
            let array = |words: &[u32]| JsValue::from(Uint32Array::from(words));
            Ok([
                mesh.positions().to_typed_array(),
                array(mesh.triangles()),
                (mesh.dimension().stride() as u32).into(),
                array(&triangles),
                array(options.locked_edges.as_flattened()),
                options.given.clone().into(),
            ])
        };
        self.ask(input, |arguments| arguments.iter().collect::<Array>().into())
    }

    /// Iterations so far.
    #[wasm_bindgen(getter)]
    pub fn iterations(&self) -> u32 {
        self.get(Session::iterations)
    }

    /// Flips so far.
    #[wasm_bindgen(getter)]
    pub fn flips(&self) -> f64 {
        self.get(|session| session.flips() as f64)
    }

    /// The engine that runs now.
    #[wasm_bindgen(getter, unchecked_return_type = "import('../types.js').Engine")]
    pub fn backend(&self) -> String {
        self.get(|session| session.backend().name().to_owned())
    }
}

/// What a session on a GPU has beside.
#[cfg(feature = "js")]
#[wasm_bindgen(js_class = Session)]
impl JsSession {
    /// The engine's GPUDevice, if it runs on one.
    #[wasm_bindgen(getter, unchecked_return_type = "GPUDevice | undefined")]
    pub fn device(&self) -> JsValue {
        self.shared_objects().map_or(JsValue::UNDEFINED, |objects| objects.device)
    }

    /// The GPUBuffer with the positions.
    #[wasm_bindgen(getter, js_name = positionBuffer, unchecked_return_type = "GPUBuffer | undefined")]
    pub fn position_buffer(&self) -> JsValue {
        self.shared_objects().map_or(JsValue::UNDEFINED, |objects| objects.positions)
    }

    /// The GPUBuffer with the triangles.
    #[wasm_bindgen(getter, js_name = indexBuffer, unchecked_return_type = "GPUBuffer | undefined")]
    pub fn index_buffer(&self) -> JsValue {
        self.shared_objects().map_or(JsValue::UNDEFINED, |objects| objects.triangles)
    }
}

#[cfg(feature = "js")]
impl JsSession {
    fn shared_objects(&self) -> Option<engine::SharedObjects> {
        self.get(Session::shared_objects)
    }
}

/// The triangles of a session, for JavaScript.
#[cfg(not(feature = "js"))]
fn indices(triangles: Vec<u32>) -> Indices {
    #[cfg(feature = "js-threads")]
    return Indices(triangles);
    #[cfg(not(feature = "js-threads"))]
    Uint32Array::from(triangles.as_slice())
}
