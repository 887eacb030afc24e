//! `Mesh`: positions and triangles. The constructor checks them, so that no later code can fail on them.

pub(crate) mod adjacency;
pub(crate) mod areas;
pub(crate) mod arrangement;
pub(crate) mod buckets;
pub(crate) mod dimension;
pub(crate) mod edges;
pub(crate) mod embedded;
pub(crate) mod extremes;
pub(crate) mod half_edge;
pub(crate) mod named_edges;
pub(crate) mod plane;
pub(crate) mod positions;
pub(crate) mod recent;
pub(crate) mod star;
pub(crate) mod winding;

use crate::Error;
use crate::system::threads::Threads;
use dimension::Dimension;
use extremes::Extremes;
use glam::{DVec2, DVec3};
use half_edge::NONE;
use positions::Positions;
use std::sync::Arc;

/// The largest number of triangles. Engines store a half-edge in 30 bits, with two flags above. The two highest words,
/// `NONE` and `BLOCKED`, are no half-edges.
pub const MAX_TRIANGLES: usize = ((1 << 30) - 2) / 3;

/// A triangle of a mesh: its slot, that is its index, its corners and their twins.
pub(crate) type Slot = [u32; 7];

/// A triangle mesh with finite coordinates and indices in range. Everything else may be dirty:
/// boundary, several components, non-manifold edges, degenerate triangles.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    dimension: Dimension,
    positions: Positions,
    triangles: Vec<u32>,
}

impl From<&Mesh> for Arc<Mesh> {
    fn from(mesh: &Mesh) -> Self {
        Self::new(mesh.clone())
    }
}

impl Mesh {
    /// Checks and takes `positions` (2 or 3 numbers per vertex, `Vec<f32>` or `Vec<f64>`) and `triangles` (3 vertex
    /// indices per triangle). If all 64-bit floats are exactly 32-bit floats, the mesh stores 32-bit floats.
    ///
    /// # Errors
    /// [`Error::RaggedArray`], [`Error::TooLarge`], [`Error::NonFinite`] or [`Error::IndexOutOfRange`] for the first
    /// vertex or triangle that is wrong.
    pub fn new(
        dimension: Dimension,
        positions: impl Into<Positions>,
        triangles: Vec<u32>,
    ) -> Result<Self, Error> {
        Self::checked(dimension, positions, triangles, &Threads::one())
    }

    /// As [`Mesh::new`], on several threads.
    pub(crate) fn checked(
        dimension: Dimension,
        positions: impl Into<Positions>,
        triangles: Vec<u32>,
        threads: &Threads,
    ) -> Result<Self, Error> {
        let positions = positions.into().narrowed();
        let stride = dimension.stride();
        for (array, length, stride) in
            [("positions", positions.len(), stride), ("triangles", triangles.len(), 3)]
        {
            if length % stride != 0 {
                return Err(Error::RaggedArray { array, length, stride });
            }
        }
        let vertices = positions.len() / stride;
        for (what, count, limit) in
            [("vertices", vertices, NONE as usize), ("triangles", triangles.len() / 3, MAX_TRIANGLES)]
        {
            if count > limit {
                return Err(Error::TooLarge { what, count, limit });
            }
        }
        positions.refuse_non_finite(dimension, threads)?;
        if !triangles.is_empty()
            && Extremes::of(&triangles, u32::MAX, threads).largest as usize >= vertices
            && let Some(i) = triangles.iter().position(|&v| v as usize >= vertices)
        {
            return Err(Error::IndexOutOfRange { triangle: i / 3, index: triangles[i], vertices });
        }
        Ok(Self { dimension, positions, triangles })
    }

    /// Of numbers that [`Mesh::new`] has checked before.
    pub(crate) fn of_checked(dimension: Dimension, positions: Positions, triangles: Vec<u32>) -> Self {
        Self { dimension, positions, triangles }
    }

    /// The same vertices and triangles in another order.
    pub(crate) fn reordered(&self, positions: Positions, triangles: Vec<u32>) -> Self {
        Self { dimension: self.dimension, positions, triangles }
    }

    /// Plane or space.
    pub fn dimension(&self) -> Dimension {
        self.dimension
    }

    /// Coordinates, 2 or 3 per vertex.
    pub fn positions(&self) -> &Positions {
        &self.positions
    }

    /// Vertex indices, 3 per triangle.
    pub fn triangles(&self) -> &[u32] {
        &self.triangles
    }

    /// Number of vertices, unreferenced ones included.
    pub fn vertex_count(&self) -> usize {
        self.positions.len() / self.dimension.stride()
    }

    /// Number of triangles.
    pub fn triangle_count(&self) -> usize {
        self.triangles.len() / 3
    }

    /// The same vertices with other triangles, such as [`crate::Outcome::triangles`].
    ///
    /// # Errors
    /// Those of [`Mesh::new`].
    pub fn with_triangles(&self, triangles: Vec<u32>) -> Result<Self, Error> {
        Self::new(self.dimension, self.positions.clone(), triangles)
    }

    /// The same vertices with triangles that flips have made.
    pub(crate) fn flipped(&self, triangles: Vec<u32>) -> Self {
        Self { dimension: self.dimension, positions: self.positions.clone(), triangles }
    }

    /// The same with other triangles in some slots. `twins` are its twins.
    pub(crate) fn with_slots(mut self, slots: &[Slot], twins: &mut [u32]) -> Self {
        for &[slot, a, b, c, x, y, z] in slots {
            let corners = 3 * slot as usize..3 * slot as usize + 3;
            self.triangles[corners.clone()].copy_from_slice(&[a, b, c]);
            twins[corners].copy_from_slice(&[x, y, z]);
        }
        self
    }

    /// Adds a vertex to a 2D mesh. If the mesh stores 32-bit floats, the coordinates have to be such.
    pub(crate) fn push_vertex(&mut self, point: DVec2) {
        match &mut self.positions {
            Positions::F32(numbers) => numbers.extend(point.to_array().map(|x| x as f32)),
            Positions::F64(numbers) => numbers.extend(point.to_array()),
        }
    }

    /// The bytes of its arrays.
    pub(crate) fn bytes(&self) -> u64 {
        4 * self.triangles.len() as u64 + self.positions.bytes()
    }

    /// The vertex's coordinates; only for a 2D mesh.
    pub(crate) fn point2(&self, vertex: u32) -> DVec2 {
        let [point] = self.positions.points2([vertex]);
        point
    }

    /// The vertex's coordinates; z is 0 in a 2D mesh.
    pub(crate) fn point3(&self, vertex: u32) -> DVec3 {
        match self.dimension {
            Dimension::Two => self.point2(vertex).extend(0.0),
            Dimension::Three => {
                let [point] = self.positions.points3([vertex]);
                point
            }
        }
    }
}
