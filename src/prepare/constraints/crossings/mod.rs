//! Brings lines in that cross each other: a new vertex where two of them cross.
//!
//! One line comes in after another. It is followed as it was given, straight from its first end to its second. What it
//! leaves behind is its chain: edges that are locked. Where it meets a locked edge a-b of earlier chains, the crossing of
//! the two lines as they were given is rounded once, to a point p. Then one of these happens, and no chain passes a vertex
//! on the wrong side:
//!
//! - p is a or b: the lines meet there.
//! - p is on a-b, or before it in one of the triangles that the line has crossed since its last vertex, and nothing is in
//!   the triangle (a, b, p): p becomes a vertex, or is one, and the chains of a-b go a-p-b.
//! - p is behind a-b. If nothing is in the triangle (a, b, p), p becomes a vertex, flips make a-p and p-b edges, and the
//!   chains of a-b go a-p-b. A vertex at p serves as well. If another vertex q is in the triangle, the chains of a-b go
//!   a-q-b, and the line goes on across one of the two. If an edge of chains is between, and has nothing between itself
//!   and p, these chains go through p first, or through the vertex that is between.
//!
//! If p is not right at a-b, or something is in the way, its neighbours and the corners of the two triangles at a-b are
//! tried too: first those with which the lines stay within two units in the last place and do not turn back, then those
//! with which they stay nearest to where they were given. That choice is the only one that rounded numbers make. The lines
//! can always meet at a or at b. Before a line that crosses others begins, flips make the triangles at it Delaunay, so
//! that these corners are near.
//!
//! The chain of the line comes to the new vertex by the shortest path between the ends of the edges that the line has
//! crossed since its last vertex. So it touches vertices that rounding would put on its other side.
//!
//! Why this ends. Triangles change behind the line and at the edge that it meets, but for flips of edges that are not
//! locked; so the locked edges ahead that it crosses stay. It crosses each of them in one point, and these points follow
//! each other along the line.
//!
//! - Let n be the number of locked edges that the line crosses when it begins. Chains that are led through a vertex cross
//!   the line as often as before: the line enters the triangle (a, b, q) through a-b and leaves it through a-q or q-b; and
//!   the chains of an edge that it does not cross are never led across it. When the line has met one of these edges at a
//!   vertex, one edge less is ahead. Each meeting tries at most 14 points, so a line adds at most 14 n vertices.
//! - Between two of them, chains are led through vertices that exist. With q, the point where the line crosses them moves
//!   on along the line; each edge joins two of finitely many vertices, and has one such point.
//! - Each search for p at one edge ends: whenever chains are led through a vertex in the triangle of their edge and p, the
//!   two new triangles lie in the old one and do not have that vertex inside.
//! - Between two locked edges, the line goes straight through triangles, of which there are finitely many.
//!
//! All this holds where the triangles at the line do not overlap. Elsewhere a step may find something else than it should,
//! which is an error.

mod chains;
mod meeting;
mod net;
mod reach;
mod splitter;
mod straight;
mod taut;

use super::walk::Obstacle;
use crate::mesh::named_edges::{LeftOut, half_edges, ordered};
use crate::predicates::distance_from_segment;
use crate::system::memory;
use crate::{Dimension, Error, Mesh, Plane, Positions};
use chains::Chains;
use net::Net;
use splitter::Splitter;

/// A mesh with lines brought in, and a vertex where two of them cross.
#[derive(Clone, Debug, PartialEq)]
pub struct SplitCrossings {
    /// The mesh: its vertices, and the new ones after them.
    pub mesh: Mesh,
    /// For each constraint, the vertices of its path of edges from its first end to its second. Empty if it was left out.
    /// Of lines that are nearly parallel, a chain may come to a vertex twice: only so it passes others on the right side.
    pub chains: Vec<Vec<u32>>,
    /// The new vertices, in their order.
    pub crossings: Vec<Crossing>,
    /// The largest distance of a chain from the line between the ends of its constraint. It is about what one coordinate
    /// is rounded by, unless vertices are so near to each other that the lines had to go around them.
    pub deviation: f64,
    /// The constraints that were left out, in ascending order.
    pub left_out: Vec<LeftOut>,
}

/// A new vertex.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// The indices of the two constraints that cross there, the earlier one first.
    pub constraints: [usize; 2],
    /// Two vertices of the mesh: those before and after it on the chain of the first constraint that passes it. What they
    /// have, such as heights, is interpolated between them.
    pub between: [u32; 2],
    /// How far the vertex is from the first of these to the second: 0 to 1.
    pub at: f64,
}

impl SplitCrossings {
    /// The edges of all chains, each once, for [`Options::locked_edges`](crate::Options::locked_edges).
    #[must_use]
    pub fn constraint_edges(&self) -> Vec<[u32; 2]> {
        let pairs = self.chains.iter().flat_map(|chain| chain.windows(2));
        let mut edges: Vec<[u32; 2]> = pairs.map(|pair| ordered([pair[0], pair[1]])).collect();
        edges.sort_unstable();
        edges.dedup();
        edges
    }

