//! Rings of any length: several rings become one by cuts between them, and ears fill it.
//!
//! A ring is filled right if all its triangles are positive, however they were found: they then cover each point as often
//! as the ring goes round it. So the tests below only have to find them where the rings do not cross.

use super::sheet::{CUT, Sheet, Side};
use crate::NONE;
use std::cmp::Ordering;

impl Sheet<'_> {
    /// Joins rings to one. `None` if a ring does not see a vertex before it. In a polygon with holes each does: without
    /// an edge to a vertex before it, the first vertex of a hole would have an angle of a half round.
    pub(super) fn one_ring(&mut self, mut rings: Vec<Vec<Side>>, t: u32) -> Option<Vec<Side>> {
        let sides: Vec<[u32; 2]> = rings.iter().flat_map(|ring| ends(ring)).collect();
        let mut all = self.take_first(&mut rings)?.1;
        while let Some((j, ring)) = self.take_first(&mut rings) {
            let to = ring[j].vertex;
            // The corners before it, from the nearest on.
            let mut last = (to, 0);
            let i = loop {
                let before = (0..all.len()).filter(|&i| self.compare_sides((all[i].vertex, i), last).is_lt());
                let i = before.max_by(|&i, &k| self.compare_sides((all[i].vertex, i), (all[k].vertex, k)))?;
                last = (all[i].vertex, i);
                if self.is_within(t, &all, i, to)
                    && self.is_within(t, &ring, j, last.0)
                    && sides.iter().all(|&side| !self.meets(t, [last.0, to], side))
                {
                    break i;
                }
            };
            let cut = self.cuts.len() as u32 | CUT;
            self.cuts.extend([NONE; 2]);
            let mut joined = all[..=i].to_vec();
            joined[i].outer = cut;
            joined.extend_from_slice(&ring[j..]);
            joined.extend_from_slice(&ring[..j]);
            joined.push(Side { vertex: to, outer: cut + 1 });
            joined.extend_from_slice(&all[i..]);
            all = joined;
        }
        Some(all)
    }

    /// Removes the ring with the first vertex of all, and returns it with the index of this vertex in it.
    fn take_first(&self, rings: &mut Vec<Vec<Side>>) -> Option<(usize, Vec<Side>)> {
        let corners = rings.iter().enumerate().flat_map(|(n, ring)| (0..ring.len()).map(move |i| (n, i)));
        let vertex = |(n, i): (usize, usize)| rings[n][i].vertex;
        let (n, i) = corners.min_by(|&one, &other| self.compare(vertex(one), vertex(other)))?;
        Some((i, rings.swap_remove(n)))
    }

    /// The order of corners of a ring; a vertex may have several.
    fn compare_sides(&self, (u, i): (u32, usize), (v, k): (u32, usize)) -> Ordering {
        self.compare(u, v).then(i.cmp(&k))
    }

    /// The order of the vertices from left to right.
    fn compare(&self, u: u32, v: u32) -> Ordering {
        let [p, q] = self.mesh.positions().points2([u, v]);
        p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y)).then(u.cmp(&v))
    }

    /// Whether the direction from corner i of a ring to vertex `to` leads inside.
    fn is_within(&self, t: u32, ring: &[Side], i: usize, to: u32) -> bool {
        let [before, at, after] = [i + ring.len() - 1, i, i + 1].map(|i| ring[i % ring.len()].vertex);
        let [first, second] =
            [[before, at, to], [at, after, to]].map(|corners| self.sign(t, corners).is_gt());
        if self.sign(t, [before, at, after]).is_gt() { first && second } else { first || second }
    }

    /// Whether a segment meets a side elsewhere than in a common vertex.
    fn meets(&self, t: u32, [p, q]: [u32; 2], [x, y]: [u32; 2]) -> bool {
        let is_common = |v: u32| v == p || v == q;
        if is_common(x) || is_common(y) {
            return false;
        }
        let [from_x, from_y] = [x, y].map(|v| self.sign(t, [p, q, v]));
        if from_x.is_eq() && from_y.is_eq() {
            return [x, y].iter().any(|&v| self.compare(v, p) != self.compare(v, q));
        }
        let [from_p, from_q] = [p, q].map(|v| self.sign(t, [x, y, v]));
        from_x != from_y && from_p != from_q
    }

    /// Ears that fill a ring, for [`Sheet::fill`]; `None` if the search ends before. A corner is an ear if its triangle
    /// is positive and meets no other part of the ring.
    pub(super) fn ears(&self, ring: &[Side], t: u32) -> Option<Vec<[usize; 3]>> {
        let count = ring.len();
        let mut before: Vec<_> = (0..count).map(|i| (i + count - 1) % count).collect();
        let mut after: Vec<_> = (0..count).map(|i| (i + 1) % count).collect();
        let mut ears = Vec::with_capacity(count);
        // What a corner that is no ear waits for: mostly, one of its neighbours has to go.
        let mut tested = vec![usize::MAX; count];
        let (mut k, mut left, mut misses, mut since) = (0, count, 0, count);
        while left > 2 {
            let (i, j) = (before[k], after[k]);
            if tested[k] > since && self.is_ear(t, ring, &after, [i, k, j]) {
                ears.push([i, k, j]);
                (after[i], before[j]) = (j, i);
                (tested[i], tested[j]) = (usize::MAX, usize::MAX);
                (left, misses) = (left - 1, 0);
                // The ear after the next keeps the triangles from meeting in one corner.
                k = after[j];
                continue;
            }
            if tested[k] > since {
                tested[k] = left;
            }
            k = j;
            misses += 1;
            if misses > left {
                if since == left {
                    return None;
                }
                // In degenerate rings, others may be ears by now, too.
                (since, misses) = (left, 0);
            }
        }
        Some(ears)
    }

    fn is_ear(&self, t: u32, ring: &[Side], after: &[usize], ear: [usize; 3]) -> bool {
        let [a, b, c] = ear.map(|i| ring[i].vertex);
        if !self.sign(t, [a, b, c]).is_gt() {
            return false;
        }
        let leaves = |v: u32| self.sign(t, [c, a, v]).is_lt();
        let lies_between = |v: u32, least: Ordering| {
            [[a, b, v], [b, c, v]].iter().all(|&corners| self.sign(t, corners) >= least)
        };
        let mut i = ear[2];
        while i != ear[0] {
            let [v, w] = [i, after[i]].map(|i| ring[i].vertex);
            let is_new = v != a && v != b && v != c;
            if is_new && !leaves(v) && lies_between(v, Ordering::Equal) {
                return false;
            }
            // A side that begins or ends where the ear has its tip may cross the ear, because cuts repeat vertices.
            let other = if v == b { Some(w) } else { (w == b).then_some(v) };
            if other.is_some_and(|other| lies_between(other, Ordering::Greater)) {
                return false;
            }
            i = after[i];
        }
        true
    }
}

/// The two vertices of each side.
fn ends(ring: &[Side]) -> impl Iterator<Item = [u32; 2]> {
    (0..ring.len()).map(|i| [ring[i].vertex, ring[(i + 1) % ring.len()].vertex])
}
