//! The reasons why edges that are not Delaunay remain.

/// Why an edge that is not Delaunay remains.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Reason {
    /// The normals of the triangles differ by more than β before or after the flip, or differed by more than β in the
    /// input.
    Angle,
    /// A new triangle would turn over (3D), or would not be strictly positive (2D).
    Fold,
    /// The flip would make an edge that exists already.
    Duplicate,
    /// The user has locked the edge: by [`Options::locked_edges`](crate::Options::locked_edges), `locked_triangles` or
    /// `groups`. Takes precedence over the other reasons.
    Locked,
    /// The old and the new diagonal are further apart than
    /// [`Options::max_deviation`](crate::Options::max_deviation).
    Deviation,
    /// The edge has three or more triangles, or one triangle twice.
    NonManifold,
    /// The two triangles of the edge have opposite orientations.
    Inconsistent,
    /// The run stopped before it flipped the edge: it was cancelled, or reached the limit on iterations.
    Stopped,
}

impl Reason {
    /// All reasons, in the order of reports.
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

    /// The name in results: `angle`, `fold`, `duplicate`, `locked`, `deviation`, `non-manifold`, `inconsistent`,
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
    /// The number of edges, with any reason.
    pub fn total(&self) -> u64 {
        self.0.iter().sum()
    }

    /// The reasons with at least one edge, and their numbers of edges.
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
