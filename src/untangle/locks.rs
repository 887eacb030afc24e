//! Locked edges come back. The triangles that such an edge crosses give way to others on both of its sides.

use super::sheet::{CUT, Lost, Sheet, Side};
use crate::NONE;
use crate::mesh::half_edge::{LOCKED, next, prev, triangle_of};
use crate::mesh::named_edges::ordered;
use crate::mesh::star::Star;
use std::cmp::Ordering;
use std::collections::{BTreeMap, BTreeSet};

/// What an edge crosses.
struct Crossed {
    slots: Vec<u32>,
    /// The half-edges from its first end to its second on the right, and back on the left.
    chains: [Vec<u32>; 2],
}

/// Finds the corners of each vertex, while triangles are replaced.
struct Corners {
    /// A corner of each vertex.
    one: Vec<u32>,
    /// All corners of the vertices that have several fans.
    of_fans: BTreeMap<u32, BTreeSet<u32>>,
}

impl Corners {
    fn new(sheet: &Sheet) -> Self {
        let one = vec![NONE; sheet.mesh.vertex_count()];
        let several = (0..).zip(sheet.fans().table).take(one.len()).filter(|&(_, list)| list != NONE);
        let mut corners = Self { of_fans: several.map(|(v, _)| (v, BTreeSet::new())).collect(), one };
        let all: Vec<u32> = (0..sheet.triangles.len() as u32 / 3).collect();
        corners.learn(sheet, &all);
        corners
    }

    fn of<'a>(&'a self, sheet: &'a Sheet, v: u32) -> impl Iterator<Item = u32> + 'a {
        let all = self.of_fans.get(&v);
        let one = if all.is_none() { self.one[v as usize] } else { NONE };
        Star::of_fan(&sheet.twins, one).chain(all.into_iter().flatten().copied())
    }

    fn forget(&mut self, sheet: &Sheet, slots: &[u32]) {
        if self.of_fans.is_empty() {
            return;
        }
        for h in slots.iter().flat_map(|slot| 3 * slot..3 * slot + 3) {
            if let Some(all) = self.of_fans.get_mut(&sheet.vertex(h)) {
                all.remove(&h);
            }
        }
    }

    fn learn(&mut self, sheet: &Sheet, slots: &[u32]) {
        for h in slots.iter().flat_map(|slot| 3 * slot..3 * slot + 3) {
            let v = sheet.vertex(h);
            if let Some(one) = self.one.get_mut(v as usize) {
                *one = h;
            }
            if !self.of_fans.is_empty()
                && let Some(all) = self.of_fans.get_mut(&v)
            {
                all.insert(h);
            }
        }
    }
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
        let mut corners = Corners::new(self);
        for edge in lost {
            if !self.bring(edge, &mut corners) {
                self.lost.push(Lost { edge, component: NONE });
            }
        }
    }

    /// Brings one edge in. Returns whether the mesh has the edge now.
    fn bring(&mut self, [u, v]: [u32; 2], corners: &mut Corners) -> bool {
        let [u, v] = self.shorter([u, v], corners);
        let (mut starts, mut found) = (Vec::new(), None);
        for h in corners.of(self, u) {
            let [x, y] = [next(h), prev(h)].map(|x| self.vertex(x));
            if x == v || y == v {
                found = Some(if x == v { h } else { prev(h) });
            }
            let t = triangle_of(h);
            if self.sign(t, [u, x, v]).is_gt() && self.sign(t, [u, v, y]).is_gt() {
                starts.push(next(h));
            }
        }
        if let Some(h) = found {
            self.lock(h);
            return true;
        }
        starts.into_iter().any(|h| self.bring_over([u, v], h, corners))
    }

    /// Two vertices, first that with fewer corners.
    fn shorter(&self, [u, v]: [u32; 2], corners: &Corners) -> [u32; 2] {
        let [mut one, mut other] = [u, v].map(|end| corners.of(self, end));
        loop {
            if one.next().is_none() {
                return [u, v];
            }
            if other.next().is_none() {
                return [v, u];
            }
        }
    }

    /// Brings an edge in that leaves its first triangle over half-edge `h`.
    fn bring_over(&mut self, [u, v]: [u32; 2], h: u32, corners: &mut Corners) -> bool {
        let Some(Crossed { mut slots, chains }) = self.crossed([u, v], h) else { return false };
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
        let chains = [(0, v, edge), (1, u, edge + 1)].map(|(i, vertex, cut)| {
            let side = |&h: &u32| Side { vertex: self.vertex(h), outer: outer(h) };
            let mut chain: Vec<Side> = chains[i].iter().map(side).collect();
            chain.push(Side { vertex, outer: cut });
            chain
        });
        let fillings = chains.map(|chain| self.filling(&[chain], slots[0]));
        let [Some(one), Some(other)] = &fillings else { return false };
        let count = one.triangles.len();
        let is_there = |ends: [u32; 2]| {
            let [p, q] = self.shorter(ends, corners);
            corners.of(self, p).any(|x| self.vertex(next(x)) == q || self.vertex(prev(x)) == q)
        };
        if count + other.triangles.len() != slots.len()
            || [one, other].iter().any(|part| part.chords().any(is_there))
        {
            return false;
        }
        corners.forget(self, &slots);
        self.cuts.resize((edge ^ CUT) as usize + 2, NONE);
        self.put_filling(one, &slots[..count]);
        self.put_filling(other, &slots[count..]);
        corners.learn(self, &slots);
        for cut in again {
            self.lock(self.cuts[(cut ^ CUT) as usize]);
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
