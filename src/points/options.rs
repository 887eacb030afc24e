//! The options of a triangulation of points.

use crate::Error;
use crate::system::threads::checked;
use std::num::NonZeroUsize;

/// The options of [`triangulate_with`](crate::triangulate_with).
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PointOptions {
    /// Threads, at most [`MOST_THREADS`](crate::MOST_THREADS); `None`: one per core, or those of the rayon pool that the
    /// caller is in. At most one per 2,048 points starts, and fewer than 32,768 points are triangulated on one thread.
    /// The result does not depend on the number. Without the feature `threads` there is always one thread.
    pub threads: Option<NonZeroUsize>,
    /// Edges that have to be in the triangulation, each by the indices of its two points. A point on one splits it. They
    /// may repeat, overlap and meet at points; one between equal points is no edge. The triangulation is then the
    /// constrained Delaunay triangulation: all other edges are Delaunay as far as points count that no constraint hides.
    pub constraints: Vec<[u32; 2]>,
    /// Whether constraints that cross an earlier one are left out, and listed in
    /// [`Triangulation::left_out`](crate::Triangulation::left_out). Otherwise they are errors.
    pub skips_constraints: bool,
}

impl PointOptions {
    /// Checks the options for so many points.
    ///
    /// # Errors
    /// [`Error::Option`].
    pub(super) fn check(&self, points: usize) -> Result<(), Error> {
        let is_no_point = |ends: &[u32; 2]| ends.iter().any(|&end| end as usize >= points);
        if let Some(index) = self.constraints.iter().position(is_no_point) {
            let [u, v] = self.constraints[index];
            let message = format!("constraint {index} joins {u} and {v}; there are {points} points");
            return Err(Error::Option { option: "constraints", message });
        }
        self.threads.map_or(Ok(()), |count| checked(count.get()).map(drop))
    }
}
