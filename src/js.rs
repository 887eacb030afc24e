//! What the npm package calls, and no one else: the hand-written TypeScript in `src/js/` is its public face.
//! Arguments arrive checked in type, not in value. Everything that is thrown is an `Error` with a `code`.

mod objects;

#[cfg(feature = "js")]
use crate::engine;
#[cfg(feature = "js")]
pub use crate::engine::{GpuDevice, WebGl2Module};
#[cfg(feature = "js-threads")]
use crate::js_threads::Indices;
pub use crate::js_values::JsPositions;
#[cfg(feature = "js")]
use crate::js_values::coded;
use crate::js_values::{backend_name, object, parse_dimension, positions_array, reasons_object, thrown};
use crate::threads::Threads;
use crate::{Backend, Error, Mesh, Options, Order, Positions, Session};
use js_sys::{Array, Uint8Array, Uint32Array};
use objects::outcome_object;
use std::num::NonZeroUsize;
use wasm_bindgen::prelude::*;

/// Vertex indices, as JavaScript gets them.
#[cfg(not(feature = "js-threads"))]
type Indices = Uint32Array;

#[wasm_bindgen]
extern "C" {
    /// The options of a run, as JavaScript has them.
    #[wasm_bindgen(typescript_type = "import('../types.js').Options")]
    pub type JsOptions;

    #[wasm_bindgen(method, getter)]
    fn backend(this: &JsOptions) -> JsValue;
    #[wasm_bindgen(method, getter, js_name = maxNormalAngle)]
    fn max_normal_angle(this: &JsOptions) -> JsValue;
    #[wasm_bindgen(method, getter, js_name = maxDeviation)]
    fn max_deviation(this: &JsOptions) -> JsValue;
    #[wasm_bindgen(method, getter, js_name = maxIterations)]
    fn max_iterations(this: &JsOptions) -> JsValue;
    #[wasm_bindgen(method, getter, js_name = lockedEdges)]
    fn locked_edges(this: &JsOptions) -> JsValue;
    #[wasm_bindgen(method, getter, js_name = lockedTriangles)]
    fn locked_triangles(this: &JsOptions) -> JsValue;
    #[wasm_bindgen(method, getter)]
    fn groups(this: &JsOptions) -> JsValue;
    #[wasm_bindgen(method, getter)]
    fn order(this: &JsOptions) -> JsValue;
    #[wasm_bindgen(method, getter)]
    fn threads(this: &JsOptions) -> JsValue;
    #[cfg(feature = "js")]
    #[wasm_bindgen(method, getter)]
    fn device(this: &JsOptions) -> JsValue;
    /// Not for users: to have no session at all where `'auto'` would take the CPU.
    #[cfg(feature = "js")]
    #[wasm_bindgen(method, getter, js_name = leavesCpu)]
    fn leaves_cpu(this: &JsOptions) -> Option<bool>;
}

/// Says where the WebGL2 engine comes from.
#[cfg(feature = "js")]
#[wasm_bindgen(js_name = setWebGl2)]
pub fn set_webgl2(module: WebGl2Module) {
    engine::set_webgl2(module);
}

/// A mesh on an engine. One call at a time: each must have answered before the next.
#[wasm_bindgen(js_name = Session)]
pub struct JsSession(Session);

impl JsSession {
    /// As [`Session::new`].
    pub(crate) async fn open(
        positions: impl Into<Positions>,
        indices: Vec<u32>,
        dimension: f64,
        options: &JsOptions,
    ) -> Result<JsSession, Error> {
        let mesh = Mesh::checked(parse_dimension(dimension)?, positions, indices, &Threads::default())?;
        Session::new(mesh, parse_options(options)?).await.map(Self)
    }
}

#[wasm_bindgen(js_class = Session)]
impl JsSession {
    /// As [`Session::step`].
    ///
    /// # Errors
    /// As there.
    #[wasm_bindgen(unchecked_return_type = "import('../types.js').Iteration | undefined")]
    pub async fn step(&mut self) -> Result<JsValue, JsValue> {
        let step = self.0.step().await.map_err(thrown)?;
        Ok(step.map_or(JsValue::UNDEFINED, |iteration| {
            object([
                ("index", iteration.index.into()),
                ("labelled", iteration.labelled.into()),
                ("flips", iteration.flips.into()),
                ("blocked", reasons_object(&iteration.blocked)),
                ("ms", iteration.ms.into()),
            ])
        }))
    }

    /// As [`Session::advance`].
    ///
    /// # Errors
    /// As there.
    pub async fn advance(&mut self) -> Result<bool, JsValue> {
        self.0.advance().await.map_err(thrown)
    }

