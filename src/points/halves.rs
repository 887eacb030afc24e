//! Triangulates columns by halves: each column by halving it in y, and then the columns by halving their row in x. A
//! vertex is a number in the order of the columns. The vertices from `a` to `b` have the slots from `2a` to `2b - 2`, so
//! that two halves never share a slot, and where a triangle is does not depend on what was made first.

use super::circle::is_before;
use super::seam::Hull;
use super::slots::{Slot, Slots};
use crate::predicates::area_sign;
use crate::system::threads::{FEWEST, Threads};
use glam::DVec2;
use std::array;

/// Slots for so many vertices.
pub(super) fn slots_of(vertices: usize, threads: &Threads) -> Vec<Slot> {
    threads.collect((2 * vertices).saturating_sub(2), |_| Slot::default())
}

/// The triangulations of a row of vertices.
pub(super) struct Network<'a> {
    points: &'a [DVec2],
    slots: Slots<&'a mut [Slot]>,
    threads: &'a Threads,
}

impl<'a> Network<'a> {
    /// No triangles yet.
    pub(super) fn new(points: &'a [DVec2], slots: &'a mut [Slot], threads: &'a Threads) -> Self {
        Self { points, slots: Slots { slots, first: 0 }, threads }
    }

    /// Triangulates columns, each from one of these starts to the next. Returns the vertices of the hull,
    /// counter-clockwise, from the first by x and then by y. On a line, they go there and back.
    pub(super) fn of_columns(&mut self, starts: &[u32]) -> Vec<u32> {
        if self.slots.slots.is_empty() {
            return (0..self.points.len() as u32).collect();
        }
        let Hull { first, .. } = self.of_row(starts);
        self.slots.hull(first)
    }

    /// Triangulates a row of columns. The ends of the hull are the first and the last vertex by x and then by y.
    fn of_row(&mut self, starts: &[u32]) -> Hull {
        match *starts {
            [start, end] => {
                let hull = self.of_column(start, end);
                self.turned(hull.first)
            }
            _ => {
                let middle = starts.len() / 2;
                let [low, high] = [&starts[..=middle], &starts[middle..]];
                self.merged(starts[middle], |half| half.of_row(low), |half| half.of_row(high))
            }
        }
    }

    /// Triangulates the vertices before and from `middle`, and merges the halves. Neither touches the other's slots, so
    /// that large ones have a thread each.
    fn merged(
        &mut self,
        middle: u32,
        low: impl FnOnce(&mut Network) -> Hull + Send,
        high: impl FnOnce(&mut Network) -> Hull + Send,
    ) -> Hull {
        let slot = 2 * middle - 2;
        let is_large = self.slots.slots.len() >= 4 * FEWEST;
        let halves = self.slots.halves(slot);
        let [mut first, mut second] = halves.map(|slots| Network { slots, ..*self });
        let (low, high) = if is_large {
            self.threads.join(|| low(&mut first), || high(&mut second))
        } else {
            (low(&mut first), high(&mut second))
        };
        self.slots.merge(self.points, [low, high], slot)
    }

    /// Triangulates two or more vertices of a column. The ends of the hull are the first and the last of them.
    fn of_column(&mut self, start: u32, end: u32) -> Hull {
        match end - start {
            2 => self.edge(start),
            3 => self.triangle(start),
            count => {
                let middle = start + count / 2;
                if count as usize >= 2 * FEWEST {
                    let low = |half: &mut Network| half.of_column(start, middle);
                    return self.merged(middle, low, |half| half.of_column(middle, end));
                }
                let low = self.of_column(start, middle);
                let high = self.of_column(middle, end);
                self.slots.merge(self.points, [low, high], 2 * middle - 2)
            }
        }
    }

    /// An edge: a ghost on each side.
    fn edge(&mut self, a: u32) -> Hull {
        let slots = &mut self.slots;
        let right = slots.put_ghost(2 * a, [a, a + 1]);
        let left = slots.put_ghost(2 * a + 1, [a + 1, a]);
        slots.join(right, left);
        slots.join_ring(&[right, left]);
        Hull { first: left + 1, last: right + 1 }
    }

    /// A triangle, or two edges in a row.
    fn triangle(&mut self, a: u32) -> Hull {
        let [b, c] = [a + 1, a + 2];
        let [p, q, r] = array::from_fn(|i| self.points[a as usize + i]);
        let slot = 2 * a;
        let sign = area_sign(p, q, r);
        if sign.is_eq() {
            let sides = [[a, b], [b, c], [c, b], [b, a]];
            let ghosts: [u32; 4] = array::from_fn(|i| self.slots.put_ghost(slot + i as u32, sides[i]));
            self.slots.join(ghosts[0], ghosts[3]);
            self.slots.join(ghosts[1], ghosts[2]);
            self.slots.join_ring(&ghosts);
            return Hull { first: ghosts[3] + 1, last: ghosts[1] + 1 };
        }
        let (second, third) = if sign.is_gt() { (b, c) } else { (c, b) };
        let inner = self.slots.put(slot, [a, second, third]);
        let sides = [[second, a], [a, third], [third, second]];
        let ghosts: [u32; 3] = array::from_fn(|i| self.slots.put_ghost(slot + 1 + i as u32, sides[i]));
        self.slots.join(inner, ghosts[0]);
        self.slots.join(inner + 1, ghosts[2]);
        self.slots.join(inner + 2, ghosts[1]);
        self.slots.join_ring(&ghosts);
        Hull { first: ghosts[0] + 1, last: if sign.is_gt() { ghosts[1] } else { ghosts[2] } + 1 }
    }

    /// The hull that has this half-edge to the symbolic vertex, from its first vertex by x and then by y to its last.
    fn turned(&self, start: u32) -> Hull {
        let point = |h: u32| self.points[self.slots.origin(h) as usize];
        let [mut first, mut last] = [start; 2];
        let mut h = self.slots.along_hull(start);
        while h != start {
            let p = point(h);
            if is_before(p, point(first)) {
                first = h;
            }
            if is_before(point(last), p) {
                last = h;
            }
            h = self.slots.along_hull(h);
        }
        Hull { first, last }
    }
}
