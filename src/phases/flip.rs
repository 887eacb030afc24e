//! Flip and update: rewrites the two triangles of each selected edge, and the twins around them.

use crate::NONE;
use crate::mesh::half_edge::{FLAGS, next, prev, triangle_of};
use crate::mesh::star::Fans;
use crate::system::threads::{Threads, Word};
use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

/// A word for each triangle. While edges bid, the word is the smallest key. After that, it is [`NONE`] if no edge of
/// the triangle is selected. If one is, the word has the twin of the selected half-edge, and in the bits of [`FLAGS`]
/// the index of the half-edge that the flip moves: the one after the selected half-edge, counted from 0 to 2 in its
/// triangle. In [`NONE`], these bits are 3.
#[derive(Default)]
pub(crate) struct Selected(Vec<AtomicU32>);

impl Selected {
    /// Selects no edge, for `triangles` triangles.
    pub(crate) fn new(triangles: usize, threads: &Threads) -> Self {
        Self(threads.collect(triangles, |_| AtomicU32::new(NONE)))
    }

    /// The word of the triangle of `h`.
    #[inline(always)]
    fn word(&self, h: u32) -> &AtomicU32 {
        &self.0[triangle_of(h) as usize]
    }

    /// Lets an edge bid for its two triangles, which must have no selected edge. The smallest key wins, whatever the
    /// order of bids. No two edges have the same key. `is_alone`: whether no other thread bids.
    #[inline(always)]
    pub(crate) fn bid(&self, edge: [u32; 2], key: u32, is_alone: bool) {
        for x in edge {
            let word = self.word(x);
            if is_alone {
                // A branch would be unpredictable.
                word.set(key.min(word.get()));
            } else if key < word.get() {
                // A bid that loses costs only this load.
                word.fetch_min(key, Relaxed);
            }
        }
    }

    /// Whether an edge has won the triangle of its half-edge `x`, after all bids.
    #[inline(always)]
    pub(crate) fn has_won(&self, x: u32, key: u32) -> bool {
        self.word(x).get() == key
    }

    /// Selects an edge.
    pub(crate) fn choose(&self, [h, g]: [u32; 2]) {
        for (x, twin) in [(h, g), (g, h)] {
            self.word(x).set(twin | (next(x) - 3 * triangle_of(x)) << FLAGS.trailing_zeros());
        }
    }

    /// Selects no edge of the triangle of `x`.
    #[inline(always)]
    pub(crate) fn release(&self, x: u32) {
        self.word(x).set(NONE);
    }

    /// Whether no edge of the triangle of `h` is selected.
    #[inline(always)]
    pub(crate) fn is_free(&self, h: u32) -> bool {
        self.word(h).get() == NONE
    }

    /// The selected half-edge of triangle `t`, and its twin.
    pub(crate) fn pair(&self, t: u32) -> Option<(u32, u32)> {
        let word = self.0[t as usize].get();
        (word != NONE).then(|| (prev(3 * t + (word >> FLAGS.trailing_zeros())), word & !FLAGS))
    }

    /// The index of a half-edge after the iteration, and whether no edge of its triangle is selected. If the half-edge
    /// follows a selected half-edge, it moves to the index of the twin of that half-edge. The result depends only on
    /// the state before the phase.
    #[inline(always)]
    fn slot(&self, x: u32) -> (u32, bool) {
        let word = self.word(x).get();
        let moves = x - 3 * triangle_of(x) == word >> FLAGS.trailing_zeros();
        (if moves { word & !FLAGS } else { x }, word == NONE)
    }
}

/// Moves the anchors of the fans with their half-edges. Call it before `edges` flip.
pub(crate) fn move_anchors(fans: &mut Fans, triangles: &[u32], selected: &Selected, edges: &[[u32; 2]]) {
    if fans.table.is_empty() {
        return;
    }
    for edge in edges {
        for moved in edge.map(next) {
            fans.move_anchor(triangles[moved as usize], moved, selected.slot(moved).0);
        }
    }
}

/// The surroundings of a flipped edge. First the twin entries of the four outer half-edges, which start at a, c, b and
/// d. An entry is [`NONE`] on the boundary. It is also [`NONE`] if the neighbour has flipped too, and the neighbour's
/// flip is the one that tests this outer edge. Then the vertices a, b, c and d.
pub(crate) type Around = [[u32; 4]; 2];

/// Flips a selected edge. Reads only the vertices and twins of its own two triangles. Writes these, and the entries of
/// neighbours without a selected edge. Returns the surroundings after the iteration.
#[inline(always)]
pub(crate) fn flip(
    triangles: &[AtomicU32],
    twins: &[AtomicU32],
    selected: &Selected,
    [h, g]: [u32; 2],
) -> Around {
    let read = |words: &[AtomicU32], i: u32| words[i as usize].get();
    let write = |words: &[AtomicU32], i: u32, word: u32| words[i as usize].set(word);
    let [hn, hp, gn, gp] = [next(h), prev(h), next(g), prev(g)];
    let vertices @ [_, _, c, d] = [h, g, hp, gp].map(|x| read(triangles, x));
    let mut outer = [gn, hp, hn, gp].map(|x| read(twins, x));
    for (inner, twin) in [h, hp, g, gp].into_iter().zip(&mut outer) {
        if *twin == NONE {
            write(twins, inner, NONE);
            continue;
        }
        let (x, flags) = (*twin & !FLAGS, *twin & FLAGS);
        let (slot, is_free) = selected.slot(x);
        // A branch would be unpredictable. So if nothing has to be written, this writes a word that is overwritten
        // below.
        write(twins, if is_free { x } else { hn }, inner | flags);
        write(twins, inner, slot | flags);
        // If the neighbour has flipped too, only one of the two flips tests the edge between them.
        *twin = if is_free | (inner < slot) { slot | flags } else { NONE };
    }
    write(triangles, hn, d);
    write(triangles, gn, c);
    write(twins, hn, gn);
    write(twins, gn, hn);
    [outer, vertices]
}
