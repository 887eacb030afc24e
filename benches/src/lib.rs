//! What the benchmarks share.

pub mod arguments;
pub mod bandwidth;
pub mod clock;
pub mod commit;
pub mod kinds;
pub mod rule;
pub mod surfaces;
pub mod warm_up;

// `kinds` is also a module of a unit test of edgeflip, where these names come from the crate itself.
use edgeflip::{Backend, Dimension, Error, Mesh, Options, families, make_delaunay};
