//! Follows a constraint through the mesh, before anything changes.

use super::state::State;
use crate::NONE;
use crate::mesh::half_edge::{next, prev};
use crate::mesh::named_edges::ordered;
use glam::DVec2;
use std::cmp::Ordering;
use std::collections::HashSet;

/// A part of a constraint between two vertices on it, without a vertex between them.
pub(super) struct Part {
    pub(super) ends: [u32; 2],
    pub(super) way: Way,
}

/// How a part lies in the mesh.
pub(super) enum Way {
    /// It is the edge of this half-edge.
    Edge(u32),
    /// It crosses the triangles of a region.
    Across(Region),
}

/// The triangles that a part crosses.
pub(super) struct Region {
    pub(super) triangles: Vec<u32>,
    /// The half-edges around them: those on the right of the part from its first end to its second, then those on the left
    /// back to the first.
    pub(super) sides: Vec<u32>,
    /// The number of the side that starts at the second end.
    pub(super) second: usize,
    /// The sign of all its triangles, and of a triangle of the part and a vertex on its left.
    pub(super) sign: Ordering,
}

impl Region {
    /// The triangles of a part that crosses the edges of these half-edges, at least one. They are in the order from its
    /// first end to its second, and each belongs to the triangle that the part leaves.
    pub(super) fn across(half_edges: &[u32], twin: impl Fn(u32) -> u32, sign: Ordering) -> Self {
        let (mut triangles, mut right, mut left) = (Vec::new(), Vec::new(), Vec::new());
        if let Some(&h) = half_edges.first() {
            triangles.push(h / 3);
            right.push(prev(h));
            left.push(next(h));
        }
        for (i, &h) in (1..).zip(half_edges) {
            let g = twin(h);
            triangles.push(g / 3);
            let after = half_edges.get(i);
            if after != Some(&next(g)) {
                right.push(next(g));
            }
            if after != Some(&prev(g)) {
                left.push(prev(g));
            }
        }
        let second = right.len();
        let sides = right.into_iter().chain(left.into_iter().rev()).collect();
        Self { triangles, sides, second, sign }
    }
}

/// A constraint in the present mesh.
pub(super) struct Walk {
    pub(super) parts: Result<Vec<Part>, Obstacle>,
    /// The triangles that it crosses, up to the obstacle.
    pub(super) crossed: Vec<u32>,
    /// The triangles around its vertices, up to the obstacle.
    pub(super) around: Vec<u32>,
    /// Its ends, and the vertices that it passes or whose edges it crosses, as far as their stars are not known to be
    /// embedded. Up to the obstacle, perhaps repeated.
    pub(super) suspects: Vec<u32>,
    /// If there are suspects and the constraint crosses triangles: the edges between suspects. It must not make such an
    /// edge again.
    pub(super) known: Option<HashSet<[u32; 2]>>,
}

/// Why a constraint cannot be brought in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Obstacle {
    /// No triangle has this vertex.
    Unused(u32),
    /// Both ends are the same vertex.
    SameVertex,
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
    /// It comes to the point of this vertex, its second end, in triangles that do not have the vertex.
    Covered(u32),
    /// It would come in with this edge, which the mesh has elsewhere.
    Doubled([u32; 2]),
}

