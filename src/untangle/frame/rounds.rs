//! The rounds. Their number is fixed, so a GPU needs no answer of the host: what is turned over after the last round, the
//! next update lifts. Each decision depends on the state before the round only.
//!
//! In each round, candidates claim vertices: a word for each vertex keeps the smallest key of those that claim it. A
//! candidate that has kept all its claims acts. So what two of them change does not overlap:
//!
//! - A vertex v that is lifted claims itself and its link. It writes the triangles around it, and the twins on the other
//!   side of the link. Suppose that w does so, too. A triangle around both would have w in the link of v. And if a side of
//!   the link of v has a triangle around w on its other side, its ends are in both links.
//! - A vertex that is put back claims the corners of its triangle. It writes this triangle, two slots of its own, and the
//!   twins on the other side of the triangle. Triangles without a common corner have no common side.
//!
//! Nor do they change what the others read when they act: the triangles around vertices that these have claimed.
//!
//! No lift makes an edge between vertices that have one: it looks for it in both stars, and nobody else makes an edge at a
//! vertex that it has claimed. So two edges never join the same vertices, and the link of a vertex does not meet itself.

use super::{Frame, Loose};
use crate::NONE;
use crate::system::threads::{self, Threads};
use std::ops::Range;

/// Rounds that lift.
pub(super) const LIFTS: u32 = 16;

/// The most triangles of a star that is lifted.
pub(super) const MOST: usize = 16;

/// The same in the first round. It grows by one from round to round, so that few large stars are left when their turn
/// comes. They take the most work, and a GPU waits for the slowest.
pub(super) const FIRST_MOST: u32 = 5;

/// Rounds after them that put vertices back where their points are.
pub(super) const PUTS: u32 = 10;

/// Rounds after them that put a vertex where its walk has come to, whatever the signs.
pub(super) const STRAYS: u32 = 4;

/// The last rounds, of any number, put a vertex where it was lifted, whatever the signs. Few wait for the same triangle
/// there, and in each round one of those that wait is put back.
const HOME: u32 = LIFTS + PUTS + STRAYS;

/// Bits of a key below those of the round.
pub(super) const KEY_BITS: u32 = 27;

/// The fewest turned triangles, or vertices that are out, of a piece for a thread.
const FEWEST: usize = 256;

/// The smallest key of those that claim each vertex.
pub(super) struct Claims {
    words: Vec<u32>,
    bits: u32,
    round: u32,
}

/// Two words for each item of a loop that has some.
type Pairs = Vec<(u32, u32)>;

/// The pairs of all pieces of a loop over `0..len`, in order. Not generic, so that it is compiled once.
fn gather(
    threads: &Threads,
    pieces: Vec<Range<usize>>,
    work: &(dyn Fn(Range<usize>, &mut Pairs) + Sync),
) -> Pairs {
    let of_piece = |piece| {
        let mut pairs = Vec::new();
        work(piece, &mut pairs);
        pairs
    };
    threads.map_each(pieces, of_piece).concat()
}

