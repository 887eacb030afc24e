//! Lift: vertices of turned triangles leave the mesh, in rounds. A GPU can do the same rounds: each decision depends on
//! the state before the round only, and what two winners write does not overlap.
//!
//! A candidate is a vertex of a turned triangle whose link, the ring of edges around its star, can be filled with
//! positive triangles. It claims its star and the triangles on the other side of the link. Of the candidates that claim
//! a triangle, the one with the smallest key keeps it; who keeps all of its triangles, leaves.

use super::sheet::{Loose, Sheet, Side};
use crate::NONE;
use crate::mesh::half_edge::{next, prev, triangle_of};
use crate::phases::key;

/// The most triangles of a star that a round lifts.
const MOST: usize = 16;

/// The smallest key that claims each triangle.
pub(super) type Claims = Vec<u64>;

/// No claim.
pub(super) const FREE: u64 = u64::MAX;

/// A vertex that may leave.
struct Candidate {
    /// First those that remove most turned triangles; then a hash. No two candidates of a component have the same.
    key: u64,
    star: Star,
}

/// The corners of a star in their order, from the lowest on.
#[derive(Clone, Copy)]
struct Star {
    corners: [u32; MOST],
    degree: usize,
}

impl Sheet<'_> {
    /// Lifts vertices until no turned triangle has one that may leave. `turned` has the turned triangles, before and
    /// after.
    pub(super) fn lift(&mut self, turned: &mut Vec<u32>, claims: &mut Claims) {
        for round in 0.. {
            turned.retain(|&t| !self.is_right(t));
            let candidates = self.candidates(turned, round);
            if candidates.is_empty() {
                return;
            }
            for Candidate { key, star } in &candidates {
                self.each_claimed(star, |t| claims[t as usize] = claims[t as usize].min(*key));
            }
            let mut is_winner = Vec::with_capacity(candidates.len());
            for Candidate { key, star } in &candidates {
                let mut wins = true;
                self.each_claimed(star, |t| wins &= claims[t as usize] == *key);
                is_winner.push(wins);
            }
            for Candidate { star, .. } in &candidates {
                self.each_claimed(star, |t| claims[t as usize] = FREE);
            }
            for (Candidate { star, .. }, _) in candidates.iter().zip(is_winner).filter(|(_, wins)| *wins) {
                self.take_out(star);
            }
        }
    }

    fn candidates(&self, turned: &[u32], round: u32) -> Vec<Candidate> {
        let corners = turned.iter().flat_map(|t| 3 * t..3 * t + 3);
        let component = |h: u32| self.components()[triangle_of(h) as usize];
        let mut corners: Vec<_> = corners.map(|h| (self.vertex(h), component(h), h)).collect();
        corners.sort_unstable();
        corners.dedup_by_key(|&mut (v, component, _)| (v, component));
        let candidate = |(v, _, h)| {
            let star = self.star(h)?;
            self.triangulation(&self.link(&star)[..star.degree], triangle_of(h))?;
            let gain = star.corners().iter().filter(|&&h| !self.is_right(triangle_of(h))).count();
            Some(Candidate { key: ((MOST - gain) as u64) << 32 | u64::from(key(v, round)), star })
        };
        corners.into_iter().filter_map(candidate).collect()
    }

    /// The star of the vertex that `corner` starts at; `None` if rounds do not lift it.
    fn star(&self, corner: u32) -> Option<Star> {
        let v = self.vertex(corner);
        if self.is_pinned(v, triangle_of(corner)) {
            return None;
        }
        let mut star = Star { corners: [NONE; MOST], degree: 0 };
        let mut h = corner;
        loop {
            *star.corners.get_mut(star.degree)? = h;
            star.degree += 1;
            h = self.twin(prev(h));
            if h == corner {
                break;
            }
        }
        let corners = &mut star.corners[..star.degree];
        let lowest = corners.iter().enumerate().min_by_key(|&(_, h)| h).map_or(0, |(i, _)| i);
        corners.rotate_left(lowest);
        // A dirty star may meet itself.
        let slots = star.slots();
        let is_inside = |h: u32| h != NONE && slots[..star.degree].contains(&triangle_of(h));
        let sides = star.corners().iter().map(|&h| next(h));
        let meets = sides.clone().any(|side| self.vertex(side) == v || is_inside(self.twin(side)));
        let is_alone = star.degree < 3 && sides.clone().all(|side| self.twin(side) == NONE);
        (!meets && !is_alone).then_some(star)
    }

    fn link(&self, star: &Star) -> [Side; MOST] {
        star.corners.map(|corner| {
            if corner == NONE {
                return Side::default();
            }
            let side = next(corner);
            Side { vertex: self.vertex(side), outer: self.twins[side as usize] }
        })
    }

    fn each_claimed(&self, star: &Star, mut visit: impl FnMut(u32)) {
        for &corner in star.corners() {
            visit(triangle_of(corner));
            let across = self.twin(next(corner));
            if across != NONE {
                visit(triangle_of(across));
            }
        }
    }

    /// Positive triangles that fill a ring, by dynamic programming over its chords: for each chord from i to j that can
    /// be one, a corner between them. The chord that closes the ring is the last. `None` if there are none.
    fn triangulation(&self, ring: &[Side], t: u32) -> Option<[[u8; MOST]; MOST]> {
        let mut apex = [[0; MOST]; MOST];
        for length in 2..ring.len() {
            for i in 0..ring.len() - length {
                let j = i + length;
                let is_side = |i: usize, j: usize, apex: u8| j == i + 1 || apex > 0;
                let fits = |&k: &usize| {
                    is_side(i, k, apex[i][k])
                        && is_side(k, j, apex[k][j])
                        && self.sign(t, [i, k, j].map(|corner| ring[corner].vertex)).is_gt()
                };
                apex[i][j] = (i + 1..j).find(fits).unwrap_or(0) as u8;
            }
        }
        (ring.len() == 2 || apex[0][ring.len() - 1] > 0).then_some(apex)
    }

    /// Takes the vertex of a star out, and fills its link.
    fn take_out(&mut self, star: &Star) {
        let (degree, vertex) = (star.degree, self.vertex(star.corners[0]));
        for &corner in star.corners() {
            if self.is_locked(corner) {
                self.lose(corner);
            }
        }
        let mut link = self.link(star);
        let Some(apex) = self.triangulation(&link[..degree], triangle_of(star.corners[0])) else { return };
        let mut ears = Vec::with_capacity(degree);
        cut_ears(&apex, [0, degree - 1], &mut ears);
        let slots = star.slots();
        let near = self.fill(&mut link[..degree], &ears, &slots[..degree]);
        self.loose.push(Loose { vertex, slots: [slots[degree - 2], slots[degree - 1]], near });
    }
}

/// The triangles on one side of a chord, each when its first two edges are sides or chords of earlier ones.
fn cut_ears(apex: &[[u8; MOST]; MOST], [i, j]: [usize; 2], ears: &mut Vec<[usize; 3]>) {
    if j > i + 1 {
        let k = usize::from(apex[i][j]);
        cut_ears(apex, [i, k], ears);
        cut_ears(apex, [k, j], ears);
        ears.push([i, k, j]);
    }
}

impl Star {
    fn corners(&self) -> &[u32] {
        &self.corners[..self.degree]
    }

    /// The slots of its triangles, in ascending order.
    fn slots(&self) -> [u32; MOST] {
        let mut slots = self.corners.map(|h| if h == NONE { NONE } else { triangle_of(h) });
        slots.sort_unstable();
        slots
    }
}