impl Obstacle {
    /// What it keeps a constraint from, as the end of a sentence. `ends` has the vertices of a half-edge.
    pub(super) fn text(self, ends: &dyn Fn(u32) -> [u32; 2]) -> String {
        match self {
            Self::Unused(vertex) => {
                format!("ends at vertex {vertex}, which no triangle has; weld it if another vertex is there")
            }
            Self::SameVertex => "joins a vertex to itself; remove it from the list".to_owned(),
            Self::SamePoint => "joins two vertices at the same point; weld them first".to_owned(),
            Self::Leaves(vertex) => format!("leaves the mesh at vertex {vertex}"),
            Self::Folded(triangle) => {
                format!("crosses triangle {triangle}, which is flat or turned over; untangle may mend that")
            }
            Self::Covered(vertex) => {
                format!(
                    "reaches the point of vertex {vertex} in triangles without it: another vertex has that point, or \
                     triangles overlap there; untangle may mend that"
                )
            }
            Self::Doubled([a, b]) => {
                format!("needs an edge between {a} and {b}, which the mesh has elsewhere: it overlaps there")
            }
            Self::Border(h) => {
                let [a, b] = ends(h);
                format!("crosses the edge between {a} and {b}, which does not have two triangles")
            }
            Self::Locked(h) => {
                let [a, b] = ends(h);
                format!("crosses the locked edge between {a} and {b}")
            }
        }
    }
}

impl Walk {
    fn check(&self, most: usize) -> Result<(), Option<Obstacle>> {
        if self.crossed.len() + self.around.len() > most { Err(None) } else { Ok(()) }
    }
}

