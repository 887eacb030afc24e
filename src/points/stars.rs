//! A triangulation whose edges can flip: its slots, and a half-edge of each vertex.

use super::circle::is_inside;
use super::slots::{GHOST, Slot, Slots, next, prev};
use crate::NONE;
use glam::DVec2;
use std::iter::successors;

pub(super) struct Stars<'a> {
    pub(super) points: &'a [DVec2],
    pub(super) slots: Slots<&'a mut [Slot]>,
    /// A half-edge that begins at each vertex.
    half_edges: Vec<u32>,
}

impl<'a> Stars<'a> {
    pub(super) fn new(points: &'a [DVec2], slots: &'a mut [Slot]) -> Self {
        let mut half_edges = vec![NONE; points.len()];
        for (slot, at) in (0..).zip(&*slots) {
            for (corner, &vertex) in (0..3).zip(&at.corners) {
                if let Some(first) = half_edges.get_mut(vertex as usize) {
                    *first = 4 * slot + corner;
                }
            }
        }
        Self { points, slots: Slots { slots, first: 0 }, half_edges }
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
            self.half_edges[vertex as usize] = h;
        }
        h
    }

    /// Flips these edges, and all around them, until all are Delaunay that are not locked, as Lawson does ("Software for
    /// C1 surface interpolation", 1977).
    pub(super) fn make_delaunay(&mut self, mut edges: Vec<u32>) {
        while let Some(h) = edges.pop() {
            if !self.is_delaunay(h) {
                let g = self.slots.twin(h);
                self.flip(h, g);
                edges.extend([next(h), prev(h), next(g), prev(g)]);
            }
        }
    }

    /// Whether an edge stays. Edges of the hull and those to the symbolic vertex do.
    fn is_delaunay(&self, h: u32) -> bool {
        let slots = &self.slots;
        if slots.is_locked(h) {
            return true;
        }
        let g = slots.twin(h);
        let corners = [slots.origin(h), slots.origin(g), slots.apex(h), slots.apex(g)];
        corners.contains(&GHOST) || !is_inside(corners.map(|vertex| self.points[vertex as usize]))
    }

    /// Flips the edge of the half-edges h, from a to b, and g. It then joins their apexes c and d.
    fn flip(&mut self, h: u32, g: u32) {
        let [a, b] = [h, g].map(|h| self.slots.origin(h));
        let [c, d] = [h, g].map(|h| self.slots.apex(h));
        let [[hn, hp], [gn, gp]] = [h, g].map(|h| [next(h), prev(h)]);
        let sides = [hn, hp, gn, gp].map(|side| (self.slots.twin(side), self.slots.is_locked(side)));
        let [bc, ca, ad, db] = sides;
        for (side, vertex, (twin, is_locked)) in [(hn, c, ca), (hp, a, ad), (gn, d, db), (gp, b, bc)] {
            self.slots.set_origin(side, vertex);
            self.slots.join(side, twin);
            self.slots.set_locked(side, is_locked);
            self.half_edges[vertex as usize] = side;
        }
        self.slots.set_origin(h, d);
        self.slots.set_origin(g, c);
    }
}
