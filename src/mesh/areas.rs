//! Triangles whose area is not positive: turned over, or flat.

use crate::mesh::winding::Winding;
use crate::predicates::{area_sign, has_area};
use crate::system::threads::Threads;
use crate::{Dimension, Positions};
use std::cmp::Ordering;
use std::ops::Range;

/// The numbers of triangles whose area is not positive.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Areas {
    /// In the plane: triangles with the opposite sign of the winding of their component.
    pub(crate) inverted: u32,
    /// Triangles of no area.
    pub(crate) flat: u32,
    /// Triangles that are left alone while the mesh moves: a number is not finite, or the points span more bits than a
    /// GPU decides.
    pub(crate) undecided: u32,
}

impl Areas {
    /// Counts the triangles. `has_infinite`: whether there may be numbers that are not finite.
    pub(crate) fn of(
        (dimension, positions, triangles): (Dimension, &Positions, &[u32]),
        winding: &Winding,
        has_infinite: bool,
        threads: &Threads,
    ) -> Self {
        if winding.is_strict {
            return Self::default();
        }
        let (triangles, _) = triangles.as_chunks::<3>();
        // The sign relative to the winding; `None` if the triangle is left alone.
        let sign = |t: usize| match dimension {
            Dimension::Two => {
                let points = positions.points2(triangles[t]);
                let is_left = has_infinite && !points.iter().all(|point| point.is_finite());
                let [a, b, c] = points;
                (!is_left).then(|| winding.relative(t as u32, area_sign(a, b, c)))
            }
            Dimension::Three => {
                let points = positions.points3(triangles[t]);
                let is_left = has_infinite && !points.iter().all(|point| point.is_finite());
                let [a, b, c] = points;
                (!is_left).then(|| if has_area(a, b, c) { Ordering::Greater } else { Ordering::Equal })
            }
        };
        let count = |piece: Range<usize>| {
            let mut areas = Self::default();
            for t in piece {
                match sign(t) {
                    Some(Ordering::Greater) => {}
                    Some(Ordering::Equal) => areas.flat += 1,
                    Some(Ordering::Less) => areas.inverted += 1,
                    None => areas.undecided += 1,
                }
            }
            areas
        };
        threads.map(triangles.len(), count).into_iter().fold(Self::default(), Self::and)
    }

    /// From the counts of the shaders: inverted, flat, undecided.
    #[cfg(feature = "gpu")]
    pub(crate) fn of_counts(counts: &[u32]) -> Self {
        Self { inverted: counts[0], flat: counts[1], undecided: counts[2] }
    }

    /// The numbers in both sets of triangles.
    fn and(self, other: Self) -> Self {
        Self {
            inverted: self.inverted + other.inverted,
            flat: self.flat + other.flat,
            undecided: self.undecided + other.undecided,
        }
    }
}
