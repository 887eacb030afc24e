//! Verifies that arrays are the Delaunay triangulation of points, in linear time. What passes has these properties:
//! triangles are counter-clockwise, twins fit, and the edges without one are a single convex ring; so the triangles cover
//! the inside of the ring once. Each point is a corner or equals one. Each edge is Delaunay, and so all triangles are.

use super::circle::is_before;
use crate::mesh::half_edge::next;
use crate::predicates::{area_sign, in_circle_sign};
use crate::{Error, NONE, Triangulation};
use glam::DVec2;
use std::array;

/// What is wrong.
pub(super) type Refusal = &'static str;

const NO_TWIN: Refusal = "a twin of it is not the same edge from the other side";
const NO_RING: Refusal = "its hull is not one ring";

/// A triangulation whose lengths and indices of points are right.
#[derive(Clone, Copy)]
pub(super) struct Given<'a> {
    pub(super) triangulation: &'a Triangulation,
    pub(super) points: &'a [[f64; 2]],
}

pub(super) fn refused(why: Refusal) -> Error {
    let message = format!("{why}; pass the triangulation of these points, unchanged");
    Error::Option { option: "triangulation", message }
}

impl<'a> Given<'a> {
    /// # Errors
    /// [`Error::RaggedArray`], [`Error::IndexOutOfRange`], or [`Error::Option`].
    pub(super) fn new(triangulation: &'a Triangulation, points: &'a [[f64; 2]]) -> Result<Self, Error> {
        let Triangulation { triangles, twins, hull, .. } = triangulation;
        let (length, vertices) = (triangles.len(), points.len());
        if length % 3 != 0 {
            return Err(Error::RaggedArray { array: "triangles", length, stride: 3 });
        }
        if twins.len() != length {
            return Err(refused("it has another number of twins than of indices in triangles"));
        }
        let is_wrong = |&index: &u32| index as usize >= vertices;
        if let Some(at) = triangles.iter().position(is_wrong) {
            return Err(Error::IndexOutOfRange { triangle: at / 3, index: triangles[at], vertices });
        }
        if length == 0 && hull.iter().any(is_wrong) {
            return Err(refused("its hull has an index that is out of range"));
        }
        Ok(Self { triangulation, points })
    }

    /// Where the half-edge starts.
    #[inline(always)]
    fn origin(&self, h: u32) -> u32 {
        self.triangulation.triangles[h as usize]
    }

    #[inline(always)]
    fn twin(&self, h: u32) -> u32 {
        self.triangulation.twins[h as usize]
    }

    #[inline(always)]
    pub(super) fn points<const N: usize>(&self, indices: [u32; N]) -> [DVec2; N] {
        array::from_fn(|i| self.points[indices[i] as usize].into())
    }

    /// The corners of a triangle, after a check of its area and its edges. Adds to `fitting` the half-edges that have no
    /// twin or are checked here. An edge is checked in the first of its triangles; half-edges that are no twins of each
    /// other are in none, so that the sum shows them.
    #[inline(always)]
    pub(super) fn triangle(&self, triangle: usize, fitting: &mut usize) -> Result<[DVec2; 3], Refusal> {
        let halves = [0, 1, 2].map(|i| 3 * triangle as u32 + i);
        let corners = halves.map(|h| self.origin(h));
        let [a, b, c] = self.points(corners);
        if !area_sign(a, b, c).is_gt() {
            return Err("a triangle of it is not counter-clockwise");
        }
        for i in 0..3 {
            let (h, g) = (halves[i], self.twin(halves[i]));
            if g == NONE {
                *fitting += 1;
            } else if h < g {
                let [start, end, before] = [0, 1, 2].map(|k| corners[(i + k) % 3]);
                if g as usize >= self.triangulation.twins.len()
                    || [self.twin(g), self.origin(g), self.origin(next(g))] != [h, end, start]
                {
                    return Err(NO_TWIN);
                }
                *fitting += 2;
                let [p, q, r, d] = self.points([start, end, before, self.origin(next(next(g)))]);
                if in_circle_sign(p, q, r, d).is_lt() {
                    return Err("an edge of it is not Delaunay");
                }
            }
        }
        Ok([a, b, c])
    }

    /// Checks the rest, after all triangles with this sum. Returns for each point a half-edge that starts there, or `NONE` if it
    /// is in no triangle; on the hull, it is the one without a twin.
    pub(super) fn half_edges(&self, fitting: usize) -> Result<Vec<u32>, Refusal> {
        let Triangulation { triangles, twins, .. } = self.triangulation;
        if fitting != twins.len() {
            return Err(NO_TWIN);
        }
        let mut half_edges = vec![NONE; self.points.len()];
        for (h, (&point, &twin)) in (0..).zip(triangles.iter().zip(twins)) {
            if twin == NONE || half_edges[point as usize] == NONE {
                half_edges[point as usize] = h;
            }
        }
        self.check_hull()?;
        self.check_duplicates(&half_edges)?;
        Ok(half_edges)
    }

    /// Checks that the edges without a twin are a ring that turns to the left once.
    fn check_hull(&self) -> Result<(), Refusal> {
        let twins = &self.triangulation.twins;
        let Some(start) = twins.iter().position(|&twin| twin == NONE) else {
            return if twins.is_empty() { self.check_line() } else { Err(NO_RING) };
        };
        let mut left = twins.iter().filter(|&&twin| twin == NONE).count();
        let (mut h, mut turns) = (start as u32, 0);
        while left > 0 {
            // Turns around the end of the edge, from twin to twin.
            let mut after = next(h);
            while self.twin(after) != NONE {
                after = next(self.twin(after));
            }
            let [a, b, c] = self.points([h, after, next(after)].map(|h| self.origin(h)));
            let [up, goes_on_up] = [is_before(a, b), is_before(b, c)];
            let order = area_sign(a, b, c);
            if order.is_lt() || (order.is_eq() && up != goes_on_up) {
                return Err("its hull is not convex");
            }
            turns += u32::from(!up && goes_on_up);
            left -= 1;
            h = after;
            if h == start as u32 {
                break;
            }
        }
        if left > 0 || h != start as u32 || turns != 1 { Err(NO_RING) } else { Ok(()) }
    }

    /// Checks that without triangles the hull has points of one line, in their order.
    fn check_line(&self) -> Result<(), Refusal> {
        let hull = &self.triangulation.hull;
        let is_line = hull.windows(2).all(|pair| {
            let [p, q, a, b] = self.points([pair[0], pair[1], hull[0], hull[hull.len() - 1]]);
            is_before(p, q) && area_sign(a, b, q).is_eq()
        });
        if is_line { Ok(()) } else { Err("it has no triangles, and its hull is not a line") }
    }

    /// Checks that each point that is in no triangle equals one that is in some.
    fn check_duplicates(&self, half_edges: &[u32]) -> Result<(), Refusal> {
        let Triangulation { triangles, hull, duplicates, .. } = self.triangulation;
        let mut is_known = Vec::from_iter(half_edges.iter().map(|&h| h != NONE));
        if triangles.is_empty() {
            hull.iter().for_each(|&point| is_known[point as usize] = true);
        }
        for &[copy, original] in duplicates {
            let [is_new, is_old] = [copy, original].map(|index| is_known.get(index as usize));
            if (is_new, is_old) != (Some(&false), Some(&true))
                || self.points[copy as usize] != self.points[original as usize]
            {
                return Err("its duplicates are not equal points");
            }
            is_known[copy as usize] = true;
        }
        if is_known.contains(&false) { Err("a point is neither in it nor a duplicate") } else { Ok(()) }
    }
}
