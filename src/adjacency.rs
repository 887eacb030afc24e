//! Twins from triangles: which half-edge lies on the other side of each half-edge.
//!
//! Half-edge h belongs to triangle h / 3 and goes from `triangles[h]` to `triangles[next(h)]`.

use crate::{Mesh, NONE};

/// The half-edge after `h` in its triangle.
pub fn next(h: u32) -> u32 {
    if h % 3 == 2 { h - 2 } else { h + 1 }
}

/// The half-edge before `h` in its triangle.
pub fn prev(h: u32) -> u32 {
    if h.is_multiple_of(3) { h + 2 } else { h - 1 }
}

/// Set in both entries of an engine's twins for an edge that was over β in the input: it stays, whatever its
/// angle becomes. The flag moves with the half-edges.
pub(crate) const CREASE: u32 = 1 << 31;

/// The same for an edge that the user has locked.
pub(crate) const LOCKED: u32 = 1 << 30;

/// All flags. Half-edges are below the lowest.
pub(crate) const FLAGS: u32 = CREASE | LOCKED;

/// The half-edge that an entry of an engine's twins names, without its flags.
pub(crate) fn unflagged(entry: u32) -> u32 {
    if entry == NONE { NONE } else { entry & !FLAGS }
}

/// The half-edges of a mesh matched in pairs, and how many edges there are of each kind.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Adjacency {
    /// For each half-edge the one on the other side; [`NONE`] on the boundary and on frozen edges.
    pub twins: Vec<u32>,
    /// Edges in all: pairs of vertices joined by a half-edge.
    pub edges: u32,
    /// Edges with one half-edge.
    pub boundary: u32,
    /// Frozen edges with three or more half-edges, or two in one triangle.
    pub non_manifold: u32,
    /// Frozen edges with two half-edges in the same direction.
    pub inconsistent: u32,
}

/// What an edge is, by its half-edges.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum EdgeKind {
    Interior,
    Boundary,
    NonManifold,
    Inconsistent,
}

/// The kind of the edge that these half-edges, all between the same two vertices, make up.
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

/// Calls `visit` once for each edge with its half-edges in ascending order, edges by their smaller vertex.
/// A counting sort of the half-edges by that vertex; within one vertex they are sorted by the other one, so
/// that a vertex of any valence costs n log n. O(triangles) memory.
pub(crate) fn for_each_edge(vertices: usize, triangles: &[u32], mut visit: impl FnMut(&[u32])) {
    let ends = |h: usize| {
        let (u, v) = (triangles[h], triangles[next(h as u32) as usize]);
        (u.min(v), u.max(v))
    };
    let mut offsets = vec![0u32; vertices + 1];
    for h in 0..triangles.len() {
        offsets[ends(h).0 as usize + 1] += 1;
    }
    for v in 0..vertices {
        offsets[v + 1] += offsets[v];
    }
    let mut sorted = vec![0u64; triangles.len()];
    for h in 0..triangles.len() {
        let (low, high) = ends(h);
        let at = &mut offsets[low as usize];
        sorted[*at as usize] = u64::from(high) << 32 | h as u64;
        *at += 1;
    }
    // Scattering has moved every offset to the end of its bucket, the start of the next.
    let mut half_edges = Vec::new();
    let mut start = 0;
    for &end in &offsets[..vertices] {
        let bucket = &mut sorted[start..end as usize];
        start = end as usize;
        bucket.sort_unstable();
        for edge in bucket.chunk_by(|x, y| x >> 32 == y >> 32) {
            half_edges.clear();
            half_edges.extend(edge.iter().map(|&entry| entry as u32));
            visit(&half_edges);
        }
    }
}

impl Adjacency {
    /// Matches the half-edges of a mesh.
    pub fn new(mesh: &Mesh) -> Self {
        Self::of_triangles(mesh.vertex_count(), mesh.triangles())
    }

    /// Matches the half-edges of `triangles`, whose indices must be below `vertices`.
    pub(crate) fn of_triangles(vertices: usize, triangles: &[u32]) -> Self {
        let mut result = Self { twins: vec![NONE; triangles.len()], ..Self::default() };
        for_each_edge(vertices, triangles, |half_edges| {
            result.edges += 1;
            match edge_kind(half_edges, triangles) {
                EdgeKind::Boundary => result.boundary += 1,
                EdgeKind::NonManifold => result.non_manifold += 1,
                EdgeKind::Inconsistent => result.inconsistent += 1,
                EdgeKind::Interior => {
                    let (h, g) = (half_edges[0], half_edges[1]);
                    result.twins[h as usize] = g;
                    result.twins[g as usize] = h;
                }
            }
        });
        result
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_edges_leave_room_for_flags() {
        let last = 3 * crate::MAX_TRIANGLES as u32 - 1;
        assert!(last < LOCKED && last | FLAGS < crate::phases::BLOCKED);
        assert_eq!([unflagged(last | FLAGS), unflagged(NONE)], [last, NONE]);
    }

    /// ```text
    ///  3-----2
    ///  | \ 1 |     triangles 0: (0, 1, 3), 1: (1, 2, 3)
    ///  | 0 \ |
    ///  0-----1
    /// ```
    #[test]
    fn two_triangles_share_one_edge() {
        let adjacency = Adjacency::of_triangles(4, &[0, 1, 3, 1, 2, 3]);
        assert_eq!(adjacency.twins, [NONE, 5, NONE, NONE, NONE, 1]);
        assert_eq!((adjacency.edges, adjacency.boundary), (5, 4));
    }

    /// Three triangles at the edge 0-1, like the pages of a book.
    #[test]
    fn an_edge_of_three_triangles_is_frozen() {
        let adjacency = Adjacency::of_triangles(5, &[0, 1, 2, 1, 0, 3, 0, 1, 4]);
        assert_eq!(adjacency.twins, [NONE; 9]);
        assert_eq!((adjacency.edges, adjacency.boundary, adjacency.non_manifold), (7, 6, 1));
    }

    #[test]
    fn an_edge_between_triangles_turned_against_each_other_is_frozen() {
        let adjacency = Adjacency::of_triangles(4, &[0, 1, 2, 0, 1, 3]);
        assert_eq!(adjacency.twins, [NONE; 6]);
        assert_eq!((adjacency.boundary, adjacency.inconsistent), (4, 1));
    }

    /// (0, 0, 1) has the edge 0-1 twice and the edge 0-0.
    #[test]
    fn a_triangle_is_not_its_own_neighbour() {
        let adjacency = Adjacency::of_triangles(2, &[0, 0, 1]);
        assert_eq!(adjacency.twins, [NONE; 3]);
        assert_eq!((adjacency.boundary, adjacency.non_manifold), (1, 1));
    }

    #[test]
    fn unreferenced_vertices_have_no_edges() {
        assert_eq!(Adjacency::of_triangles(7, &[]), Adjacency::default());
        assert_eq!(Adjacency::of_triangles(9, &[8, 4, 6]).boundary, 3);
    }
}
