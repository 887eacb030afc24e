//! The Delaunay triangulation of points in the plane. The points are sorted into columns; each column is triangulated by
//! halving it in y, and the columns are merged by halving their row in x. From the triangulation comes the Voronoi
//! diagram: circumcentres, and cells that are cut along a box.

mod cells;
mod changes;
mod circle;
mod columns;
mod constraints;
mod distribution;
pub(crate) mod ears;
mod frame;
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
mod verify;
pub(crate) mod voronoi;
mod walk;
