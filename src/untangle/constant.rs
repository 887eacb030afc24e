//! What is the same before and after each repair of a mesh.

use crate::mesh::half_edge::{next, triangle_of};
use crate::mesh::star::{Fans, Star};
use crate::mesh::winding::Outline;
use crate::system::threads::Threads;
use crate::{Mesh, NONE};

/// What no move and no repair changes.
pub(crate) struct Constant {
    pub(super) outline: Outline,
    /// The number of triangles of each component.
    pub(super) sizes: Vec<u32>,
    /// Whether a vertex stays: it is on the boundary, or has several fans.
    is_pinned: Vec<bool>,
    /// The exceptions, sorted: vertices with several fans, each with a component in which it has only one, which is
    /// closed.
    free: Vec<[u32; 2]>,
    /// Whether there are vertices with several fans.
    pub(super) has_fans: bool,
}

impl Constant {
    pub(crate) fn new(mesh: &Mesh, twins: &[u32]) -> Self {
        let (vertices, triangles) = (mesh.vertex_count(), mesh.triangles());
        let outline = Outline::new(triangles, twins);
        let fans = Fans::of_vertices(|_| true, vertices, triangles, twins, &Threads::one());
        let has_several = |v: u32| fans.table.get(v as usize).is_some_and(|&list| list != NONE);
        let mut is_pinned: Vec<bool> = (0..vertices as u32).map(has_several).collect();
        let mut of_fans = Vec::new();
        for v in (0..vertices as u32).filter(|&v| has_several(v)) {
            let anchors = fans.table[fans.table[v as usize] as usize..].iter().take_while(|&&h| h != NONE);
            of_fans.extend(anchors.map(|&h| {
                let is_closed = Star::of_fan(twins, h).all(|corner| twins[corner as usize] != NONE);
                ([v, outline.components()[triangle_of(h) as usize]], is_closed)
            }));
        }
        of_fans.sort_unstable();
        let alone = of_fans.chunk_by(|one, other| one.0 == other.0);
        let free = alone.filter(|fans| fans.len() == 1 && fans[0].1).map(|fans| fans[0].0).collect();
        for (h, _) in (0..).zip(twins).filter(|(_, twin)| **twin == NONE) {
            for end in [h, next(h)] {
                is_pinned[triangles[end as usize] as usize] = true;
            }
        }
        let last = outline.components().iter().max();
        let mut sizes = vec![0; last.map_or(0, |&last| last as usize + 1)];
        outline.components().iter().for_each(|&component| sizes[component as usize] += 1);
        Self { outline, sizes, is_pinned, free, has_fans: !fans.table.is_empty() }
    }

    /// Whether a vertex stays in a component.
    pub(super) fn is_pinned(&self, v: u32, component: u32) -> bool {
        self.is_pinned[v as usize] && self.free.binary_search(&[v, component]).is_err()
    }
}
