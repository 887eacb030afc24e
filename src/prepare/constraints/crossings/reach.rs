//! Looks from an edge at a point behind it.

use super::chains::Chains;
use super::net::Net;
use crate::NONE;
use crate::mesh::half_edge::{next, prev};
use glam::DVec2;

/// What there is in the triangle of an edge and a point.
pub(super) enum Seen {
    /// A vertex at the point, opposite to this half-edge, and nothing before it.
    Vertex(u32),
    /// Nothing, and the point is inside the triangle of this half-edge.
    Inside(u32),
    /// Nothing, and the point is on the edge of this half-edge, which may get a vertex.
    On(u32),
    /// This vertex is before the point.
    Before(u32),
    /// This half-edge of an edge of chains is before the point. It belongs to the triangle before the edge.
    Behind(u32),
    /// Something that has to stay as it is, or triangles that overlap.
    Nothing,
}

impl Net {
    /// What there is in the triangle of the edge of `e` and a point on the left of `e`.
    ///
    /// As long as no vertex is in that triangle, each edge that is, cuts it in two. So there is one way to the point.
    pub(super) fn look(&self, e: u32, point: DVec2, chains: &Chains) -> Seen {
        let [x, y] = self.ends(e).map(|v| self.point(v));
        let mut h = e;
        loop {
            let far = self.apex(h);
            let [p, q, r] = [h, next(h), prev(h)].map(|side| self.point(self.vertex(side)));
            if self.turn(p, q, r).is_le() {
                return Seen::Nothing;
            }
            if r == point {
                return Seen::Vertex(h);
            }
            let [beyond_y, beyond_x] = [self.turn(y, point, r).is_lt(), self.turn(point, x, r).is_lt()];
            if !beyond_y && !beyond_x {
                return Seen::Before(far);
            }
            let mut crossed = None;
            for (is_candidate, side, [from, to]) in [(beyond_x, next(h), [q, r]), (beyond_y, prev(h), [r, p])]
            {
                let turn = self.turn(from, to, point);
                if !is_candidate || turn.is_gt() {
                    continue;
                }
                let is_free =
                    self.twin(side) != NONE && (!self.is_locked(side) || chains.may_change(self.ends(side)));
                if !is_free {
                    return Seen::Nothing;
                }
                if turn.is_eq() {
                    return Seen::On(side);
                }
                crossed = Some(side);
            }
            let Some(side) = crossed else { return Seen::Inside(h) };
            if self.is_locked(side) {
                return Seen::Behind(side);
            }
            h = self.twin(side);
        }
    }
}
