//! Twins from triangles: the half-edge on the other side of each half-edge.

use super::buckets::{Buckets, Rising, visit_edges};
use super::half_edge::next;
use crate::system::threads::{Threads, Word, shared};
use crate::{Mesh, NONE};
use std::sync::atomic::AtomicU32;

/// The twins of the half-edges of a mesh, and the number of edges of each kind.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Adjacency {
    /// For each half-edge, the half-edge on the other side; [`NONE`] on the boundary and on frozen edges.
    pub twins: Vec<u32>,
    /// All edges: pairs of vertices joined by a half-edge.
    pub edges: u32,
    /// Edges with one half-edge.
    pub boundary: u32,
    /// Frozen edges with three or more half-edges, or two in one triangle.
    pub non_manifold: u32,
    /// Frozen edges with two half-edges in the same direction.
    pub inconsistent: u32,
}

/// The kind of an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum EdgeKind {
    Interior,
    Boundary,
    NonManifold,
    Inconsistent,
}

/// The kind of an edge, from all half-edges between its two vertices.
pub(crate) fn edge_kind(half_edges: &[u32], triangles: &[u32]) -> EdgeKind {
    match *half_edges {
        [_] => EdgeKind::Boundary,
        [h, g] if h / 3 != g / 3 => {
            if triangles[h as usize] == triangles[g as usize] {
                EdgeKind::Inconsistent
            } else {
                EdgeKind::Interior
            }
        }
        _ => EdgeKind::NonManifold,
    }
}

/// The twin of a half-edge of an edge of this kind.
pub(super) fn twin_of(h: u32, edge: &[u32], kind: EdgeKind) -> u32 {
    if kind == EdgeKind::Interior { edge[0] ^ edge[edge.len() - 1] ^ h } else { NONE }
}

impl Adjacency {
    /// Matches the half-edges of a mesh.
    pub fn new(mesh: &Mesh) -> Self {
        Self::of_triangles(mesh.vertex_count(), mesh.triangles(), &Threads::default())
    }

    /// Matches the half-edges of `triangles`, whose indices must be below `vertices`.
    pub(crate) fn of_triangles(vertices: usize, triangles: &[u32], threads: &Threads) -> Self {
        let mut buckets = Buckets::new(vertices, triangles, threads, false);
        buckets.sort_large(threads);
        let Buckets { ends, highs, mut half_edges } = buckets;
        let rising = Rising { ends: &ends, highs: &highs, half_edges: shared(&mut half_edges) };
        let mut twins = threads.zeros(triangles.len());
        let words = shared(&mut twins);
        let mut unmatched = rising.match_all(triangles, words, threads);
        unmatched.sort_unstable();
        let mut adjacency = Self { edges: rising.count() as u32, ..Self::default() };
        adjacency.match_with_care(triangles, words, &rising, &unmatched);
        Self { twins, ..adjacency }
    }

    /// Counts the edges in the buckets of the unmatched half-edges again, edge by edge, and writes their twins. In the
    /// other buckets, the number of rising half-edges is the number of edges.
    fn match_with_care(
        &mut self,
        triangles: &[u32],
        twins: &[AtomicU32],
        rising: &Rising,
        unmatched: &[(u32, u32)],
    ) {
        let (mut bucket, mut scratch) = (Vec::new(), Vec::new());
        for unmatched in unmatched.chunk_by(|x, y| x.0 == y.0) {
            bucket.clear();
            for (high, h, is_taken) in rising.of(unmatched[0].0) {
                self.edges -= 1;
                bucket.push((high, h));
                if is_taken {
                    bucket.push((high, twins[h as usize].get()));
                }
            }
            // The rising ones among the unmatched half-edges are in the bucket already.
            for &(low, h) in unmatched {
                let from = triangles[h as usize];
                if from > low || triangles[next(h) as usize] == low {
                    bucket.push((from, h));
                }
            }
            visit_edges(&mut bucket, &mut scratch, |edge| {
                let kind = self.count(edge, triangles);
                for &h in edge {
                    twins[h as usize].set(twin_of(h, edge, kind));
                }
            });
        }
    }

