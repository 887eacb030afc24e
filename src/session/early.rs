//! Opens a GPU while the program reads a mesh, and closes it while the program writes the result.

use super::choice::{asks_gpu, job_of};
use super::cost::Job;
#[cfg(feature = "gpu")]
use crate::engine::Device;
use crate::system::threads::Threads;
use crate::{Backend, Dimension, Error, Mesh, Options};
use std::thread::{self, JoinHandle};

/// A GPU that a background thread opens for later sessions. Waiting for it is optional. A process that ends while the
/// thread opens the GPU has to skip its exit handlers: drivers do not expect them at that moment.
pub struct EarlyGpu(Option<JoinHandle<Result<(), Error>>>);

impl EarlyGpu {
    /// Starts the thread, if a session with these options would try the GPU for a mesh of `triangles` triangles.
    pub fn open(options: &Options, triangles: usize) -> Self {
        let takes_software = options.backend == Backend::Gpu;
        let open = move || opened(takes_software);
        let threads = Threads::count_for(options.threads, triangles);
        // The dimension is not known yet: in space the CPU takes longer.
        let job = Job { triangles, dimension: Dimension::Three, threads };
        // If no thread starts, the session opens the GPU.
        Self(asks_gpu(options, job).then(|| thread::Builder::new().spawn(open).ok()).flatten())
    }

    /// Waits for the GPU, if a session with these options would try it for this mesh.
    ///
    /// # Errors
    /// The session would return the same: [`Error::BackendUnavailable`] and [`Error::Device`].
    pub fn wait(self, mesh: &Mesh, options: &Options) -> Result<(), Error> {
        let thread = self.0.filter(|_| asks_gpu(options, job_of(mesh, options)));
        // After a panic in the thread, the session opens the GPU itself and meets the same panic.
        thread.map_or(Ok(()), |thread| thread.join().unwrap_or(Ok(())))
    }
}

/// Closes the shared GPU on a background thread, once no session holds it, and lets go of devices that the program has
/// given. A later session opens it again. Without this call the process closes the GPU when it ends, and ends later. It
/// also keeps up to 1 GiB of the memory of earlier sessions on the GPU, for later ones with a mesh of the same size.
pub fn close_gpu() {
    #[cfg(feature = "gpu")]
    {
        let devices = Device::taken();
        // If no thread starts, this thread closes them.
        let _ = thread::Builder::new().spawn(move || drop(devices));
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
