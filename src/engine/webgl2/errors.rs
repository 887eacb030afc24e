//! Errors of the WebGL2 engine.

use crate::{EngineKind, Error};
use web_sys::WebGl2RenderingContext as Gl;

/// There is no context, or none that is taken.
pub(super) fn unavailable(message: impl Into<String>) -> Error {
    Error::BackendUnavailable { backend: EngineKind::WebGl, message: message.into() }
}

/// The engine cannot take the mesh.
pub(super) fn refuse<T>(message: String) -> Result<T, Error> {
    Err(Error::BackendLimit { backend: EngineKind::WebGl, message })
}

/// What has happened where a call gives nothing.
pub(super) fn lost(gl: &Gl) -> Error {
    let message = if gl.is_context_lost() { "the WebGL2 context was lost" } else { "WebGL2 gave no object" };
    Error::Device { message: message.to_owned() }
}
