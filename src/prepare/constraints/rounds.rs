//! Brings constraints in, on several threads, with the result of one after another.
//!
//! A round takes the next constraints that wait. All are walked, which changes nothing. Those that are free come in; the
//! others wait for the next round. A constraint is free if it and an earlier one of the round are apart: neither crosses
//! a triangle that the other crosses, reads or has beside it. Constraints that are apart come in in any order with the
//! same result, because only triangles that a constraint crosses change, and the neighbours' links to them.
//!
//! The triangles that a constraint crosses cover the same region before and after. So an earlier constraint that waits
//! stays within the triangles that it, or one before it, has claimed. It does not meet the free ones in a later round
//! either.
//!
//! Where the mesh overlaps, a constraint may have several ways to go, and the edges of other places may block its ears.
//! An earlier one may change both, if it or this one meets suspects: vertices whose stars may not be embedded. While such
//! a constraint waits, so do all after it. The first of a round is always free, unless its walk is cut short.

use super::state::{Links, State};
use super::walk::{Obstacle, Part, Walk, Way};
use crate::system::threads::Threads;
use std::collections::VecDeque;
use std::mem;

/// The most constraints of a round.
const MOST: usize = 1 << 10;

/// The fewest triangles that ends the walk of a constraint in a round of several. Small in debug builds, for the tests.
const FEWEST: usize = if cfg!(debug_assertions) { 8 } else { 64 };

/// The constraints that wait, by their indices, in order.
pub(super) struct Rounds {
    waiting: VecDeque<usize>,
    /// The number of constraints that the next round takes.
    size: usize,
    claims: Claims,
    threads: Threads,
}

/// The edges of a constraint, each with its two vertices and a half-edge.
type Edges = Vec<([u32; 2], u32)>;

/// A constraint that has had its turn.
pub(super) struct Done {
    pub(super) index: usize,
    pub(super) edges: Result<Edges, Obstacle>,
    /// The number of edges that it crossed.
    pub(super) crossed: usize,
}

impl Rounds {
    pub(super) fn new(count: usize, threads: Threads) -> Self {
        let size = if threads.is_one() { 1 } else { MOST };
        Self { waiting: (0..count).collect(), size, claims: Claims::default(), threads }
    }

    /// Makes the constraints from `index` on wait no longer.
    pub(super) fn end_at(&mut self, index: usize) {
        self.waiting.retain(|&other| other < index);
    }

    /// Runs a round. The constraints that came in are not locked yet. `None` if none waits.
    pub(super) fn next(&mut self, state: &mut State, constraints: &[[u32; 2]]) -> Option<Vec<Done>> {
        let taken: Vec<usize> = self.waiting.drain(..self.size.min(self.waiting.len())).collect();
        if taken.is_empty() {
            return None;
        }
        // So the walks of a round take a bounded part of the memory that the mesh takes.
        let most = match taken.len() {
            1 => usize::MAX,
            count => (state.triangles.len() / 6 / count).max(FEWEST),
        };
        let walk = |&index: &usize| state.walk(constraints[index], most);
        let walks = self.threads.map_each(self.threads.pieces(taken.len(), 1), |piece| {
            taken[piece].iter().map(walk).collect::<Vec<_>>()
        });
        let walks: Vec<Option<Walk>> = walks.into_iter().flatten().collect();
        let is_any_cut = walks.iter().any(Option::is_none);
        let (free, others) = self.claims.divide(state, taken.into_iter().zip(walks));
        if !self.threads.is_one() {
            // Walks of constraints that are not free are lost.
            let size = if others.is_empty() { 2 * self.size } else { 2 * free.len() };
            self.size = if is_any_cut { self.size / 2 } else { size }.clamp(1, MOST);
        }
        others.into_iter().rev().for_each(|index| self.waiting.push_front(index));
        Some(self.bring_in(state, free))
    }

    /// Brings in a constraint through vertices, from each to the next. At an obstacle, triangles before it have changed.
    pub(super) fn bring_in_chain(&self, state: &mut State, index: usize, chain: &[u32]) -> Done {
        let mut crossed = 0;
        let mut bring_in = || {
            let mut edges = Vec::new();
            for (&from, &to) in chain.iter().zip(&chain[1..]) {
                let walk = state.walk([from, to], usize::MAX).map(|walk| (index, walk));
                for done in self.bring_in(state, Vec::from_iter(walk)) {
                    crossed += done.crossed;
                    edges.extend(done.edges?);
                }
            }
            // A later step may have renumbered the half-edges of an earlier one, or crossed it where the mesh overlaps.
            for (ends, h) in &mut edges {
                *h = state.half_edge(*ends).ok_or(Obstacle::Doubled(*ends))?;
            }
            Ok(edges)
        };
        let edges = bring_in();
        Done { index, edges, crossed }
    }

