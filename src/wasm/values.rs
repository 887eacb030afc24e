//! Conversions between Rust and JavaScript that the modules of the npm package share: meshes, plain objects and errors.
//! The names are those of the package, such as `indices` for the triangles.

#[cfg(any(feature = "js-files", feature = "js-points", feature = "js-point-session"))]
use crate::LeftOut;
#[cfg(any(feature = "js-session", feature = "js-audit"))]
use crate::Reasons;
#[cfg(feature = "js-meshes")]
use crate::{Dimension, Mesh, system::memory, system::threads::Threads};
use crate::{Error, Positions};
#[cfg(feature = "js-meshes")]
use js_sys::Uint32Array;
#[cfg(any(
    feature = "js-session",
    feature = "js-untangle",
    feature = "js-audit",
    feature = "js-files",
    feature = "js-points",
    feature = "js-point-session"
))]
use js_sys::{Array, Object};
use js_sys::{Float32Array, Float64Array};
use wasm_bindgen::prelude::*;

#[wasm_bindgen]
extern "C" {
    /// Positions in a typed array.
    #[wasm_bindgen(typescript_type = "Float32Array | Float64Array")]
    pub type JsPositions;

    #[wasm_bindgen(method, getter, js_name = byteLength)]
    pub(crate) fn byte_length(this: &JsPositions) -> f64;
}

impl From<JsPositions> for Positions {
    fn from(array: JsPositions) -> Self {
        match array.dyn_into::<Float32Array>() {
            Ok(array) => array.to_vec().into(),
            Err(array) => Float64Array::new(&array).to_vec().into(),
        }
    }
}

/// The mesh of arrays of JavaScript. Copies them after a check that there is enough memory.
///
/// # Errors
/// Those of [`Mesh::new`]; [`Error::OutOfMemory`].
#[cfg(feature = "js-meshes")]
pub(crate) fn mesh_of(
    positions: JsPositions,
    indices: &Uint32Array,
    dimension: u32,
    threads: &Threads,
) -> Result<Mesh, Error> {
    let bytes = positions.byte_length() + f64::from(indices.byte_length());
    memory::check(bytes as u64)?;
    Mesh::checked(dimension_of(dimension), positions, indices.to_vec(), threads)
}

/// Runs once, when a module is loaded.
#[wasm_bindgen(start)]
pub fn start() {
    #[cfg(debug_assertions)]
    console_error_panic_hook::set_once();
}

/// Throws if memory runs out. `tools/build.mjs` makes Rust call this function, because a trap would not name the
/// reason. `fromModule` in `src/js/error.ts` recognizes the message.
#[wasm_bindgen(js_name = outOfMemory)]
pub fn out_of_memory() {
    wasm_bindgen::throw_str("out of memory");
}

/// A plain object.
#[cfg(any(
    feature = "js-session",
    feature = "js-untangle",
    feature = "js-audit",
    feature = "js-files",
    feature = "js-points",
    feature = "js-point-session"
))]
pub(crate) fn object<'a>(fields: impl IntoIterator<Item = (&'a str, JsValue)>) -> JsValue {
    let entries: Array = fields.into_iter().map(|(name, value)| Array::of2(&name.into(), &value)).collect();
    // Fails only for values that are not a list of pairs.
    Object::from_entries(&entries).map_or_else(|error| error, JsValue::from)
}

/// The constraints that were left out.
#[cfg(any(feature = "js-files", feature = "js-points", feature = "js-point-session"))]
pub(crate) fn left_out_list(left_out: &[LeftOut]) -> JsValue {
    let fields = |LeftOut { index, reason }: &LeftOut| {
        object([("index", (*index as f64).into()), ("reason", reason.into())])
    };
    left_out.iter().map(fields).collect::<Array>().into()
}

/// The reasons with at least one edge.
#[cfg(any(feature = "js-session", feature = "js-audit"))]
pub(crate) fn reasons_object(reasons: &Reasons) -> JsValue {
    object(reasons.iter().map(|(reason, edges)| (reason.name(), (edges as f64).into())))
}

/// The dimension of a mesh with 2 or 3 numbers per vertex, as `checkDimension` in `src/js/mesh.ts` has made sure.
#[cfg(feature = "js-meshes")]
pub(crate) fn dimension_of(stride: u32) -> Dimension {
    if stride == 2 { Dimension::Two } else { Dimension::Three }
}

/// The exception for an error: an `Error` with a `code`.
pub(crate) fn thrown(error: Error) -> JsValue {
    let code = error.code();
    match error {
        Error::Option { option, message } => {
            coded(code, &format!("option {}: {message}", in_camel_case(option)))
        }
        #[cfg(feature = "js-session")]
        Error::Thrown { exception } => exception,
        error => coded(code, &in_words_of_javascript(error).to_string()),
    }
}

/// The exception for a mesh that the module leaves to the CPU engine of another: it has the arguments that made the
/// mesh.
#[cfg(feature = "js")]
pub(super) fn left_to_cpu(why: &str, mesh: &Mesh) -> JsValue {
    let error = coded("backend-unavailable", why);
    let arrays: Array = [
        mesh.positions().to_typed_array(),
        Uint32Array::from(mesh.triangles()).into(),
        (mesh.dimension().stride() as u32).into(),
    ]
    .iter()
    .collect();
    // Setting a field of an error does not fail.
    let _ = js_sys::Reflect::set(&error, &"mesh".into(), &arrays);
    error
}

/// `maxNormalAngle` for `max_normal_angle`.
fn in_camel_case(name: &str) -> String {
    let mut is_after_line = false;
    let of_char = |letter: char| match (letter, std::mem::replace(&mut is_after_line, letter == '_')) {
        ('_', _) => None,
        (letter, true) => Some(letter.to_ascii_uppercase()),
        (letter, false) => Some(letter),
    };
    name.chars().filter_map(of_char).collect()
}

/// An `Error` with a `code`.
pub(crate) fn coded(code: &str, message: &str) -> JsValue {
    let thrown = js_sys::Error::new(message);
    // Setting a field of a new object does not fail.
    let _ = js_sys::Reflect::set(thrown.unchecked_ref(), &"code".into(), &code.into());
    thrown.into()
}

fn in_words_of_javascript(error: Error) -> Error {
    match error {
        Error::RaggedArray { array: "triangles", length, stride } => {
            Error::RaggedArray { array: "indices", length, stride }
        }
        Error::FileTooLarge { limit, .. } => Error::FileTooLarge { limit, option: "maxBytes" },
        error => error,
    }
}
