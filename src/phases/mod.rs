//! The four phases of an iteration, as pure functions over slices: Label, Select, Flip with Update. Every
//! decision is a gather from the state before the phase, every word has one writer.
//!
//! ```text
//!         c                   c
//!       /   \               / | \        h: a → b, twin g: b → a
//!  prev/     \next      prev  |  g       after the flip the triangles are
//!    a ---h--- b          a   |   b      (a, d, c) in the place of (a, b, c) and
//!      \     /              h | prev     (b, c, d) in the place of (b, a, d)
//!       \   /               \ | /
//!         d                   d
//! ```

mod crease;
mod flip;
pub(crate) mod frozen;
mod label;
mod select;

pub(crate) use crease::flag_creases;
pub(crate) use flip::{Around, Selected, flip, move_anchors};
pub(crate) use label::{
    Diamond, Verdict, keep_non_delaunay, label, makes_duplicate, verdict, verdict_of_shape,
};
pub(crate) use select::{select, yields};

use crate::mesh::Dimension;
use crate::mesh::adjacency::unflagged;
use crate::mesh::embedded::Embedded;
use crate::mesh::star::Fans;
use crate::mesh::winding::Winding;
use crate::{NONE, Options, Positions, cos_degrees};

/// In `best`: no labelled edge, but one blocked as a duplicate, so that the triangle stays in the frontier.
pub(crate) const BLOCKED: u32 = NONE - 1;

/// What a flip may do to a surface (3D).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Thresholds {
    /// cos β.
    pub(crate) cos: f64,
    /// How far apart the lines of the old and the new diagonal may be; infinite: any distance.
    pub(crate) deviation: f32,
}

impl From<&Options> for Thresholds {
    fn from(options: &Options) -> Self {
        let most = options.max_deviation;
        let nearest = most as f32;
        Self {
            cos: cos_degrees(options.max_normal_angle),
            deviation: if f64::from(nearest) > most { nearest.next_down() } else { nearest },
        }
    }
}

/// What the phases read and never write.
pub(crate) struct Geometry<'a> {
    pub(crate) dimension: Dimension,
    pub(crate) positions: &'a Positions,
    pub(crate) thresholds: Thresholds,
    pub(crate) winding: &'a Winding,
    pub(crate) embedded: &'a Embedded,
}

/// The triangulation that an iteration starts from, or some of its triangles that follow each other.
#[derive(Clone, Copy)]
pub(crate) struct Topology<'a> {
    /// The first half-edge.
    pub(crate) first: u32,
    pub(crate) triangles: &'a [u32],
    pub(crate) twins: &'a [u32],
    pub(crate) fans: &'a Fans,
}

impl Topology<'_> {
    /// The vertex that a half-edge starts at.
    #[inline(always)]
    pub(crate) fn corner(&self, h: u32) -> u32 {
        self.triangles[(h - self.first) as usize]
    }

    /// The entry of a half-edge in the twins.
    #[inline(always)]
    pub(crate) fn twin(&self, h: u32) -> u32 {
        self.twins[(h - self.first) as usize]
    }

    /// Whether it is a half-edge of these triangles; [`NONE`] is not.
    #[inline(always)]
    pub(crate) fn has(&self, h: u32) -> bool {
        (h.wrapping_sub(self.first) as usize) < self.twins.len()
    }

    /// Whether a half-edge has a twin that is of other triangles.
    #[inline(always)]
    pub(crate) fn leaves(&self, h: u32) -> bool {
        let g = unflagged(self.twin(h));
        g != NONE && !self.has(g)
    }
}

/// The priority of an edge in an iteration; the smallest wins. A bijection of the edge id for each iteration,
/// so no two edges tie; it changes with the iteration, or chains of neighbours would flip one by one.
#[inline]
pub(crate) fn key(edge: u32, iteration: u32) -> u32 {
    let mut x = edge ^ iteration.wrapping_mul(0x9e37_79b9);
    x = (x ^ (x >> 16)).wrapping_mul(0x7feb_352d);
    x = (x ^ (x >> 15)).wrapping_mul(0x846c_a68b);
    x ^ (x >> 16)
}