    /// Brings in constraints that are apart.
    fn bring_in(&self, state: &mut State, mut free: Vec<(usize, Walk)>) -> Vec<Done> {
        let changed: Vec<_> = free.iter_mut().map(|(_, walk)| mem::take(&mut walk.crossed)).collect();
        state.leave(changed.iter().flatten().copied());
        let links = state.links();
        let done = self.threads.map_each(free, |(index, walk)| {
            let (edges, crossed) = match come_in(links, walk) {
                Ok((edges, crossed)) => (Ok(edges), crossed),
                Err(obstacle) => (Err(obstacle), 0),
            };
            Done { index, edges, crossed }
        });
        state.enter(changed.iter().flatten().copied());
        done
    }
}

/// Brings a constraint in, or changes nothing. Returns its edges, and the number of edges that it crossed.
fn come_in(links: Links, Walk { parts, mut known, .. }: Walk) -> Result<(Edges, usize), Obstacle> {
    let parts = parts?;
    // No part crosses a triangle of another one.
    let ears = parts.iter().map(|part| match &part.way {
        Way::Edge(_) => Ok(Vec::new()),
        Way::Across(region) => links.ears(region, known.as_mut()),
    });
    let ears: Vec<_> = ears.collect::<Result<_, _>>()?;
    let mut crossed = 0;
    let edge = |(Part { ends, way }, ears): (Part, Vec<_>)| match way {
        Way::Edge(h) => (ends, h),
        Way::Across(region) => {
            crossed += region.triangles.len() - 1;
            (ends, links.fill(&region, &ears))
        }
    };
    let edges = parts.into_iter().zip(ears).map(edge).collect();
    Ok((edges, crossed))
}

/// For each triangle, the last round in which a constraint has crossed it, and the last in which one has crossed it, read
/// it or had it beside it.
#[derive(Default)]
struct Claims {
    round: u32,
    crossed: Vec<u32>,
    read: Vec<u32>,
}

impl Claims {
    /// Divides the constraints of a round: those that are free, and the others. What a constraint will meet is not known
    /// if its walk was cut short, or if it waits, and it or an earlier one meets suspects. Then all after it wait too.
    fn divide(
        &mut self,
        state: &State,
        walks: impl ExactSizeIterator<Item = (usize, Option<Walk>)>,
    ) -> (Vec<(usize, Walk)>, Vec<usize>) {
        let (mut free, mut others) = (Vec::new(), Vec::new());
        if walks.len() == 1 {
            free.extend(walks.filter_map(|(index, walk)| Some((index, walk?))));
            return (free, others);
        }
        self.round += 1;
        for list in [&mut self.crossed, &mut self.read] {
            list.resize(state.triangles.len() / 3, 0);
        }
        let (mut is_known, mut is_embedded) = (true, true);
        for (index, walk) in walks {
            is_embedded &= walk.as_ref().is_some_and(|walk| walk.suspects.is_empty());
            match walk {
                Some(walk) if is_known && self.claim(state, &walk) => free.push((index, walk)),
                _ => {
                    is_known &= is_embedded;
                    others.push(index);
                }
            }
        }
        (free, others)
    }

    /// Claims the triangles of a constraint. Returns whether it and each one that has claimed are apart.
    fn claim(&mut self, state: &State, Walk { crossed, around, .. }: &Walk) -> bool {
        let beside = crossed.iter().flat_map(|&t| state.beside(t));
        let read: Vec<u32> = around.iter().chain(crossed).copied().chain(beside).collect();
        let is_in = |list: &[u32], t: u32| list[t as usize] == self.round;
        let is_free =
            !read.iter().any(|&t| is_in(&self.crossed, t)) && !crossed.iter().any(|&t| is_in(&self.read, t));
        for (list, triangles) in [(&mut self.read, &read), (&mut self.crossed, crossed)] {
            triangles.iter().for_each(|&t| list[t as usize] = self.round);
        }
        is_free
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "what fails here is a failed test")]

    use super::*;
    use crate::families;
    use oorandom::Rand64;

    /// A race of two threads is too rare for a test, so this one asks for its cause.
    #[test]
    fn free_constraints_are_apart() {
        let mut random = Rand64::new(1);
        let (mut apart, mut others) = (0, 0);
        for seed in 0..200 {
            let mesh = families::by_name(&format!("random 12 seed={seed}")).unwrap();
            let state = State::new(&mesh, &[], &Threads::one());
            let mut vertex = || random.rand_range(0..144) as u32;
            let walks = (0..8).map(|i| (i, state.walk([vertex(), vertex()], usize::MAX)));
            let (free, waiting) = Claims::default().divide(&state, walks);
            others += waiting.len();
            for (i, (_, one)) in free.iter().enumerate() {
                for (_, other) in &free[..i] {
                    apart += 1;
                    for [one, other] in [[one, other], [other, one]] {
                        for &t in &one.crossed {
                            assert!(!other.crossed.contains(&t) && !other.around.contains(&t));
                            assert!(state.beside(t).all(|t| !other.crossed.contains(&t)));
                        }
                    }
                }
            }
        }
        assert!(apart > 100 && others > 500, "{apart}, {others}");
    }
}
