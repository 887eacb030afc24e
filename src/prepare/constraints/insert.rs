//! Brings an edge in: the triangles that it crosses make way for two polygons, one on each side of it, which are
//! triangulated. Flips could need the square of the number of crossed edges; this takes time in proportion to them.
//!
//! Each crossed edge joins the polygons across the new edge. So all their vertices see the new edge, and a corner that is
//! convex in its polygon is an ear: nothing of the polygon's boundary is in its triangle. It comes off, and the rest is
//! such a polygon again. The first of the vertices that are farthest from the new edge is always convex.
//!
//! Where the mesh overlaps, the polygon may turn by more than 360° at a corner. Some crossed edge ends there. From the next
//! side to that edge it turns by less than 180°, whatever came off. So it is convex if it turns by less than 180° from the
//! edge to the side before, and from side to side. Where the mesh overlaps, it may also have the edge that an ear would
//! make. That ear stays; if none is left, the constraint does not come in.
//!
//! Nothing changes before all ears are known. Several threads may bring in edges that are apart; see
//! [`Rounds`](super::rounds::Rounds).

use super::state::{Links, area};
use super::walk::{Obstacle, Region};
use crate::NONE;
use crate::mesh::half_edge::{FLAGS, LOCKED, prev, unflagged};
use crate::mesh::named_edges::ordered;
use crate::mesh::star::move_anchor;
use crate::points::ears::Corners;
use crate::system::threads::Word;
use std::collections::HashSet;

/// The corners before an ear, of it and after it, by the numbers of the sides that start there.
type Ear = [usize; 3];

impl Links<'_> {
    fn vertex(&self, h: u32) -> u32 {
        self.triangles[h as usize].get()
    }

    /// The ears of both polygons. `known`: the edges that an ear must not make; adds those that ears make.
    pub(super) fn ears(
        &self,
        region: &Region,
        mut known: Option<&mut HashSet<[u32; 2]>>,
    ) -> Result<Vec<Ear>, Obstacle> {
        let Region { sides, second, sign, .. } = region;
        let mut corners = Corners::new(sides.len(), 1..sides.len());
        let mut ears = Vec::with_capacity(sides.len() - 2);
        let mut blocked = [0; 2];
        let is_end = |corner: usize| corner == 0 || corner == *second;
        let is_positive = |vertices: [u32; 3]| area(self.mesh, vertices) == *sign;
        while let Some(ear @ [before, corner, after]) = corners.next() {
            let [p, q, r] = ear.map(|corner| self.vertex(sides[corner]));
            if corner == *second || !is_positive([p, q, r]) {
                continue;
            }
            if let Some(known) = &mut known {
                let across = self.vertex(prev(sides[corner]));
                if !is_positive([q, across, p]) {
                    continue;
                }
                if !(is_end(before) && is_end(after) || known.insert(ordered([p, r]))) {
                    blocked = [p, r];
                    continue;
                }
            }
            ears.push(ear);
            corners.cut(ear);
        }
        if ears.len() + 2 == sides.len() { Ok(ears) } else { Err(Obstacle::Doubled(blocked)) }
    }

    /// Makes the ears triangles, in place of those of the region. Returns the half-edge between the ends.
    pub(super) fn fill(&self, Region { triangles, sides, second, .. }: &Region, ears: &[Ear]) -> u32 {
        let ears = || triangles.iter().map(|t| 3 * t).zip(ears);
        // The half-edges that take the places of the sides.
        let mut new = vec![NONE; sides.len()];
        for (h, [before, corner, _]) in ears() {
            for (side, h) in [(*before, h), (*corner, h + 1)] {
                if new[side] == NONE {
                    new[side] = h;
                }
            }
        }
        if !self.fans.is_empty() {
            self.move_anchors(sides, &new);
        }
        let vertices: Vec<u32> = sides.iter().map(|&side| self.vertex(side)).collect();
        self.move_sides(sides, &new);
        // The half-edges of the ears along which they came off, by their first corners.
        let mut cuts = new.clone();
        for (h, &[before, corner, after]) in ears() {
            for (side, h) in [(before, h), (corner, h + 1)] {
                if new[side] != h {
                    self.join(cuts[side], h);
                }
            }
            cuts[before] = h + 2;
            for (h, corner) in (h..).zip([before, corner, after]) {
                self.triangles[h as usize].set(vertices[corner]);
            }
        }
        self.join(cuts[0], cuts[*second]);
        cuts[0]
    }

    fn join(&self, h: u32, g: u32) {
        self.twins[h as usize].set(g);
        self.twins[g as usize].set(h);
    }

    /// Moves the outer sides of half-edges to others.
    fn move_sides(&self, from: &[u32], to: &[u32]) {
        let outer = || from.iter().map(|&h| self.twins[h as usize].get()).collect::<Vec<_>>();
        for (&h, twin) in to.iter().zip(outer()) {
            if twin != NONE {
                self.twins[(twin & !FLAGS) as usize].set(h | twin & FLAGS);
            }
        }
        // By now, sides that were twins of each other have their new twins.
        for (&h, twin) in to.iter().zip(outer()) {
            self.twins[h as usize].set(twin);
        }
    }

    /// Moves the anchors at the corners of the region to the new half-edges that start there.
    fn move_anchors(&self, sides: &[u32], new: &[u32]) {
        // One that has moved is flagged, until all have.
        for (i, &side) in sides.iter().enumerate() {
            let last = sides[i.checked_sub(1).unwrap_or(sides.len() - 1)];
            let mut corner = side;
            loop {
                move_anchor(self.fans, self.vertex(side), corner, new[i] | LOCKED);
                if prev(corner) == last {
                    break;
                }
                corner = unflagged(self.twins[prev(corner) as usize].get());
            }
        }
        for (&side, &h) in sides.iter().zip(new) {
            move_anchor(self.fans, self.vertex(side), h | LOCKED, h);
        }
    }
}
