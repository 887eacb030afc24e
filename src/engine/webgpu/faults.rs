//! What a device has to say of our own calls, by error scopes. A page may share the device and its handler of
//! uncaptured errors, so an error outside of our scopes is none of ours.

use crate::Error;
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
    Error::BackendUnavailable { backend: "gpu", message }
}

/// The device cannot take the mesh.
pub(super) fn refuse<T>(message: String) -> Result<T, Error> {
    Err(Error::BackendLimit { backend: "gpu", message })
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

#[cfg(target_arch = "wasm32")]
pub(super) use super::browser::watch;
