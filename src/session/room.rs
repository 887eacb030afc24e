//! How much memory a session takes on the CPU, from measuring the most that each family of meshes takes: `tests/room.rs`.

use crate::{Dimension, Mesh, Options, Order};

/// Bytes a triangle that the lists of edges and of their states take, while they are made.
pub(super) const EDGES: u64 = 88;

/// Bytes a triangle that a copy of the triangles takes.
pub(super) const COPY: u64 = 12;

/// Bytes a triangle that are taken while positions change.
pub(super) const POSITIONS: u64 = 44;

/// What of it a run takes after its session has begun.
pub(super) fn of_run(mesh: &Mesh, options: &Options) -> u64 {
    bytes(mesh, options) / 5 * 2
}

/// Bytes a vertex: marks and fans.
const VERTEX: u64 = 24;

/// Bytes an edge that is locked: the options' pair and what finds its half-edges.
const LOCKED: u64 = 24;

/// As [`Session::bytes`](crate::Session::bytes).
pub(super) fn bytes(mesh: &Mesh, options: &Options) -> u64 {
    // Adjacency and triangles, and the lists of edges that an iteration goes through, or those of Lawson's regions.
    let triangle = match (options.order, mesh.dimension()) {
        (Order::Reproducible, Dimension::Two) => 52,
        (Order::Reproducible, Dimension::Three) => 64,
        (Order::Any, Dimension::Two) => 72,
        (Order::Any, Dimension::Three) => 84,
    };
    triangle * mesh.triangle_count() as u64
        + VERTEX * mesh.vertex_count() as u64
        + LOCKED * options.locked_edges.len() as u64
}
