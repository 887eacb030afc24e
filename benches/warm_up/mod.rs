//! A GPU that mostly waits lowers its clock, and raises it slowly: before a run that counts, others keep it busy.

use edgeflip::{Error, Mesh, families};
use std::{
    sync::Arc,
    time::{Duration, Instant},
};

/// How long a GPU has to be busy before its clock is up.
const RISE: Duration = Duration::from_millis(500);
/// For how long it stays up while the GPU mostly waits.
const STAY: Duration = Duration::from_millis(200);

/// Brings the clock of the GPU up, with work that leaves hardly anything to the host.
pub struct WarmUp {
    mesh: Arc<Mesh>,
    ended: Option<Instant>,
}

impl WarmUp {
    /// Nothing runs yet.
    pub fn new() -> Result<Self, Error> {
        // All its iterations are one dispatch or two.
        Ok(Self { mesh: Arc::new(families::by_name("strips 1000")?), ended: None })
    }

    /// Calls `run`, which runs a mesh on the GPU, until the clock is up; not at all if it still is.
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