impl State<'_> {
    /// Follows a constraint through the mesh. Whatever the order of the triangles around a vertex, the result is the
    /// same. `None` if it would meet more than `most` triangles.
    pub(super) fn walk(&self, [from, to]: [u32; 2], most: usize) -> Option<Walk> {
        let mut walk = Walk {
            parts: if from == to { Err(Obstacle::SameVertex) } else { Ok(Vec::new()) },
            crossed: Vec::new(),
            around: Vec::new(),
            suspects: Vec::new(),
            known: None,
        };
        let mut at = from;
        while at != to {
            match self.first_part([at, to], &mut walk, most) {
                Ok(part) => {
                    at = part.ends[1];
                    walk.parts.as_mut().ok()?.push(part);
                }
                Err(obstacle) => {
                    walk.parts = Err(obstacle?);
                    return Some(walk);
                }
            }
        }
        self.find_known(&mut walk);
        walk.check(most).is_ok().then_some(walk)
    }

    /// Finds the edges between suspects, if the constraint crosses triangles.
    fn find_known(&self, walk: &mut Walk) {
        let Walk { parts, suspects, known, around, .. } = walk;
        suspects.sort_unstable();
        suspects.dedup();
        let is_across = |part: &Part| matches!(part.way, Way::Across(_));
        if !suspects.is_empty() && parts.as_ref().is_ok_and(|parts| parts.iter().any(is_across)) {
            let known = known.insert(HashSet::new());
            // Each edge is found at both ends, so the largest star need not be searched.
            let largest = suspects.iter().copied().max_by_key(|&v| self.degree(v));
            for &v in suspects.iter().filter(|&&v| Some(v) != largest) {
                for corner in self.star(v) {
                    around.push(corner / 3);
                    let others = [next(corner), prev(corner)].map(|h| self.vertex(h));
                    let others = others.into_iter().filter(|other| suspects.binary_search(other).is_ok());
                    known.extend(others.map(|other| ordered([v, other])));
                }
            }
        }
    }

    /// The part that starts at `at` of the constraint from there to `to`. The error is `None` if the walk meets more than
    /// `most` triangles.
    fn first_part(&self, [at, to]: [u32; 2], walk: &mut Walk, most: usize) -> Result<Part, Option<Obstacle>> {
        if self.mesh.point2(at) == self.mesh.point2(to) {
            return Err(Obstacle::SamePoint.into());
        }
        if let Some(unused) = [at, to].into_iter().find(|&v| !self.is_used(v)) {
            return Err(Obstacle::Unused(unused).into());
        }
        let side = |v: u32| self.sign([at, to, v]);
        self.suspect(walk, at);
        // Where several triangles fit, because the mesh overlaps, the lowest index decides.
        let (mut edge, mut covered, mut start) = (None, None, None);
        for corner in self.star(at) {
            walk.around.push(corner / 3);
            let [x, y] = [next(corner), prev(corner)].map(|x| self.vertex(x));
            let sides = [x, y].map(side);
            for (v, side, h) in [(x, sides[0], corner), (y, sides[1], prev(corner))] {
                match self.is_passed(v, side, [at, to]) {
                    Ok(false) => {}
                    Ok(true) => lower(&mut edge, (h, v)),
                    Err(obstacle) => lower(&mut covered, (h, obstacle)),
                }
            }
            if sides[0].is_ne() && sides[0] == sides[1].reverse() && self.sign([at, x, y]) == sides[1] {
                lower(&mut start, (next(corner), sides[1]));
            }
        }
        walk.check(most)?;
        if let Some((h, v)) = edge {
            self.suspect(walk, v);
            return Ok(Part { ends: [at, v], way: Way::Edge(h) });
        }
        if let Some((_, obstacle)) = covered {
            return Err(Some(obstacle));
        }
        let (mut h, sign) = start.ok_or(Some(Obstacle::Leaves(at)))?;
        let mut half_edges = Vec::new();
        walk.crossed.push(h / 3);
        self.ends(h).into_iter().for_each(|v| self.suspect(walk, v));
        loop {
            // Where the mesh overlaps, the walk may have passed the end.
            let stopped = |obstacle: Obstacle| {
                let [x, y] = self.ends(h);
                let is_ahead = self.sign([x, y, to]) == sign.reverse();
                Err(Some(if is_ahead { obstacle } else { Obstacle::Covered(to) }))
            };
            if self.twin(h) == NONE {
                return stopped(Obstacle::Border(h));
            }
            if self.is_locked(h) {
                return stopped(Obstacle::Locked(h));
            }
            half_edges.push(h);
            let g = self.twin(h);
            walk.crossed.push(g / 3);
            walk.check(most)?;
            let far = self.vertex(prev(g));
            self.suspect(walk, far);
            if self.sign([g, next(g), prev(g)].map(|x| self.vertex(x))) != sign {
                return stopped(Obstacle::Folded(g / 3));
            }
            let side = side(far);
            if self.is_passed(far, side, [at, to])? {
                let region = Region::across(&half_edges, |h| self.twin(h), sign);
                return Ok(Part { ends: [at, far], way: Way::Across(region) });
            }
            h = if side == sign { next(g) } else { prev(g) };
        }
    }

    fn suspect(&self, walk: &mut Walk, v: u32) {
        if !self.embedded.at(v) {
            walk.suspects.push(v);
        }
    }

    /// Whether the constraint from `at` to `to` passes or reaches the vertex `v`, which lies on `side`, behind `at`.
    fn is_passed(&self, v: u32, side: Ordering, [at, to]: [u32; 2]) -> Result<bool, Obstacle> {
        if v == to {
            return Ok(true);
        }
        is_between([at, to, v].map(|v| self.mesh.point2(v)), side).ok_or(Obstacle::Covered(to))
    }
}

/// Whether a point, which lies on this side of the line from one point to another, is between them. `None` if it is at or
/// beyond the second.
pub(super) fn is_between([from, end, point]: [DVec2; 3], side: Ordering) -> Option<bool> {
    if side.is_ne() {
        return Some(false);
    }
    let [from, end, point] = [from, end, point].map(|point| point.to_array());
    // On one line, one coordinate that differs decides.
    let axis = usize::from(from[0] == end[0]);
    let order = |x: f64, y: f64| x.partial_cmp(&y).unwrap_or(Ordering::Equal);
    let ahead = order(end[axis], from[axis]);
    if order(point[axis], from[axis]) != ahead {
        return Some(false);
    }
    (order(end[axis], point[axis]) == ahead).then_some(true)
}

/// Keeps the candidate with the lower half-edge.
fn lower<T>(best: &mut Option<(u32, T)>, candidate: (u32, T)) {
    if best.as_ref().is_none_or(|(h, _)| candidate.0 < *h) {
        *best = Some(candidate);
    }
}
