//! A triangulation of points that move, come and go.

use super::columns::Columns;
use super::net::Net;
use super::numbering::numbered_hull;
use super::options::PointOptions;
use super::triangulation::{Triangulation, count_of, refuse_many, triangulated};
use crate::predicates::nearer;
use crate::system::memory;
use crate::system::threads::Threads;
use crate::{Dimension, Error, Positions};
use glam::DVec2;
use std::num::NonZeroUsize;

/// The most bytes that a point takes at a time: what it takes in [`triangulate`](crate::triangulate) (136), its numbers,
/// given and in the net, and in an update again (48), its index and its vertex (8), and the half-edge of that (4).
const BYTES_PER_POINT: u64 = 196;

/// The same for what reads the triangles (64), what moves points (64), and what makes room for one more (160).
const BYTES_TO_READ: u64 = 64;
const BYTES_TO_MOVE: u64 = 64;
const BYTES_TO_GROW: u64 = 160;

/// A Delaunay triangulation of points in the plane that move, come and go. After each call it is the one that
/// [`triangulate`](crate::triangulate) makes of the present points, bit for bit: hull and duplicates change along.
///
/// Points keep their indices. A new point gets the next one, and the index of a point that was removed stays unused.
///
/// ```
/// use edgeflip::{PointSession, Positions};
///
/// let points = Positions::from(vec![0.0, 0.0, 4.0, 0.0, 4.0, 3.0, 0.0, 3.0]);
/// let mut session = PointSession::new(&points, None)?;
/// assert_eq!(session.add([2.0, 1.0])?, 4);
/// assert_eq!(session.triangles()?, [0, 1, 4, 0, 4, 3, 1, 2, 4, 2, 3, 4]);
/// session.move_to(4, [2.0, 5.0])?;
/// assert_eq!(session.hull(), [0, 1, 2, 4, 3]);
/// assert_eq!(session.nearest([3.0, 4.5]), Some(4));
/// session.remove(4);
/// assert_eq!(session.locate([1.0, 0.5]), Some([0, 1, 2]));
/// # Ok::<(), edgeflip::Error>(())
/// ```
pub struct PointSession {
    /// Where each point is, or was before it was removed.
    given: Vec<DVec2>,
    is_present: Vec<bool>,
    /// The triangulation, if there is a triangle.
    net: Option<Net>,
    /// Whether points have changed since it was looked for a triangle.
    is_stale: bool,
    threads: Threads,
}

impl PointSession {
    /// Points in the plane: 2 numbers per point. `threads` is as in [`PointOptions`](crate::PointOptions); the first
    /// triangulation uses them, and an update after which little is left of the triangles.
    ///
    /// # Errors
    /// Those of [`triangulate_with`](crate::triangulate_with).
    pub fn new(points: &Positions, threads: Option<NonZeroUsize>) -> Result<Self, Error> {
        let count = count_of(points)?;
        let threads = Threads::new(threads, 2 * count)?;
        points.refuse_non_finite(Dimension::Two, &threads)?;
        memory::check(BYTES_PER_POINT * count as u64)?;
        let given: Vec<DVec2> = (0..count).map(|i| point_of(points, i)).collect();
        let mut session = Self { is_present: vec![true; count], given, net: None, is_stale: true, threads };
        session.find_net();
        Ok(session)
    }

    /// The number of points, with those that were removed.
    pub fn len(&self) -> usize {
        self.given.len()
    }

    /// Whether there never was a point.
    pub fn is_empty(&self) -> bool {
        self.given.is_empty()
    }

