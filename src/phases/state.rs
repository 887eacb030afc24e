//! The state that the phases read, and the order of edges in an iteration.

use crate::mesh::embedded::Embedded;
use crate::mesh::half_edge::unflagged;
use crate::mesh::star::Fans;
use crate::mesh::winding::Winding;
use crate::{Dimension, NONE, Positions};

/// In `best`: the triangle has no labelled edge, but an edge blocked as a duplicate, so it stays in the frontier.
pub(crate) const BLOCKED: u32 = NONE - 1;

/// Limits for flips in space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Thresholds {
    /// cos β.
    pub(crate) cos: f64,
    /// The largest distance between the lines of the old and the new diagonal. Infinity sets no limit.
    pub(crate) deviation: f32,
}

impl Default for Thresholds {
    /// Without limits.
    fn default() -> Self {
        Self { cos: -1.0, deviation: f32::INFINITY }
    }
}

/// The geometry. The phases never write it.
pub(crate) struct Geometry<'a> {
    pub(crate) dimension: Dimension,
    pub(crate) positions: &'a Positions,
    pub(crate) thresholds: Thresholds,
    pub(crate) winding: &'a Winding,
    pub(crate) embedded: &'a Embedded,
    /// Whether there may be numbers that are not finite. Edges with such a number are left alone.
    pub(crate) has_infinite: bool,
}

/// The triangles and twins before a phase: of the whole mesh, or of a range of its triangles.
#[derive(Clone, Copy)]
pub(crate) struct Topology<'a> {
    /// The first half-edge of the range.
    pub(crate) first: u32,
    pub(crate) triangles: &'a [u32],
    pub(crate) twins: &'a [u32],
    pub(crate) fans: &'a Fans,
}

impl Topology<'_> {
    /// The vertex that a half-edge starts at.
    #[inline(always)]
    pub(crate) fn vertex(&self, h: u32) -> u32 {
        self.triangles[(h - self.first) as usize]
    }

    /// The entry of a half-edge in the twins.
    #[inline(always)]
    pub(crate) fn twin(&self, h: u32) -> u32 {
        self.twins[(h - self.first) as usize]
    }

    /// Whether `h` is a half-edge of these triangles. [`NONE`] is not.
    #[inline(always)]
    pub(crate) fn has(&self, h: u32) -> bool {
        (h.wrapping_sub(self.first) as usize) < self.twins.len()
    }

    /// Whether a half-edge has a twin outside these triangles.
    #[inline(always)]
    pub(crate) fn leaves(&self, h: u32) -> bool {
        let g = unflagged(self.twin(h));
        g != NONE && !self.has(g)
    }
}

/// The key of an edge in an iteration: an integer hash. The edge with the smallest key wins. `edge` is the lower
/// half-edge: of the two half-edges, the one with the smaller index. For each iteration the hash is a bijection, so no
/// two edges tie. The key changes with the iteration; otherwise chains of neighbours would flip one by one.
#[inline]
pub(crate) fn key(edge: u32, iteration: u32) -> u32 {
    let mut x = edge ^ iteration.wrapping_mul(0x9e37_79b9);
    x = (x ^ (x >> 16)).wrapping_mul(0x7feb_352d);
    x = (x ^ (x >> 15)).wrapping_mul(0x846c_a68b);
    x ^ (x >> 16)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::MAX_TRIANGLES;
    use crate::mesh::half_edge::{FLAGS, LOCKED};

    #[test]
    fn half_edges_leave_room_for_flags() {
        let last = 3 * MAX_TRIANGLES as u32 - 1;
        assert!(last < LOCKED && last | FLAGS < BLOCKED);
        assert_eq!([unflagged(last | FLAGS), unflagged(NONE)], [last, NONE]);
    }
}
