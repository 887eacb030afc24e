//! The shortest path between two vertices in a corridor: a row of triangles between them (Lee and Preparata, "Euclidean
//! shortest paths in the presence of rectilinear barriers", 1984).

use super::net::Net;
use std::collections::VecDeque;

/// An edge between two triangles of a corridor: its end on the right and its end on the left.
pub(super) type Gate = [u32; 2];

/// The part of a corridor that the paths to the ends of a gate share no more. Each side is a path from the apex, without
/// it, that bends towards the middle.
struct Funnel<'a> {
    net: &'a Net,
    apex: u32,
    /// The right side and the left side.
    sides: [VecDeque<u32>; 2],
    path: Vec<u32>,
}

/// The vertices of the shortest path from `from` through the gates to `to`, without `from`.
pub(super) fn taut(net: &Net, from: u32, gates: &[Gate], to: u32) -> Vec<u32> {
    let mut funnel = Funnel { net, apex: from, sides: Default::default(), path: Vec::new() };
    for gate in gates {
        for (side, &v) in gate.iter().enumerate() {
            if funnel.sides[side].back().copied().unwrap_or(funnel.apex) != v {
                funnel.narrow(side, v);
            }
        }
    }
    funnel.narrow(0, to);
    let Funnel { mut path, sides: [last, _], .. } = funnel;
    path.extend(last);
    path
}

impl Funnel<'_> {
    /// Whether the way from u to v to w bends towards the middle at v, on side 0 to the right, on side 1 to the left.
    fn bends(&self, side: usize, [u, v, w]: [u32; 3]) -> bool {
        let turn = self.net.turn(self.net.point(u), self.net.point(v), self.net.point(w));
        if side == 0 { turn.is_lt() } else { turn.is_gt() }
    }

    /// Moves an end of the gate to a vertex.
    fn narrow(&mut self, side: usize, v: u32) {
        while let Some(&last) = self.sides[side].back() {
            let own = &self.sides[side];
            let before = if own.len() > 1 { own[own.len() - 2] } else { self.apex };
            if self.bends(side, [before, last, v]) {
                break;
            }
            self.sides[side].pop_back();
        }
        if self.sides[side].is_empty() {
            let other = 1 - side;
            while let Some(&first) = self.sides[other].front() {
                if !self.bends(other, [self.apex, first, v]) {
                    break;
                }
                self.sides[other].pop_front();
                self.path.push(first);
                self.apex = first;
            }
        }
        self.sides[side].push_back(v);
    }
}
