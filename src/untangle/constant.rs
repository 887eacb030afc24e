//! What is the same before and after each repair of a mesh.

use crate::mesh::half_edge::next;
use crate::mesh::star::Fans;
use crate::mesh::winding::Outline;
use crate::system::threads::Threads;
use crate::{Mesh, NONE};

/// What no move and no repair changes.
#[derive(Clone)]
pub(crate) struct Constant {
    pub(super) outline: Outline,
    /// Whether a vertex stays: it is on the boundary, or has several fans.
    pub(super) is_pinned: Vec<bool>,
    /// Whether there are vertices with several fans.
    pub(super) has_fans: bool,
}

impl Constant {
    pub(crate) fn new(mesh: &Mesh, twins: &[u32]) -> Self {
        let (vertices, triangles) = (mesh.vertex_count(), mesh.triangles());
        let fans = Fans::of_vertices(|_| true, vertices, triangles, twins, &Threads::one());
        let mut is_pinned: Vec<bool> =
            (0..vertices).map(|v| fans.table.get(v).is_some_and(|&list| list != NONE)).collect();
        for (h, _) in (0..).zip(twins).filter(|(_, twin)| **twin == NONE) {
            for end in [h, next(h)] {
                is_pinned[triangles[end as usize] as usize] = true;
            }
        }
        Self { outline: Outline::new(triangles, twins), is_pinned, has_fans: !fans.table.is_empty() }
    }
}
