//! A build without the GPU engine (feature `gpu`).

use super::cost::Job;
use crate::engine::Engine;
use crate::phases::Thresholds;
use crate::{EngineKind, Error, Mesh, Options};
use std::sync::Arc;

/// Says yes, so that the session opens the engine and gets its error.
pub(super) fn is_ready(_: Job, _: bool, _: &Options) -> bool {
    true
}

pub(super) fn why_not_ready(_: Job, _: bool, _: &Options) -> String {
    String::new()
}

pub(super) async fn engine(_: &Arc<Mesh>, _: &Options, _: Thresholds) -> Result<Box<dyn Engine>, Error> {
    let message = "this build has no GPU engine (feature `gpu`)".to_owned();
    Err(Error::BackendUnavailable { backend: EngineKind::Gpu, message })
}
