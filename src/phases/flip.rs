//! Flip with Update: rotate the two triangles of each selected edge in place and repair the twins around.

use crate::NONE;
use crate::mesh::half_edge::{FLAGS, next, prev, triangle_of};
use crate::mesh::star::Fans;
use crate::system::threads::{Threads, Word};
use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

/// For each triangle the twin of its half-edge that flips, with the place of the next one in the triangle in the bits of
/// [`FLAGS`]: that one moves. Or [`NONE`], whose place is none.
#[derive(Default)]
pub(crate) struct Selected(Vec<AtomicU32>);

impl Selected {
    /// No edge of so many triangles.
    pub(crate) fn new(triangles: usize, threads: &Threads) -> Self {
        Self(threads.collect(triangles, |_| AtomicU32::new(NONE)))
    }

    /// That of the triangle of `h`.
    #[inline(always)]
    fn word(&self, h: u32) -> &AtomicU32 {
        &self.0[triangle_of(h) as usize]
    }

    /// Lets the edge of two half-edges bid for its triangles, of which no edge is selected: the smallest key stays,
    /// whichever comes first. No two edges have the same.
    #[inline(always)]
    pub(crate) fn bid(&self, edge: [u32; 2], key: u32) {
        for x in edge {
            let word = self.word(x);
            // Those that lose need no more than a load.
            if key < word.get() {
                word.fetch_min(key, Relaxed);
            }
        }
    }

    /// Whether an edge has won the triangle of its half-edge `x`, once all have bidden.
    #[inline(always)]
    pub(crate) fn has_won(&self, x: u32, key: u32) -> bool {
        self.word(x).get() == key
    }

    /// Selects the edge of two half-edges.
    pub(crate) fn choose(&self, [h, g]: [u32; 2]) {
        for (x, twin) in [(h, g), (g, h)] {
            self.word(x).set(twin | (next(x) - 3 * triangle_of(x)) << FLAGS.trailing_zeros());
        }
    }

    /// No edge of the triangle of `x` is selected.
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

    /// Where a half-edge will be after the iteration: the one after a selected one moves into the place of the selected
    /// one's twin. A function of the state before the phase. And whether no edge of its triangle is selected.
    #[inline(always)]
    fn slot(&self, x: u32) -> (u32, bool) {
        let word = self.word(x).get();
        let moves = x - 3 * triangle_of(x) == word >> FLAGS.trailing_zeros();
        (if moves { word & !FLAGS } else { x }, word == NONE)
    }
}

/// Moves the anchors of the fans with their half-edges; before the flips of these edges.
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

/// What is around an edge that has flipped: the entries in the twins of the half-edges from a, c, b and d, [`NONE`] where
/// the edge is tested from its other side; then a, b, c and d.
pub(crate) type Around = [[u32; 4]; 2];

/// Flips the selected edge of two half-edges. Reads the corners and twins of its own two triangles only; writes those, and
/// the entries of the neighbours that are not selected themselves. Returns what is around it after the iteration.
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
    let corners @ [_, _, c, d] = [h, g, hp, gp].map(|x| read(triangles, x));
    let mut outer = [gn, hp, hn, gp].map(|x| read(twins, x));
    for (inner, twin) in [h, hp, g, gp].into_iter().zip(&mut outer) {
        if *twin == NONE {
            write(twins, inner, NONE);
            continue;
        }
        let (x, flags) = (*twin & !FLAGS, *twin & FLAGS);
        let (slot, is_free) = selected.slot(x);
        // Where there is nothing to write, a word that is written below; nothing could predict a branch.
        write(twins, if is_free { x } else { hn }, inner | flags);
        write(twins, inner, slot | flags);
        // Between two that have flipped, one of them tests.
        *twin = if is_free | (inner < slot) { slot | flags } else { NONE };
    }
    write(triangles, hn, d);
    write(triangles, gn, c);
    write(twins, hn, gn);
    write(twins, gn, hn);
    [outer, corners]
}
