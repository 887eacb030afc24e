//! Frozen edges never flip: three or more triangles share the edge, one triangle has it twice, or its two triangles
//! have opposite orientations. Flips around them may change their opposite angles. Therefore the session counts after
//! the run which of them are not Delaunay.

use crate::mesh::Mesh;
use crate::mesh::adjacency::{EdgeKind, edge_kind};
use crate::mesh::buckets::for_each_edge;
use crate::mesh::half_edge::{next, prev};
use crate::predicates::{Quad, corner};
use crate::{Reason, Reasons};

/// Counts the frozen edges of `triangles` with two opposite angles that sum to more than π. Angles are unsigned here,
/// because the triangles of a frozen edge do not lie on two sides of it.
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
        // A sum over π needs an obtuse angle. It suffices to compare one obtuse angle with all other angles, because
        // two obtuse angles of proper triangles always sum to more than π. If only flat triangles have obtuse angles,
        // all of these angles are π, and any of them decides.
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
