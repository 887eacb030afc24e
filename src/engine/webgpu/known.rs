//! What the host has read before it was asked.

#[cfg(not(target_arch = "wasm32"))]
use super::copies::Words;
#[cfg(target_arch = "wasm32")]
use super::mapped::Words;
use crate::engine::Census;

/// What was read behind the last iteration, before anybody has asked.
#[derive(Default)]
pub(super) struct Known {
    pub(super) census: Option<Census>,
    /// Gone once they were asked for.
    pub(super) triangles: Option<Words>,
}
