//! What a device has to say of our own calls, by error scopes. A page may share the device and its handler of
//! uncaptured errors, so an error outside of our scopes is none of ours.

#[cfg(target_arch = "wasm32")]
use super::browser::{GpuDevice, Told};
use crate::{EngineKind, Error};
use std::fmt;
use std::pin::Pin;

/// An error of the device about a call.
pub(super) enum Fault {
    /// There was no memory for a buffer.
    OutOfMemory,
    /// Anything else, in the words of the device.
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

/// There is no device, or none that is taken.
pub(super) fn unavailable(message: String) -> Error {
    Error::BackendUnavailable { backend: EngineKind::Gpu, message }
}

/// The device cannot take the mesh.
pub(super) fn refuse<T>(message: String) -> Result<T, Error> {
    Err(Error::BackendLimit { backend: EngineKind::Gpu, message })
}

/// The word of the device on calls, once it has given it: the fault that says most.
pub(super) type Word = Pin<Box<dyn Future<Output = Option<Fault>>>>;

/// Makes calls to the device, whose word on them is to be waited for.
#[cfg(not(target_arch = "wasm32"))]
pub(super) fn watch<T>(device: &wgpu::Device, calls: impl FnOnce() -> T) -> (T, Word) {
    use wgpu::ErrorFilter::{Internal, OutOfMemory, Validation};
    let [validation, internal, memory] =
        [Validation, Internal, OutOfMemory].map(|filter| device.push_error_scope(filter));
    let result = calls();
    let (memory, internal, validation) = (memory.pop(), internal.pop(), validation.pop());
    let word = async move {
        // What follows from a buffer that is not there is told as well, but says less.
        match (memory.await, internal.await.or(validation.await)) {
            (Some(_), _) => Some(Fault::OutOfMemory),
            (None, other) => other.map(|error| Fault::Other(error.to_string())),
        }
    };
    (result, Box::pin(word))
}

/// As natively. Not through wgpu, which panics on an internal error.
#[cfg(target_arch = "wasm32")]
pub(super) fn watch<T>(device: &wgpu::Device, calls: impl FnOnce() -> T) -> (T, Word) {
    let Some(device) = GpuDevice::of(device) else { return (calls(), Box::pin(std::future::ready(None))) };
    device.push_error_scopes();
    let result = calls();
    let told = device.pop_error_scopes();
    (result, Box::pin(word(told)))
}

#[cfg(target_arch = "wasm32")]
async fn word([memory, internal, validation]: [wasm_bindgen_futures::JsFuture; 3]) -> Option<Fault> {
    use wasm_bindgen::{JsCast, JsValue};
    // The promises of a lost device may be refused: its loss is told elsewhere.
    let told = |error: Result<JsValue, JsValue>| error.ok().filter(JsValue::is_object);
    match (told(memory.await), told(internal.await).or(told(validation.await))) {
        (Some(_), _) => Some(Fault::OutOfMemory),
        (None, other) => other.map(|error| Fault::Other(error.unchecked_into::<Told>().message())),
    }
}
