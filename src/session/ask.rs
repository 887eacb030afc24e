//! Questions to the engine of a session.

use super::choice::cpu_after;
use super::{Session, memory_bounds};
use crate::engine::{Answer, Census, Engine};
use crate::{Backend, Error};

impl Session {
    /// Asks the engine. With `Auto`, asks the CPU again if the device fails or refuses the mesh.
    pub(super) async fn ask<T>(
        &mut self,
        question: impl for<'a> Fn(&'a mut dyn Engine) -> Answer<'a, T>,
    ) -> Result<T, Error> {
        loop {
            match question(self.engine.as_mut()).await {
                Err(error) if self.options.backend == Backend::Auto => self.recover(error).await?,
                answer => return answer,
            }
        }
    }

    /// Asks the engine for words, if `bytes` bytes per triangle are available. Boxed, so that this code is compiled only
    /// once.
    pub(super) fn words(
        &mut self,
        bytes: u64,
        question: for<'a> fn(&'a mut dyn Engine) -> Answer<'a, Vec<u32>>,
    ) -> Answer<'_, Vec<u32>> {
        Box::pin(async move {
            self.check_memory(bytes)?;
            self.ask(question).await
        })
    }

    /// The present triangles and twins. Boxed, too.
    pub(super) fn joined(&mut self) -> Answer<'_, (Vec<u32>, Vec<u32>)> {
        Box::pin(async {
            let twins = self.words(memory_bounds::EDGES, |engine| engine.twins()).await?;
            Ok((self.triangles().await?, twins))
        })
    }

    /// Counts the edges that are not Delaunay. Boxed, too.
    pub(super) fn census(&mut self) -> Answer<'_, Census> {
        Box::pin(self.ask(|engine| engine.census()))
    }

    /// Changes to the CPU after the device failed, or after the engine refused the mesh during the run. The CPU repeats
    /// the run up to the last complete iteration; all engines give the same triangles. Boxed, so that this code is
    /// compiled only once.
    fn recover(&mut self, error: Error) -> Answer<'_, ()> {
        Box::pin(async move {
            let why = match error {
                Error::Device { message } => format!("the device failed during the run: {message}"),
                Error::BackendLimit { .. } => error.to_string(),
                error => return Err(error),
            };
            let before = self.fallback.as_deref().map_or(String::new(), |before| format!("{before}; "));
            let choice = cpu_after(before + &why, &self.mesh, &self.options).await?;
            self.take(choice);
            // Updates are not repeated.
            self.updates = 0;
            self.engine.iterate(self.iterations()).await.map(drop)
        })
    }
}