    /// Moves all points: 2 numbers per point. Those of points that were removed do not count.
    ///
    /// # Errors
    /// [`Error::PositionCount`], [`Error::NonFinite`] for the first coordinate that is NaN or infinite, and
    /// [`Error::OutOfMemory`]. Then nothing has changed.
    pub fn update(&mut self, points: &Positions) -> Result<(), Error> {
        let expected = Dimension::Two.stride() * self.len();
        if points.len() != expected {
            return Err(Error::PositionCount { length: points.len(), expected });
        }
        memory::check(BYTES_TO_MOVE * self.len() as u64)?;
        let is_moved = |&i: &usize| self.is_present[i] && point_of(points, i) != self.given[i];
        let moved: Vec<usize> = (0..self.len()).filter(is_moved).collect();
        moved.iter().try_for_each(|&i| refuse_non_finite(i, point_of(points, i)))?;
        match &mut self.net {
            Some(net) if net.is_few(moved.len()) => {
                for &i in &moved {
                    self.replace(i, point_of(points, i));
                }
            }
            Some(net) => {
                moved.iter().for_each(|&i| self.given[i] = point_of(points, i));
                if !net.update(&self.given) {
                    self.forget();
                    self.find_net();
                }
            }
            None => {
                moved.iter().for_each(|&i| self.given[i] = point_of(points, i));
                self.is_stale = true;
            }
        }
        Ok(())
    }

    /// Moves one point. The time does not depend on the number of points, unless it moves far or has many neighbours.
    ///
    /// # Errors
    /// [`Error::NonFinite`], and [`Error::Option`] if there is no such point. Then nothing has changed.
    pub fn move_to(&mut self, index: u32, point: [f64; 2]) -> Result<(), Error> {
        let i = index as usize;
        if !self.is_present.get(i).is_some_and(|&is_present| is_present) {
            let message = format!("there is no point {index}");
            return Err(Error::Option { option: "index", message });
        }
        let point = DVec2::from(point) + DVec2::ZERO;
        refuse_non_finite(i, point)?;
        self.replace(i, point);
        Ok(())
    }

    /// Adds a point. Returns its index. The time is that of [`locate`](Self::locate), unless it gets many neighbours.
    ///
    /// # Errors
    /// [`Error::NonFinite`], [`Error::TooLarge`], [`Error::OutOfMemory`]. Then nothing has changed.
    pub fn add(&mut self, point: [f64; 2]) -> Result<u32, Error> {
        let index = self.len();
        let point = DVec2::from(point) + DVec2::ZERO;
        refuse_non_finite(index, point)?;
        refuse_many(index + 1)?;
        if index == self.given.capacity() {
            memory::check(BYTES_TO_GROW * index as u64)?;
        }
        self.given.push(point);
        self.is_present.push(true);
        match &mut self.net {
            Some(net) => net.insert(index as u32, point, None),
            None => self.is_stale = true,
        }
        Ok(index as u32)
    }

    /// Removes a point. Returns whether there was one.
    pub fn remove(&mut self, index: u32) -> bool {
        match self.is_present.get_mut(index as usize) {
            Some(is_present) if *is_present => *is_present = false,
            _ => return false,
        }
        match &mut self.net {
            Some(net) => {
                if !net.remove(index) {
                    self.forget();
                }
            }
            None => self.is_stale = true,
        }
        true
    }

