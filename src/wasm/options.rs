//! Converts the options of a run from JavaScript to Rust. JavaScript passes them to each module as one object, and each
//! module reads it here.

#[cfg(feature = "js")]
use crate::engine::GpuDevice;
use crate::system::threads::checked;
use crate::{Backend, Error, Options, Order};
#[cfg(feature = "js-session")]
use js_sys::{Object, Uint32Array};
use wasm_bindgen::prelude::*;

#[wasm_bindgen]
extern "C" {
    /// The options that `settingsOf` in `src/js/settings.ts` returns. It has checked their types, but not their values.
    #[wasm_bindgen(typescript_type = "import('../settings.js').Settings")]
    #[derive(Clone)]
    pub type JsOptions;

    #[wasm_bindgen(method, structural, indexing_getter)]
    fn get(this: &JsOptions, name: &str) -> JsValue;
    #[cfg(feature = "js-session")]
    #[wasm_bindgen(method, structural, indexing_deleter)]
    fn delete(this: &JsOptions, name: &str);
}

/// All options. An absent one keeps its default.
///
/// # Errors
/// [`Error::RaggedArray`]; [`Error::Option`] for a value that its Rust type cannot hold.
#[cfg(feature = "js-session")]
pub(crate) fn read(given: &JsOptions) -> Result<Options, Error> {
    // The session keeps the copy, without its lists.
    let kept: JsOptions = Object::assign(&Object::new(), given.unchecked_ref()).unchecked_into();
    let list = |name| {
        let list = kept.get(name);
        kept.delete(name);
        if list.is_undefined() { Vec::new() } else { list.unchecked_into::<Uint32Array>().to_vec() }
    };
    let ends = list("lockedEdges");
    #[cfg(feature = "js")]
    let spare = kept.get("spare");
    #[cfg(feature = "js")]
    kept.delete("spare");
    let (locked_edges, []) = ends.as_chunks() else {
        return Err(Error::RaggedArray { array: "lockedEdges", length: ends.len(), stride: 2 });
    };
    Ok(Options {
        lost_edges: list("lostEdges").as_chunks().0.to_vec(),
        locked_edges: locked_edges.to_vec(),
        locked_triangles: list("lockedTriangles"),
        groups: list("groups"),
        #[cfg(feature = "js")]
        spare: Some(spare).filter(JsValue::is_truthy).map(JsCast::unchecked_into),
        ..without_lists(&kept)?
    })
}

/// The options except the lists, because reading a list copies it.
///
/// # Errors
/// [`Error::Option`] for a value that its Rust type cannot hold.
pub(crate) fn without_lists(given: &JsOptions) -> Result<Options, Error> {
    let number = |name| given.get(name).as_f64();
    let text = |name| given.get(name).as_string();
    let default = Options::default();
    Ok(Options {
        backend: match text("backend").as_deref() {
            Some("webgpu") => Backend::Gpu,
            Some("webgl2") => Backend::WebGl,
            Some("cpu") => Backend::Cpu,
            _ => Backend::Auto,
        },
        max_normal_angle: number("maxNormalAngle").unwrap_or(default.max_normal_angle),
        max_deviation: number("maxDeviation").unwrap_or(default.max_deviation),
        max_iterations: number("maxIterations").map(|count| count as u32),
        order: if text("order").as_deref() == Some("any") { Order::Any } else { Order::Reproducible },
        track_changes: given.get("trackChanges").is_truthy(),
        adjacency: given.get("adjacency").is_truthy(),
        untangle: given.get("untangle").as_bool(),
        threads: number("threads").map(|count| checked(count as usize)).transpose()?,
        #[cfg(feature = "js")]
        device: Some(given.get("device")).filter(JsValue::is_truthy).map(JsCast::unchecked_into::<GpuDevice>),
        #[cfg(feature = "js")]
        leaves_cpu: given.get("leavesCpu").is_truthy(),
        #[cfg(feature = "js-session")]
        given: given.clone().unchecked_into(),
        ..default
    })
}
