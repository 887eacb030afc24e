//! Frozen edges: those that can never flip because not exactly two triangles lie on two sides of them.
//! They are counted when a run has ended, since what lies opposite to them may have changed.

use crate::mesh::Mesh;
use crate::mesh::adjacency::{EdgeKind, edge_kind};
use crate::mesh::buckets::for_each_edge;
use crate::mesh::half_edge::{next, prev};
use crate::predicates::{Quad, corner};
use crate::{Reason, Reasons};

/// Counts the frozen edges of `triangles` at which two of the opposite angles sum to more than π.
/// Angles have no sign here: the triangles at such an edge agree on no side.
pub(crate) fn count_non_delaunay(mesh: &Mesh, triangles: &[u32]) -> Reasons {
    let mut reasons = Reasons::default();
    for_each_edge(mesh.vertex_count(), triangles, |half_edges| {
        let reason = match edge_kind(half_edges, triangles) {
            EdgeKind::NonManifold => Reason::NonManifold,
            EdgeKind::Inconsistent => Reason::Inconsistent,
            EdgeKind::Interior | EdgeKind::Boundary => return,
        };
        let [a, b] = [half_edges[0], next(half_edges[0])].map(|h| mesh.point3(triangles[h as usize]));
        let opposite = |h: u32| mesh.point3(triangles[prev(h) as usize]);
        // A sum over π needs an obtuse angle. One of a proper triangle decides against all others at once:
        // a second obtuse one makes a sum over π with it. Without such, one of a flat triangle, which is π,
        // decides, because all of those are alike.
        let obtuse = half_edges.iter().enumerate().filter_map(|(i, &h)| {
            let (is_obtuse, is_flat) = corner(a, b, opposite(h));
            is_obtuse.then_some((is_flat, i))
        });
        if let Some((_, i)) = obtuse.min() {
            let c = opposite(half_edges[i]);
            let others = half_edges.iter().enumerate().filter(|&(j, _)| j != i);
            let mut quads = others.map(|(_, &h)| Quad::new(a, b, c, opposite(h)));
            if quads.any(|quad| quad.is_non_delaunay()) {
                reasons[reason] += 1;
            }
        }
    });
    reasons
}
