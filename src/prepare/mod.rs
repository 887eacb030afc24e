//! Before and after a run: triangles turned towards one side, vertices joined and split again, attributes carried along.

pub(crate) mod reorient;
pub(crate) mod wedges;
pub(crate) mod weld;
