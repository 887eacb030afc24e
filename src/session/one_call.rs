//! A whole session in one call.

use super::{Session, ms_since};
use crate::{EngineKind, Error, Mesh, Options, Outcome, Timings};
use std::borrow::Cow;
use std::ops::ControlFlow;
use std::sync::Arc;
use web_time::Instant;

/// Makes `mesh` Delaunay by flipping edges. [`Session::new`] describes `mesh`, and [`Session::run`] describes `watch`.
///
/// # Errors
/// Those of [`Session::new`] and [`Session::run`].
pub fn make_delaunay(
    mesh: impl Into<Arc<Mesh>>,
    options: &Options,
    watch: impl FnMut(u32, u64) -> ControlFlow<()>,
) -> Result<Outcome, Error> {
    pollster::block_on(async {
        let mut session = Session::new(mesh, options.clone()).await?;
        session.run(watch).await?;
        session.into_outcome().await
    })
}

impl Session {
    /// As [`Session::outcome`], at the end of a session. The CPU engine need not copy its triangles then.
    async fn into_outcome(mut self) -> Result<Outcome, Error> {
        let counts = self.engine.edge_counts();
        if self.engine.backend() != EngineKind::Cpu || counts.non_manifold + counts.inconsistent > 0 {
            return self.outcome().await;
        }
        let outcome = self.summary(Instant::now(), &|| Cow::default()).await?;
        let start = Instant::now();
        let triangles = self.ask(|engine| engine.take_triangles()).await?;
        let timings = Timings { total: outcome.timings.total + ms_since(start), ..outcome.timings };
        Ok(Outcome { triangles, timings, ..outcome })
    }
}
