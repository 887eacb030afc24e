//! A GPU that is opened while a mesh is read, and closed while the result is written.

use super::choice::{asks_gpu, job_of};
use super::cost::Job;
#[cfg(feature = "gpu")]
use crate::engine::Device;
use crate::system::threads::Threads;
use crate::{Backend, Dimension, Error, Mesh, Options};
use std::thread::{self, JoinHandle};

/// A GPU that a thread of its own opens for the sessions to come. Nobody has to wait for it; but whoever ends the process
/// while it is being opened leaves out what the system does at an end: drivers do not expect it.
pub struct EarlyGpu(Option<JoinHandle<Result<(), Error>>>);

impl EarlyGpu {
    /// Begins, if a session with these options asks for the GPU where a mesh has so many triangles.
    pub fn open(options: &Options, triangles: usize) -> Self {
        let takes_software = options.backend == Backend::Gpu;
        let open = move || opened(takes_software);
        let threads = Threads::count_for(options.threads, triangles);
        // In space the CPU takes longer.
        let job = Job { triangles, dimension: Dimension::Three, threads };
        // Where no thread can be had, the session opens it.
        Self(asks_gpu(options, job).then(|| thread::Builder::new().spawn(open).ok()).flatten())
    }

    /// Waits for it, if a session with these options asks for it with this mesh.
    ///
    /// # Errors
    /// Those that the session would have: [`Error::BackendUnavailable`] and [`Error::Device`].
    pub fn wait(self, mesh: &Mesh, options: &Options) -> Result<(), Error> {
        let thread = self.0.filter(|_| asks_gpu(options, job_of(mesh, options)));
        // A session says itself what it panics at.
        thread.map_or(Ok(()), |thread| thread.join().unwrap_or(Ok(())))
    }
}

/// Closes the GPU, which no session has any more, on a thread of its own; another session opens it again. The end of a
/// process does so too, but takes its time.
pub fn close_gpu() {
    #[cfg(feature = "gpu")]
    if let Some(device) = Device::taken() {
        // Where no thread can be had, it is closed here.
        let _ = thread::Builder::new().spawn(move || drop(device));
    }
}

#[cfg(feature = "gpu")]
fn opened(takes_software: bool) -> Result<(), Error> {
    pollster::block_on(Device::shared(takes_software, None)).map(drop)
}

#[cfg(not(feature = "gpu"))]
fn opened(_: bool) -> Result<(), Error> {
    Ok(())
}