    /// As [`Session::set_positions`].
    ///
    /// # Errors
    /// As there.
    #[wasm_bindgen(js_name = setPositions)]
    pub async fn set_positions(&mut self, positions: JsPositions) -> Result<(), JsValue> {
        self.0.set_positions(positions).await.map_err(thrown)
    }

    /// As [`Session::triangles`].
    ///
    /// # Errors
    /// As there.
    pub async fn triangles(&mut self) -> Result<Indices, JsValue> {
        Ok(indices(self.0.triangles().await.map_err(thrown)?))
    }

    /// As [`Session::outcome`].
    ///
    /// # Errors
    /// As there.
    #[wasm_bindgen(
        unchecked_return_type = "Omit<import('../types.js').Result, 'turnedTriangles' | 'joinedVertices' | 'seamEdges'>"
    )]
    pub async fn outcome(&mut self) -> Result<JsValue, JsValue> {
        Ok(outcome_object(self.0.outcome().await.map_err(thrown)?))
    }

    /// As [`Session::edges`].
    ///
    /// # Errors
    /// As there.
    #[wasm_bindgen(unchecked_return_type = "import('../types.js').Edges")]
    pub async fn edges(&mut self) -> Result<JsValue, JsValue> {
        let edges = self.0.edges().await.map_err(thrown)?;
        let array = |words: &[u32]| Uint32Array::from(words).into();
        Ok(object([
            ("v1", array(&edges.v1)),
            ("v2", array(&edges.v2)),
            ("ta", array(&edges.ta)),
            ("tb", array(&edges.tb)),
        ]))
    }

    /// As [`Session::edge_states`]: the number of each state.
    ///
    /// # Errors
    /// As there.
    #[wasm_bindgen(js_name = edgeStates)]
    pub async fn edge_states(&mut self) -> Result<Uint8Array, JsValue> {
        let states = self.0.edge_states().await.map_err(thrown)?;
        let numbers: Vec<u8> = states.into_iter().map(|state| state as u8).collect();
        Ok(Uint8Array::from(numbers.as_slice()))
    }

    /// What [`Session::verify`] checks, as the arguments of `js_audit::audit` in its module.
    ///
    /// # Errors
    /// As there.
    #[wasm_bindgen(js_name = auditInput, unchecked_return_type = "Parameters<typeof import('./edgeflip_audit.js').audit>")]
    pub async fn audit_input(&mut self) -> Result<JsValue, JsValue> {
        let triangles = self.0.triangles().await.map_err(thrown)?;
        let (mesh, options) = self.0.input();
        let array = |words: &[u32]| JsValue::from(Uint32Array::from(words));
        let arguments = [
            positions_array(mesh.positions()),
            array(mesh.triangles()),
            (mesh.dimension().stride() as u32).into(),
            array(&triangles),
            options.max_normal_angle.into(),
            options.max_deviation.into(),
            array(options.locked_edges.as_flattened()),
        ];
        Ok(arguments.iter().collect::<Array>().into())
    }

    /// Iterations so far.
    #[wasm_bindgen(getter)]
    pub fn iterations(&self) -> u32 {
        self.0.iterations()
    }

    /// Flips so far.
    #[wasm_bindgen(getter)]
    pub fn flips(&self) -> f64 {
        self.0.flips() as f64
    }

    /// The engine that runs now.
    #[wasm_bindgen(getter, unchecked_return_type = "import('../types.js').Engine")]
    pub fn backend(&self) -> String {
        backend_name(self.0.backend()).to_owned()
    }
}

/// What a session on a GPU has beside.
#[cfg(feature = "js")]
#[wasm_bindgen(js_class = Session)]
impl JsSession {
    /// As [`Session::new`].
    ///
    /// # Errors
    /// Those of [`Mesh::new`] and [`Session::new`]; `backend-unavailable`, with the reasons alone, where the CPU is left.
    pub async fn create(
        positions: JsPositions,
        indices: Vec<u32>,
        dimension: f64,
        options: JsOptions,
    ) -> Result<JsSession, JsValue> {
        Self::open(positions, indices, dimension, &options).await.map_err(|error| match error {
            Error::Device { message } if options.leaves_cpu() == Some(true) => {
                coded("backend-unavailable", &message)
            }
            error => thrown(error),
        })
    }

    /// The engine's GPUDevice, if it runs on one.
    #[wasm_bindgen(getter, unchecked_return_type = "GPUDevice | undefined")]
    pub fn device(&self) -> JsValue {
        self.0.shared_objects().map_or(JsValue::UNDEFINED, |objects| objects.device)
    }

    /// The GPUBuffer with the positions.
    #[wasm_bindgen(getter, js_name = positionBuffer, unchecked_return_type = "GPUBuffer | undefined")]
    pub fn position_buffer(&self) -> JsValue {
        self.0.shared_objects().map_or(JsValue::UNDEFINED, |objects| objects.positions)
    }

