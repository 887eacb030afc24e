//! The cells of a Voronoi diagram: walks around the points.

use super::frame::{Cut, Frame};
use super::verify::Given;
use crate::mesh::half_edge::{next, prev, triangle_of};
use crate::system::threads::Threads;
use crate::{Error, NONE, Triangulation};
use glam::DVec2;
use std::ops::Range;

pub(super) struct Cells<'a> {
    pub(super) given: Given<'a>,
    pub(super) frame: Frame,
    /// Of each triangle, the circumcentre and its outcode.
    pub(super) centres: &'a [[f64; 2]],
    pub(super) outcodes: &'a [u8],
}

/// An edge of a cell: where the array has the point on the other side, and the triangles from whose circumcentre to whose
/// the edge goes, with the cell on the left. `None` is infinitely far.
struct Edge<'a> {
    array: &'a [u32],
    other: usize,
    triangles: [Option<u32>; 2],
}

/// Where the edges of a cell are.
#[derive(Clone, Copy)]
enum Place {
    /// Around the point where this half-edge starts. On the hull, it is the first one around the point.
    Star(u32),
    /// Between this point of the hull and those before and after it, where all points are on one line.
    Line(usize),
}

/// Cells one after the other.
#[derive(Default)]
struct Outlines {
    ends: Vec<usize>,
    corners: Vec<[f64; 2]>,
}

impl Cells<'_> {
    /// The cells of all points: where each begins, and the corners. `half_edges` has one that starts at each point, on the
    /// hull the first around it, or `NONE` if the point is in no triangle.
    ///
    /// # Errors
    /// [`Error::TooLarge`].
    pub(super) fn all(
        &self,
        half_edges: &[u32],
        threads: &Threads,
    ) -> Result<(Vec<u32>, Vec<[f64; 2]>), Error> {
        let count = half_edges.len();
        let parts = if self.given.triangulation.is_flat() {
            let mut places = vec![None; count];
            for (i, &point) in self.given.triangulation.hull.iter().enumerate() {
                places[point as usize] = Some(Place::Line(i));
            }
            vec![self.of(0..count, 4.0, &|point| places[point])]
        } else {
            let place = |point: usize| Some(half_edges[point]).filter(|&h| h != NONE).map(Place::Star);
            // A circumcentre in the box is a corner of three cells.
            let inside = self.outcodes.iter().filter(|&&outcode| outcode == 0).count();
            let mean = 3.0 * inside as f64 / count as f64;
            threads.map(count, |points| self.of(points, mean, &place))
        };
        let mut starts = Vec::with_capacity(count + 1);
        starts.push(0);
        let mut before = 0;
        for part in &parts {
            starts.extend(part.ends.iter().map(|end| (before + end) as u32));
            before += part.corners.len();
        }
        let limit = u32::MAX as usize;
        if before > limit {
            return Err(Error::TooLarge { what: "corners of cells", count: before, limit });
        }
        Ok((starts, threads.joined(parts.into_iter().map(|part| part.corners).collect())))
    }

    /// The cells of these points, which have so many corners in the mean.
    fn of(&self, points: Range<usize>, mean: f64, place: &dyn Fn(usize) -> Option<Place>) -> Outlines {
        let mut outlines = Outlines {
            ends: Vec::with_capacity(points.len()),
            corners: Vec::with_capacity((mean * points.len() as f64) as usize),
        };
        for point in points {
            if let Some(place) = place(point) {
                self.add(&mut outlines.corners, point as u32, place);
            }
            outlines.ends.push(outlines.corners.len());
        }
        outlines
    }

    /// Adds the corners of a cell.
    fn add(&self, corners: &mut Vec<[f64; 2]>, point: u32, place: Place) {
        let mut outline =
            Outline { start: corners.len(), corners, is_met: false, first_entry: None, last_exit: None };
        let is_whole = matches!(place, Place::Star(start) if self.add_whole(&mut outline, start));
        let ends = |edge: &Edge| self.given.points([point, edge.array[edge.other]]);
        if !is_whole {
            self.edges(place, |edge| {
                let outcodes = edge.triangles.map(|triangle| Some(self.outcodes[triangle? as usize]));
                let ends = ends(&edge);
                if let Some(cut) = self.frame.cut(outcodes, ends) {
                    outline.add(cut, &edge, self, ends);
                }
            });
        }
        outline.close(self, || {
            let mut has_corner = true;
            self.edges(place, |edge| {
                let [p, q] = ends(&edge);
                has_corner = has_corner && self.frame.has_corner(0, p, q);
            });
            has_corner
        });
    }

    /// Adds the corners of a cell around the point where the half-edge starts, if all of them are circumcentres in the box.
    #[inline(always)]
    fn add_whole(&self, outline: &mut Outline, start: u32) -> bool {
        let mut h = start;
        loop {
            let triangle = triangle_of(h) as usize;
            let twin = self.given.triangulation.twins[prev(h) as usize];
            if twin == NONE || self.outcodes[triangle] != 0 {
                outline.corners.truncate(outline.start);
                return false;
            }
            outline.push(self.centres[triangle]);
            if twin == start {
                outline.is_met = true;
                return true;
            }
            h = twin;
        }
    }

    /// The edges of a cell, counter-clockwise.
    #[inline(always)]
    fn edges<'b>(&'b self, place: Place, mut each: impl FnMut(Edge<'b>)) {
        let Triangulation { triangles, twins, hull, .. } = self.given.triangulation;
        let start = match place {
            Place::Star(start) => start,
            Place::Line(i) => {
                let others = [Some(i + 1).filter(|&after| after < hull.len()), i.checked_sub(1)];
                for other in others.into_iter().flatten() {
                    each(Edge { array: hull, other, triangles: [None; 2] });
                }
                return;
            }
        };
        let array = triangles.as_slice();
        if twins[start as usize] == NONE {
            each(Edge { array, other: next(start) as usize, triangles: [None, Some(triangle_of(start))] });
        }
        let mut h = start;
        let mut from = triangle_of(h);
        loop {
            let other = prev(h) as usize;
            let twin = twins[other];
            if twin == NONE {
                return each(Edge { array, other, triangles: [Some(from), None] });
            }
            let to = triangle_of(twin);
            each(Edge { array, other, triangles: [Some(from), Some(to)] });
            if twin == start {
                return;
            }
            (h, from) = (twin, to);
        }
    }
}

