//! The result of a run, and statistics of its iterations.

use crate::{EngineKind, LeftOut, Reasons};

/// Statistics of one iteration of [`Session::step`](crate::Session::step).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Iteration {
    /// Its index, from 0.
    pub index: u32,
    /// Non-Delaunay edges that may flip, in the whole mesh, before the iteration.
    pub labelled: u32,
    /// Edges flipped.
    pub flips: u32,
    /// Non-Delaunay interior edges that may not flip, in the whole mesh, before the iteration: by `Angle`, `Fold`,
    /// `Duplicate`, `Locked` or `Deviation`. Only the outcome counts frozen edges.
    pub blocked: Reasons,
    /// Wall time in milliseconds, including these counts.
    pub ms: f64,
}

/// What the updates of a session have done, and what is left. See [`Session::counters`](crate::Session::counters).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counters {
    /// The number of updates that the counts are of: all before the call.
    pub updates: u64,
    /// Flips of these updates.
    pub flips: u64,
    /// Edges that are not Delaunay after the last of them, by reason. [`Reason::Stopped`](crate::Reason::Stopped) counts those that the next
    /// update may flip. Frozen edges are not counted.
    pub remaining: Reasons,
    /// Triangles that are turned over, in the plane; 0 in space. They are those of [`Outcome::inverted`], compared with
    /// the orientation that their component had at the start of the session.
    pub inverted: u32,
    /// Triangles of no area, as [`Outcome::flat`].
    pub flat: u32,
    /// Triangles that are neither of them nor known to be right: a coordinate is not finite, or the coordinates span more
    /// bits than the GPU decides exactly, or reach 2^126. The CPU decides all finite ones.
    pub undecided: u32,
    /// Edges left alone because a coordinate of their triangles is not finite.
    pub non_finite: u32,
    /// Edges left alone because the coordinates of their triangles span more bits than the GPU decides exactly, or
    /// reach 2^126. The CPU decides them all.
    pub too_wide: u32,
}

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// No edge is left that may flip.
    Done,
    /// Cancelled, or at the limit on iterations, after a complete iteration.
    Stopped,
}

/// Wall times in milliseconds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Timings {
    /// What brought the constraints in, before the engine got the mesh.
    pub constraints: f64,
    /// On a GPU, the time before the adjacency: checks, allocation and copies to the device; in the first session also
    /// opening the device and compiling the kernels. On the CPU, it is 0.
    pub upload: f64,
    /// The adjacency, the creases and the winding. After [`Session::set_positions`](crate::Session::set_positions): the
    /// time of that call. With WebGPU in a browser, it is 0: the engine does not wait for the device there, so `flip`
    /// includes the copies and the adjacency.
    pub adjacency: f64,
    /// The iterations.
    pub flip: f64,
    /// The sum of the others, plus the read-back and the final count.
    pub total: f64,
}

/// The result of a run, with statistics.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// 3 vertex indices per triangle. The two triangles of a flip keep their indices.
    pub triangles: Vec<u32>,
    /// Done or stopped.
    pub status: Status,
    /// The engine that ran.
    pub backend: EngineKind,
    /// The GPU's name and driver.
    pub adapter: Option<String>,
    /// Why `auto` chose the CPU, or started there.
    pub fallback: Option<String>,
    /// Iterations with at least one flip.
    pub iterations: u32,
    /// Flips in all.
    pub flips: u64,
    /// How many edges the constraints crossed: each made way for another one, without a flip.
    pub crossed_edges: u64,
    /// The largest distance of a vertex from the constraint that goes through it; 0 without
    /// [`Options::constraint_tolerance`](crate::Options::constraint_tolerance).
    pub constraint_deviation: f64,
    /// The edges that the constraints have become, each by its two vertices, for [`regions`](crate::regions). The
    /// constraints are in their order; the edges of one lead from its first vertex to its second.
    pub constraint_edges: Vec<[u32; 2]>,
    /// The constraints that were left out, in ascending order.
    pub left_out: Vec<LeftOut>,
    /// Locked edges that the mesh does not have any more, because no triangulation with them was found after the
    /// vertices moved ([`Options::untangle`](crate::Options::untangle)). Each has its smaller vertex first. They come back
    /// with positions that allow it. Where triangles stay turned over or flat, flips may have made one again, which is not
    /// locked then.
    pub lost_edges: Vec<[u32; 2]>,
    /// Flips of each iteration; a whole run of Lawson's algorithm counts as one iteration.
    pub flips_per_iteration: Vec<u32>,
    /// Compute dispatches encoded on the GPU.
    pub dispatches: u64,
    /// The peak size of the WebGPU buffers in bytes; 0 on other engines.
    pub device_bytes: u64,
    /// Edges of the mesh.
    pub edges: u64,
    /// Edges with one triangle.
    pub boundary_edges: u64,
    /// Frozen edges with three or more triangles, or with one triangle twice.
    pub non_manifold_edges: u64,
    /// Frozen edges whose two triangles have opposite orientations.
    pub inconsistent_edges: u64,
    /// Non-Delaunay edges left, by reason.
    pub remaining: Reasons,
    /// Triangles that are turned over, in the plane: their orientation is not that of their component, which is
    /// connected over edges between two triangles of one orientation. A component has the orientation of its total
    /// area, which no flip changes; without an area it counts as counter-clockwise. 0 in space.
    pub inverted: u32,
    /// Triangles of no area: their corners are on one line, exactly.
    pub flat: u32,
    /// Wall times.
    pub timings: Timings,
}
