//! A session, as JavaScript calls it. The TypeScript in `src/js/` has checked the types of all arguments, but not their
//! values. Every exception is an `Error` with a `code`.

use super::objects::outcome_object;
use super::options;
pub use super::options::JsOptions;
use crate::engine::Answer;
use crate::session;
pub use crate::session::UntangleModule;
use crate::system::memory;
use crate::system::promise::promise;
use crate::system::threads::Threads;
#[cfg(all(feature = "js-threads", not(feature = "js")))]
use crate::wasm::threads::Indices;
pub use crate::wasm::values::JsPositions;
use crate::wasm::values::{coded, mesh_of, object, reasons_object, thrown};
#[cfg(feature = "js")]
use crate::wasm::values::{dimension_of, left_to_cpu};
use crate::{Error, Mesh, Options, Session};
use js_sys::{Array, Promise, Uint8Array, Uint32Array};
use std::cell::RefCell;
use std::rc::Rc;
use std::sync::Arc;
use wasm_bindgen::prelude::*;

/// Vertex indices, as JavaScript gets them from an engine that has them in the memory of the module.
#[cfg(not(any(feature = "js-threads", feature = "js")))]
type Indices = Uint32Array;

/// The error of every call after the one that crashed.
const ENDED: &str = "the session ended when a call of it crashed or ran out of memory; begin a new one";

/// Sets the module of the repair.
#[wasm_bindgen(js_name = setUntangler)]
pub fn set_untangler(module: UntangleModule) {
    session::set_untangler(module);
}

/// A mesh on an engine. It takes one call at a time: each must have settled before the next begins. A call holds the
/// session while it runs, so a call that ends with an exception or a trap never returns it.
#[wasm_bindgen(js_name = Session)]
pub struct JsSession(Rc<RefCell<Option<Session>>>);

/// A question to a session, whose answer JavaScript gets.
type Question = Box<dyn for<'a> FnOnce(&'a mut Session) -> Answer<'a, JsValue>>;

impl JsSession {
    /// Asks the session, and returns a promise of what `give` makes of the answer.
    fn ask<T>(
        &self,
        question: impl AsyncFnOnce(&mut Session) -> Result<T, Error> + 'static,
        give: impl FnOnce(T) -> JsValue + 'static,
    ) -> Promise {
        self.promise(Box::new(|session: &mut Session| {
            Box::pin(async move { question(session).await.map(give) })
        }))
    }

    /// Boxed, so that this code is compiled only once.
    fn promise(&self, question: Question) -> Promise {
        let shared = self.0.clone();
        promise(async move {
            let mut session = shared.take().ok_or_else(|| coded("freed", ENDED))?;
            let answer = question(&mut session).await;
            shared.replace(Some(session));
            answer.map_err(thrown)
        })
    }

    /// Asks the session, which answers before this returns.
    fn at_once<T>(&self, question: impl FnOnce(&mut Session) -> T) -> Result<T, JsValue> {
        let mut session = self.0.take().ok_or_else(|| coded("freed", ENDED))?;
        let answer = question(&mut session);
        self.0.replace(Some(session));
        Ok(answer)
    }

    fn begin(mesh: Mesh, chosen: Options, settles: bool) -> Promise {
        let mesh = Arc::new(mesh);
        #[cfg(feature = "js")]
        let leaves_cpu = chosen.leaves_cpu;
        promise(async move {
            let opened = async {
                let mut session = Session::new(mesh.clone(), chosen).await?;
                if settles {
                    session.settle().await?;
                }
                Ok(session)
            };
            match opened.await {
                Ok(session) => Ok(Self(Rc::new(RefCell::new(Some(session)))).into()),
                #[cfg(feature = "js")]
                Err(Error::Device { message }) if leaves_cpu => Err(left_to_cpu(&message, &mesh)),
                Err(error) => Err(thrown(error)),
            }
        })
    }

    pub(super) fn get<T: Default>(&self, value: impl FnOnce(&Session) -> T) -> T {
        self.0.borrow().as_ref().map(value).unwrap_or_default()
    }
}

