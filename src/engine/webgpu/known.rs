//! Results that the host reads before the session asks for them.

use super::words::Words;
use crate::engine::Census;

/// Results read in the submission of the last iteration.
#[derive(Default)]
pub(super) struct Known {
    pub(super) census: Option<Census>,
    /// Handed out once.
    pub(super) triangles: Option<Words>,
}
