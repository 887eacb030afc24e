//! The result of a parser.

use super::pieces;
use crate::Positions;
use crate::system::threads::Threads;

/// Faces as triangles: a polygon becomes the fan around its first corner.
#[derive(Default)]
pub(super) struct CutFaces {
    /// Vertex indices, 3 per triangle.
    pub(super) triangles: Vec<u32>,
    /// Faces with more than 3 corners.
    pub(super) polygons: usize,
}

impl CutFaces {
    /// Adds a face of at least 3 corners.
    pub(super) fn push(&mut self, corners: &[u32]) {
        let Some((&first, rest)) = corners.split_first() else { return };
        self.polygons += usize::from(rest.len() > 2);
        for pair in rest.windows(2) {
            self.triangles.extend_from_slice(&[first, pair[0], pair[1]]);
        }
    }

    /// Joins the pieces of a file, in order.
    pub(super) fn joined(parts: Vec<Self>, threads: &Threads) -> Self {
        let polygons = parts.iter().map(|part| part.polygons).sum();
        let triangles = parts.into_iter().map(|part| part.triangles).collect();
        Self { triangles: pieces::joined(triangles, threads), polygons }
    }
}

/// What a file has that a [`crate::Mesh`] cannot hold, each named once.
#[derive(Default)]
pub(super) struct Dropped(pub(super) Vec<String>);

impl Dropped {
    /// Adds a name.
    pub(super) fn note(&mut self, what: &str) {
        if !self.0.iter().any(|known| known == what) {
            self.0.push(what.to_owned());
        }
    }
}

/// The result of a parser: finite positions, and indices in range.
pub(super) struct Parsed {
    /// Numbers per vertex: 2 or 3.
    pub(super) stride: usize,
    /// `stride` numbers per vertex.
    pub(super) positions: Positions,
    /// The faces.
    pub(super) faces: CutFaces,
    /// What was dropped.
    pub(super) dropped: Dropped,
}
