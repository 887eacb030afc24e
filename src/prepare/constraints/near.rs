//! The vertices near a constraint, which count as on it.

use super::state::State;
use crate::NONE;
use crate::predicates::{Segment, compare_across, compare_along, is_near};
use glam::DVec2;
use std::collections::HashSet;

impl State<'_> {
    /// The vertices that a constraint goes through in turn, with both ends: those at most `tolerance` from it that lie
    /// strictly between its ends, seen along it. Those at the same place along it come from right to left, and of those
    /// at the same point only the one with the lowest index.
    ///
    /// They are found among the triangles that touch the strip between both ends. The strip is convex, so where
    /// triangles cover it, those that touch it are joined by edges that touch it.
    pub(super) fn chain(&self, [from, to]: [u32; 2], tolerance: f64) -> Vec<u32> {
        let line = [from, to].map(|v| self.mesh.point2(v));
        if line[0] == line[1] || !self.is_used(from) || !self.is_used(to) {
            return vec![from, to];
        }
        let strip = Strip::new(line, tolerance);
        let (mut inside, mut seen) = (Vec::new(), HashSet::new());
        let mut open: Vec<u32> = [from, to].into_iter().flat_map(|v| self.star(v)).map(|h| h / 3).collect();
        while let Some(t) = open.pop() {
            if !seen.insert(t) {
                continue;
            }
            let half_edges = [3 * t, 3 * t + 1, 3 * t + 2];
            let vertices = half_edges.map(|h| self.vertex(h));
            let sides = vertices.map(|v| strip.sides(self.mesh.point2(v)));
            for (k, h) in half_edges.into_iter().enumerate() {
                if sides[k] == 0 && strip.has(self.mesh.point2(vertices[k])) {
                    inside.push(vertices[k]);
                }
                if sides[k] & sides[(k + 1) % 3] == 0 && self.twin(h) != NONE {
                    open.push(self.twin(h) / 3);
                }
            }
        }
        inside.sort_unstable_by(|&p, &q| {
            let [at, other] = [p, q].map(|v| self.mesh.point2(v));
            let order = compare_along(line, at, other).then_with(|| compare_across(line, at, other));
            order.then(p.cmp(&q))
        });
        inside.dedup_by_key(|v| self.mesh.point2(*v));
        [&[from], inside.as_slice(), &[to]].concat()
    }
}

/// The points at most `tolerance` from a segment, and between its ends, seen along it.
struct Strip {
    line: Segment,
    tolerance: f64,
    along: DVec2,
    square: f64,
    reach: f64,
}

impl Strip {
    fn new(line: Segment, tolerance: f64) -> Self {
        let along = line[1] - line[0];
        let square = along.length_squared();
        Self { line, tolerance, along, square, reach: tolerance * square.sqrt() }
    }

    /// Whether a point beyond no side is inside, but not at the place of an end.
    fn has(&self, p: DVec2) -> bool {
        let Self { line, tolerance, .. } = *self;
        is_near(line, p, tolerance)
            && compare_along(line, line[0], p).is_lt()
            && compare_along(line, p, line[1]).is_lt()
    }

    /// The sides of the strip beyond which a point certainly is, as bits. No part of an edge is inside if both its ends
    /// are beyond the same side.
    fn sides(&self, p: DVec2) -> u8 {
        let offset = p - self.line[0];
        let products = [self.along.x * offset.y, self.along.y * offset.x];
        let across = products[0] - products[1];
        let [x, y] = [self.along.x * offset.x, self.along.y * offset.y];
        // Far more than what rounding and underflow can add.
        let size = self.square + self.reach + products[0].abs() + products[1].abs() + x.abs() + y.abs();
        let margin = 1e-14 * size + f64::MIN_POSITIVE;
        let beyond = [
            across > self.reach + margin,
            -across > self.reach + margin,
            x + y < -margin,
            x + y > self.square + margin,
        ];
        (0..).zip(beyond).map(|(bit, is_beyond)| u8::from(is_beyond) << bit).sum()
    }
}
