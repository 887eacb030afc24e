//! Before and after a run: makes the orientation consistent, welds and splits vertices, and carries attributes along.

pub(crate) mod constraints;
pub(crate) mod reorient;
pub(crate) mod wedges;
pub(crate) mod weld;
