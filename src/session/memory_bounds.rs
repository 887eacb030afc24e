//! How much memory a session takes on the CPU. `tests/memory_bounds.rs` measures each family of meshes against these
//! bounds.

use crate::mesh::arrangement::Arrangement;
use crate::{Dimension, Mesh, Options, Order};

/// Bytes per triangle to make the list of edges, or of their states.
pub(super) const EDGES: u64 = 88;

/// Bytes per triangle of a copy of the triangles.
pub(super) const COPY: u64 = 12;

/// Bytes per triangle to change the positions.
pub(super) const POSITIONS: u64 = 44;

/// Bytes per triangle of a repair: other triangles and twins, the old twins, claims, what stays constant, and the vertices
/// that are out.
pub(super) const UNTANGLE: u64 = 128;

/// The part of [`bytes`] that a run takes after `Session::new`.
pub(super) fn of_run(mesh: &Mesh, options: &Options) -> u64 {
    bytes(mesh, options) / 5 * 2
}

/// Bytes per vertex: marks and fans.
const VERTEX: u64 = 24;

/// Bytes per locked edge: its pair in the options, and the search for its half-edges.
const LOCKED: u64 = 24;

/// Bytes per constraint: its edge, and the search for it.
const CONSTRAINT: u64 = 100;

/// As [`Session::bytes`](crate::Session::bytes).
pub(super) fn bytes(mesh: &Mesh, options: &Options) -> u64 {
    // Adjacency, triangles, and the lists of edges of an iteration or of Lawson's regions.
    let triangle = match (options.order, mesh.dimension()) {
        (Order::Reproducible, Dimension::Two) => 52,
        (Order::Reproducible, Dimension::Three) => 64,
        (Order::Any, Dimension::Two) => 72,
        (Order::Any, Dimension::Three) => 84,
    };
    let changes = if options.track_changes { 4 } else { 0 };
    let arrangement = if Arrangement::is_needed(mesh) { Arrangement::bytes(mesh) } else { 0 };
    // The run takes a mesh that flips have made.
    let constraints = match options.constraints.len() as u64 {
        0 => 0,
        count => CONSTRAINT * count + mesh.bytes(),
    };
    // The search for the vertices near a constraint may meet all triangles, and it may become an edge per vertex.
    let near = if options.constraint_tolerance > 0.0 && !options.constraints.is_empty() {
        40 * mesh.triangle_count() as u64 + CONSTRAINT * mesh.vertex_count() as u64
    } else {
        0
    };
    (triangle + changes) * mesh.triangle_count() as u64
        + VERTEX * mesh.vertex_count() as u64
        + LOCKED * options.locked_edges.len() as u64
        + arrangement
        + constraints
        + near
}
