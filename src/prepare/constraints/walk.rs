//! Follows a constraint through the mesh, before anything flips.

use super::state::State;
use crate::NONE;
use crate::mesh::half_edge::{next, prev};
use std::cmp::Ordering;

/// A part of a constraint between two vertices on it, without a vertex between them.
pub(super) struct Part {
    pub(super) ends: [u32; 2],
    pub(super) way: Way,
}

/// How a part lies in the mesh.
pub(super) enum Way {
    /// It is the edge of this half-edge.
    Edge(u32),
    /// It crosses the edges of these half-edges. They are in the order from its first end to its second, and each
    /// belongs to the triangle that the part leaves.
    Across {
        half_edges: Vec<u32>,
        /// The sign of all triangles that it crosses.
        sign: Ordering,
    },
}

/// Why a constraint cannot be brought in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Obstacle {
    /// No triangle has this vertex.
    Unused(u32),
    /// Both ends are at the same point.
    SamePoint,
    /// It leaves the mesh at this vertex.
    Leaves(u32),
    /// It crosses the edge of this half-edge, which has one triangle, or is frozen.
    Border(u32),
    /// It crosses the edge of this half-edge, which is locked.
    Locked(u32),
    /// It crosses this triangle, which is flat, or of the other winding than the triangle before it.
    Folded(u32),
    /// An edge of the mesh, or a triangle, covers its second end without having it as a vertex. The number is a vertex
    /// behind the second end.
    Covered(u32),
}

impl State<'_> {
    /// The parts of a constraint.
    pub(super) fn parts(&self, [from, to]: [u32; 2]) -> Result<Vec<Part>, Obstacle> {
        let mut parts = Vec::new();
        let mut at = from;
        while at != to {
            let part = self.first_part(at, to)?;
            at = part.ends[1];
            parts.push(part);
        }
        Ok(parts)
    }

    /// The part of the constraint from `at` to `to` that starts at `at`.
    fn first_part(&self, at: u32, to: u32) -> Result<Part, Obstacle> {
        if self.mesh().point2(at) == self.mesh().point2(to) {
            return Err(Obstacle::SamePoint);
        }
        let side = |v: u32| self.sign([at, to, v]);
        let mut is_used = false;
        let mut start = None;
        for corner in self.star(at) {
            is_used = true;
            let [x, y] = [next(corner), prev(corner)].map(|x| self.vertex(x));
            for (v, h) in [(x, corner), (y, prev(corner))] {
                if self.is_passed(v, at, to)? {
                    return Ok(Part { ends: [at, v], way: Way::Edge(h) });
                }
            }
            let sign = self.sign([at, x, y]);
            if sign.is_ne() && side(x) == sign.reverse() && side(y) == sign {
                start = Some((next(corner), sign));
            }
        }
        if !is_used || self.star(to).next().is_none() {
            return Err(Obstacle::Unused(if is_used { to } else { at }));
        }
        let (mut h, sign) = start.ok_or(Obstacle::Leaves(at))?;
        let mut half_edges = Vec::new();
        loop {
            if self.twin(h) == NONE {
                return Err(Obstacle::Border(h));
            }
            if self.is_locked(h) {
                return Err(Obstacle::Locked(h));
            }
            half_edges.push(h);
            let g = self.twin(h);
            let far = self.vertex(prev(g));
            if self.sign([g, next(g), prev(g)].map(|x| self.vertex(x))) != sign {
                return Err(Obstacle::Folded(g / 3));
            }
            if self.is_passed(far, at, to)? {
                return Ok(Part { ends: [at, far], way: Way::Across { half_edges, sign } });
            }
            h = if side(far) == sign { next(g) } else { prev(g) };
        }
    }

    /// Whether the constraint from `at` to `to` passes or reaches the vertex `v` behind `at`.
    fn is_passed(&self, v: u32, at: u32, to: u32) -> Result<bool, Obstacle> {
        if v == to {
            return Ok(true);
        }
        if self.sign([at, to, v]).is_ne() {
            return Ok(false);
        }
        let [from, end, point] = [at, to, v].map(|v| self.mesh().point2(v).to_array());
        // On one line, one coordinate that differs decides.
        let axis = usize::from(from[0] == end[0]);
        let order = |x: f64, y: f64| x.partial_cmp(&y).unwrap_or(Ordering::Equal);
        let ahead = order(end[axis], from[axis]);
        if order(point[axis], from[axis]) != ahead {
            return Ok(false);
        }
        if order(end[axis], point[axis]) == ahead { Ok(true) } else { Err(Obstacle::Covered(v)) }
    }
}
