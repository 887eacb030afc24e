//! Verifies that arrays are the Delaunay triangulation of points, in linear time. What passes has these properties:
//! triangles are counter-clockwise, twins fit, and the edges without one are a single convex ring; so the triangles cover
//! the inside of the ring once. Each point is a corner or equals one. Each edge is Delaunay, and so all triangles are.

use crate::mesh::half_edge::next;
use crate::predicates::{area_sign, in_circle_sign};
use crate::system::threads::Threads;
use crate::{Error, NONE, Positions, Triangulation};
use glam::DVec2;
use std::ops::Range;

/// For each point a half-edge that starts there, or `NONE` if it is in no triangle. On the hull, it is the one without a
/// twin.
///
/// # Errors
/// [`Error::Option`] if this is not the Delaunay triangulation of the points; [`Error::RaggedArray`],
/// [`Error::IndexOutOfRange`].
pub(super) fn corners_of(
    triangulation: &Triangulation,
    points: &Positions,
    threads: &Threads,
) -> Result<Vec<u32>, Error> {
    let Triangulation { triangles, twins, .. } = triangulation;
    let (length, vertices) = (triangles.len(), points.len() / 2);
    if length % 3 != 0 {
        return Err(Error::RaggedArray { array: "triangles", length, stride: 3 });
    }
    if twins.len() != length {
        return Err(refused("it has another number of twins than of indices in triangles"));
    }
    if let Some(at) = triangles.iter().position(|&index| index as usize >= vertices) {
        return Err(Error::IndexOutOfRange { triangle: at / 3, index: triangles[at], vertices });
    }
    let verified = Verified { triangulation, points };
    threads
        .map(length / 3, |piece| verified.check_triangles(piece))
        .into_iter()
        .collect::<Result<(), _>>()?;
    let mut first = vec![NONE; vertices];
    for (h, (&vertex, &twin)) in (0..).zip(triangles.iter().zip(twins)) {
        if twin == NONE || first[vertex as usize] == NONE {
            first[vertex as usize] = h;
        }
    }
    verified.check_hull()?;
    verified.check_duplicates(&first)?;
    Ok(first)
}

const NO_RING: &str = "its hull is not one ring";

fn refused(message: &str) -> Error {
    let message = format!("{message}; pass the triangulation of these points, unchanged");
    Error::Option { option: "triangulation", message }
}

fn is_before(p: DVec2, q: DVec2) -> bool {
    p.x < q.x || (p.x == q.x && p.y < q.y)
}

struct Verified<'a> {
    triangulation: &'a Triangulation,
    points: &'a Positions,
}

impl Verified<'_> {
    /// Where the half-edge starts.
    fn origin(&self, h: u32) -> u32 {
        self.triangulation.triangles[h as usize]
    }

    fn twin(&self, h: u32) -> u32 {
        self.triangulation.twins[h as usize]
    }

    fn check_triangles(&self, triangles: Range<usize>) -> Result<(), Error> {
        for h in triangles.map(|triangle| 3 * triangle as u32) {
            let corners = [h, h + 1, h + 2].map(|h| self.origin(h));
            let [a, b, c] = self.points.points2(corners);
            if !area_sign(a, b, c).is_gt() {
                return Err(refused("a triangle of it is not counter-clockwise"));
            }
            for (i, [p, q, r]) in [[a, b, c], [b, c, a], [c, a, b]].into_iter().enumerate() {
                let (h, g) = (h + i as u32, self.twin(h + i as u32));
                if g == NONE {
                    continue;
                }
                let [start, end] = [corners[i], corners[(i + 1) % 3]];
                let is_twin = (g as usize) < self.triangulation.twins.len()
                    && self.twin(g) == h
                    && self.origin(g) == end
                    && self.origin(next(g)) == start;
                if !is_twin {
                    return Err(refused("a twin of it is not the same edge from the other side"));
                }
                if h < g {
                    let [d] = self.points.points2([self.origin(next(next(g)))]);
                    if in_circle_sign(p, q, r, d).is_lt() {
                        return Err(refused("an edge of it is not Delaunay"));
                    }
                }
            }
        }
        Ok(())
    }

    /// Checks that the edges without a twin are a ring that turns to the left once.
    fn check_hull(&self) -> Result<(), Error> {
        let twins = &self.triangulation.twins;
        let Some(start) = twins.iter().position(|&twin| twin == NONE) else {
            return if twins.is_empty() { self.check_line() } else { Err(refused(NO_RING)) };
        };
        let mut left = twins.iter().filter(|&&twin| twin == NONE).count();
        let (mut h, mut turns) = (start as u32, 0);
        while left > 0 {
            // Turns around the end of the edge, from twin to twin.
            let mut after = next(h);
            while self.twin(after) != NONE {
                after = next(self.twin(after));
            }
            let corners = [h, after, next(after)].map(|h| self.origin(h));
            let [a, b, c] = self.points.points2(corners);
            let [up, goes_on_up] = [is_before(a, b), is_before(b, c)];
            let order = area_sign(a, b, c);
            if order.is_lt() || (order.is_eq() && up != goes_on_up) {
                return Err(refused("its hull is not convex"));
            }
            turns += u32::from(!up && goes_on_up);
            left -= 1;
            h = after;
            if h == start as u32 {
                break;
            }
        }
        if left > 0 || h != start as u32 || turns != 1 {
            return Err(refused(NO_RING));
        }
        Ok(())
    }

    /// Checks that without triangles the hull has points of one line, in their order.
    fn check_line(&self) -> Result<(), Error> {
        let (hull, vertices) = (&self.triangulation.hull, self.points.len() / 2);
        if hull.iter().any(|&index| index as usize >= vertices) {
            return Err(refused("its hull has an index that is out of range"));
        }
        let is_line = hull.windows(2).all(|pair| {
            let [p, q, a, b] = self.points.points2([pair[0], pair[1], hull[0], hull[hull.len() - 1]]);
            is_before(p, q) && area_sign(a, b, q).is_eq()
        });
        if is_line { Ok(()) } else { Err(refused("it has no triangles, and its hull is not a line")) }
    }

    /// Checks that each point that is in no triangle equals one that is in some.
    fn check_duplicates(&self, first: &[u32]) -> Result<(), Error> {
        let Triangulation { triangles, hull, duplicates, .. } = self.triangulation;
        let mut is_known: Vec<bool> = first.iter().map(|&h| h != NONE).collect();
        if triangles.is_empty() {
            hull.iter().for_each(|&point| is_known[point as usize] = true);
        }
        let is_copy = |is_known: &[bool], [copy, original]: [u32; 2]| {
            let [is_new, is_old] = [copy, original].map(|index| is_known.get(index as usize).copied());
            is_new == Some(false) && is_old == Some(true) && {
                let [p, q] = self.points.points2([copy, original]);
                p == q
            }
        };
        for &pair in duplicates {
            if !is_copy(&is_known, pair) {
                return Err(refused("its duplicates are not equal points"));
            }
            is_known[pair[0] as usize] = true;
        }
        if is_known.contains(&false) {
            return Err(refused("a point is neither in it nor a duplicate"));
        }
        Ok(())
    }
}
