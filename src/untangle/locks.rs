//! Locked edges come back. The triangles that such an edge crosses give way to others on both of its sides.

use super::sheet::{CUT, Lost, Sheet, Side};
use crate::NONE;
use crate::mesh::half_edge::{LOCKED, next, prev, triangle_of};
use crate::mesh::named_edges::ordered;
use crate::mesh::star::{Fans, Star};
use std::cmp::Ordering;

/// What an edge crosses.
struct Crossed {
    slots: Vec<u32>,
    /// The half-edges from its first end to its second on the right, and back on the left.
    chains: [Vec<u32>; 2],
}

impl Sheet<'_> {
    /// Brings the lost edges back that cross only free edges of positive triangles. The others stay lost.
    pub(super) fn bring_back(&mut self) {
        let mut lost: Vec<_> = self.lost.drain(..).map(|lost| ordered(lost.edge)).collect();
        lost.sort_unstable();
        lost.dedup();
        if lost.is_empty() {
            return;
        }
        let mut corners = vec![NONE; self.mesh.vertex_count()];
        for h in 0..self.triangles.len() as u32 {
            if let Some(corner) = corners.get_mut(self.vertex(h) as usize) {
                *corner = h;
            }
        }
        for edge in lost {
            if !self.bring(edge, &mut corners, &self.fans()) {
                self.lost.push(Lost { edge, component: NONE });
            }
        }
    }

    /// Brings one edge in. `corners` has a half-edge that starts at each vertex. Returns whether the mesh has the edge
    /// now.
    fn bring(&mut self, [u, v]: [u32; 2], corners: &mut [u32], fans: &Fans) -> bool {
        let corner = corners[u as usize];
        if corner == NONE {
            return false;
        }
        let mut start = None;
        for h in Star::new(&self.triangles, &self.twins, fans, corner) {
            let [x, y] = [next(h), prev(h)].map(|x| self.vertex(x));
            if x == v || y == v {
                self.lock(if x == v { h } else { prev(h) });
                return true;
            }
            let t = triangle_of(h);
            if self.sign(t, [u, x, v]).is_gt() && self.sign(t, [u, v, y]).is_gt() {
                start = Some(next(h));
            }
        }
        let Some(Crossed { mut slots, chains }) = start.and_then(|h| self.crossed([u, v], h)) else {
            return false;
        };
        slots.sort_unstable();
        // Edges between the triangles that are not crossed themselves: both of their sides belong to a chain.
        let lower = |h: u32| h.min(self.twin(h));
        let is_inner =
            |h: &u32| self.twin(*h) != NONE && slots.binary_search(&triangle_of(self.twin(*h))).is_ok();
        let mut inner: Vec<u32> = chains.iter().flatten().copied().filter(is_inner).map(lower).collect();
        inner.sort_unstable();
        inner.dedup();
        let first = self.cuts.len() as u32 | CUT;
        let edge = first + 2 * inner.len() as u32;
        let outer = |h: u32| match inner.binary_search(&lower(h)) {
            Ok(i) => first + 2 * i as u32 + u32::from(h > self.twin(h)),
            Err(_) => self.twins[h as usize],
        };
        let mut again = vec![edge];
        again.extend((0..).zip(&inner).filter(|(_, h)| self.is_locked(**h)).map(|(i, _)| first + 2 * i));
        let mut chains = [(0, v, edge), (1, u, edge + 1)].map(|(i, vertex, cut)| {
            let side = |&h: &u32| Side { vertex: self.vertex(h), outer: outer(h) };
            let mut chain: Vec<Side> = chains[i].iter().map(side).collect();
            chain.push(Side { vertex, outer: cut });
            chain
        });
        let t = slots[0];
        let [Some(one), Some(other)] = [&chains[0], &chains[1]].map(|chain| self.ears(chain, t)) else {
            return false;
        };
        let is_there = |p: u32, q: u32| {
            let mut star = Star::new(&self.triangles, &self.twins, fans, corners[p as usize]);
            star.any(|corner| self.vertex(next(corner)) == q || self.vertex(prev(corner)) == q)
        };
        // All chords but that of the last ear, which is the edge.
        for (chain, ears) in chains.iter().zip([&one, &other]) {
            let (_, chords) = ears.split_last().unwrap_or((&[0; 3], &[]));
            if chords.iter().any(|&[i, _, j]| is_there(chain[i].vertex, chain[j].vertex)) {
                return false;
            }
        }
        self.cuts.resize((edge ^ CUT) as usize + 2, NONE);
        self.fill(&mut chains[0], &one, &slots[..one.len()]);
        self.fill(&mut chains[1], &other, &slots[one.len()..]);
        for cut in again {
            self.lock(self.cuts[(cut ^ CUT) as usize]);
        }
        for h in slots.iter().flat_map(|slot| 3 * slot..3 * slot + 3) {
            corners[self.vertex(h) as usize] = h;
        }
        true
    }

    fn lock(&mut self, h: u32) {
        let twin = self.twin(h);
        if twin != NONE {
            self.join(h | LOCKED, twin);
        }
    }

    /// What an edge from u to v crosses, if it leaves the first triangle over half-edge `h`. `None` if it meets a vertex,
    /// or an edge that has to stay.
    fn crossed(&self, [u, v]: [u32; 2], mut h: u32) -> Option<Crossed> {
        let (mut slots, mut right, mut left) = (vec![triangle_of(h)], vec![prev(h)], vec![next(h)]);
        loop {
            let g = self.twin(h);
            if g == NONE || self.is_locked(h) || !self.is_right(triangle_of(g)) {
                return None;
            }
            slots.push(triangle_of(g));
            let far = self.vertex(prev(g));
            let sign = self.sign(triangle_of(g), [u, v, far]);
            if far == v || sign.is_lt() {
                right.push(next(g));
            }
            if far == v || sign.is_gt() {
                left.push(prev(g));
            }
            if far == v {
                left.reverse();
                return Some(Crossed { slots, chains: [right, left] });
            }
            h = match sign {
                Ordering::Greater => next(g),
                Ordering::Less => prev(g),
                Ordering::Equal => return None,
            };
        }
    }
}
