//! Before and after a run: makes the orientation consistent, welds and splits vertices, carries attributes along, brings
//! constraints in, and finds the regions that they bound.

pub(crate) mod constraints;
pub(crate) mod regions;
pub(crate) mod reorient;
pub(crate) mod wedges;
pub(crate) mod weld;
