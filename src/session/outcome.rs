//! What a run says of its iterations and of its result.

use crate::{EngineKind, Reasons};

/// What one watched iteration did.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Iteration {
    /// Its number, from 0.
    pub index: u32,
    /// Non-Delaunay edges that may flip, in the whole mesh, before the iteration.
    pub labelled: u32,
    /// Edges flipped.
    pub flips: u32,
    /// Non-Delaunay edges of two triangles that may not flip, in the whole mesh, before the iteration: by
    /// `Angle`, `Fold`, `Duplicate`, `Locked` or `Deviation`. Frozen edges are counted at the end only.
    pub blocked: Reasons,
    /// Wall time in milliseconds, the counts for the watcher included.
    pub ms: f64,
}

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// No edge is left that may flip.
    Done,
    /// Cancelled or capped, after a complete iteration.
    Stopped,
}

/// Wall times in milliseconds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Timings {
    /// On a GPU what comes before the adjacency: checks, memory and the copies to the device; for the first session
    /// also the device and its shaders. Else 0.
    pub upload: f64,
    /// The adjacency and what else is found out of the input. After the vertices have moved: that move. A browser's WebGPU
    /// is not waited for: 0 then, it counts as iterations, as do the copies.
    pub adjacency: f64,
    /// The iterations.
    pub flip: f64,
    /// All of it, with the read-back and the final count.
    pub total: f64,
}

/// The result of a run, and what there is to say about it.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// Vertex indices, 3 a triangle; a flip rotates two triangles in place.
    pub triangles: Vec<u32>,
    /// Done or stopped.
    pub status: Status,
    /// The engine that ran.
    pub backend: EngineKind,
    /// The GPU's name and driver.
    pub adapter: Option<String>,
    /// Why `auto` is on the CPU, or began there.
    pub fallback: Option<String>,
    /// Iterations with at least one flip.
    pub iterations: u32,
    /// Flips in all.
    pub flips: u64,
    /// Flips of each iteration; a whole pass of Lawson's algorithm is one.
    pub flips_per_iteration: Vec<u32>,
    /// Compute dispatches encoded on the GPU.
    pub dispatches: u64,
    /// The most bytes that the buffers of WebGPU took at a time; 0 on other engines.
    pub device_bytes: u64,
    /// Edges of the mesh.
    pub edges: u64,
    /// Edges with one triangle.
    pub boundary_edges: u64,
    /// Frozen edges: three or more triangles, or one triangle twice.
    pub non_manifold_edges: u64,
    /// Frozen edges: two triangles oriented against each other.
    pub inconsistent_edges: u64,
    /// Non-Delaunay edges left, by reason.
    pub remaining: Reasons,
    /// Wall times.
    pub timings: Timings,
}
