//! Brings an edge in: flips the edges that it crosses until none is left.
//!
//! Let the new edge go from u to v. The vertices on its left are a chain from u to v, and so are those on its right; each
//! crossed edge joins both chains. A flip whose new edge joins two vertices of one chain, or ends at u or v, leaves one
//! crossed edge less. Such flips are made first. They may all be blocked by angles that are not strictly convex. Then let
//! p be the first of the highest vertices on the left: its edges flip too, until none of them is crossed. All neighbours
//! of p among the crossed edges, and its neighbours in the chain, are below p or as high, and those on the right are below
//! u and v. So a vertex q on the right is a corner of the convex hull of these neighbours, and the edge between p and q is
//! the diagonal of a strictly convex quad. Its flip takes an edge away from p, or is one of the flips above. With one edge
//! left, p has only such a flip. So every insertion ends.
//!
//! A flip changes the quads of the edges before and after it only, so the search goes on at the edge before. Each search
//! through all crossed edges ends with a vertex less, or with one edge less for each of its flips.
//!
//! Where the mesh overlaps, a flip may also be blocked because the mesh has the new edge already. Then a search may end
//! without a flip. The constraint does not come in, and its flips are undone.

use super::flips::Flips;
use super::walk::Obstacle;
use crate::mesh::half_edge::next;
use crate::mesh::named_edges::ordered;
use crate::predicates::cross_sign;
use std::cmp::Ordering;
use std::collections::HashSet;

/// Keeps the flips of a constraint from making an edge that the mesh has already.
pub(super) struct Guard {
    /// The present edges between vertices whose stars may overlap.
    edges: HashSet<[u32; 2]>,
    /// The half-edges of the flips, in their order.
    pub(super) flips: Vec<u32>,
    /// The edge of the last flip that was blocked.
    blocked: [u32; 2],
}

impl Guard {
    pub(super) fn new(edges: HashSet<[u32; 2]>) -> Self {
        Self { edges, flips: Vec::new(), blocked: [0; 2] }
    }

    /// Notes the flip of the edge of `h` from a-b to c-d. Returns whether it is allowed.
    fn allows(&mut self, h: u32, [a, b, c, d]: [u32; 4]) -> bool {
        if !self.edges.insert(ordered([c, d])) {
            self.blocked = [c, d];
            return false;
        }
        self.edges.remove(&ordered([a, b]));
        self.flips.push(h);
        true
    }
}

/// The crossed edges in their order, as a ring. The last link is no edge.
struct Ring {
    half_edges: Vec<u32>,
    before: Vec<usize>,
    after: Vec<usize>,
}

impl Ring {
    fn new(half_edges: Vec<u32>) -> Self {
        let links = half_edges.len() + 1;
        Self {
            half_edges,
            before: (0..links).map(|i| (i + links - 1) % links).collect(),
            after: (0..links).map(|i| (i + 1) % links).collect(),
        }
    }

    /// The link that is no edge.
    fn end(&self) -> usize {
        self.half_edges.len()
    }

    fn is_empty(&self) -> bool {
        self.after[self.end()] == self.end()
    }

    fn remove(&mut self, i: usize) {
        let (before, after) = (self.before[i], self.after[i]);
        self.after[before] = after;
        self.before[after] = before;
    }
}

/// The edge that is brought in.
struct Line {
    ends: [u32; 2],
    /// The sign of the triangles that it crosses, and of a triangle of the line and a vertex on its left.
    sign: Ordering,
}

impl Flips<'_> {
    /// Flips the crossed edges of a part until it is an edge. Returns its half-edge, and the number of flips. Without a
    /// guard, it never fails.
    pub(super) fn bring_in(
        &self,
        ends: [u32; 2],
        half_edges: Vec<u32>,
        sign: Ordering,
        mut guard: Option<&mut Guard>,
    ) -> Result<(u32, u64), Obstacle> {
        let line = Line { ends, sign };
        let mut ring = Ring::new(half_edges);
        let mut i = ring.after[ring.end()];
        let (mut newest, mut flips) = (ring.half_edges[i], 0);
        let (mut highest, mut flips_before) = (None, 0);
        while !ring.is_empty() {
            if i == ring.end() {
                if let Some(guard) = &guard
                    && highest.is_some()
                    && flips == flips_before
                {
                    return Err(Obstacle::Doubled(guard.blocked));
                }
                flips_before = flips;
                i = self.first_at_highest(&line, &ring);
                highest = Some(self.left(&ring, i));
            }
            let is_wanted =
                highest == Some(self.left(&ring, i)) || !self.still_crosses(&line, ring.half_edges[i]);
            if !is_wanted || !self.may_flip(&line, ring.half_edges[i], &mut guard) {
                i = ring.after[i];
                continue;
            }
            newest = self.flip_in(&line, &mut ring, i);
            flips += 1;
            // The flip may have made the angles of the edge before convex.
            let before = ring.before[i];
            i = if before == ring.end() { ring.after[before] } else { before };
        }
        Ok((newest, flips))
    }

    /// The vertex of a crossed edge on the left.
    fn left(&self, ring: &Ring, i: usize) -> u32 {
        self.vertex(next(ring.half_edges[i]))
    }

    /// Flips a crossed edge, and removes it from the ring if the new edge is not crossed. Returns the new half-edge.
    fn flip_in(&self, line: &Line, ring: &mut Ring, i: usize) -> u32 {
        let h = ring.half_edges[i];
        let gn = next(self.twin(h));
        let is_crossed = self.still_crosses(line, h);
        let [.., d] = self.diamond(h);
        let is_left = self.side(line, d) == line.sign;
        self.flip(h);
        let after = ring.after[i];
        if after != ring.end() && ring.half_edges[after] == gn {
            ring.half_edges[after] = h;
        }
        // The new edge goes from d to c in the triangle of `h`. The half-edge from right to left belongs to the nearer
        // triangle.
        let new = if is_left { gn } else { next(h) };
        ring.half_edges[i] = new;
        if !is_crossed {
            ring.remove(i);
        }
        new
    }

    fn side(&self, line: &Line, v: u32) -> Ordering {
        let [u, w] = line.ends;
        if v == u || v == w { Ordering::Equal } else { self.sign([u, w, v]) }
    }

    /// Whether the flip of a crossed edge makes a crossed edge.
    fn still_crosses(&self, line: &Line, h: u32) -> bool {
        let [_, _, c, d] = self.diamond(h);
        let [c, d] = [c, d].map(|v| self.side(line, v));
        c.is_ne() && c == d.reverse()
    }

    /// Whether both new triangles of a flip have the sign of the old ones, and the guard allows it.
    fn may_flip(&self, line: &Line, h: u32, guard: &mut Option<&mut Guard>) -> bool {
        let [a, b, c, d] = self.diamond(h);
        self.sign([a, d, c]) == line.sign
            && self.sign([b, c, d]) == line.sign
            && guard.as_mut().is_none_or(|guard| guard.allows(h, [a, b, c, d]))
    }

    /// The first crossed edge of the first of the highest vertices on the left.
    fn first_at_highest(&self, line: &Line, ring: &Ring) -> usize {
        let [u, v] = line.ends.map(|v| self.mesh.point2(v));
        let mut highest = ring.after[ring.end()];
        let mut i = ring.after[highest];
        while i != ring.end() {
            let [p, q] = [highest, i].map(|i| self.mesh.point2(self.left(ring, i)));
            if cross_sign(u, v, p, q) == line.sign {
                highest = i;
            }
            i = ring.after[i];
        }
        highest
    }
}
