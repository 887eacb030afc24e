//! Brings edges into a mesh in the plane. The crossed edges flip away, by exact tests. No vertex moves, and none is
//! added.

mod insert;
mod state;
#[cfg(test)]
mod tests;
mod walk;

use crate::mesh::named_edges::half_edges;
use crate::{Dimension, Error, Mesh};
use state::State;
use std::collections::HashMap;
use walk::{Obstacle, Part, Way};

/// A mesh with edges brought in.
#[derive(Clone, Debug, PartialEq)]
pub struct Constrained {
    /// The same vertices, and as many triangles.
    pub mesh: Mesh,
    /// The edges that must not flip, each by its two vertices: first those that were locked before, then the
    /// constraints. A constraint through vertices is several edges.
    pub locked_edges: Vec<[u32; 2]>,
    /// The flips that brought them in.
    pub flips: u64,
    /// The constraints that were left out, in ascending order.
    pub left_out: Vec<LeftOut>,
}

/// A constraint that was left out.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub struct LeftOut {
    /// Its index in the list of constraints.
    pub index: usize,
    /// A sentence that says why, with the vertices and what it crosses.
    pub reason: String,
}

/// Brings `constraints` in, one after another, each an edge between two vertices. A vertex on a constraint splits it.
/// Constraints may repeat, overlap, and be edges already. `locked_edges` are edges that must not flip, as in
/// [`crate::Options`].
///
/// A constraint is an error, or left out if `skips`, if it crosses an earlier constraint, a locked edge, a boundary edge
/// or a frozen edge, if it leaves the mesh, or if it crosses triangles that are not positive.
///
/// # Errors
/// [`Error::Option`] for a mesh in space, for a vertex that does not exist, for a constraint that cannot be brought in,
/// and for a locked edge that the mesh does not have.
pub fn constrained(
    mesh: &Mesh,
    constraints: &[[u32; 2]],
    locked_edges: &[[u32; 2]],
    skips: bool,
) -> Result<Constrained, Error> {
    let refuse = |message| Err(Error::Option { option: "constraints", message });
    if mesh.dimension() == Dimension::Three {
        return refuse("constraints need a mesh in the plane; lock edges of a surface instead".to_owned());
    }
    let vertices = mesh.vertex_count();
    if let Some(index) = constraints.iter().position(|ends| ends.iter().any(|&v| v as usize >= vertices)) {
        let [u, v] = constraints[index];
        let message = format!("constraint {index} joins {u} and {v}; the mesh has {vertices} vertices");
        return refuse(message);
    }
    let mut state = State::new(mesh, &half_edges(mesh, locked_edges)?);
    let mut edges = locked_edges.to_vec();
    let mut origins = HashMap::new();
    let mut left_out = Vec::new();
    for (index, &ends) in constraints.iter().enumerate() {
        match state.parts(ends) {
            Ok(parts) => {
                for Part { ends, way } in parts {
                    let h = match way {
                        Way::Edge(h) => h,
                        Way::Across { half_edges, sign } => state.bring_in(ends, half_edges, sign),
                    };
                    state.lock(h);
                    edges.push(ends);
                    origins.entry(ordered(ends)).or_insert(index);
                }
            }
            Err(obstacle) => {
                let [u, v] = ends;
                let what = what(&state, constraints, &origins, obstacle);
                let reason = format!("constraint {index} between {u} and {v} {what}");
                if !skips {
                    return refuse(reason);
                }
                left_out.push(LeftOut { index, reason });
            }
        }
    }
    let State { triangles, flips, .. } = state;
    Ok(Constrained { mesh: mesh.with_triangles(triangles)?, locked_edges: edges, flips, left_out })
}

fn ordered([u, v]: [u32; 2]) -> [u32; 2] {
    [u.min(v), u.max(v)]
}

/// What keeps a constraint out. `origins` has the first constraint that each edge is a part of.
fn what(
    state: &State,
    constraints: &[[u32; 2]],
    origins: &HashMap<[u32; 2], usize>,
    obstacle: Obstacle,
) -> String {
    match obstacle {
        Obstacle::Unused(vertex) => format!("ends at vertex {vertex}, which no triangle has"),
        Obstacle::SamePoint => "joins two vertices at the same point; weld them first".to_owned(),
        Obstacle::Leaves(vertex) => format!("leaves the mesh at vertex {vertex}"),
        Obstacle::Folded(triangle) => format!("crosses triangle {triangle}, which is flat or turned over"),
        Obstacle::Covered(vertex) => {
            format!("passes its end before it meets vertex {vertex}: the mesh overlaps there")
        }
        Obstacle::Border(h) => {
            let [a, b] = state.ends(h);
            format!("crosses the edge between {a} and {b}, which does not have two triangles")
        }
        Obstacle::Locked(h) => {
            let [a, b] = state.ends(h);
            match origins.get(&ordered([a, b])) {
                Some(&other) => {
                    let [c, d] = constraints[other];
                    format!("crosses constraint {other} between {c} and {d}")
                }
                None => format!("crosses the locked edge between {a} and {b}"),
            }
        }
    }
}