    /// The GPUBuffer with the triangles.
    #[wasm_bindgen(getter, js_name = indexBuffer, unchecked_return_type = "GPUBuffer | undefined")]
    pub fn index_buffer(&self) -> JsValue {
        self.0.shared_objects().map_or(JsValue::UNDEFINED, |objects| objects.triangles)
    }
}

/// The triangles of a session, for JavaScript.
fn indices(triangles: Vec<u32>) -> Indices {
    #[cfg(feature = "js-threads")]
    return Indices(triangles);
    #[cfg(not(feature = "js-threads"))]
    Uint32Array::from(triangles.as_slice())
}

/// Each is a worker.
const MOST_THREADS: u32 = 256;

/// What is `undefined` keeps its default.
fn parse_options(given: &JsOptions) -> Result<Options, Error> {
    let mut options = Options::default();
    let wrong = |option, value: &JsValue, known: &str| {
        Err(Error::Option { option, message: format!("{value:?} is not {known}") })
    };
    let backend = given.backend();
    if !backend.is_undefined() {
        options.backend = match backend.as_string().as_deref() {
            Some("auto") => Backend::Auto,
            Some("webgpu") => Backend::Gpu,
            Some("webgl2") => Backend::WebGl,
            Some("cpu") => Backend::Cpu,
            _ => return wrong("backend", &backend, "'auto', 'webgpu', 'webgl2' or 'cpu'"),
        };
    }
    let order = given.order();
    if !order.is_undefined() {
        options.order = match order.as_string().as_deref() {
            Some("reproducible") => Order::Reproducible,
            Some("any") => Order::Any,
            _ => return wrong("order", &order, "'reproducible' or 'any'"),
        };
    }
    let threads = given.threads();
    if !threads.is_undefined() {
        let count = whole(&threads).filter(|&count| count <= MOST_THREADS);
        options.threads = count.and_then(|count| NonZeroUsize::new(count as usize));
        if options.threads.is_none() {
            return wrong("threads", &threads, "a number of threads, 1 to 256");
        }
    }
    #[cfg(feature = "js")]
    {
        options.leaves_cpu = given.leaves_cpu().unwrap_or(false);
        let device = given.device();
        if !device.is_undefined() {
            match device.dyn_into() {
                Ok(device) => options.device = Some(device),
                Err(other) => return wrong("device", &other, "a GPUDevice of this window or worker"),
            }
        }
    }
    let angle = given.max_normal_angle();
    if !angle.is_undefined() {
        let Some(degrees) = angle.as_f64() else { return wrong("maxNormalAngle", &angle, "a number") };
        options.max_normal_angle = degrees;
    }
    let deviation = given.max_deviation();
    if !deviation.is_undefined() {
        let Some(most) = deviation.as_f64() else { return wrong("maxDeviation", &deviation, "a number") };
        options.max_deviation = most;
    }
    let numbers = parse_numbers("lockedEdges", &given.locked_edges(), "vertex indices")?;
    options.locked_edges = match numbers.as_chunks() {
        (pairs, []) => pairs.to_vec(),
        _ => return Err(Error::RaggedArray { array: "lockedEdges", length: numbers.len(), stride: 2 }),
    };
    options.locked_triangles =
        parse_numbers("lockedTriangles", &given.locked_triangles(), "numbers of triangles")?;
    options.groups = parse_numbers("groups", &given.groups(), "whole numbers")?;
    let cap = given.max_iterations();
    if !cap.is_undefined() {
        match (cap.as_f64(), whole(&cap)) {
            (Some(f64::INFINITY), _) => {}
            (_, None) => return wrong("maxIterations", &cap, "a number of iterations"),
            (_, number) => options.max_iterations = number,
        }
    }
    Ok(options)
}

/// The numbers of an option; none where it is `undefined`.
fn parse_numbers(option: &'static str, given: &JsValue, what: &str) -> Result<Vec<u32>, Error> {
    if given.is_undefined() {
        return Ok(Vec::new());
    }
    let numbers = match given.dyn_ref::<Uint32Array>() {
        Some(array) => Some(array.to_vec()),
        None => {
            given.dyn_ref::<Array>().and_then(|array| array.iter().map(|number| whole(&number)).collect())
        }
    };
    let message = || format!("it is neither a Uint32Array nor an array of {what}");
    numbers.ok_or_else(|| Error::Option { option, message: message() })
}

/// A whole number of 32 bits.
fn whole(value: &JsValue) -> Option<u32> {
    let number = value.as_f64()?;
    (number.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(&number)).then_some(number as u32)
}
