//! Moves all points of a net. Vertices whose triangles would turn over are lifted out before, and put back where their
//! points are then. In between the edges flip.
//!
//! All triangles are positive, and each vertex of the hull but two lies between its neighbours, by x and then by y. So the
//! lower side of the hull goes from the first vertex to the last, and the upper side back. Positive triangles cover each
//! place as often as the hull goes around it, which is at most once: they are a triangulation. Its pockets close by flips
//! with ghosts, as in Graham's scan, whatever their order.

use super::circle::is_before;
use super::net::Net;
use super::slots::GHOST;
use crate::NONE;
use glam::DVec2;

/// If more than one in so many points changes alone, all are moved together.
const FEW: usize = 32;

/// If more than one vertex in so many would be lifted, or if more edges would flip than there are vertices, the
/// triangulation is made anew.
const MANY: usize = 64;

impl Net {
    /// Whether so many points are few enough to remove and insert them, one after another.
    pub(super) fn is_few(&self, moved: usize) -> bool {
        moved <= self.indices.len() / FEW
    }

    /// Moves the points to these places, by the caller's indices. Returns whether it could: if not, the net is of no use
    /// any more.
    pub(super) fn update(&mut self, given: &[DVec2]) -> bool {
        // Each copy has a place of its own now.
        let mut waiting: Vec<(u32, Option<u32>)> = Vec::new();
        for [vertex, index] in std::mem::take(&mut self.copies) {
            waiting.push((index, Some(vertex)));
        }
        let points: Vec<DVec2> = (self.indices.iter().zip(&self.stars.points))
            .enumerate()
            .map(
                |(vertex, (&index, &point))| {
                    if self.is_used(vertex as u32) { given[index as usize] } else { point }
                },
            )
            .collect();
        if !self.lift(&points, &mut waiting) {
            return false;
        }
        self.stars.points = points;
        let mut edges = Vec::new();
        let mut left = self.indices.len();
        for slot in 0..self.stars.slots.slots.len() as u32 {
            if self.is_free(slot) {
                continue;
            }
            for h in 4 * slot..4 * slot + 3 {
                if h < self.stars.slots.twin(h) && !self.stars.is_delaunay(h) {
                    edges.push(h);
                    left -= self.stars.flip_all(&mut edges, left);
                    if left == 0 {
                        return false;
                    }
                }
            }
        }
        for (index, near) in waiting {
            self.insert(index, given[index as usize], near);
        }
        true
    }

    fn is_used(&self, vertex: u32) -> bool {
        self.stars.half_edges[vertex as usize] != NONE
    }

    /// Lifts vertices until the others are a triangulation at these points. Returns whether they are few.
    fn lift(&mut self, points: &[DVec2], waiting: &mut Vec<(u32, Option<u32>)>) -> bool {
        let is_turned = |net: &Self, h: &u32| {
            let corners = net.stars.corners(*h);
            !corners.contains(&GHOST) && !net.stars.is_positive(corners, points)
        };
        let mut left = points.len() / MANY;
        let first = (0..self.stars.slots.slots.len() as u32).map(|slot| 4 * slot);
        let mut triangles: Vec<u32> = first.filter(|h| is_turned(self, h)).collect();
        let mut turning = Vec::new();
        loop {
            let vertex = if let Some(h) = triangles.pop() {
                if !is_turned(self, &h) {
                    continue;
                }
                self.farthest(h, points)
            } else if let Some(vertex) = turning.pop() {
                if !self.is_used(vertex) {
                    continue;
                }
                vertex
            } else {
                turning = self.turning(points);
                if turning.is_empty() {
                    return true;
                }
                continue;
            };
            if left == 0 {
                return false;
            }
            left -= 1;
            waiting.push((self.indices[vertex as usize], Some(self.neighbour_of(vertex))));
            let removed = self.take_out(vertex);
            if removed.is_flat {
                return false;
            }
            triangles.extend(removed.ears);
            triangles.push(removed.last);
        }
    }

    /// The corner of a triangle that moves farthest.
    fn farthest(&self, h: u32, points: &[DVec2]) -> u32 {
        let distance = |v: u32| (points[v as usize] - self.stars.points[v as usize]).length_squared();
        let [a, b, c] = self.stars.corners(h);
        let farther = |u: u32, v: u32| if distance(v) > distance(u) { v } else { u };
        farther(a, farther(b, c))
    }

    /// The vertices of the hull where its direction in x, and then in y, changes, but for the first and the last vertex.
    fn turning(&self, points: &[DVec2]) -> Vec<u32> {
        let hull = self.hull();
        let is_before = |u: u32, v: u32| is_before(points[u as usize], points[v as usize]);
        let first = hull.iter().copied().reduce(|u, v| if is_before(v, u) { v } else { u });
        let last = hull.iter().copied().reduce(|u, v| if is_before(u, v) { v } else { u });
        let at = |i: usize| hull[i % hull.len()];
        let rows = (0..hull.len()).map(|i| [at(i), at(i + 1), at(i + 2)]);
        let is_turning = |&[before, at, after]: &[u32; 3]| is_before(before, at) != is_before(at, after);
        let turning = rows.filter(is_turning).map(|[_, at, _]| at);
        turning.filter(|&vertex| Some(vertex) != first && Some(vertex) != last).collect()
    }
}