    /// Numbers of the vertices, `width` for each, with those of the new vertices: interpolated between two vertices of the
    /// mesh, as [`Crossing::between`] says.
    #[must_use]
    pub fn interpolated(&self, numbers: &[f64], width: usize) -> Vec<f64> {
        let mut all = numbers.to_vec();
        for &Crossing { between, at, .. } in &self.crossings {
            for i in 0..width {
                let [x, y] =
                    between.map(|v| numbers.get(v as usize * width + i).copied().unwrap_or(f64::NAN));
                all.push(x + at * (y - x));
            }
        }
        all
    }

    /// The terrain with these triangles, if [`mesh`](SplitCrossings::mesh) is its [plan](Mesh::plan): a new vertex has a
    /// height between those of two vertices, as [`Crossing::between`] says. A mesh in the plane stays.
    ///
    /// # Errors
    /// Those of [`Mesh::new`].
    pub fn lifted(&self, surface: &Mesh, plane: Plane) -> Result<Mesh, Error> {
        if surface.dimension() == Dimension::Two {
            return Ok(self.mesh.clone());
        }
        let numbers: Vec<f64> = surface.positions().iter().collect();
        let mut all = self.interpolated(&numbers, 3);
        for (i, point) in (surface.vertex_count() as u32..).zip(all[numbers.len()..].as_chunks_mut::<3>().0) {
            let [u, v] = plane.axes();
            [point[u], point[v]] = self.mesh.point2(i).to_array();
        }
        let positions = match surface.positions() {
            Positions::F32(_) if !self.mesh.positions().is_double() => {
                Positions::F32(all.into_iter().map(|x| x as f32).collect())
            }
            _ => Positions::F64(all),
        };
        Mesh::new(Dimension::Three, positions, self.mesh.triangles().to_vec())
    }
}

/// Brings `constraints` in, each an edge between two vertices, as [`constrained`](crate::constrained) does, but adds a
/// vertex where two of them cross: at the exact crossing, rounded to 32-bit floats if the mesh has such, else to 64-bit
/// floats. Both lines go on through it. Where rounding would put another vertex on the wrong side of a line, the line
/// goes through that vertex; [`SplitCrossings::deviation`] says how far a line had to go. The result depends on the order
/// of the constraints.
///
/// `locked_edges` are edges that must not change; a constraint that crosses one is an error, or left out if `skips`. So is
/// one that leaves the mesh, crosses its boundary or a frozen edge, or crosses triangles that are not positive.
///
/// ```
/// use edgeflip::{Dimension, Mesh, split_crossings};
///
/// // Both diagonals of a square.
/// let mesh = Mesh::new(Dimension::Two, vec![0.0, 0.0, 2.0, 0.0, 2.0, 2.0, 0.0, 2.0], vec![0, 1, 2, 0, 2, 3])?;
/// let split = split_crossings(&mesh, &[[0, 2], [1, 3]], &[], false)?;
/// assert_eq!(split.chains, [[0, 4, 2], [1, 4, 3]]);
/// assert_eq!((split.mesh.triangle_count(), split.crossings[0].constraints, split.deviation), (4, [0, 1], 0.0));
/// # Ok::<(), edgeflip::Error>(())
/// ```
///
/// # Errors
/// [`Error::Option`] for a mesh in space, for a vertex that does not exist, for a constraint that cannot be brought in, and
/// for a locked edge that the mesh does not have; [`Error::OutOfMemory`]; [`Error::TooLarge`].
pub fn split_crossings(
    mesh: &Mesh,
    constraints: &[[u32; 2]],
    locked_edges: &[[u32; 2]],
    skips: bool,
) -> Result<SplitCrossings, Error> {
    split_in(mesh, constraints, locked_edges, skips, mesh.positions().is_double())
}

