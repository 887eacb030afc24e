//! What the next iteration does with each edge, and why: the rules of `phases/`, applied to all triangles.

use crate::mesh::adjacency::{EdgeKind, edge_kind};
use crate::mesh::buckets::for_each_edge;
use crate::mesh::half_edge::unflagged;
use crate::phases::{Geometry, Topology, Verdict, label, select, verdict};
use crate::{NONE, Reason};

/// The state of an edge between two iterations.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum EdgeState {
    /// Interior and Delaunay.
    Delaunay,
    /// Not Delaunay, and selected: the next iteration, if there is one, flips it.
    Flips,
    /// Not Delaunay, and may flip, but the next iteration does not select it. Lawson's algorithm selects none.
    Waits,
    /// Not Delaunay, and blocked by [`Reason::Angle`].
    Angle,
    /// Not Delaunay, and blocked by [`Reason::Fold`].
    Fold,
    /// Not Delaunay, and blocked by [`Reason::Duplicate`].
    Duplicate,
    /// Not Delaunay, and blocked by [`Reason::Locked`].
    Locked,
    /// Not Delaunay, and blocked by [`Reason::Deviation`].
    Deviation,
    /// Frozen, whatever its angles: it has three or more triangles, or one triangle twice.
    NonManifold,
    /// Frozen, whatever its angles: its two triangles have opposite orientations.
    Inconsistent,
    /// On the boundary: it has one triangle.
    Boundary,
}

impl EdgeState {
    /// All states, each at the index of its number.
    pub const ALL: [Self; 11] = [
        Self::Delaunay,
        Self::Flips,
        Self::Waits,
        Self::Angle,
        Self::Fold,
        Self::Duplicate,
        Self::Locked,
        Self::Deviation,
        Self::NonManifold,
        Self::Inconsistent,
        Self::Boundary,
    ];

    /// The name of the state: `delaunay`, `flips`, `waits`, `angle`, `fold`, `duplicate`, `locked`,
    /// `deviation`, `non-manifold`, `inconsistent`, `boundary`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Delaunay => "delaunay",
            Self::Flips => "flips",
            Self::Waits => "waits",
            Self::Angle => Reason::Angle.name(),
            Self::Fold => Reason::Fold.name(),
            Self::Duplicate => Reason::Duplicate.name(),
            Self::Locked => Reason::Locked.name(),
            Self::Deviation => Reason::Deviation.name(),
            Self::NonManifold => Reason::NonManifold.name(),
            Self::Inconsistent => Reason::Inconsistent.name(),
            Self::Boundary => "boundary",
        }
    }
}

impl From<Verdict> for EdgeState {
    fn from(verdict: Verdict) -> Self {
        match verdict {
            Verdict::Delaunay => Self::Delaunay,
            Verdict::Labelled | Verdict::Blocked(Reason::Stopped) => Self::Waits,
            Verdict::Blocked(Reason::Angle) => Self::Angle,
            Verdict::Blocked(Reason::Fold) => Self::Fold,
            Verdict::Blocked(Reason::Duplicate) => Self::Duplicate,
            Verdict::Blocked(Reason::Locked) => Self::Locked,
            Verdict::Blocked(Reason::Deviation) => Self::Deviation,
            Verdict::Blocked(Reason::NonManifold) => Self::NonManifold,
            Verdict::Blocked(Reason::Inconsistent) => Self::Inconsistent,
        }
    }
}

/// The state of the edge of each half-edge before `iteration`. `iteration` is `None` for Lawson's algorithm, which has
/// no select phase.
pub(crate) fn edge_states(
    geometry: &Geometry,
    mesh: Topology,
    vertices: usize,
    iteration: Option<u32>,
) -> Vec<EdgeState> {
    let Topology { triangles, twins, .. } = mesh;
    let mut states = vec![EdgeState::Delaunay; triangles.len()];
    for (h, g) in (0u32..).zip(twins.iter().copied().map(unflagged)) {
        if g != NONE && h < g {
            let state = verdict(geometry, mesh, h).into();
            (states[h as usize], states[g as usize]) = (state, state);
        }
    }
    if let Some(iteration) = iteration {
        let best = label(geometry, mesh, iteration);
        // For each triangle of a selected edge, `select` gives the half-edge on the other side of the edge.
        for g in select(mesh, iteration, &best).into_iter().filter(|&g| g != NONE) {
            states[g as usize] = EdgeState::Flips;
        }
    }
    if twins.contains(&NONE) {
        for_each_edge(vertices, triangles, |half_edges| {
            let state = match edge_kind(half_edges, triangles) {
                EdgeKind::Interior => return,
                EdgeKind::Boundary => EdgeState::Boundary,
                EdgeKind::NonManifold => EdgeState::NonManifold,
                EdgeKind::Inconsistent => EdgeState::Inconsistent,
            };
            for &h in half_edges {
                states[h as usize] = state;
            }
        });
    }
    states
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn states_are_numbered_and_named_as_in_typescript() {
        let names = EdgeState::ALL.map(|state| format!("'{}'", state.name()));
        let tuple: String = include_str!("../js/edge-states.ts")
            .lines()
            .skip_while(|line| !line.starts_with("export const EDGE_STATES = ["))
            .skip(1)
            .take_while(|line| !line.starts_with("] as const;"))
            .map(str::trim)
            .collect();
        assert_eq!(tuple.trim_end_matches(','), names.join(","));
        assert!(EdgeState::ALL.iter().zip(0..).all(|(&state, number)| state as u8 == number));
    }
}
