//! Adds vertices to a Delaunay triangulation, and removes them.

use super::circle::turn;
use super::ears::Corners;
use super::slots::{GHOST, next, prev};
use super::stars::Stars;
use super::walk::Place;
use crate::NONE;
use std::array;
use std::mem::replace;

impl Stars {
    /// Adds a vertex at its place, which is no vertex, and flips around it. Takes two slots.
    pub(super) fn add(&mut self, vertex: u32, place: Place, slots: [u32; 2]) {
        let ring = match place {
            Place::Vertex(_) => return,
            Place::Inside(h) | Place::Outside(h) => self.split_triangle(vertex, h, slots),
            Place::Edge(h) => self.split_edge(vertex, h, slots),
        };
        self.make_delaunay(ring);
    }

    /// Splits the triangle of a half-edge into three. Returns its sides.
    fn split_triangle(&mut self, vertex: u32, h: u32, slots: [u32; 2]) -> Vec<u32> {
        let corners = self.corners(h);
        let sides = [h, next(h), prev(h)].map(|h| self.slots.twin(h));
        let new = [h >> 2, slots[0], slots[1]];
        for i in 0..3 {
            self.put(new[i], [corners[i], corners[(i + 1) % 3], vertex]);
            self.slots.join(4 * new[i], sides[i]);
        }
        for i in 0..3 {
            self.slots.join(4 * new[i] + 1, 4 * new[(i + 1) % 3] + 2);
        }
        sides.to_vec()
    }

    /// Splits an edge and its two triangles. Returns the sides of these.
    fn split_edge(&mut self, vertex: u32, h: u32, slots: [u32; 2]) -> Vec<u32> {
        let g = self.slots.twin(h);
        let [[a, b, c], [.., d]] = [h, g].map(|h| self.corners(h));
        let [bc, ca, ad, db] = [next(h), prev(h), next(g), prev(g)].map(|h| self.slots.twin(h));
        let new = [slots[0], h >> 2, slots[1], g >> 2];
        let rim = [[b, c], [c, a], [a, d], [d, b]];
        let sides = [bc, ca, ad, db];
        for i in 0..4 {
            self.put(new[i], [rim[i][0], rim[i][1], vertex]);
            self.slots.join(4 * new[i], sides[i]);
        }
        for i in 0..4 {
            self.slots.join(4 * new[i] + 1, 4 * new[(i + 1) % 4] + 2);
        }
        sides.to_vec()
    }

    /// Removes a vertex. All triangles are positive again, but perhaps not Delaunay.
    pub(super) fn remove(&mut self, vertex: u32) -> Removed {
        let mut ring: Vec<u32> = self.star(vertex).collect();
        let ghost = ring.iter().position(|&h| self.slots.origin(next(h)) == GHOST);
        // On the hull, the ring begins at the symbolic vertex and goes on to the next vertex of the hull.
        ring.rotate_left(ghost.unwrap_or(0));
        let ears = self.cut_ears(vertex, &mut ring, ghost.is_some());
        let free = if ghost.is_none() { self.close(&ring) } else { self.open(&ring) };
        self.half_edges[vertex as usize] = NONE;
        let last = ring[usize::from(ghost.is_some())];
        let is_flat = ghost.is_some() && self.slots.apex(self.slots.twin(next(ring[1]))) == GHOST;
        Removed { free, ears, last, is_flat }
    }

    /// Flips edges of a vertex, by half-edges that begin there, as long as a triangle comes off that is positive: until
    /// three are left, or until the neighbours on the hull turn to the right everywhere. Returns the half-edges of these
    /// triangles along which they came off.
    ///
    /// Inside the hull, the neighbours are a polygon. If it has more than three corners, it can be triangulated with two
    /// ears that are apart, and the vertex is in one of them at most: so an ear comes off that leaves the vertex in the
    /// polygon, or on its boundary.
    fn cut_ears(&mut self, vertex: u32, ring: &mut Vec<u32>, is_on_hull: bool) -> Vec<u32> {
        let count = ring.len();
        let mut corners = Corners::new(count, if is_on_hull { 2..count - 1 } else { 0..count });
        let most = if is_on_hull { count } else { count - 3 };
        let mut ears = Vec::new();
        while ears.len() < most
            && let Some(three @ [before, corner, _]) = corners.next()
        {
            let [p, q, r] = self.points(three.map(|corner| self.slots.origin(next(ring[corner]))));
            let [at] = self.points([vertex]);
            if turn(p, q, r).is_gt() && (is_on_hull || turn(p, r, at).is_ge()) {
                let h = replace(&mut ring[corner], NONE);
                let g = self.slots.twin(h);
                self.flip(h, g);
                ears.push(g);
                ring[before] = prev(h);
                corners.cut(three);
            }
        }
        ring.retain(|&h| h != NONE);
        ears
    }

    /// Makes one triangle of the three around a vertex. Returns the slots of the other two.
    fn close(&mut self, ring: &[u32]) -> [u32; 2] {
        let sides: [u32; 3] = array::from_fn(|i| next(ring[i]));
        let twins = sides.map(|side| self.slots.twin(side));
        let h = self.put(ring[0] >> 2, sides.map(|side| self.slots.origin(side)));
        for (h, twin) in (h..).zip(twins) {
            self.slots.join(h, twin);
        }
        [ring[1] >> 2, ring[2] >> 2]
    }

    /// Makes ghosts of the triangles around a vertex of the hull. Returns the slots of its own ghosts.
    fn open(&mut self, ring: &[u32]) -> [u32; 2] {
        let [first, last] = [ring[0], ring[ring.len() - 1]];
        let triangles = &ring[1..ring.len() - 1];
        let [to_first, from_last] = [next(first), next(last)].map(|h| self.slots.twin(h));
        for &h in triangles {
            let [end, side] = [next(h), prev(h)].map(|h| (h, self.slots.origin(h)));
            self.begin(GHOST, h);
            self.begin(side.1, side.0);
            self.begin(end.1, end.0);
        }
        if let (Some(&first), Some(&last)) = (triangles.first(), triangles.last()) {
            self.slots.join(first, to_first);
            self.slots.join(prev(last), from_last);
        }
        [first >> 2, last >> 2]
    }
}

/// What is left of the star of a vertex.
pub(super) struct Removed {
    /// The slots that no triangle has any more.
    pub(super) free: [u32; 2],
    /// The half-edges of the new triangles along which they came off the star, in their order, and one of the last.
    pub(super) ears: Vec<u32>,
    pub(super) last: u32,
    /// Whether no triangle is left.
    pub(super) is_flat: bool,
}
