//! What updates have made of a mesh.

use crate::mesh::embedded::Embedded;
use crate::mesh::winding::Winding;
use crate::phases::{Geometry, Thresholds};
use crate::{Mesh, Positions};

/// The state of a mesh that moves.
#[derive(Default)]
pub(super) struct Motion {
    /// The present positions, if they are not those of the mesh.
    pub(super) positions: Option<Positions>,
    /// Whether there may be numbers that are not finite.
    pub(super) has_infinite: bool,
    /// The first iteration of the next update.
    pub(super) next: u32,
    /// The number of updates.
    pub(super) updates: u32,
    /// The update in which each triangle last changed; empty if nobody asks for it.
    pub(super) changes: Vec<u32>,
    /// Flips of all updates.
    pub(super) flips: u64,
    /// Flips of the last update.
    pub(super) last_flips: usize,
}

impl Motion {
    pub(super) fn geometry<'a>(
        &'a self,
        mesh: &'a Mesh,
        winding: &'a Winding,
        embedded: &'a Embedded,
        thresholds: Thresholds,
    ) -> Geometry<'a> {
        let positions = self.positions.as_ref().unwrap_or(mesh.positions());
        let (dimension, has_infinite) = (mesh.dimension(), self.has_infinite);
        Geometry { dimension, positions, thresholds, winding, embedded, has_infinite }
    }
}