/// A cell whose edges are added one after the other.
struct Outline<'a> {
    corners: &'a mut Vec<[f64; 2]>,
    /// The first corner of the cell.
    start: usize,
    /// Whether an edge meets the box.
    is_met: bool,
    /// The side of the first entry, if no exit came before.
    first_entry: Option<usize>,
    /// The side of the last exit, if no entry has come after.
    last_exit: Option<usize>,
}

impl Outline<'_> {
    /// Adds the part of an edge that is in the box, and the corners of the box between it and the part before.
    fn add(&mut self, cut: Cut, edge: &Edge, cells: &Cells, [p, q]: [DVec2; 2]) {
        self.is_met = true;
        match (cut.entry, edge.triangles[0]) {
            (Some(side), _) => {
                match self.last_exit.take() {
                    Some(exit) => self.turn(exit, side, cells),
                    None => self.first_entry = Some(side),
                }
                self.push(cells.frame.crossing(p, q, side));
            }
            (None, Some(triangle)) => self.push(cells.centres[triangle as usize]),
            (None, None) => {}
        }
        if let Some(side) = cut.exit {
            self.push(cells.frame.crossing(p, q, side));
            self.last_exit = Some(side);
        }
    }

    /// Adds the corners of the box from one side to another. On the same side there are none: the cell is convex, and
    /// so it has the whole segment between the exit and the entry.
    fn turn(&mut self, exit: usize, entry: usize, cells: &Cells) {
        let mut side = exit;
        while side != entry {
            side = (side + 1) % 4;
            self.push(cells.frame.corner(side));
        }
    }

    /// Completes the cell. If no edge meets the box, it has all of it or nothing.
    #[inline(always)]
    fn close(&mut self, cells: &Cells, has_box: impl FnOnce() -> bool) {
        if let (Some(exit), Some(entry)) = (self.last_exit, self.first_entry) {
            self.turn(exit, entry, cells);
        }
        if !self.is_met && has_box() {
            (0..4).for_each(|corner| self.push(cells.frame.corner(corner)));
        }
        let corners = &self.corners[self.start..];
        if corners.len() > 1 && corners.first() == corners.last() {
            self.corners.pop();
        }
        if self.corners.len() < self.start + 3 {
            self.corners.truncate(self.start);
        }
    }

    /// Adds a corner, unless it is the last one again.
    #[inline(always)]
    fn push(&mut self, corner: [f64; 2]) {
        if self.corners[self.start..].last() != Some(&corner) {
            self.corners.push(corner);
        }
    }
}
