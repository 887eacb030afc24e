//! The cells of a Voronoi diagram: walks around the points.

use super::frame::{Cut, Frame};
use crate::mesh::half_edge::{next, prev, triangle_of};
use crate::system::threads::Threads;
use crate::{Error, NONE, Positions, Triangulation};
use glam::DVec2;
use std::ops::Range;

pub(super) struct Cells<'a> {
    pub(super) triangulation: &'a Triangulation,
    pub(super) points: &'a Positions,
    pub(super) frame: Frame,
    /// Of each triangle, the circumcentre and its outcode.
    pub(super) centres: &'a [DVec2],
    pub(super) outcodes: &'a [u8],
}

/// An edge of a cell: the point on the other side, and the triangles from whose circumcentre to whose it goes, with the
/// cell on the left. `None` is infinitely far.
struct Edge {
    other: u32,
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
    /// The cells of all points: where each begins, and the corners. `first` has a half-edge of each point, the first one
    /// around it if it is on the hull, or `NONE` if the point is in no triangle.
    ///
    /// # Errors
    /// [`Error::TooLarge`].
    pub(super) fn all(&self, first: &[u32], threads: &Threads) -> Result<(Vec<u32>, Vec<[f64; 2]>), Error> {
        let mut parts = if self.triangulation.is_flat() {
            let mut places = vec![None; first.len()];
            for (i, &point) in self.triangulation.hull.iter().enumerate() {
                places[point as usize] = Some(Place::Line(i));
            }
            vec![self.of(0..first.len(), |point| places[point])]
        } else {
            let place = |point: usize| Some(first[point]).filter(|&start| start != NONE).map(Place::Star);
            threads.map(first.len(), |points| self.of(points, place))
        };
        let count = parts.iter().map(|part| part.corners.len()).sum();
        let limit = u32::MAX as usize;
        if count > limit {
            return Err(Error::TooLarge { what: "corners of cells", count, limit });
        }
        let mut starts = Vec::with_capacity(first.len() + 1);
        starts.push(0);
        let mut before = 0;
        for part in &parts {
            starts.extend(part.ends.iter().map(|end| (before + end) as u32));
            before += part.corners.len();
        }
        if let [part] = &mut *parts {
            return Ok((starts, std::mem::take(&mut part.corners)));
        }
        let mut corners = Vec::with_capacity(count);
        parts.iter().for_each(|part| threads.append(&mut corners, &part.corners));
        Ok((starts, corners))
    }

    /// The cells of these points.
    fn of(&self, points: Range<usize>, place: impl Fn(usize) -> Option<Place>) -> Outlines {
        let mut outlines = Outlines::default();
        outlines.ends.reserve(points.len());
        for point in points {
            if let Some(place) = place(point) {
                self.add(&mut outlines.corners, point as u32, place);
            }
            outlines.ends.push(outlines.corners.len());
        }
        outlines
    }

    /// Adds the corners of a cell.
    #[inline(always)]
    fn add(&self, corners: &mut Vec<[f64; 2]>, point: u32, place: Place) {
        let mut outline =
            Outline { start: corners.len(), corners, is_met: false, first_entry: None, last_exit: None };
        self.edges(place, |edge| {
            let outcodes =
                edge.triangles.map(|triangle| triangle.map(|triangle| self.outcodes[triangle as usize]));
            let ends = || self.points.points2([point, edge.other]);
            if let Some(cut) = self.frame.cut(outcodes, ends) {
                outline.add(cut, &edge, self, ends);
            }
        });
        outline.close(self, || {
            let mut has_corner = true;
            self.edges(place, |Edge { other, .. }| {
                let [p, q] = self.points.points2([point, other]);
                has_corner = has_corner && self.frame.has_corner(0, p, q);
            });
            has_corner
        });
    }

    /// The edges of a cell, counter-clockwise.
    #[inline(always)]
    fn edges(&self, place: Place, mut each: impl FnMut(Edge)) {
        let Triangulation { triangles, twins, hull, .. } = self.triangulation;
        let start = match place {
            Place::Star(start) => start,
            Place::Line(i) => {
                let neighbours = [hull.get(i + 1), i.checked_sub(1).and_then(|before| hull.get(before))];
                neighbours
                    .into_iter()
                    .flatten()
                    .for_each(|&other| each(Edge { other, triangles: [None; 2] }));
                return;
            }
        };
        if twins[start as usize] == NONE {
            let other = triangles[next(start) as usize];
            each(Edge { other, triangles: [None, Some(triangle_of(start))] });
        }
        let mut h = start;
        loop {
            let last = prev(h);
            let (other, twin) = (triangles[last as usize], twins[last as usize]);
            let to = (twin != NONE).then(|| triangle_of(twin));
            each(Edge { other, triangles: [Some(triangle_of(h)), to] });
            if twin == NONE || twin == start {
                return;
            }
            h = twin;
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
    #[inline(always)]
    fn add(&mut self, cut: Cut, edge: &Edge, cells: &Cells, ends: impl Fn() -> [DVec2; 2]) {
        self.is_met = true;
        match (cut.entry, edge.triangles[0]) {
            (Some(side), _) => {
                match self.last_exit.take() {
                    Some(exit) => self.turn(exit, side, cells),
                    None => self.first_entry = Some(side),
                }
                let [p, q] = ends();
                self.push(cells.frame.crossing(p, q, side));
            }
            (None, Some(triangle)) => self.push(cells.centres[triangle as usize]),
            (None, None) => {}
        }
        if let Some(side) = cut.exit {
            let [p, q] = ends();
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
    fn push(&mut self, corner: DVec2) {
        let corner = corner.to_array();
        if self.corners[self.start..].last() != Some(&corner) {
            self.corners.push(corner);
        }
    }
}