#[wasm_bindgen(js_class = Session)]
impl JsSession {
    /// As [`Session::new`]. Copies the arrays before it returns. `settles`: whether updates may follow at once.
    ///
    /// # Errors
    /// Those of [`Mesh::new`](crate::Mesh::new) and [`Session::new`]; `backend-unavailable` if the options exclude the
    /// CPU engine and no other engine is available. With `leavesCpu`, the latter has the mesh, as the first arguments of
    /// this function: `error.mesh`.
    #[wasm_bindgen(unchecked_return_type = "Promise<Session>")]
    pub fn create(
        positions: JsPositions,
        indices: &Uint32Array,
        dimension: u32,
        options: JsOptions,
        settles: bool,
    ) -> Result<Promise, JsValue> {
        let chosen = options::read(&options);
        #[cfg(feature = "js")]
        let sent = chosen
            .as_ref()
            .ok()
            .and_then(|options| crate::session::send(dimension_of(dimension), indices, &positions, options));
        let open = || {
            let mesh = mesh_of(positions, indices, dimension, &Threads::default())?;
            Ok((mesh, chosen?))
        };
        let begun = open().map_err(thrown).map(|(mesh, chosen)| Self::begin(mesh, chosen, settles));
        // What the session has not taken.
        #[cfg(feature = "js")]
        sent.iter().for_each(|device| device.forget_sent());
        begun
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

    /// As [`Session::update`]. Copies the array before it returns.
    ///
    /// # Errors
    /// Those of [`Session::update`].
    pub fn update(&self, positions: Option<JsPositions>, iterations: u32) -> Result<(), JsValue> {
        self.at_once(|session| {
            if let Some(positions) = &positions {
                memory::check(positions.byte_length() as u64)?;
            }
            session.update(positions.map(Into::into), iterations)
        })
        .and_then(|done| done.map_err(thrown))
    }

    /// As [`Session::counters`]. Asks the engine before it returns.
    #[wasm_bindgen(unchecked_return_type = "Promise<import('../types.js').Counters>")]
    pub fn counters(&self) -> Promise {
        let asked = self.at_once(Session::counters);
        promise(async move {
            let counters = asked?.await.map_err(thrown)?;
            Ok(object([
                ("updates", (counters.updates as f64).into()),
                ("flips", (counters.flips as f64).into()),
                ("remaining", reasons_object(&counters.remaining)),
                ("inverted", counters.inverted.into()),
                ("flat", counters.flat.into()),
                ("undecided", counters.undecided.into()),
                ("nonFinite", counters.non_finite.into()),
                ("tooWide", counters.too_wide.into()),
            ]))
        })
    }

    /// Whether updates may follow at once.
    #[wasm_bindgen(getter, js_name = isSettled)]
    pub fn is_settled(&self) -> bool {
        self.get(Session::is_settled)
    }

    /// As [`Session::settle`].
    #[wasm_bindgen(unchecked_return_type = "Promise<void>")]
    pub fn settle(&self) -> Promise {
        self.ask(Session::settle, |()| JsValue::UNDEFINED)
    }

    /// As [`Session::triangles`].
    #[wasm_bindgen(unchecked_return_type = "Promise<Uint32Array>")]
    pub fn triangles(&self) -> Promise {
        #[cfg(feature = "js")]
        return self.ask(Session::triangles_array, JsValue::from);
        #[cfg(not(feature = "js"))]
        self.ask(Session::triangles, |triangles| indices(triangles).into())
    }

    /// As [`Session::outcome`]. If the triangles stay on a GPU, the outcome may have none.
    #[wasm_bindgen(
        unchecked_return_type = "Promise<Omit<import('../types.js').Result<Uint32Array>, 'threads' | 'hint' | 'turnedTriangles' | 'joinedVertices' | 'seamEdges'>>"
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

    /// As [`Session::changes`].
    #[wasm_bindgen(unchecked_return_type = "Promise<Uint32Array>")]
    pub fn changes(&self) -> Promise {
        self.ask(Session::changes, |changes| Uint32Array::from(changes.as_slice()).into())
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

    /// The arguments of `audit` in `src/wasm/audit.rs`, which checks the same as [`Session::verify`], for a session
    /// without constraints.
    #[wasm_bindgen(js_name = auditInput, unchecked_return_type = "Promise<Parameters<typeof import('./edgeflip_audit.js').audit>>")]
    pub fn audit_input(&self) -> Promise {
        let input = async |session: &mut Session| {
            session.come_to_rest().await?;
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

    /// Whether the triangles stay on a GPU until somebody asks for them. It counts for the next calls.
    #[cfg(feature = "js")]
    #[wasm_bindgen(setter)]
    pub fn set_stays(&self, stays: bool) {
        if let Some(session) = self.0.borrow_mut().as_mut() {
            session.stays = stays;
        }
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

/// The triangles of a session, for JavaScript.
#[cfg(not(feature = "js"))]
fn indices(triangles: Vec<u32>) -> Indices {
    #[cfg(feature = "js-threads")]
    return Indices(triangles);
    #[cfg(not(feature = "js-threads"))]
    Uint32Array::from(triangles.as_slice())
}
