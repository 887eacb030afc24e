//! Repairs the triangles of a session again and again, and keeps its locked edges. In the npm package this is in another
//! module, which the modules of the engines call through `untangler_proxy.rs`.

use super::repaired::Repaired;
use crate::mesh::named_edges::ordered;
use crate::untangle::{Constant, Untangled, untangled};
use crate::{Error, Mesh};

/// Repairs a mesh in the plane whose boundary and components stay.
#[derive(Default)]
pub(crate) struct Untangler {
    /// Filled in when it is needed.
    constant: Option<Constant>,
    /// All locked edges, and how many of them are locks, not constraints. `None` as long as the mesh has had them all.
    all: Option<(Vec<[u32; 2]>, usize)>,
}

impl Untangler {
    /// Whether a mesh with these twins, and `lost` locked edges, may need other triangles. Then this is ready for them.
    pub(super) fn is_needed(&self, _mesh: &Mesh, _twins: &[u32], _lost: usize) -> Result<bool, Error> {
        Ok(true)
    }

    /// Other triangles for a mesh with these twins, which have the flags of locked edges; `None` if it keeps its own. Of
    /// the `locked_edges` that it has at present, the first `locks` are locks, the others edges of constraints. `lost` are
    /// those that it has lost, each with the smaller vertex first, sorted.
    pub(crate) fn repaired(
        &mut self,
        mesh: &Mesh,
        twins: &[u32],
        (locked_edges, locks): (&[[u32; 2]], usize),
        lost: &[[u32; 2]],
    ) -> Result<Option<Repaired>, Error> {
        let constant = self.constant.get_or_insert_with(|| Constant::new(mesh, twins));
        let Some(Untangled { slots, lost: missing }) = untangled(mesh, twins, constant, lost.to_vec()) else {
            return Ok(None);
        };
        let (all, count) = self.all.get_or_insert_with(|| {
            // Only locks can have been lost before.
            let (held, constraints) = locked_edges.split_at(locks);
            ([held, lost, constraints].concat(), held.len() + lost.len())
        });
        let is_kept = |edge: &&[u32; 2]| missing.binary_search(&ordered(**edge)).is_err();
        let locks = all[..*count].iter().filter(is_kept).count();
        let locked_edges = all.iter().filter(is_kept).copied().collect();
        Ok(Some(Repaired { slots, locked_edges, locks, lost: missing }))
    }
}
