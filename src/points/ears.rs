//! The order in which the corners of a polygon come off as ears. Neighbours one after the other would make a fan of long
//! triangles, and flips would have to undo it; with corners here and there, few flips are left, as Chew has it ("Building
//! Voronoi diagrams for convex polygons in linear expected time", 1990). The order is always the same.

use std::ops::Range;

/// A polygon, or a row of vertices whose ends stay.
pub(crate) struct Corners {
    before: Vec<u32>,
    after: Vec<u32>,
    /// Which corners may come off.
    inner: Range<u32>,
    /// Those that are to be looked at, once each.
    waiting: Vec<u32>,
    is_waiting: Vec<bool>,
}

impl Corners {
    /// So many corners in a ring. Those in `inner` may come off.
    pub(crate) fn new(count: usize, inner: Range<usize>) -> Self {
        let inner = inner.start as u32..inner.end as u32;
        let last = (count as u32).saturating_sub(1);
        let mut waiting: Vec<u32> = inner.clone().collect();
        let mut state = 1u64;
        for i in (1..waiting.len()).rev() {
            // Knuth's generator.
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            waiting.swap(i, (state >> 33) as usize % (i + 1));
        }
        Self {
            before: (0..=last).map(|i| if i == 0 { last } else { i - 1 }).collect(),
            after: (0..=last).map(|i| if i == last { 0 } else { i + 1 }).collect(),
            inner,
            waiting,
            is_waiting: vec![true; count],
        }
    }

    /// The next corner to look at, between the corners before and after it.
    pub(crate) fn next(&mut self) -> Option<[usize; 3]> {
        let corner = self.waiting.pop()? as usize;
        self.is_waiting[corner] = false;
        Some([self.before[corner] as usize, corner, self.after[corner] as usize])
    }

    /// Takes the middle one of three corners off. Its neighbours are looked at again.
    pub(crate) fn cut(&mut self, [before, _, after]: [usize; 3]) {
        self.after[before] = after as u32;
        self.before[after] = before as u32;
        for corner in [before, after] {
            if self.inner.contains(&(corner as u32)) && !self.is_waiting[corner] {
                self.is_waiting[corner] = true;
                self.waiting.push(corner as u32);
            }
        }
    }
}
