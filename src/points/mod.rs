//! The Delaunay triangulation of points in the plane. The points are sorted into columns; each column is triangulated by
//! halving it in y, and the columns are merged by halving their row in x. From the triangulation comes the Voronoi
//! diagram: circumcentres, and cells that are cut along a box.

mod cells;
mod columns;
mod distribution;
mod frame;
mod groups;
mod halves;
mod insertion;
mod numbering;
pub(crate) mod options;
mod seam;
mod slots;
pub(crate) mod triangulation;
mod verify;
pub(crate) mod voronoi;