/// As [`split_crossings`]; `is_double`: whether crossings are rounded to 64-bit floats.
pub(crate) fn split_in(
    mesh: &Mesh,
    constraints: &[[u32; 2]],
    locked_edges: &[[u32; 2]],
    skips: bool,
    is_double: bool,
) -> Result<SplitCrossings, Error> {
    super::check_constraints(mesh, constraints)?;
    // The mesh, twins, corners and chains, and the marks of the vertices in the end.
    memory::check(3 * mesh.bytes() + 40 * mesh.vertex_count() as u64 + 100 * constraints.len() as u64)?;
    let locked = half_edges(mesh, locked_edges)?;
    let positions = match mesh.positions() {
        Positions::F32(numbers) if is_double => Positions::F64(numbers.iter().map(|&x| x.into()).collect()),
        positions => positions.clone(),
    };
    let net = Net::new(mesh, positions, &locked);
    let fixed: Vec<[u32; 2]> = locked.iter().map(|&h| net.ends(h)).collect();
    let chains = Chains::new(constraints.len(), fixed.into_iter());
    let directed = directed(&net, constraints);
    let mut splitter = Splitter::new(net, chains, constraints.to_vec());
    let mut left_out = Vec::new();
    for (index, &ends) in directed.iter().enumerate() {
        if let Err(obstacle) = splitter.bring_in(index as u32, ends)? {
            let reason = reason(&splitter.net, index, constraints[index], obstacle);
            if !skips {
                return Err(Error::Option { option: "constraints", message: reason });
            }
            left_out.push(LeftOut { index, reason });
        }
    }
    let Splitter { net, chains, crossings, .. } = splitter;
    if net.has_doubled() {
        let message = "they need an edge that the mesh has elsewhere: it overlaps itself there".to_owned();
        return Err(Error::Option { option: "constraints", message });
    }
    let paths = constraints.iter().enumerate().map(|(line, [from, _])| {
        let mut path = chains.path(line, |v| net.original(v));
        if path.first() != Some(from) {
            path.reverse();
        }
        path
    });
    let chains: Vec<Vec<u32>> = paths.collect();
    let (positions, triangles) = net.into_parts();
    let split = Mesh::new(Dimension::Two, positions, triangles)?;
    let crossings = placed(mesh, &split, constraints, &chains, crossings);
    let deviation = deviation(&split, constraints, &chains);
    Ok(SplitCrossings { mesh: split, chains, crossings, deviation, left_out })
}

/// Each constraint from the end where fewer triangles and constraints meet: to begin there is a search among the triangles
/// of that vertex.
fn directed(net: &Net, constraints: &[[u32; 2]]) -> Vec<[u32; 2]> {
    let mut met = vec![0u32; net.given as usize];
    let ends = net.triangles.iter().map(|&v| net.original(v));
    ends.chain(constraints.as_flattened().iter().copied()).for_each(|v| met[v as usize] += 1);
    let direct = |&[u, v]: &[u32; 2]| if met[v as usize] < met[u as usize] { [v, u] } else { [u, v] };
    constraints.iter().map(direct).collect()
}

/// The sentence about a constraint that was left out.
fn reason(net: &Net, index: usize, [u, v]: [u32; 2], obstacle: Obstacle) -> String {
    let obstacle = match obstacle {
        Obstacle::Leaves(vertex) => Obstacle::Leaves(net.original(vertex)),
        Obstacle::Covered(vertex) => Obstacle::Covered(net.original(vertex)),
        Obstacle::Unused(vertex) => Obstacle::Unused(net.original(vertex)),
        other => other,
    };
    let what = obstacle.text(&|h| net.ends(h).map(|v| net.original(v)));
    format!("constraint {index} between {u} and {v} {what}")
}

/// The new vertices, with what they are interpolated between.
fn placed(
    mesh: &Mesh,
    split: &Mesh,
    constraints: &[[u32; 2]],
    chains: &[Vec<u32>],
    crossings: Vec<[u32; 2]>,
) -> Vec<Crossing> {
    let given = mesh.vertex_count() as u32;
    let mut between: Vec<[u32; 2]> = crossings.iter().map(|&[line, _]| constraints[line as usize]).collect();
    let mut is_placed = vec![false; crossings.len()];
    for chain in chains {
        let (mut before, mut new) = (None, Vec::new());
        for &v in chain {
            if v >= given {
                new.push((v - given) as usize);
                continue;
            }
            if let Some(before) = before {
                for i in new.drain(..) {
                    if !is_placed[i] {
                        (between[i], is_placed[i]) = ([before, v], true);
                    }
                }
            }
            before = Some(v);
        }
    }
    let crossing = |(i, lines): (usize, [u32; 2])| {
        let [p, q] = between[i].map(|v| split.point2(v));
        let along = q - p;
        let at = (split.point2(given + i as u32) - p).dot(along) / along.length_squared();
        let [first, second] = [lines[0].min(lines[1]), lines[0].max(lines[1])].map(|line| line as usize);
        let at = if at.is_finite() { at.clamp(0.0, 1.0) } else { 0.5 };
        Crossing { constraints: [first, second], between: between[i], at }
    };
    crossings.into_iter().enumerate().map(crossing).collect()
}

/// The largest distance of a chain from its constraint.
fn deviation(mesh: &Mesh, constraints: &[[u32; 2]], chains: &[Vec<u32>]) -> f64 {
    let mut largest: f64 = 0.0;
    for (ends, chain) in constraints.iter().zip(chains) {
        let ends = ends.map(|v| mesh.point2(v));
        for &v in chain {
            let point = mesh.point2(v);
            let rough = || (ends[1] - ends[0]).perp_dot(point - ends[0]).abs() / ends[0].distance(ends[1]);
            largest = largest.max(distance_from_segment(ends, point).unwrap_or_else(rough));
        }
    }
    largest
}
