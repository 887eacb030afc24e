//! The edges of a mesh as arrays: the Edges array of Navarro, Hitschfeld-Kahler and Scheihing (2011, §3).

use crate::Adjacency;
use crate::mesh::half_edge::{next, unflagged};
use crate::system::threads::Threads;

/// Every edge, one entry in each array, in the order of the lower half-edges. The lower half-edge is
/// the one with the smaller index, or the only one. Each half-edge of a frozen edge is an entry of its own.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Edges {
    /// The vertex that the lower half-edge starts at.
    pub v1: Vec<u32>,
    /// The vertex that the lower half-edge goes to.
    pub v2: Vec<u32>,
    /// The lower half-edge: `triangles[ta]` is `v1`.
    pub ta: Vec<u32>,
    /// Its twin: `triangles[tb]` is `v2`. [`NONE`](crate::NONE) on the boundary and on frozen edges.
    pub tb: Vec<u32>,
}

impl Edges {
    /// The edges of `triangles`, whose indices are below `vertices`.
    pub fn new(vertices: usize, triangles: &[u32]) -> Self {
        Self::from_twins(triangles, &Adjacency::of_triangles(vertices, triangles, &Threads::default()).twins)
    }

    /// The edges of `triangles`, given their twins, flagged or not.
    pub(crate) fn from_twins(triangles: &[u32], twins: &[u32]) -> Self {
        let mut edges = Self::default();
        for (h, twin) in (0u32..).zip(twins.iter().copied().map(unflagged)) {
            // NONE is above every half-edge.
            if h < twin {
                edges.v1.push(triangles[h as usize]);
                edges.v2.push(triangles[next(h) as usize]);
                edges.ta.push(h);
                edges.tb.push(twin);
            }
        }
        edges
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::NONE;

    /// ```text
    /// 3---2
    /// | / |
    /// 0---1
    /// ```
    #[test]
    fn edges_of_a_square() {
        let edges = Edges::new(4, &[0, 1, 2, 0, 2, 3]);
        assert_eq!(edges.v1, [0, 1, 2, 2, 3]);
        assert_eq!(edges.v2, [1, 2, 0, 3, 0]);
        assert_eq!(edges.ta, [0, 1, 2, 4, 5]);
        assert_eq!(edges.tb, [NONE, NONE, 3, NONE, NONE]);
    }

    /// Three triangles at the edge 0-1: each keeps its own half-edge.
    #[test]
    fn half_edges_of_a_frozen_edge_are_edges() {
        let edges = Edges::new(5, &[0, 1, 2, 1, 0, 3, 0, 1, 4]);
        assert_eq!(edges.ta.len(), 9);
        assert!(edges.tb.iter().all(|&tb| tb == NONE));
    }
}
