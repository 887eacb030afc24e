//! Errors of our own calls, caught by error scopes. A page may share the device and its handler of uncaptured errors,
//! so errors outside our scopes are not ours.

#[cfg(target_arch = "wasm32")]
use super::browser::{GpuDevice, HasMessage};
use crate::{EngineKind, Error};
use std::fmt;
use std::pin::Pin;

/// An error of the device about a call.
pub(super) enum Fault {
    /// There was no memory for a buffer.
    OutOfMemory,
    /// Any other error, with the message of the device.
    Other(String),
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::OutOfMemory => f.write_str("the device has no memory left"),
            Self::Other(message) => f.write_str(message),
        }
    }
}

/// The error for a device that does not exist or is refused.
pub(super) fn unavailable(message: String) -> Error {
    Error::BackendUnavailable { backend: EngineKind::Gpu, message }
}

/// The error for a mesh that the device cannot take.
pub(super) fn refuse<T>(message: String) -> Result<T, Error> {
    Err(Error::BackendLimit { backend: EngineKind::Gpu, message })
}

/// A future for the most telling fault that the error scopes of some calls caught.
pub(super) type Caught = Pin<Box<dyn Future<Output = Option<Fault>>>>;

/// Makes calls to the device within error scopes.
#[cfg(not(target_arch = "wasm32"))]
pub(super) fn watch<T>(device: &wgpu::Device, calls: impl FnOnce() -> T) -> (T, Caught) {
    use wgpu::ErrorFilter::{Internal, OutOfMemory, Validation};
    let [validation, internal, memory] =
        [Validation, Internal, OutOfMemory].map(|filter| device.push_error_scope(filter));
    let result = calls();
    let (memory, internal, validation) = (memory.pop(), internal.pop(), validation.pop());
    let caught = async move {
        // A failed allocation also causes validation errors, which say less.
        match (memory.await, internal.await.or(validation.await)) {
            (Some(_), _) => Some(Fault::OutOfMemory),
            (None, other) => other.map(|error| Fault::Other(error.to_string())),
        }
    };
    (result, Box::pin(caught))
}

/// The same in a browser. Not through wgpu, which panics on an internal error.
#[cfg(target_arch = "wasm32")]
pub(super) fn watch<T>(device: &wgpu::Device, calls: impl FnOnce() -> T) -> (T, Caught) {
    let Some(device) = GpuDevice::of(device) else { return (calls(), Box::pin(std::future::ready(None))) };
    device.push_error_scopes();
    (calls(), caught(&device))
}

#[cfg(target_arch = "wasm32")]
#[inline(never)]
fn caught(device: &GpuDevice) -> Caught {
    use wasm_bindgen::{JsCast, JsValue};
    let [memory, internal, validation] = device.pop_error_scopes();
    // A lost device may reject these promises. The loss callback reports the loss.
    let error_of = |error: Result<JsValue, JsValue>| error.ok().filter(JsValue::is_object);
    Box::pin(async move {
        match (error_of(memory.await), error_of(internal.await).or(error_of(validation.await))) {
            (Some(_), _) => Some(Fault::OutOfMemory),
            (None, other) => other.map(|error| Fault::Other(error.unchecked_into::<HasMessage>().message())),
        }
    })
}
