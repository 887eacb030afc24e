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
}

impl PointOptions {
    /// # Errors
    /// [`Error::Option`].
    pub(super) fn check(&self) -> Result<(), Error> {
        self.threads.map_or(Ok(()), |count| checked(count.get()).map(drop))
    }
}
