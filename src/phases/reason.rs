//! Why an edge that is not Delaunay stays.

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