impl Frame<'_> {
    /// Lifts vertices of turned triangles, and puts them back.
    pub(crate) fn untangle(&mut self, vertices: usize, threads: &Threads) {
        let (triangles, frame) = (self.triangles.len() / 3, &*self);
        let turned = gather(threads, threads.pieces(triangles, threads::FEWEST), &|piece, turned| {
            for t in piece.map(|t| t as u32).filter(|&t| frame.is_turned(t)) {
                turned.push((t, 0));
            }
        });
        // A GPU has two words for each triangle: for the claims, for this list, and for the vertices that are out.
        let needed = vertices.max(triangles) + turned.len() + triangles / 2;
        if turned.is_empty() || needed > 2 * triangles || vertices > 1 << KEY_BITS {
            return;
        }
        let (mut claims, mut waiting) = (Claims::new(vertices), Vec::new());
        for round in 0..LIFTS {
            claims.round = round;
            let frame = &*self;
            let candidates = gather(threads, threads.pieces(turned.len(), FEWEST), &|piece, found| {
                for &(t, _) in &turned[piece] {
                    frame.find_candidates(t, &claims, found);
                }
            });
            if candidates.is_empty() && claims.most() == MOST {
                break;
            }
            for &(corner, key) in &candidates {
                self.claim_star(corner, key, &mut claims);
            }
            for (corner, _) in candidates {
                waiting.extend(self.lift(corner, &claims));
            }
        }
        claims.round = LIFTS;
        while !waiting.is_empty() {
            self.put_back(&mut waiting, &mut claims, threads);
            claims.round = HOME.min(claims.round + 1);
        }
    }

    fn put_back(&mut self, waiting: &mut Vec<Loose>, claims: &mut Claims, threads: &Threads) {
        let (frame, round) = (&*self, claims.round);
        let aims = gather(threads, threads.pieces(waiting.len(), FEWEST), &|piece, aims| {
            for loose in &waiting[piece] {
                aims.push(frame.aim(loose, round));
            }
        });
        // The last rounds have one number, so nobody may have claimed in an earlier one.
        if round == HOME {
            for &(_, target) in &aims {
                for v in self.corners(target) {
                    claims.words[v as usize] = NONE;
                }
            }
        }
        for (loose, &(at, target)) in waiting.iter_mut().zip(&aims) {
            (loose.at, loose.target) = (at, target);
            if target != NONE {
                claims.claim(&self.corners(target), claims.key(self.name(loose.vertex), 0));
            }
        }
        let mut i = 0;
        while i < waiting.len() {
            if self.put(&waiting[i], claims) {
                waiting.swap_remove(i);
            } else {
                i += 1;
            }
        }
    }

    /// The triangle to which the walk of a vertex comes in a round, and the one that it claims.
    fn aim(&self, loose: &Loose, round: u32) -> (u32, u32) {
        let from = if round == HOME { self.twins[3 * loose.slots[0] as usize] } else { loose.at };
        let at = self.filled(from);
        if round < HOME - STRAYS { self.walk(loose.vertex, at, round) } else { (at, at) }
    }
}

impl Claims {
    fn new(vertices: usize) -> Self {
        let bits = vertices.next_power_of_two().trailing_zeros();
        Self { words: vec![NONE; vertices], bits, round: 0 }
    }

    /// The key of the vertex with this name, which no other has. First come later rounds, because nobody clears the
    /// claims of earlier ones; then those with the largest gain; then a hash.
    pub(super) fn key(&self, name: u32, gain: u32) -> u32 {
        let most = (1 << (KEY_BITS - self.bits)) - 1;
        (HOME - self.round) << KEY_BITS | (most - gain.min(most)) << self.bits | self.hash(name)
    }

    /// A bijection.
    fn hash(&self, name: u32) -> u32 {
        name.wrapping_mul(0x9e37_79b1) & ((1 << self.bits) - 1)
    }

    pub(super) fn claim(&mut self, vertices: &[u32], key: u32) {
        for &v in vertices {
            let word = &mut self.words[v as usize];
            *word = key.min(*word);
        }
    }

    /// The key of a vertex, if it has kept its claim for itself.
    pub(super) fn own(&self, v: u32, name: u32) -> Option<u32> {
        let word = self.words[v as usize];
        let is_own =
            word >> KEY_BITS == HOME - self.round && word & ((1 << self.bits) - 1) == self.hash(name);
        is_own.then_some(word)
    }

    /// The most triangles of a star that is lifted in this round.
    pub(super) fn most(&self) -> usize {
        MOST.min((FIRST_MOST + self.round) as usize)
    }

    pub(super) fn have(&self, vertices: &[u32], key: u32) -> bool {
        vertices.iter().all(|&v| self.words[v as usize] == key)
    }
}
