//! Merges two Delaunay triangulations whose points are apart: from the lower common tangent to the upper one, a seam of
//! triangles grows between them. On its way it removes the edges that are no longer Delaunay, by flips with ghosts.

use super::circle::{is_inside, is_left_turn};
use super::slots::{GHOST, Slot, Slots, next, prev};
use glam::DVec2;
use std::ops::DerefMut;

/// A hull, by the half-edges to the symbolic vertex from the first and from the last of its vertices, in the direction
/// in which the sets of points follow each other.
#[derive(Clone, Copy)]
pub(super) struct Hull {
    pub(super) first: u32,
    pub(super) last: u32,
}

/// The open end of the seam. All names are as if the sets were side by side and the seam grew upwards.
struct Front {
    /// The half-edge from `right` to `left` below the front.
    base: u32,
    left: DVec2,
    right: DVec2,
    /// From the left vertex to the symbolic one, in the ghost along the left side of the gap.
    left_ghost: u32,
    /// From the symbolic vertex to the right one, in the ghost along the right side of the gap.
    right_ghost: u32,
}

impl<S: DerefMut<Target = [Slot]>> Slots<S> {
    /// Merges the triangulations of two sets. The second is after the first in some direction. Two slots from `slot` are
    /// free: they become the ghosts below and above the seam.
    pub(super) fn merge(&mut self, points: &[DVec2], [low, high]: [Hull; 2], slot: u32) -> Hull {
        let ends = [self.origin(low.first), self.origin(high.last)];
        let [left_ghost, right] = self.tangent(points, low.last, high.first);
        let (mut left_vertex, mut right_vertex) = (self.origin(left_ghost), self.origin(right));
        let bottom = self.put_ghost(slot, [right_vertex, left_vertex]);
        let right_ghost = self.twin(right);
        self.join(bottom + 1, self.twin(left_ghost));
        self.join(bottom + 2, right);
        let first = if left_vertex == ends[0] { bottom + 1 } else { low.first };

        let at = |vertex: u32| points[vertex as usize];
        let (left, right) = (at(left_vertex), at(right_vertex));
        let mut front = Front { base: bottom, left, right, left_ghost, right_ghost };
        loop {
            let [mut upper_left, mut upper_right] =
                [front.left_ghost, front.right_ghost].map(|h| self.apex(h));
            let [mut p, mut q] = [upper_left, upper_right].map(at);
            let is_left = is_left_turn(p, front.left, front.right);
            let is_right = is_left_turn(q, front.left, front.right);
            if !is_left && !is_right {
                break;
            }
            if is_left {
                (upper_left, p) = self.clear_left(points, &front, (upper_left, p));
            }
            if is_right {
                (upper_right, q) = self.clear_right(points, &front, (upper_right, q));
            }
            if !is_left || (is_right && is_inside([p, front.left, front.right, q])) {
                self.set_origin(front.right_ghost, left_vertex);
                self.join(front.base, front.right_ghost);
                front.base = prev(front.right_ghost);
                front.right_ghost = self.twin(front.base);
                (right_vertex, front.right) = (upper_right, q);
            } else {
                let to_right = next(front.left_ghost);
                self.set_origin(to_right, right_vertex);
                self.join(front.base, front.left_ghost);
                front.base = to_right;
                front.left_ghost = self.twin(to_right);
                (left_vertex, front.left) = (upper_left, p);
            }
        }
        let top = self.put_ghost(slot + 1, [left_vertex, right_vertex]);
        self.join(top, front.base);
        self.join(top + 1, front.right_ghost);
        self.join(top + 2, front.left_ghost);
        Hull { first, last: if right_vertex == ends[1] { top + 1 } else { high.last } }
    }

    /// The lower common tangent: the half-edges to the symbolic vertex from its left and its right end. `left` and
    /// `right` are those of the last vertex of the left hull and of the first vertex of the right hull.
    fn tangent(&self, points: &[DVec2], mut left: u32, mut right: u32) -> [u32; 2] {
        let at = |h: u32| points[self.origin(h) as usize];
        let (mut p, mut q) = (at(left), at(right));
        loop {
            let before = self.back_along_hull(left);
            let lower = at(before);
            if is_left_turn(p, lower, q) {
                (left, p) = (before, lower);
                continue;
            }
            let after = self.along_hull(right);
            let lower = at(after);
            if is_left_turn(lower, q, p) {
                (right, q) = (after, lower);
                continue;
            }
            return [left, right];
        }
    }

    /// Removes edges from the left end of the front that are not Delaunay with its right end. `upper` is the other end of
    /// the first of these edges; the result is that of the edge which stays.
    ///
    /// The ghost (left, symbolic, upper) and the triangle (left, upper, beyond) behind it become (left, symbolic, beyond)
    /// and (symbolic, upper, beyond).
    #[inline(always)]
    fn clear_left(&mut self, points: &[DVec2], front: &Front, mut upper: (u32, DVec2)) -> (u32, DVec2) {
        let to_upper = next(front.left_ghost);
        let from_upper = next(to_upper);
        loop {
            let inner = self.twin(from_upper);
            let to_beyond = next(inner);
            let from_beyond = next(to_beyond);
            let beyond = self.origin(from_beyond);
            if beyond == GHOST {
                return upper;
            }
            let point = points[beyond as usize];
            if !is_inside([front.left, front.right, upper.1, point]) {
                return upper;
            }
            self.join(inner, self.twin(to_upper));
            self.join(from_upper, self.twin(from_beyond));
            self.join(to_upper, from_beyond);
            self.set_origin(inner, GHOST);
            self.set_origin(from_upper, beyond);
            upper = (beyond, point);
        }
    }

    /// The same at the right end: the ghost (symbolic, right, upper) and the triangle (upper, right, beyond) become
    /// (symbolic, right, beyond) and (upper, symbolic, beyond).
    #[inline(always)]
    fn clear_right(&mut self, points: &[DVec2], front: &Front, mut upper: (u32, DVec2)) -> (u32, DVec2) {
        let to_upper = next(front.right_ghost);
        let from_upper = next(to_upper);
        loop {
            let inner = self.twin(to_upper);
            let to_beyond = next(inner);
            let from_beyond = next(to_beyond);
            let beyond = self.origin(from_beyond);
            if beyond == GHOST {
                return upper;
            }
            let point = points[beyond as usize];
            if !is_inside([front.left, front.right, upper.1, point]) {
                return upper;
            }
            self.join(inner, self.twin(from_upper));
            self.join(to_upper, self.twin(to_beyond));
            self.join(from_upper, to_beyond);
            self.set_origin(to_beyond, GHOST);
            self.set_origin(from_upper, beyond);
            upper = (beyond, point);
        }
    }
}
