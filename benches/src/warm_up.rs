//! Raises the clock rate of the GPU before a measured run: a GPU that mostly waits lowers the rate, and raises it
//! slowly.

use edgeflip::{Error, Mesh, families};
use std::{
    sync::Arc,
    time::{Duration, Instant},
};

/// The time for which a GPU has to be busy to reach its full clock rate.
const RISE: Duration = Duration::from_millis(500);
/// The time for which the rate stays while the GPU mostly waits.
const STAY: Duration = Duration::from_millis(200);

/// Keeps the GPU busy with work that needs hardly any time of the host.
pub struct WarmUp {
    mesh: Arc<Mesh>,
    ended: Option<Instant>,
}

impl WarmUp {
    /// Generates the mesh for the warm-up.
    pub fn new() -> Result<Self, Error> {
        // All iterations of this mesh take one or two dispatches.
        Ok(Self { mesh: Arc::new(families::by_name("strips 1000")?), ended: None })
    }

    /// Calls `run`, which runs a mesh on the GPU, until the clock rate is high. Does nothing if the rate is still high.
    pub fn before<T>(&mut self, run: impl Fn(&Arc<Mesh>) -> Result<T, Error>) -> Result<(), Error> {
        if self.ended.is_some_and(|ended| ended.elapsed() < STAY) {
            return Ok(());
        }
        let start = Instant::now();
        while start.elapsed() < RISE {
            run(&self.mesh)?;
        }
        self.ended = Some(Instant::now());
        Ok(())
    }
}
