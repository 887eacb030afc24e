//! Brings edges into a mesh in the plane. The triangles that they cross make way for others, by exact tests. No vertex
//! moves, and none is added.

pub(crate) mod crossings;
mod insert;
mod near;
mod rounds;
mod state;
#[cfg(test)]
mod tests;
mod walk;

use crate::error::number;
use crate::mesh::named_edges::{LeftOut, half_edges, ordered};
use crate::predicates::distance_from_segment;
use crate::system::threads::Threads;
use crate::{Dimension, Error, Mesh};
use rounds::{Done, Rounds};
use state::State;
use std::collections::HashMap;
use std::num::NonZeroUsize;
use walk::Obstacle;

/// A mesh with edges brought in.
#[derive(Clone, Debug, PartialEq)]
pub struct Constrained {
    /// The same vertices, and as many triangles.
    pub mesh: Mesh,
    /// The edges that must not flip, each by its two vertices: first those that were locked before, then the
    /// constraints. A constraint through vertices is several edges.
    pub locked_edges: Vec<[u32; 2]>,
    /// The number of edges that were locked before. The others are in the order of the constraints.
    pub locks: usize,
    /// How many edges they crossed: each made way for another one.
    pub crossed_edges: u64,
    /// The largest distance of a vertex from the constraint that goes through it; 0 without a tolerance.
    pub deviation: f64,
    /// The constraints that were left out, in ascending order.
    pub left_out: Vec<LeftOut>,
}

impl Constrained {
    /// The edges of the constraints, without those that were locked before: for [`regions`](crate::regions).
    #[must_use]
    pub fn constraint_edges(&self) -> &[[u32; 2]] {
        self.locked_edges.get(self.locks..).unwrap_or_default()
    }
}

/// Brings `constraints` in, each an edge between two vertices, with the result of one after another. A vertex on a
/// constraint splits it. Constraints may repeat, overlap, and be edges already. `locked_edges` are edges that must not
/// flip. `tolerance` and `threads` are as [`constraint_tolerance`](crate::Options::constraint_tolerance) and `threads` of
/// [`Options`](crate::Options); `threads` does not change the result.
///
/// A constraint is an error, or left out if `skips`, if it crosses an earlier constraint, a locked edge, a boundary edge
/// or a frozen edge, if it leaves the mesh, if it crosses triangles that are not positive, or if its ends are at the same
/// point.
///
/// # Errors
/// [`Error::Option`] for a mesh in space, for a tolerance that is no length, for a vertex that does not exist, for a constraint that cannot be brought in,
/// for a locked edge that the mesh does not have, and if the threads cannot be started.
pub fn constrained(
    mesh: &Mesh,
    constraints: &[[u32; 2]],
    locked_edges: &[[u32; 2]],
    skips: bool,
    tolerance: f64,
    threads: Option<NonZeroUsize>,
) -> Result<Constrained, Error> {
    check_constraints(mesh, constraints)?;
    check_tolerance(tolerance)?;
    let threads = Threads::new(threads, mesh.triangle_count())?;
    let locked = half_edges(mesh, locked_edges)?;
    let run = || {
        let state = State::new(mesh, &locked, &threads);
        let mut work = Work {
            directed: directed(&state, constraints),
            state,
            constraints,
            origins: HashMap::new(),
            edges: Vec::new(),
            crossed_edges: 0,
            left_out: Vec::new(),
        };
        let rounds = Rounds::new(constraints.len(), threads.clone());
        if tolerance > 0.0 {
            work.run_near(rounds, skips, tolerance);
        } else {
            work.run(rounds, skips);
        }
        let Work { state, edges, crossed_edges, left_out, .. } = work;
        (state.triangles, edges, crossed_edges, left_out)
    };
    let (triangles, mut edges, crossed_edges, mut left_out) = threads.enter(run);
    left_out.sort_by_key(|left| left.index);
    if let Some(LeftOut { reason, .. }) = left_out.first().filter(|_| !skips) {
        return Err(refused(reason.clone()));
    }
    edges.sort_by_key(|&(index, _)| index);
    let deviation = if tolerance > 0.0 { deviation(mesh, constraints, &edges, tolerance) } else { 0.0 };
    let edges = edges.into_iter().map(|(_, ends)| ends);
    let locks = locked_edges.len();
    let locked_edges = locked_edges.iter().copied().chain(edges).collect();
    Ok(Constrained { mesh: mesh.flipped(triangles), locked_edges, locks, crossed_edges, deviation, left_out })
}

