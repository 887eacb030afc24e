//! Follows the straight line between two vertices through the triangles.

use super::net::Net;
use crate::NONE;
use crate::mesh::half_edge::{next, prev};
use crate::predicates::area_sign;
use crate::prepare::constraints::walk::{Obstacle, is_between};
use std::cmp::Ordering;

/// A part of a line between two vertices on it, without a vertex between them.
pub(super) struct Part {
    pub(super) ends: [u32; 2],
    pub(super) way: Way,
}

/// How a part lies in the triangulation.
pub(super) enum Way {
    /// It is the edge of this half-edge.
    Edge(u32),
    /// It crosses the edges of these half-edges, each of the triangle that it leaves. All these triangles have this sign.
    Across(Vec<u32>, Ordering),
}

/// How a line goes on from a vertex on it.
pub(super) enum Start {
    /// Along the edge of this half-edge to the second vertex.
    Edge(u32, [u32; 2]),
    /// From this vertex through a triangle of this sign, which it leaves through the edge of this half-edge.
    Triangle(u32, u32, Ordering),
}

impl Net {
    /// The parts of the line between two vertices, and whether it crosses locked edges. `may_cross` has the vertices of a
    /// locked edge.
    ///
    /// # Errors
    /// What is in the way.
    pub(super) fn straight(
        &self,
        [from, to]: [u32; 2],
        may_cross: impl Fn([u32; 2]) -> bool,
    ) -> Result<(Vec<Part>, bool), Obstacle> {
        let (mut parts, mut crosses, mut at) = (Vec::new(), false, from);
        while !self.is_same(at, to) {
            let (mut h, start, sign) = match self.start([at, to])? {
                Start::Edge(h, ends) => {
                    parts.push(Part { ends, way: Way::Edge(h) });
                    at = ends[1];
                    continue;
                }
                Start::Triangle(h, start, sign) => (h, start, sign),
            };
            let mut half_edges = Vec::new();
            at = loop {
                // Where the mesh overlaps, the line may have passed its end.
                let stopped = |obstacle| {
                    let [x, y] = self.ends(h).map(|v| self.point(v));
                    let is_ahead = area_sign(x, y, self.point(to)) == sign.reverse();
                    Err(if is_ahead { obstacle } else { Obstacle::Covered(to) })
                };
                let g = self.twin(h);
                if g == NONE {
                    return stopped(Obstacle::Border(h));
                }
                if self.is_locked(h) {
                    if !may_cross(self.ends(h)) {
                        return stopped(Obstacle::Locked(h));
                    }
                    crosses = true;
                }
                half_edges.push(h);
                let far = self.apex(g);
                let [x, y] = self.ends(g);
                let [p, q, r, from, end] = self.points([x, y, far, at, to]);
                if !self.is_embedded(far) && area_sign(p, q, r) != sign {
                    return stopped(Obstacle::Folded(g / 3));
                }
                let side = area_sign(from, end, r);
                if self.is_passed(far, side, [at, to])? {
                    break far;
                }
                h = if side == sign { next(g) } else { prev(g) };
            };
            parts.push(Part { ends: [start, at], way: Way::Across(half_edges, sign) });
        }
        Ok((parts, crosses))
    }

    /// How the line between two vertices begins.
    ///
    /// # Errors
    /// What is in the way.
    pub(super) fn start(&self, [at, to]: [u32; 2]) -> Result<Start, Obstacle> {
        if self.point(at) == self.point(to) {
            return Err(Obstacle::SamePoint);
        }
        if let Some(unused) = [at, to].into_iter().find(|&v| !self.is_used(v)) {
            return Err(Obstacle::Unused(unused));
        }
        let [from, end] = self.points([at, to]);
        let mut obstacle = Obstacle::Leaves(at);
        // Two triangles have each vertex around this one.
        let mut known = (NONE, Ordering::Equal);
        for copy in self.all(self.original(at)) {
            for corner in self.star(copy) {
                let [x, y] = [self.vertex(next(corner)), self.vertex(prev(corner))];
                let [p, q] = self.points([x, y]);
                let first = if x == known.0 { known.1 } else { area_sign(from, end, p) };
                let sides = [first, area_sign(from, end, q)];
                known = (y, sides[1]);
                for (v, side, h) in [(x, sides[0], corner), (y, sides[1], prev(corner))] {
                    match self.is_passed(v, side, [at, to]) {
                        Ok(true) => return Ok(Start::Edge(h, [copy, v])),
                        Ok(false) => {}
                        Err(covered) => obstacle = covered,
                    }
                }
                if sides[0].is_ne() && sides[0] == sides[1].reverse() && area_sign(from, p, q) == sides[1] {
                    return Ok(Start::Triangle(next(corner), copy, sides[1]));
                }
            }
        }
        Err(obstacle)
    }

    pub(super) fn is_same(&self, u: u32, v: u32) -> bool {
        self.original(u) == self.original(v)
    }

    /// Whether the line from `at` to `to` passes or reaches the vertex `v`, which lies on `side`, behind `at`.
    fn is_passed(&self, v: u32, side: Ordering, [at, to]: [u32; 2]) -> Result<bool, Obstacle> {
        if self.is_same(v, to) {
            return Ok(true);
        }
        is_between(self.points([at, to, v]), side).ok_or(Obstacle::Covered(to))
    }
}