    /// Counts an edge, from all its half-edges. Returns its kind.
    pub(super) fn count(&mut self, half_edges: &[u32], triangles: &[u32]) -> EdgeKind {
        self.edges += 1;
        let kind = edge_kind(half_edges, triangles);
        match kind {
            EdgeKind::Interior => {}
            EdgeKind::Boundary => self.boundary += 1,
            EdgeKind::NonManifold => self.non_manifold += 1,
            EdgeKind::Inconsistent => self.inconsistent += 1,
        }
        kind
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::buckets::for_each_edge;
    use proptest::collection::vec;
    use proptest::prelude::*;
    use std::collections::BTreeMap;
    use std::num::NonZeroUsize;

    /// The vertices of an edge, the smaller one first.
    fn edge_vertices(triangles: &[u32], h: u32) -> [u32; 2] {
        let [from, to] = [h, next(h)].map(|x| triangles[x as usize]);
        [from.min(to), from.max(to)]
    }

    /// The adjacency, from a map of edges.
    fn expected(triangles: &[u32]) -> Adjacency {
        let mut edges = BTreeMap::<_, Vec<u32>>::new();
        for h in 0..triangles.len() as u32 {
            edges.entry(edge_vertices(triangles, h)).or_default().push(h);
        }
        let mut expected = Adjacency { twins: vec![NONE; triangles.len()], ..Adjacency::default() };
        for edge in edges.values() {
            expected.edges += 1;
            match edge_kind(edge, triangles) {
                EdgeKind::Interior => {
                    expected.twins[edge[0] as usize] = edge[1];
                    expected.twins[edge[1] as usize] = edge[0];
                }
                EdgeKind::Boundary => expected.boundary += 1,
                EdgeKind::NonManifold => expected.non_manifold += 1,
                EdgeKind::Inconsistent => expected.inconsistent += 1,
            }
        }
        expected
    }

    fn compare(vertices: usize, triangles: &[u32]) {
        let expected = expected(triangles);
        for threads in 1..=3 {
            let threads = Threads::new(NonZeroUsize::new(threads), usize::MAX).unwrap();
            assert_eq!(Adjacency::of_triangles(vertices, triangles, &threads), expected);
        }
        let mut number = 0;
        for_each_edge(vertices, triangles, |edge| {
            number += 1;
            assert!(
                edge.is_sorted()
                    && edge.iter().all(|&h| edge_vertices(triangles, h) == edge_vertices(triangles, edge[0]))
            );
        });
        assert_eq!(number, expected.edges);
    }

    proptest! {
        /// Few vertices make nearly all edges non-manifold, many make nearly all boundary. Triangles may repeat a
        /// corner.
        #[test]
        fn the_half_edges_of_any_triangles_are_matched(
            triangles in (2u32..40).prop_flat_map(|vertices| vec(0..vertices, 0..40).prop_map(|mut corners| {
                corners.truncate(corners.len() / 3 * 3);
                corners
            }))
        ) {
            compare(40, &triangles);
        }

        /// Cones of many triangles around the first or the last vertex. Some triangles are repeated or reversed.
        #[test]
        fn the_half_edges_of_poles_are_matched(
            [is_first, is_last] in any::<[bool; 2]>(), size in 3u32..300, dirt in vec((0usize..300, any::<bool>()), 0..4)
        ) {
            let mut triangles = Vec::new();
            for (apex, is_apex) in [(0, is_first), (size + 1, is_last)] {
                let cone = |i: u32| if apex == 0 { [i + 1, (i + 1) % size + 1, 0] } else { [(i + 1) % size + 1, i + 1, apex] };
                triangles.extend((0..if is_apex { size } else { 0 }).flat_map(cone));
            }
            for (t, is_turned) in dirt {
                if let Some(corners) = triangles.as_chunks::<3>().0.get(t) {
                    let [a, b, c] = *corners;
                    triangles.extend(if is_turned { [b, a, c] } else { [b, c, a] });
                }
            }
            compare(size as usize + 2, &triangles);
        }
    }

    /// A cone of many triangles around vertex 1, and a triangle from vertex 0 to one of its border.
    #[test]
    fn a_pole_and_the_vertex_before_it_keep_their_edges() {
        let cone = (2..100).flat_map(|i| [i, if i == 99 { 2 } else { i + 1 }, 1]).collect::<Vec<u32>>();
        for border in 2..100 {
            compare(101, &[cone.as_slice(), &[0, border, 100]].concat());
        }
    }

    fn matched(vertices: usize, triangles: &[u32]) -> Adjacency {
        Adjacency::of_triangles(vertices, triangles, &Threads::default())
    }

    /// ```text
    ///  3-----2
    ///  | \ 1 |     triangles 0: (0, 1, 3), 1: (1, 2, 3)
    ///  | 0 \ |
    ///  0-----1
    /// ```
    #[test]
    fn two_triangles_share_one_edge() {
        let adjacency = matched(4, &[0, 1, 3, 1, 2, 3]);
        assert_eq!(adjacency.twins, [NONE, 5, NONE, NONE, NONE, 1]);
        assert_eq!((adjacency.edges, adjacency.boundary), (5, 4));
    }

    /// Three triangles at the edge 0-1, like the pages of a book.
    #[test]
    fn an_edge_of_three_triangles_is_frozen() {
        let adjacency = matched(5, &[0, 1, 2, 1, 0, 3, 0, 1, 4]);
        assert_eq!(adjacency.twins, [NONE; 9]);
        assert_eq!((adjacency.edges, adjacency.boundary, adjacency.non_manifold), (7, 6, 1));
    }

    #[test]
    fn an_edge_between_triangles_of_opposite_orientation_is_frozen() {
        let adjacency = matched(4, &[0, 1, 2, 0, 1, 3]);
        assert_eq!(adjacency.twins, [NONE; 6]);
        assert_eq!((adjacency.boundary, adjacency.inconsistent), (4, 1));
    }

    /// (0, 0, 1) has the edge 0-1 twice and the edge 0-0.
    #[test]
    fn a_triangle_is_not_its_own_neighbour() {
        let adjacency = matched(2, &[0, 0, 1]);
        assert_eq!(adjacency.twins, [NONE; 3]);
        assert_eq!((adjacency.boundary, adjacency.non_manifold), (1, 1));
    }

    #[test]
    fn unreferenced_vertices_have_no_edges() {
        assert_eq!(matched(7, &[]), Adjacency::default());
        assert_eq!(matched(9, &[8, 4, 6]).boundary, 3);
    }
}
