//! Lift: a vertex of a turned triangle leaves the mesh, and triangles fill its link. They need not be positive: with fewer
//! vertices, more links are. Those that gain most go first.

use super::rounds::Claims;
use super::{Frame, Loose};
use crate::NONE;
use crate::mesh::half_edge::{LOCKED, next, prev, triangle_of, unflagged};
use crate::mesh::star::Star;
use crate::untangle::divide::join;
use std::cmp::Ordering;

/// The most triangles of a star that is lifted.
pub(super) const MOST: usize = 16;

/// The most triangles of one of two stars that are searched for a common edge.
pub(super) const LARGE: u32 = 64;

/// What is added to a gain, so that it is rarely negative.
pub(super) const BIAS: u32 = 4;

/// A vertex that may be lifted.
struct Candidate {
    /// The corners around it, from that of its lowest turned triangle on.
    corners: [u32; MOST],
    /// The vertices of its link.
    ring: [u32; MOST],
    degree: usize,
    /// How many triangles of the star are turned.
    turned: u32,
}

/// For each side or chord of a link, from its first corner to its last, how few turned triangles fill the part between them.
type Costs = [[u8; MOST]; MOST];

/// The cost of a chord that would join two vertices a second time.
pub(super) const NEVER: u8 = 15;

impl Frame<'_> {
    /// The corners of a triangle, if it is turned, whose vertices may be lifted, and the keys of these. Of the turned
    /// triangles around a vertex, the lowest claims for it.
    pub(super) fn candidates(&self, triangle: u32, claims: &Claims) -> impl Iterator<Item = (u32, u32)> {
        let corners = if self.is_turned(triangle) { 3 * triangle..3 * triangle + 3 } else { 0..0 };
        corners.filter_map(|h| {
            let star = self.candidate(h)?;
            let cost = self.plan(&star)[0][star.degree - 1];
            let gain = (star.turned + BIAS).saturating_sub(cost.into());
            (cost < NEVER).then(|| (h, claims.key(self.name(self.vertex(h)), gain)))
        })
    }

    /// Takes the vertex out that a corner of a turned triangle claims for, if it has kept its claims.
    pub(super) fn lift(&mut self, corner: u32, claims: &Claims, written: &mut Vec<u32>) -> Option<Loose> {
        // If its triangle has changed by now, this is another vertex, which has not claimed for itself, or none.
        let vertex = self.vertex(corner);
        let key = if vertex == NONE { None } else { claims.own(vertex, self.name(vertex)) }?;
        let star = self.candidate(corner)?;
        if !claims.have(&star.ring[..star.degree], key) {
            return None;
        }
        let costs = self.plan(&star);
        // Turned triangles get the slots of turned ones first, which the list has.
        let slots = star.corners[..star.degree].iter().map(|&h| triangle_of(h));
        let (mut slots, right) = slots.partition::<Vec<_>, _>(|&slot| self.is_turned(slot));
        slots.extend(right);
        written.extend(&slots);
        let (near, slots) = self.fill(&star, &costs, &slots);
        for h in slots.map(|slot| 3 * slot as usize) {
            self.triangles[h..h + 3].fill(NONE);
            self.twins[h] = near;
        }
        Some(Loose { vertex, slots, at: near, target: NONE })
    }

    /// The star of the vertex that `corner` starts at, if it is whole, not too large and without locked edges, and the
    /// triangle of `corner` is the lowest turned one. A vertex with several fans stays, and so do its neighbours, so that its
    /// fans keep their anchors.
    fn candidate(&self, corner: u32) -> Option<Candidate> {
        let v = self.vertex(corner);
        let lowest = self.triangle_name(triangle_of(corner));
        let mut star = Candidate { corners: [0; MOST], ring: [0; MOST], degree: 0, turned: 0 };
        let mut h = corner;
        while h != corner || star.degree == 0 {
            let (t, u) = (triangle_of(h), self.vertex(next(h)));
            if star.degree == MOST || u == v || [u, v].iter().any(|&v| self.fans.has_several(v)) {
                return None;
            }
            star.corners[star.degree] = h;
            star.ring[star.degree] = u;
            star.degree += 1;
            if self.sign(t, self.corners(t))?.is_le() {
                star.turned += 1;
                if self.triangle_name(t) < lowest {
                    return None;
                }
            }
            let entry = self.twins[prev(h) as usize];
            if entry == NONE || entry & LOCKED != 0 {
                return None;
            }
            h = unflagged(entry);
        }
        (star.degree > 2).then_some(star)
    }

    /// The costs without chords that would join two vertices a second time. Mostly there are none, so only the chords of
    /// the best filling are tested first: without the others, it stays the best.
    fn plan(&self, star: &Candidate) -> Costs {
        let costs = self.costs(star, false);
        let last = star.degree - 1;
        let mut open = vec![[0, last]];
        while let Some([i, j]) = open.pop() {
            if j - i < last && self.has_edge(star, [i, j]) {
                return self.costs(star, true);
            }
            let k = self.apex(star, &costs, [i, j]).1;
            open.extend([[i, k], [k, j]].into_iter().filter(|[from, to]| to - from > 1));
        }
        costs
    }

    /// Finds the costs by dynamic programming. `looks`: whether to look for other edges between the ends of chords.
    fn costs(&self, star: &Candidate, looks: bool) -> Costs {
        let mut costs = [[NEVER; MOST]; MOST];
        let last = star.degree - 1;
        for i in 0..last {
            costs[i][i + 1] = 0;
        }
        for length in 2..=last {
            for i in 0..=last - length {
                let j = i + length;
                if length == last || !looks || !self.has_edge(star, [i, j]) {
                    costs[i][j] = self.apex(star, &costs, [i, j]).0;
                }
            }
        }
        costs
    }

    /// The cost of a chord, and the third corner of its triangle.
    fn apex(&self, star: &Candidate, costs: &Costs, [i, j]: [usize; 2]) -> (u8, usize) {
        let mut best = (NEVER, i);
        for (k, to) in costs.iter().enumerate().take(j).skip(i + 1) {
            let cost = costs[i][k] + to[j];
            if cost < best.0 {
                best = best.min((cost + u8::from(!self.is_right(star, [i, k, j])), k));
            }
        }
        best
    }

    /// Whether three corners of a link make a positive triangle.
    fn is_right(&self, star: &Candidate, corners: [usize; 3]) -> bool {
        let vertices = corners.map(|corner| star.ring[corner]);
        self.sign(triangle_of(star.corners[0]), vertices) == Some(Ordering::Greater)
    }

    /// Whether an edge joins two vertices of a link. The star of either gives the answer. If both are large, it is as if one
    /// did.
    fn has_edge(&self, star: &Candidate, ends: [usize; 2]) -> bool {
        let corners = ends.map(|end| next(star.corners[end]));
        let [u, v] = ends.map(|end| star.ring[end]);
        let joins =
            |corner: u32, far: u32| [next(corner), prev(corner)].iter().any(|&h| self.vertex(h) == far);
        let mut walks = corners.map(|corner| Star::new(self.triangles, self.twins, self.fans, corner));
        for step in 0..=LARGE {
            let [Some(at_u), Some(at_v)] = walks.each_mut().map(Iterator::next) else { return false };
            if step == LARGE || joins(at_u, v) || joins(at_v, u) {
                break;
            }
        }
        true
    }

    /// Fills a link. Turned triangles take the first slots, others the last ones. Returns the slot of a triangle, and the
    /// two slots that are left.
    fn fill(&mut self, star: &Candidate, costs: &Costs, mut slots: &[u32]) -> (u32, [u32; 2]) {
        let outer = star.corners.map(|corner| self.twins[next(corner) as usize]);
        let last = star.degree - 1;
        // Sides and chords with a part to fill, and the entry on their other side.
        let mut open = vec![([0, last], outer[last])];
        let mut near = NONE;
        while let Some(([i, j], entry)) = open.pop() {
            let k = self.apex(star, costs, [i, j]).1;
            let is_right = self.is_right(star, [i, k, j]);
            let slot = if is_right { slots.split_off_last() } else { slots.split_off_first() };
            let Some(&slot) = slot else { break };
            if near == NONE {
                near = slot;
            }
            let h = 3 * slot;
            for (corner, at) in [i, k, j].into_iter().zip(h as usize..) {
                self.triangles[at] = star.ring[corner];
            }
            join(self.twins, h + 2, entry);
            for (side, [from, to]) in [(h, [i, k]), (h + 1, [k, j])] {
                if to == from + 1 {
                    join(self.twins, side, outer[from]);
                } else {
                    open.push(([from, to], side));
                }
            }
        }
        (near, [slots[0], slots[1]])
    }
}