    /// The present triangles, twins, hull and duplicates.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    pub fn triangulation(&mut self) -> Result<Triangulation, Error> {
        self.prepare_to_read()?;
        let threads = self.pool();
        let Some(net) = &self.net else { return Ok(self.flat(&threads)) };
        let (triangles, twins) = net.with_twins(&threads);
        let (hull, duplicates) = (numbered_hull(net.hull(), &net.indices), net.duplicates());
        Ok(Triangulation { triangles, twins, hull, duplicates, ..Triangulation::default() })
    }

    /// The present triangles: those of [`Self::triangulation`].
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    pub fn triangles(&mut self) -> Result<Vec<u32>, Error> {
        self.prepare_to_read()?;
        let threads = self.pool();
        Ok(self.net.as_ref().map_or_else(Vec::new, |net| net.triangles(&threads)))
    }

    fn prepare_to_read(&mut self) -> Result<(), Error> {
        let bytes = if self.is_stale { BYTES_PER_POINT } else { BYTES_TO_READ };
        memory::check(bytes * self.len() as u64)?;
        self.find_net();
        Ok(())
    }

    /// The present hull: that of [`Self::triangulation`].
    pub fn hull(&mut self) -> Vec<u32> {
        self.find_net();
        match &self.net {
            Some(net) => numbered_hull(net.hull(), &net.indices),
            None => self.flat(&self.pool()).hull,
        }
    }

    /// The triangulation of points without a triangle.
    fn flat(&self, threads: &Threads) -> Triangulation {
        let (points, indices) = self.present();
        // Without constraints, it does not fail.
        let flat = triangulated(&points, &PointOptions::default(), threads).unwrap_or_default();
        let Triangulation { hull, duplicates, .. } = flat;
        let index = |vertex: u32| indices[vertex as usize];
        Triangulation {
            hull: hull.into_iter().map(index).collect(),
            duplicates: duplicates.into_iter().map(|pair| pair.map(index)).collect(),
            ..Triangulation::default()
        }
    }

    /// The triangle at a place, counter-clockwise from its smallest index. Of several, the first in the order of
    /// [`Triangulation::triangles`]. `None` outside of the hull. It walks from the triangle of the call before: the time
    /// grows with the distance.
    pub fn locate(&mut self, [x, y]: [f64; 2]) -> Option<[u32; 3]> {
        self.find_net();
        let place = DVec2::new(x, y);
        self.net.as_mut().filter(|_| place.is_finite())?.triangle_at(place)
    }

    /// The point that is nearest to a place. Of several, the one with the smallest index. `None` if there is no point, or if
    /// a coordinate is NaN or infinite. It walks as [`locate`](Self::locate) does.
    pub fn nearest(&mut self, [x, y]: [f64; 2]) -> Option<u32> {
        self.find_net();
        let place = DVec2::new(x, y);
        if !place.is_finite() {
            return None;
        }
        match &mut self.net {
            Some(net) => Some(net.nearest(place)),
            None => {
                let present = (0..self.len()).filter(|&i| self.is_present[i]);
                let nearest = present.min_by(|&i, &j| nearer(self.given[i], self.given[j], place));
                nearest.map(|i| i as u32)
            }
        }
    }

    /// Moves a point that is present.
    fn replace(&mut self, i: usize, point: DVec2) {
        self.given[i] = point;
        let index = i as u32;
        match &mut self.net {
            Some(net) => {
                let neighbour = net.neighbour(index);
                if net.remove(index) {
                    net.insert(index, point, Some(neighbour));
                } else {
                    self.forget();
                }
            }
            None => self.is_stale = true,
        }
    }

    fn forget(&mut self) {
        self.net = None;
        self.is_stale = true;
    }

    /// Looks for a triangle, if points have changed since the last time.
    fn find_net(&mut self) {
        if std::mem::take(&mut self.is_stale) {
            let threads = self.pool();
            let (points, indices) = self.present();
            let columns = threads.enter(|| Columns::of(&points, &threads));
            self.net = threads.enter(|| Net::of(columns, &indices, self.len(), &threads));
        }
    }

    fn pool(&self) -> Threads {
        self.threads.clone().for_triangles(2 * self.len())
    }

    /// The points that are present, and their indices.
    fn present(&self) -> (Positions, Vec<u32>) {
        let indices: Vec<u32> =
            (0..).zip(&self.is_present).filter_map(|(i, &is_present)| is_present.then_some(i)).collect();
        let numbers = indices.iter().flat_map(|&index| self.given[index as usize].to_array()).collect();
        (Positions::F64(numbers), indices)
    }
}

/// A point as it is compared: -0 is 0.
fn point_of(points: &Positions, i: usize) -> DVec2 {
    let [point] = points.points2([i as u32]);
    point + DVec2::ZERO
}

fn refuse_non_finite(vertex: usize, point: DVec2) -> Result<(), Error> {
    match [('x', point.x), ('y', point.y)].into_iter().find(|(_, value)| !value.is_finite()) {
        Some((axis, value)) => Err(Error::NonFinite { vertex, axis, value }),
        None => Ok(()),
    }
}