/// # Errors
/// [`Error::Option`] for a mesh in space, and for a vertex that does not exist.
fn check_constraints(mesh: &Mesh, constraints: &[[u32; 2]]) -> Result<(), Error> {
    if mesh.dimension() == Dimension::Three {
        return Err(refused(
            "constraints need a mesh of dimension 2; edges of a surface can only be locked; a terrain needs plane".to_owned(),
        ));
    }
    let vertices = mesh.vertex_count();
    if let Some(index) = constraints.iter().position(|ends| ends.iter().any(|&v| v as usize >= vertices)) {
        let [u, v] = constraints[index];
        let message = format!("constraint {index} joins {u} and {v}; the mesh has {vertices} vertices");
        return Err(refused(message));
    }
    Ok(())
}

/// # Errors
/// [`Error::Option`] for a number that is no length.
pub(crate) fn check_tolerance(tolerance: f64) -> Result<(), Error> {
    if (0.0..f64::INFINITY).contains(&tolerance) {
        return Ok(());
    }
    let message = format!("{} is not a length: give 0 or more", number(tolerance));
    Err(Error::Option { option: "constraint_tolerance", message })
}

/// The largest distance of a vertex from the constraint that goes through it, or `most` where f64 cannot hold it. `edges`
/// have the indices of their constraints.
fn deviation(mesh: &Mesh, constraints: &[[u32; 2]], edges: &[(usize, [u32; 2])], most: f64) -> f64 {
    let distance = |&(index, [_, to]): &(usize, [u32; 2])| {
        let line = constraints[index].map(|v| mesh.point2(v));
        distance_from_segment(line, mesh.point2(to)).unwrap_or(most)
    };
    edges.iter().map(distance).fold(0.0, f64::max)
}

fn refused(message: String) -> Error {
    Error::Option { option: "constraints", message }
}

/// Each constraint from the end where fewer triangles and constraints meet: a walk begins with a search among the
/// triangles of its first vertex.
fn directed(state: &State, constraints: &[[u32; 2]]) -> Vec<[u32; 2]> {
    let mut met: Vec<u32> = (0..state.mesh.vertex_count() as u32).map(|v| state.degree(v)).collect();
    constraints.as_flattened().iter().for_each(|&v| met[v as usize] += 1);
    let direct = |&[u, v]: &[u32; 2]| if met[v as usize] < met[u as usize] { [v, u] } else { [u, v] };
    constraints.iter().map(direct).collect()
}

/// Constraints that come in.
struct Work<'a> {
    state: State<'a>,
    constraints: &'a [[u32; 2]],
    /// The constraints as they are walked.
    directed: Vec<[u32; 2]>,
    /// The first constraint that each edge is a part of.
    origins: HashMap<[u32; 2], usize>,
    /// The edges of the constraints, with their indices.
    edges: Vec<(usize, [u32; 2])>,
    /// The number of edges that they crossed.
    crossed_edges: u64,
    left_out: Vec<LeftOut>,
}

impl Work<'_> {
    /// Brings all in, or those before the first obstacle.
    fn run(&mut self, mut rounds: Rounds, skips: bool) {
        while let Some(round) = rounds.next(&mut self.state, &self.directed) {
            for done in round {
                let index = done.index;
                if !self.take(done) && !skips {
                    rounds.end_at(index);
                }
            }
        }
    }

    /// The same, each through the vertices near it.
    fn run_near(&mut self, rounds: Rounds, skips: bool, tolerance: f64) {
        for index in 0..self.directed.len() {
            let chain = self.state.chain(self.directed[index], tolerance);
            let done = rounds.bring_in_chain(&mut self.state, index, &chain);
            if !self.take(done) && !skips {
                return;
            }
        }
    }

    /// Notes what became of a constraint. Returns whether it came in.
    fn take(&mut self, Done { index, edges, crossed }: Done) -> bool {
        self.crossed_edges += crossed as u64;
        match edges {
            Ok(edges) => {
                self.lock(index, edges);
                true
            }
            Err(obstacle) => {
                let [u, v] = self.constraints[index];
                let reason = format!("constraint {index} between {u} and {v} {}", self.what(obstacle));
                self.left_out.push(LeftOut { index, reason });
                false
            }
        }
    }

    fn lock(&mut self, index: usize, mut edges: Vec<([u32; 2], u32)>) {
        if self.directed[index] != self.constraints[index] {
            edges.reverse();
            edges.iter_mut().for_each(|(ends, _)| ends.reverse());
        }
        for (ends, h) in edges {
            self.state.lock(h);
            self.edges.push((index, ends));
            let origin = self.origins.entry(ordered(ends)).or_insert(index);
            *origin = index.min(*origin);
        }
    }

    /// What keeps a constraint out.
    fn what(&self, obstacle: Obstacle) -> String {
        if let Obstacle::Locked(h) = obstacle
            && let Some(&other) = self.origins.get(&ordered(self.state.ends(h)))
        {
            let [c, d] = self.constraints[other];
            return format!("crosses constraint {other} between {c} and {d}");
        }
        obstacle.text(&|h| self.state.ends(h))
    }
}
