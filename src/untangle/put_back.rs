//! Put back: the vertices that are out come back, in rounds, each into the triangle that has its point. A GPU can do the
//! same rounds: in each of them, a triangle takes one vertex, that with the smallest key.

use super::lift::{Claims, FREE};
use super::sheet::{Loose, Sheet};
use crate::NONE;
use crate::mesh::arrangement::codes;
use crate::mesh::half_edge::triangle_of;
use crate::phases::key;
use crate::system::threads::Threads;
use std::cmp::Ordering;

/// The longest walk of a round, in triangles.
const LONGEST: u32 = 256;

/// The last round in which a vertex may walk on from the round before.
const LAST: u32 = 64;

/// From so many vertices on, those that begin at one slot walk in the order of a curve.
const MANY: usize = 1024;

/// How a walk ends.
enum Walk {
    At(Location),
    /// It goes on in the next round.
    TooLong,
    /// It has left the component, or ended at another vertex or on the boundary.
    Failed,
}

/// Where a vertex comes back.
#[derive(Clone, Copy)]
struct Location {
    /// The triangle.
    triangle: u32,
    /// The half-edge that it is on, or [`NONE`].
    edge: u32,
}

impl Sheet<'_> {
    /// Puts all vertices back. Where one has no triangle with its point, there is no triangulation. `flips`: whether edges
    /// flip in between, so that many vertices do not make long triangles.
    pub(super) fn put_back(&mut self, claims: &mut Claims, flips: bool) {
        let mut waiting = std::mem::take(&mut self.loose);
        if waiting.len() > MANY {
            let codes = codes(self.mesh, &Threads::one());
            waiting.sort_unstable_by_key(|loose| (loose.near, codes[loose.vertex as usize], loose.vertex));
        }
        let mut strays = Vec::new();
        for round in 0.. {
            let mut located: Vec<(Loose, Location)> = Vec::with_capacity(waiting.len());
            // Where the last walk began and ended: many vertices may begin at one slot, and end one after another.
            let mut last = [NONE; 2];
            for mut loose in std::mem::take(&mut waiting) {
                let start = self.filled(loose.near);
                loose.near = if start == last[0] { last[1] } else { start };
                let end = self.walk(&mut loose, round);
                last = [start, loose.near];
                match end {
                    Walk::At(location) => located.push((loose, location)),
                    Walk::TooLong if round < LAST => waiting.push(loose),
                    _ => strays.push(loose),
                }
            }
            if located.is_empty() && waiting.is_empty() {
                self.search(&mut strays, &mut located);
                if located.is_empty() {
                    break;
                }
            }
            let both = |location: Location| {
                let across = if location.edge == NONE { NONE } else { self.twin(location.edge) };
                [Some(location.triangle), (across != NONE).then(|| triangle_of(across))].into_iter().flatten()
            };
            let key = |loose: &Loose| u64::from(key(loose.vertex, round));
            for (loose, location) in &located {
                for t in both(*location) {
                    claims[t as usize] = claims[t as usize].min(key(loose));
                }
            }
            let wins = |(loose, location): &(Loose, Location)| {
                both(*location).all(|t| claims[t as usize] == key(loose))
            };
            let is_winner: Vec<_> = located.iter().map(wins).collect();
            for t in located.iter().flat_map(|(_, location)| both(*location)) {
                claims[t as usize] = FREE;
            }
            let mut open = Vec::new();
            for ((loose, location), is_winner) in located.into_iter().zip(is_winner) {
                if !is_winner {
                    waiting.push(Loose { near: location.triangle, ..loose });
                    continue;
                }
                self.put(&loose, location);
                if flips {
                    let slots = [location.triangle, loose.slots[0], loose.slots[1]];
                    open.extend(slots.iter().flat_map(|slot| 3 * slot..3 * slot + 3));
                }
            }
            self.flip_all(open);
        }
        for loose in &strays {
            let near = self.filled(loose.near);
            self.split(near, loose);
        }
    }

    /// Puts a vertex where it belongs. On an edge, the edge flips, because one of the three triangles has no area. It does
    /// so if it is locked, too: no triangulation has it.
    fn put(&mut self, loose: &Loose, Location { triangle, edge }: Location) {
        self.split(triangle, loose);
        if edge != NONE {
            let [first, second] = loose.slots;
            let h = 3 * [triangle, first, second][(edge - 3 * triangle) as usize];
            if self.is_locked(h) {
                self.lose(h);
            }
            self.flip(h);
        }
    }

    /// Walks to the triangle that has the point of a vertex. Each triangle is left over an edge that has the point on its
    /// other side; which one comes first changes with the triangle and the round, so that no walk goes in a circle for
    /// ever.
    fn walk(&self, loose: &mut Loose, round: u32) -> Walk {
        let mut from = NONE;
        for step in 0..LONGEST {
            let t = loose.near;
            let turn = key(t, round.wrapping_add(step)) % 3;
            let leaves = |h: &u32| *h != from && self.side(t, *h, loose.vertex).is_lt();
            let Some(h) = (0..3).map(|i| 3 * t + (turn + i) % 3).find(leaves) else {
                return self.location(t, loose.vertex).map_or(Walk::Failed, Walk::At);
            };
            from = self.twin(h);
            if from == NONE {
                return Walk::Failed;
            }
            loose.near = triangle_of(from);
        }
        Walk::TooLong
    }

    /// The side of a half-edge of triangle `t` on which a vertex lies.
    fn side(&self, t: u32, h: u32, vertex: u32) -> Ordering {
        let [a, b, c] = self.corners(t);
        let [from, to] = [[a, b], [b, c], [c, a]][(h - 3 * t) as usize];
        self.sign(t, [from, to, vertex])
    }

    /// How a vertex lies in triangle `t`, if it does.
    fn location(&self, t: u32, vertex: u32) -> Option<Location> {
        let sides = [3 * t, 3 * t + 1, 3 * t + 2].map(|h| (self.side(t, h, vertex), h));
        let mut on = sides.iter().filter(|(side, _)| side.is_eq());
        let edge = on.next().map_or(NONE, |&(_, h)| h);
        let is_in = sides.iter().all(|(side, _)| side.is_ge()) && self.is_right(t) && on.next().is_none();
        (is_in && (edge == NONE || self.twin(edge) != NONE)).then_some(Location { triangle: t, edge })
    }

    /// Finds triangles for vertices whose walks have failed, in one pass over all triangles.
    fn search(&self, strays: &mut Vec<Loose>, located: &mut Vec<(Loose, Location)>) {
        if strays.is_empty() {
            return;
        }
        // Rounding keeps the order, so that each vertex is found between the rounded ends of its triangle.
        let key = |v: u32| {
            let bits = (self.mesh.point2(v).x as f32).to_bits();
            if bits >> 31 == 1 { !bits } else { bits | 1 << 31 }
        };
        let mut keys: Vec<(u32, u32)> =
            (0..).zip(&*strays).map(|(i, loose)| (key(loose.vertex), i)).collect();
        keys.sort_unstable();
        let (components, mut found) = (self.components(), vec![None; strays.len()]);
        for t in (0..self.triangles.len() as u32 / 3).filter(|&t| !self.is_empty(t)) {
            let [a, b, c] = self.corners(t).map(key);
            let (least, most) = (a.min(b).min(c), a.max(b).max(c));
            let first = keys.partition_point(|&(key, _)| key < least);
            for &(_, i) in keys[first..].iter().take_while(|&&(key, _)| key <= most) {
                let Loose { vertex, near, .. } = strays[i as usize];
                if found[i as usize].is_none() && components[t as usize] == components[near as usize] {
                    found[i as usize] = self.location(t, vertex);
                }
            }
        }
        let mut found = found.into_iter();
        strays.retain(|&loose| match found.next().flatten() {
            Some(location) => {
                located.push((loose, location));
                false
            }
            None => true,
        });
    }
}
