//! What a run says of its iterations, of its result and of the edges that it left.

/// Why a non-Delaunay edge was left.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Reason {
    /// The triangles' normals differ by more than β before or after the flip, or did so in the input.
    Angle,
    /// A new triangle would turn over (3D) or not be strictly positive (2D).
    Fold,
    /// The edge that the flip would make exists already.
    Duplicate,
    /// The user has locked it: [`Options::locked_edges`](crate::Options::locked_edges), its triangles or the border of its
    /// group. Goes before all other reasons.
    Locked,
    /// The old and the new diagonal are further apart than
    /// [`Options::max_deviation`](crate::Options::max_deviation).
    Deviation,
    /// Three or more triangles, or one triangle twice, meet at the edge.
    NonManifold,
    /// Its two triangles are oriented against each other.
    Inconsistent,
    /// The run was stopped, by cancellation or the cap on iterations, before it was flipped.
    Stopped,
}

impl Reason {
    /// All reasons, in the order in which they are reported.
    pub const ALL: [Self; 8] = [
        Self::Angle,
        Self::Fold,
        Self::Duplicate,
        Self::Locked,
        Self::Deviation,
        Self::NonManifold,
        Self::Inconsistent,
        Self::Stopped,
    ];

    /// The word used in results: `angle`, `fold`, `duplicate`, `locked`, `deviation`, `non-manifold`, `inconsistent`,
    /// `stopped`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Angle => "angle",
            Self::Fold => "fold",
            Self::Duplicate => "duplicate",
            Self::Locked => "locked",
            Self::Deviation => "deviation",
            Self::NonManifold => "non-manifold",
            Self::Inconsistent => "inconsistent",
            Self::Stopped => "stopped",
        }
    }
}

/// Numbers of edges by [`Reason`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Reasons([u64; Reason::ALL.len()]);

impl Reasons {
    /// Edges in all.
    pub fn total(&self) -> u64 {
        self.0.iter().sum()
    }

    /// The reasons with at least one edge.
    pub fn iter(&self) -> impl Iterator<Item = (Reason, u64)> + '_ {
        Reason::ALL.into_iter().map(|reason| (reason, self[reason])).filter(|&(_, n)| n > 0)
    }
}

impl FromIterator<Reason> for Reasons {
    fn from_iter<I: IntoIterator<Item = Reason>>(edges: I) -> Self {
        let mut reasons = Self::default();
        for reason in edges {
            reasons[reason] += 1;
        }
        reasons
    }
}

impl std::ops::Index<Reason> for Reasons {
    type Output = u64;
    fn index(&self, reason: Reason) -> &u64 {
        &self.0[reason as usize]
    }
}

impl std::ops::IndexMut<Reason> for Reasons {
    fn index_mut(&mut self, reason: Reason) -> &mut u64 {
        &mut self.0[reason as usize]
    }
}

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
    /// The engine that ran: `cpu` or `gpu`.
    pub backend: &'static str,
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
