//! Put back: a vertex that is out walks to the triangle with its point, and divides it. On an edge, one of the three new
//! triangles is flat, and the flips of the update take it away.

use super::rounds::Claims;
use super::{Frame, Loose};
use crate::NONE;
use crate::mesh::half_edge::{next, triangle_of, unflagged};
use crate::phases::key;
use crate::untangle::divide::divide;
use std::cmp::Ordering;

/// The longest walk of a round, in triangles.
pub(super) const LONGEST: u32 = 64;

impl Frame<'_> {
    /// Walks towards the point of a vertex. Returns where it comes to, and the triangle that has the point, or [`NONE`]. The
    /// walk leaves each triangle over an edge that has the point on its other side; which one comes first changes with the
    /// triangle and the round, so that no walk goes in a circle for ever. If only the boundary has the point on its other
    /// side, the walk goes along the boundary until it has not.
    pub(super) fn walk(&self, vertex: u32, mut t: u32, round: u32) -> (u32, u32) {
        let is_beyond = |h: u32| {
            let side = [self.vertex(h), self.vertex(next(h)), vertex];
            self.sign(triangle_of(h), side) == Some(Ordering::Less)
        };
        let (mut from, mut border) = (NONE, NONE);
        for step in 0..LONGEST {
            if border == NONE {
                let turn = key(self.triangle_name(t), round + step) % 3;
                let mut to = NONE;
                for i in 0..3 {
                    let h = 3 * t + (turn + i) % 3;
                    if to == NONE && h != from && is_beyond(h) {
                        to = unflagged(self.twins[h as usize]);
                        border = if to == NONE { next(h) } else { NONE };
                    }
                }
                if to != NONE {
                    (from, t) = (to, triangle_of(to));
                } else if border == NONE {
                    return (t, t);
                }
                continue;
            }
            // Turns around the end of the side before, up to the next side.
            t = triangle_of(border);
            let across = unflagged(self.twins[border as usize]);
            if across != NONE || is_beyond(border) {
                border = next(if across == NONE { border } else { across });
            } else {
                (from, border) = (NONE, NONE);
            }
        }
        (t, NONE)
    }

    /// Puts a vertex into the triangle that it claims, if it has kept its claims. Returns whether it is back.
    pub(super) fn put(&mut self, loose: &Loose, claims: &Claims) -> bool {
        let (t, vertex) = (loose.target, loose.vertex);
        if t == NONE || !claims.have(&self.corners(t), claims.key(self.name(vertex), 0)) {
            return false;
        }
        let slots = [t, loose.slots[0], loose.slots[1]];
        let corners = divide(self.triangles, self.twins, slots, vertex);
        // The other corners keep their half-edges.
        self.fans.move_anchor(corners[2], 3 * t + 2, 3 * slots[2]);
        self.written.extend(slots);
        true
    }
}
