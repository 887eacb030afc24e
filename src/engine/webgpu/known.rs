//! Results that the host has read before the session asks for them.

use super::copies::PendingRead;
use super::words::Words;
use crate::engine::Census;
use crate::mesh::areas::Areas;

/// Results of the present state: read in the submission of the last iteration, or after it.
#[derive(Default)]
pub(super) struct Known {
    pub(super) counts: Option<(Census, Areas)>,
    /// Counts that the device makes behind the last iteration.
    pub(super) counting: Option<PendingRead>,
    /// Handed out once.
    pub(super) triangles: Option<Words>,
}
