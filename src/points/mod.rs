//! The Delaunay triangulation of points in the plane. The points are sorted into columns; each column is triangulated by
//! halving it in y, and the columns are merged by halving their row in x.

mod changes;
mod circle;
mod columns;
mod constraints;
mod distribution;
mod groups;
mod halves;
mod insertion;
mod motion;
mod net;
mod numbering;
pub(crate) mod options;
mod seam;
pub(crate) mod session;
mod slots;
mod stars;
pub(crate) mod triangulation;
mod walk;
