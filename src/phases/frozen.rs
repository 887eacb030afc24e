//! Frozen edges never flip: three or more triangles share the edge, one triangle has it twice, or its two triangles
//! have opposite orientations. Flips around them may change their opposite angles. Therefore the session counts after
//! the run which of them are not Delaunay.

use crate::mesh::Mesh;
use crate::mesh::adjacency::{EdgeKind, edge_kind};
use crate::mesh::buckets::for_each_edge;
use crate::mesh::half_edge::{next, prev};
use crate::predicates::{Quad, obtuse};
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
        let corners = half_edges.iter().enumerate();
        let obtuse = corners.filter_map(|(i, &h)| Some((obtuse(a, b, opposite(h))?, i)));
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

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "what fails here is a failed test")]

    use super::*;
    use crate::families;
    use crate::predicates::tiers::exact_decisions;

    /// The filters decide nearly all frozen edges, so that the count takes no longer than the run.
    #[test]
    fn few_frozen_edges_need_integers() {
        // Three sheets over each other: a random one, and a lattice, whose right angles are ties.
        for (name, most) in [("random 30", 30), ("grid 30", 3 * 3 * 29 * 29)] {
            let mesh = families::by_name(name).unwrap();
            let triangles = [mesh.triangles(); 3].concat();
            let mut counted = Reasons::default();
            let exact = exact_decisions(|| counted = count_non_delaunay(&mesh, &triangles));
            assert!(exact <= most, "{name}: {exact} decisions need integers");
            assert!(name.starts_with("grid") || counted[Reason::NonManifold] > 100);
        }
    }
}
