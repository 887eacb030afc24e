//! The phases of an iteration, as functions over slices: label, select, flip and update. Every decision reads only the
//! state before its phase. Every word has one writer, or keeps the smallest of distinct keys.
//!
//! ```text
//!         c                   c
//!       /   \               / | \        h: a → b, twin g: b → a
//!  prev/     \next      prev  |  g       after the flip the triangles are
//!    a ---h--- b          a   |   b      (a, d, c), with the index of (a, b, c), and
//!      \     /              h | prev     (b, c, d), with the index of (b, a, d)
//!       \   /               \ | /
//!         d                   d
//! ```

mod crease;
mod flip;
pub(crate) mod frozen;
mod label;
pub(crate) mod reason;
mod select;
pub(crate) mod state;

pub(crate) use crease::flag_creases;
pub(crate) use flip::{Around, Selected, flip, move_anchors};
pub(crate) use label::{
    Diamond, Verdict, is_finite, keep_non_delaunay, label, makes_duplicate, verdict, verdict_of_shape,
};
pub(crate) use select::{select, yields};
pub(crate) use state::{Geometry, Thresholds, Topology, key};
