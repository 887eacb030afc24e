//! Errors of the WebGL2 engine.

use crate::{EngineKind, Error};
use web_sys::WebGl2RenderingContext as Gl;

/// The error for a context that does not exist or is refused.
pub(super) fn unavailable(message: impl Into<String>) -> Error {
    Error::BackendUnavailable { backend: EngineKind::WebGl, message: message.into() }
}

/// The error for a mesh that the engine cannot take.
pub(super) fn refuse<T>(message: String) -> Result<T, Error> {
    Err(Error::BackendLimit { backend: EngineKind::WebGl, message })
}

/// The error of a call that returned no object.
pub(super) fn lost(gl: &Gl) -> Error {
    let message = if gl.is_context_lost() { "the WebGL2 context was lost" } else { "WebGL2 gave no object" };
    Error::Device { message: message.to_owned() }
}
