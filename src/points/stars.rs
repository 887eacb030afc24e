//! A triangulation that can change: its slots, and a half-edge of each vertex. Edges flip as Lawson does ("Software for C1
//! surface interpolation", 1977).

use super::circle::{is_inside, is_left_turn};
use super::slots::{GHOST, Slot, Slots, next, prev};
use crate::NONE;
use glam::DVec2;
use std::array;
use std::iter::successors;

/// Every vertex of a slot has a star: either there is a triangle, or a ghost on each side of each edge of a line.
pub(super) struct Stars {
    pub(super) points: Vec<DVec2>,
    pub(super) slots: Slots<Vec<Slot>>,
    /// A half-edge that begins at each vertex; [`NONE`] for one that no slot has.
    pub(super) half_edges: Vec<u32>,
}

impl Stars {
    /// `points` are those of the vertices of the slots.
    pub(super) fn new(points: Vec<DVec2>, slots: Vec<Slot>) -> Self {
        let mut half_edges = vec![NONE; points.len()];
        for (slot, at) in (0..).zip(&slots) {
            for (corner, &vertex) in (0..3).zip(&at.corners) {
                if let Some(first) = half_edges.get_mut(vertex as usize) {
                    *first = 4 * slot + corner;
                }
            }
        }
        Self { points, slots: Slots { slots, first: 0 }, half_edges }
    }

    #[inline(always)]
    pub(super) fn points<const N: usize>(&self, vertices: [u32; N]) -> [DVec2; N] {
        // Not `map`, which is not always inlined.
        array::from_fn(|i| self.points[vertices[i] as usize])
    }

    /// The corners of the triangle of a half-edge, from its beginning.
    pub(super) fn corners(&self, h: u32) -> [u32; 3] {
        let slots = &self.slots;
        [slots.origin(h), slots.origin(next(h)), slots.origin(prev(h))]
    }

    /// The half-edges that begin at a vertex, counter-clockwise.
    pub(super) fn star(&self, vertex: u32) -> impl Iterator<Item = u32> {
        let first = self.half_edges[vertex as usize];
        successors(Some(first), move |&h| Some(self.slots.twin(prev(h))).filter(|&h| h != first))
    }

    /// Writes the corners of a slot. Returns its first half-edge.
    pub(super) fn put(&mut self, slot: u32, corners: [u32; 3]) -> u32 {
        let h = self.slots.put(slot, corners);
        for (h, vertex) in (h..).zip(corners) {
            self.begin(vertex, h);
        }
        h
    }

    /// Writes where a half-edge begins.
    pub(super) fn begin(&mut self, vertex: u32, h: u32) {
        self.slots.set_origin(h, vertex);
        if let Some(first) = self.half_edges.get_mut(vertex as usize) {
            *first = h;
        }
    }

    /// Flips these edges, and all around them, until all are Delaunay that are not locked, or so many have flipped. Returns
    /// the number of flips.
    pub(super) fn flip_all(&mut self, edges: &mut Vec<u32>, most: usize) -> usize {
        let mut flips = 0;
        while flips < most
            && let Some(h) = edges.pop()
        {
            if !self.is_delaunay(h) {
                let g = self.slots.twin(h);
                self.flip(h, g);
                edges.extend([next(h), prev(h), next(g), prev(g)]);
                flips += 1;
            }
        }
        flips
    }

    /// The same without a limit.
    pub(super) fn make_delaunay(&mut self, mut edges: Vec<u32>) {
        self.flip_all(&mut edges, usize::MAX);
    }

    /// Makes a polygon Delaunay whose corners came off as ears, each along the edge of one of these half-edges: puts them
    /// back, one after another.
    pub(super) fn put_back(&mut self, ears: &[u32]) {
        ears.iter().for_each(|&h| self.lock(h, true));
        let mut edges = Vec::new();
        for &h in ears.iter().rev() {
            self.lock(h, false);
            edges.push(h);
            self.flip_all(&mut edges, usize::MAX);
        }
    }

    /// Writes whether an edge is locked.
    pub(super) fn lock(&mut self, h: u32, is_locked: bool) {
        self.slots.set_locked(h, is_locked);
        self.slots.set_locked(self.slots.twin(h), is_locked);
    }

    /// Whether an edge stays. An edge of the hull does. One to the symbolic vertex does where the hull is convex.
    pub(super) fn is_delaunay(&self, h: u32) -> bool {
        let slots = &self.slots;
        if slots.is_locked(h) {
            return true;
        }
        let g = slots.twin(h);
        let corners @ [a, b, c, d] = slots.diamond(h, g);
        if a.max(b) == GHOST {
            // From the vertex before to the vertex after, along the hull.
            let [before, at, after] = if b == GHOST { [d, a, c] } else { [c, b, d] };
            let [p, q, r] = self.points([before, at, after]);
            return !is_left_turn(r, q, p);
        }
        c.max(d) == GHOST || !is_inside(self.points(corners))
    }

    /// Flips the edge of the half-edges h, from a to b, and g. It then joins their apexes c and d.
    pub(super) fn flip(&mut self, h: u32, g: u32) {
        let [a, b, c, d] = self.slots.diamond(h, g);
        let [[hn, hp], [gn, gp]] = [h, g].map(|h| [next(h), prev(h)]);
        let sides = [hn, hp, gn, gp].map(|side| (self.slots.twin(side), self.slots.is_locked(side)));
        let [bc, ca, ad, db] = sides;
        for (side, vertex, (twin, is_locked)) in [(hn, c, ca), (hp, a, ad), (gn, d, db), (gp, b, bc)] {
            self.begin(vertex, side);
            self.slots.join(side, twin);
            self.slots.set_locked(side, is_locked);
        }
        self.slots.set_origin(h, d);
        self.slots.set_origin(g, c);
    }
}
