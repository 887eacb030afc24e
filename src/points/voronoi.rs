//! `Triangulation::voronoi`: for each point, the part of a box that is nearer to it than to the others.

use super::cells::Cells;
use super::frame::Frame;
use super::verify::{Given, refused};
use crate::predicates::circumcentre;
use crate::system::memory;
use crate::system::threads::Threads;
use crate::{Dimension, Error, Positions, Triangulation};
use std::borrow::Cow;

/// The most bytes that a point takes at a time: its coordinates (16), two circumcentres (32) and their outcodes (2), a
/// half-edge (4), whether it is known (1), where its cell ends (12), and six corners (96) in a list that may grow to
/// twice its size (192).
const BYTES_PER_POINT: u64 = 355;

/// The Voronoi diagram of points in a box, from [`Triangulation::voronoi`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Voronoi {
    /// x and y of the circumcentre of each triangle. It may be far away, and infinite if it is beyond the range of f64.
    pub circumcentres: Vec<f64>,
    /// The cell of point i has the corners from `starts[i]` to before `starts[i + 1]`. One more than there are points.
    pub starts: Vec<u32>,
    /// x and y of the corners of the cells. Those of a cell are counter-clockwise, all different, and the last is not the
    /// first again.
    pub corners: Vec<f64>,
}

impl Voronoi {
    /// The corners of the cell of a point. There are none if the point equals another with a smaller index, if the cell
    /// does not reach into the box, if what it has there has no area in 64-bit floats, or if there is no such point.
    pub fn cell(&self, point: usize) -> &[[f64; 2]] {
        let range = self.starts.get(point).zip(self.starts.get(point + 1));
        let corners = self.corners.as_chunks().0;
        range.and_then(|(&start, &end)| corners.get(start as usize..end as usize)).unwrap_or_default()
    }
}

impl Triangulation {
    /// The Voronoi diagram of the points of this triangulation in a box: `[xmin, ymin, xmax, ymax]`.
    ///
    /// The cells fill the box. Each corner of a cell is a circumcentre, a corner of the box, or where two cells meet on
    /// its side: the exact coordinates, rounded once. So the cells that have a corner in common have it with the same
    /// bits. Which corners a cell has is decided without rounding. The time is linear.
    ///
    /// ```
    /// use edgeflip::{Positions, triangulate};
    ///
    /// let points = Positions::from(vec![1.0, 1.0, 3.0, 1.0, 2.0, 4.0]);
    /// let voronoi = triangulate(&points)?.voronoi(&points, [0.0, 0.0, 4.0, 5.0])?;
    /// assert_eq!(voronoi.circumcentres, [2.0, 7.0 / 3.0]);
    /// assert_eq!(voronoi.cell(0), [[2.0, 0.0], [2.0, 7.0 / 3.0], [0.0, 3.0], [0.0, 0.0]]);
    /// # Ok::<(), edgeflip::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Option`] about `bounds` if they are not finite or the box has no area, and about `triangulation` if this
    /// is not the Delaunay triangulation of the points; [`Error::RaggedArray`] for a number of coordinates or of indices
    /// that does not fit, [`Error::IndexOutOfRange`], [`Error::NonFinite`], [`Error::OutOfMemory`] and
    /// [`Error::TooLarge`].
    pub fn voronoi(&self, points: &Positions, bounds: [f64; 4]) -> Result<Voronoi, Error> {
        let (length, stride) = (points.len(), Dimension::Two.stride());
        if length % stride != 0 {
            return Err(Error::RaggedArray { array: "positions", length, stride });
        }
        memory::check(BYTES_PER_POINT * (length / stride) as u64)?;
        let threads = Threads::new(None, self.triangles.len() / 3)?;
        points.refuse_non_finite(Dimension::Two, &threads)?;
        let frame = Frame::new(bounds)?;
        let pairs = match points {
            Positions::F32(numbers) => {
                Cow::from_iter(numbers.as_chunks().0.iter().map(|pair| pair.map(f64::from)))
            }
            Positions::F64(numbers) => Cow::Borrowed(numbers.as_chunks().0),
        };
        let given = Given::new(self, &pairs)?;
        diagram(given, frame, &threads)
    }
}

fn diagram(given: Given, frame: Frame, threads: &Threads) -> Result<Voronoi, Error> {
    let parts = threads.map(given.triangulation.triangles.len() / 3, |triangles| {
        let mut fitting = 0;
        let mut outcodes = Vec::with_capacity(triangles.len());
        let mut centres = Vec::with_capacity(triangles.len());
        for triangle in triangles {
            let corners = given.triangle(triangle, &mut fitting)?;
            let centre = circumcentre(corners);
            outcodes.push(frame.outcode(centre, corners));
            centres.push(centre.to_array());
        }
        Ok(((centres, outcodes), fitting))
    });
    let parts = parts.into_iter().collect::<Result<Vec<_>, _>>().map_err(refused)?;
    let (parts, fitting): (Vec<_>, Vec<usize>) = parts.into_iter().unzip();
    let (centres, outcodes): (Vec<_>, Vec<_>) = parts.into_iter().unzip();
    let (centres, outcodes) = (threads.joined(centres), threads.joined(outcodes));
    let half_edges = given.half_edges(fitting.iter().sum()).map_err(refused)?;
    let cells = Cells { given, frame, centres: &centres, outcodes: &outcodes };
    let (starts, corners) = cells.all(&half_edges, threads)?;
    Ok(Voronoi { circumcentres: centres.into_flattened(), starts, corners: corners.into_flattened() })
}
