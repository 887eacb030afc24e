//! Finds the triangle at a place, by walking.

use super::circle::{is_left_turn, turn};
use super::slots::{GHOST, next, prev};
use super::stars::Stars;
use glam::DVec2;

/// Where a place is in a Delaunay triangulation that has a triangle.
#[derive(Clone, Copy)]
pub(super) enum Place {
    /// At a vertex.
    Vertex(u32),
    /// On the edge of this half-edge, between its ends. Its triangle is no ghost.
    Edge(u32),
    /// In the triangle of this half-edge.
    Inside(u32),
    /// Outside of the hull, beyond the edge of this half-edge of a ghost.
    Outside(u32),
}

impl Stars {
    /// Walks from the star of this vertex to a place. From each triangle it goes on beyond an edge that has the place on its
    /// other side, which never leads back in a Delaunay triangulation.
    pub(super) fn place(&self, from: u32, point: DVec2) -> Place {
        let is_real = |&h: &u32| self.corners(h).iter().all(|&vertex| vertex != GHOST);
        let mut h = self.star(from).find(is_real).unwrap_or(self.half_edges[from as usize]);
        loop {
            let sides = [h, next(h), prev(h)];
            let signs = sides.map(|h| {
                let [a, b] = self.points([h, next(h)].map(|h| self.slots.origin(h)));
                turn(a, b, point)
            });
            if let Some(side) = (0..3).find(|&i| signs[i].is_lt()) {
                h = self.slots.twin(sides[side]);
                if self.slots.apex(h) == GHOST {
                    return Place::Outside(h);
                }
                continue;
            }
            return match signs.map(|sign| sign.is_eq()) {
                [true, _, true] => Place::Vertex(self.slots.origin(sides[0])),
                [true, true, _] => Place::Vertex(self.slots.origin(sides[1])),
                [_, true, true] => Place::Vertex(self.slots.origin(sides[2])),
                [true, ..] => Place::Edge(sides[0]),
                [_, true, _] => Place::Edge(sides[1]),
                [.., true] => Place::Edge(sides[2]),
                _ => Place::Inside(h),
            };
        }
    }

    /// Whether three points are a triangle, counter-clockwise.
    pub(super) fn is_positive(&self, corners: [u32; 3], points: &[DVec2]) -> bool {
        let point = |vertex: u32| points[vertex as usize];
        let [a, b, c] = corners;
        is_left_turn(point(a), point(b), point(c))
    }
}
