//! Lift: a vertex of a turned triangle leaves the mesh, and triangles fill its link. They need not be positive: with fewer
//! vertices, more links are. Those that gain most go first.

use super::rounds::{Claims, MOST};
use super::{Frame, Loose};
use crate::NONE;
use crate::mesh::half_edge::{LOCKED, next, prev, triangle_of, unflagged};
use crate::mesh::star::are_joined;
use crate::untangle::divide::join;
use std::cmp::Ordering;

/// The most steps around two vertices that look for a common edge.
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
    /// A bit for each triangle of the star that is turned.
    turned: u32,
}

/// For each side or chord of a link, from its first corner to its last: [`MOST`] times how few turned triangles fill the
/// part between them, plus the third corner of its triangle.
type Chords = [[u16; MOST]; MOST];

/// The triangles of a filling, each of three corners of a link.
type Parts = [[usize; 3]; MOST];

/// The cost of a chord that would join two vertices a second time.
pub(super) const NEVER: u16 = 15;

impl Frame<'_> {
    /// Finds the corners of a triangle, if it is turned, whose vertices may be lifted, and the keys of these. Of the turned
    /// triangles around a vertex, the lowest claims for it.
    pub(super) fn find_candidates(&self, triangle: u32, claims: &Claims, found: &mut Vec<(u32, u32)>) {
        for h in 3 * triangle..3 * triangle + 3 {
            let Some(star) = self.candidate(h, claims.most()) else { continue };
            let cost = star.cost(&self.plan(&star));
            if cost < NEVER {
                let gain = star.turned.count_ones() + BIAS;
                let key = claims.key(self.name(self.vertex(h)), gain.saturating_sub(cost.into()));
                found.push((h, key));
            }
        }
    }

    /// Claims the vertex that a corner starts at, and its link.
    pub(super) fn claim_star(&self, corner: u32, key: u32, claims: &mut Claims) {
        claims.claim(&[self.vertex(corner)], key);
        let mut h = corner;
        while {
            claims.claim(&[self.vertex(next(h))], key);
            h = unflagged(self.twins[prev(h) as usize]);
            h != corner
        } {}
    }

    /// Takes the vertex out that a corner of a turned triangle claims for, if it has kept its claims.
    pub(super) fn lift(&mut self, corner: u32, claims: &Claims) -> Option<Loose> {
        // If its triangle has changed by now, this is another vertex, which has not claimed for itself, or none.
        let vertex = self.vertex(corner);
        let key = if vertex == NONE { None } else { claims.own(vertex, self.name(vertex)) }?;
        let star = self.candidate(corner, claims.most())?;
        if !claims.have(&star.ring[..star.degree], key) {
            return None;
        }
        let chords = self.plan(&star);
        let (near, slots) = self.fill(&star, &chords);
        for slot in slots {
            self.set_triangle(slot, [NONE; 3]);
            self.twins[3 * slot as usize] = near;
        }
        Some(Loose { vertex, slots, at: near, target: NONE })
    }

    /// The star of the vertex that `corner` starts at, if it is whole, of at most `most` triangles and without locked edges,
    /// and the triangle of `corner` is the lowest turned one. A vertex with several fans stays, and so do its neighbours,
    /// so that its fans keep their anchors.
    fn candidate(&self, corner: u32, most: usize) -> Option<Candidate> {
        let v = self.vertex(corner);
        if v == NONE {
            return None;
        }
        let lowest = self.triangle_name(triangle_of(corner));
        let mut star = Candidate { corners: [0; MOST], ring: [0; MOST], degree: 0, turned: 0 };
        let mut h = corner;
        while h != corner || star.degree == 0 {
            let (t, u) = (triangle_of(h), self.vertex(next(h)));
            if star.degree == most || u == v || self.fans.has_several(v) || self.fans.has_several(u) {
                return None;
            }
            star.corners[star.degree] = h;
            star.ring[star.degree] = u;
            let is_turned = self.sign(t, self.corners(t))?.is_le();
            star.turned |= u32::from(is_turned) << star.degree;
            star.degree += 1;
            let entry = self.twins[prev(h) as usize];
            // The first triangle has to be turned.
            if star.turned & 1 == 0 || is_turned && self.triangle_name(t) < lowest || entry & LOCKED != 0 {
                return None;
            }
            h = unflagged(entry);
        }
        (star.degree > 2).then_some(star)
    }

    /// The chords without those that would join two vertices a second time. Mostly there are none, so only the chords of
    /// the best filling are tested first: without the others, it stays the best.
    fn plan(&self, star: &Candidate) -> Chords {
        let chords = self.chords(star, false);
        let (parts, count) = star.parts(&chords);
        for &[i, _, j] in &parts[1..count] {
            if self.has_edge(star, [i, j]) {
                return self.chords(star, true);
            }
        }
        chords
    }

    /// Finds the chords by dynamic programming. `looks`: whether to look for other edges between their ends.
    fn chords(&self, star: &Candidate, looks: bool) -> Chords {
        let mut chords = [[0; MOST]; MOST];
        let last = star.degree - 1;
        for length in 2..=last {
            for i in 0..=last - length {
                let j = i + length;
                let mut least = NEVER * MOST as u16;
                if length == last || !looks || !self.has_edge(star, [i, j]) {
                    for (k, to) in chords.iter().enumerate().take(j).skip(i + 1) {
                        let mut cost = cost_of(chords[i][k]) + cost_of(to[j]);
                        if cost < cost_of(least) {
                            cost += u16::from(!self.is_right(star, [i, k, j]));
                            least = least.min(cost * MOST as u16 + k as u16);
                        }
                    }
                }
                chords[i][j] = least;
            }
        }
        chords
    }

    /// Whether three corners of a link make a positive triangle.
    fn is_right(&self, star: &Candidate, corners: [usize; 3]) -> bool {
        let vertices = corners.map(|corner| star.ring[corner]);
        self.sign(triangle_of(star.corners[0]), vertices) == Some(Ordering::Greater)
    }

    /// Whether an edge joins two vertices of a link. If both have large stars, it is as if one did.
    fn has_edge(&self, star: &Candidate, ends: [usize; 2]) -> bool {
        are_joined(self.triangles, self.twins, self.fans, ends.map(|end| next(star.corners[end])), LARGE)
    }

    /// Fills a link. Turned triangles take the first slots, where turned ones were first, others the last ones. Returns the
    /// slot of a triangle, and the two slots that are left.
    fn fill(&mut self, star: &Candidate, chords: &Chords) -> (u32, [u32; 2]) {
        let (mut slots, mut end) = ([NONE; MOST], 0);
        for half in [1, 0] {
            for i in (0..star.degree).filter(|i| star.turned >> i & 1 == half) {
                slots[end] = triangle_of(star.corners[i]);
                end += 1;
            }
        }
        // The entry on the other side of each side, and of each chord that a triangle has already.
        let mut entries = [[NONE; MOST]; MOST];
        for i in 0..star.degree {
            let [from, to] = if i + 1 < star.degree { [i, i + 1] } else { [0, i] };
            entries[from][to] = self.twins[next(star.corners[i]) as usize];
        }
        let (mut first, mut near) = (0, NONE);
        let (parts, count) = star.parts(chords);
        for &[i, k, j] in &parts[..count] {
            let cost = cost_of(chords[i][k]) + cost_of(chords[k][j]);
            let is_right = cost == cost_of(chords[i][j]);
            end -= usize::from(is_right);
            let slot = slots[if is_right { end } else { first }];
            first += usize::from(!is_right);
            near = if near == NONE { slot } else { near };
            self.set_triangle(slot, [i, k, j].map(|corner| star.ring[corner]));
            join(self.twins, 3 * slot + 2, entries[i][j]);
            for (side, [from, to]) in [(3 * slot, [i, k]), (3 * slot + 1, [k, j])] {
                join(self.twins, side, entries[from][to]);
                entries[from][to] = side;
            }
        }
        (near, [slots[first], slots[first + 1]])
    }
}

impl Candidate {
    fn cost(&self, chords: &Chords) -> u16 {
        cost_of(chords[0][self.degree - 1])
    }

    /// The triangles of a filling, and their number. Each comes after the one on the other side of its chord from the first
    /// corner to the last.
    fn parts(&self, chords: &Chords) -> (Parts, usize) {
        let (mut parts, mut count) = ([[0; 3]; MOST], 0);
        let (mut open, mut left) = ([[0; 2]; MOST], 1);
        open[0] = [0, self.degree - 1];
        while left > 0 {
            left -= 1;
            let [i, j] = open[left];
            if j - i > 1 {
                let k = chords[i][j] as usize % MOST;
                parts[count] = [i, k, j];
                count += 1;
                (open[left], open[left + 1]) = ([i, k], [k, j]);
                left += 2;
            }
        }
        (parts, count)
    }
}

fn cost_of(chord: u16) -> u16 {
    chord / MOST as u16
}
