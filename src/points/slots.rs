//! The triangles while they are made. A triangle on the hull has a neighbour beyond: a ghost, whose third corner is a
//! symbolic vertex. So V vertices always have 2V - 2 triangles, and each set of neighbouring vertices has its own slots.
//!
//! Half-edge h belongs to slot h / 4 and goes from its corner h % 4 to the next; h % 4 is never 3.

use std::ops::DerefMut;

/// The symbolic vertex.
pub(super) const GHOST: u32 = u32::MAX;

/// A triangle, and the twins of its half-edges. A slot is half a cache line.
#[derive(Clone, Copy, Default)]
#[repr(align(32))]
pub(super) struct Slot {
    /// Vertices, counter-clockwise. The fourth number has a bit for each half-edge: whether it is locked.
    pub(super) corners: [u32; 4],
    /// Half-edges; the fourth is unused.
    pub(super) twins: [u32; 4],
}

/// The half-edge after `h` in its triangle.
#[inline(always)]
pub(super) fn next(h: u32) -> u32 {
    if h & 3 == 2 { h - 2 } else { h + 1 }
}

/// The half-edge before `h` in its triangle.
#[inline(always)]
pub(super) fn prev(h: u32) -> u32 {
    if h & 3 == 0 { h + 2 } else { h - 1 }
}

/// All slots, or some of them, of which the first has the number `first`.
pub(super) struct Slots<S> {
    pub(super) slots: S,
    pub(super) first: u32,
}

impl<S: DerefMut<Target = [Slot]>> Slots<S> {
    /// The slots before and after the two from `slot`.
    pub(super) fn halves(&mut self, slot: u32) -> [Slots<&mut [Slot]>; 2] {
        let (low, rest) = self.slots.split_at_mut((slot - self.first) as usize);
        [Slots { slots: low, first: self.first }, Slots { slots: &mut rest[2..], first: slot + 2 }]
    }

    #[inline(always)]
    fn slot(&self, h: u32) -> &Slot {
        &self.slots[(h >> 2).wrapping_sub(self.first) as usize]
    }

    #[inline(always)]
    fn slot_mut(&mut self, h: u32) -> &mut Slot {
        &mut self.slots[(h >> 2).wrapping_sub(self.first) as usize]
    }

    /// The vertex at which a half-edge begins.
    #[inline(always)]
    pub(super) fn origin(&self, h: u32) -> u32 {
        self.slot(h).corners[h as usize & 3]
    }

    /// The vertex of its triangle that is not on the half-edge.
    #[inline(always)]
    pub(super) fn apex(&self, h: u32) -> u32 {
        self.origin(prev(h))
    }

    /// The ends of the edge of two half-edges, and then their apexes.
    #[inline(always)]
    pub(super) fn diamond(&self, h: u32, g: u32) -> [u32; 4] {
        let corners = |h: u32| {
            let (corners, corner) = (&self.slot(h).corners, h as usize & 3);
            (corners[corner], corners[[2, 0, 1, 3][corner]])
        };
        let ((a, c), (b, d)) = (corners(h), corners(g));
        [a, b, c, d]
    }

    #[inline(always)]
    pub(super) fn twin(&self, h: u32) -> u32 {
        self.slot(h).twins[h as usize & 3]
    }

    #[inline(always)]
    pub(super) fn set_origin(&mut self, h: u32, vertex: u32) {
        self.slot_mut(h).corners[h as usize & 3] = vertex;
    }

    /// Whether the edge must not flip.
    #[inline(always)]
    pub(super) fn is_locked(&self, h: u32) -> bool {
        self.slot(h).corners[3] >> (h & 3) & 1 != 0
    }

    #[inline(always)]
    pub(super) fn set_locked(&mut self, h: u32, is_locked: bool) {
        let bits = &mut self.slot_mut(h).corners[3];
        *bits = *bits & !(1 << (h & 3)) | u32::from(is_locked) << (h & 3);
    }

    /// Writes the twin of one half-edge only.
    #[inline(always)]
    pub(super) fn set_twin(&mut self, h: u32, g: u32) {
        self.slot_mut(h).twins[h as usize & 3] = g;
    }

    /// Makes two half-edges twins of each other.
    #[inline(always)]
    pub(super) fn join(&mut self, h: u32, g: u32) {
        self.set_twin(h, g);
        self.set_twin(g, h);
    }

    /// Writes the corners of a slot. Returns its first half-edge.
    pub(super) fn put(&mut self, slot: u32, [a, b, c]: [u32; 3]) -> u32 {
        self.slot_mut(4 * slot).corners = [a, b, c, 0];
        4 * slot
    }

    /// Writes the ghost along the other side of an edge. Returns the half-edge of the edge.
    pub(super) fn put_ghost(&mut self, slot: u32, [a, b]: [u32; 2]) -> u32 {
        self.put(slot, [a, b, GHOST])
    }

    /// Joins the ghosts along a hull, each to the one after it.
    pub(super) fn join_ring(&mut self, ghosts: &[u32]) {
        for (i, &h) in ghosts.iter().enumerate() {
            self.join(h + 1, ghosts[(i + 1) % ghosts.len()] + 2);
        }
    }

    /// The half-edge to the symbolic vertex from the next vertex along the hull, counter-clockwise. `h` is such a
    /// half-edge too.
    #[inline(always)]
    pub(super) fn along_hull(&self, h: u32) -> u32 {
        self.twin(next(h))
    }

    /// The same of the vertex before.
    #[inline(always)]
    pub(super) fn back_along_hull(&self, h: u32) -> u32 {
        prev(self.twin(h))
    }

    /// The vertices of the hull, counter-clockwise, from the one where this half-edge to the symbolic vertex begins.
    pub(super) fn hull(&self, first: u32) -> Vec<u32> {
        let mut vertices = vec![self.origin(first)];
        let mut h = self.along_hull(first);
        while h != first {
            vertices.push(self.origin(h));
            h = self.along_hull(h);
        }
        vertices
    }
}
