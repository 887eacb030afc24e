//! A triangulation that changes with its points, by the caller's indices.

use super::changes::Removed;
use super::columns::Columns;
use super::distribution::sort_pairs;
use super::halves::{Network, slots_of};
use super::numbering::{Numbered, numbered};
use super::slots::{GHOST, next, prev};
use super::stars::Stars;
use super::walk::Place;
use crate::NONE;
use crate::predicates::nearer;
use crate::system::threads::Threads;
use glam::DVec2;

/// There is always a triangle.
pub(super) struct Net {
    pub(super) stars: Stars,
    /// The caller's index of each vertex: of equal points the smallest.
    pub(super) indices: Vec<u32>,
    /// The vertex of each of the caller's indices.
    vertices: Vec<u32>,
    /// The vertices of other equal points, with the indices of these. Sorted.
    pub(super) copies: Vec<[u32; 2]>,
    pub(super) free_vertices: Vec<u32>,
    /// Slots that no triangle has: two per vertex that was removed.
    pub(super) free_slots: Vec<[u32; 2]>,
    /// Where the next walk begins.
    last: u32,
}

impl Net {
    /// Triangulates columns. `indices` has the caller's index of each of their points; all are below `count`. `None` if
    /// there is no triangle.
    pub(super) fn of(columns: Columns, indices: &[u32], count: usize, threads: &Threads) -> Option<Self> {
        let Columns { points, indices: places, starts, duplicates } = columns;
        let mut slots = slots_of(points.len(), threads);
        Network::new(&points, &mut slots, threads).of_columns(&starts);
        if slots.iter().all(|slot| slot.corners[..3].contains(&GHOST)) {
            return None;
        }
        let mut vertices = vec![NONE; count];
        let own = |place: u32| indices[place as usize];
        let places: Vec<u32> = places.into_iter().map(own).collect();
        for (vertex, &index) in (0..).zip(&places) {
            vertices[index as usize] = vertex;
        }
        let mut copies = Vec::new();
        for [index, first] in duplicates.into_iter().map(|pair| pair.map(own)) {
            vertices[index as usize] = vertices[first as usize];
            copies.push([vertices[first as usize], index]);
        }
        sort_pairs(&mut copies);
        Some(Self {
            stars: Stars::new(points, slots),
            indices: places,
            vertices,
            copies,
            free_vertices: Vec::new(),
            free_slots: Vec::new(),
            last: 0,
        })
    }

    /// Adds a point. The walk to it begins at the vertex `near`, if there is one.
    pub(super) fn insert(&mut self, index: u32, point: DVec2, near: Option<u32>) {
        if self.vertices.len() <= index as usize {
            self.vertices.resize(index as usize + 1, NONE);
        }
        let place = self.stars.place(self.start(near, point), point);
        if let Place::Vertex(vertex) = place {
            let owner = &mut self.indices[vertex as usize];
            insert(&mut self.copies, [vertex, index.max(*owner)]);
            *owner = index.min(*owner);
            self.vertices[index as usize] = vertex;
            self.last = vertex;
            return;
        }
        let vertex = self.free_vertices.pop().unwrap_or_else(|| {
            self.stars.points.push(point);
            self.stars.half_edges.push(NONE);
            self.indices.push(index);
            self.indices.len() as u32 - 1
        });
        self.stars.points[vertex as usize] = point;
        self.indices[vertex as usize] = index;
        self.vertices[index as usize] = vertex;
        let slots = self.free_slots.pop().unwrap_or_else(|| {
            let slots = &mut self.stars.slots.slots;
            let first = slots.len() as u32;
            slots.resize(slots.len() + 2, Default::default());
            [first, first + 1]
        });
        self.stars.add(vertex, place, slots);
        self.last = vertex;
    }

    /// Removes a point. Returns whether there is still a triangle.
    pub(super) fn remove(&mut self, index: u32) -> bool {
        let vertex = self.vertices[index as usize];
        // The point itself, if it is a copy, or else the first copy of it, which takes its place.
        let is_copy = self.indices[vertex as usize] != index;
        let at = self.copies.partition_point(|&copy| copy < [vertex, if is_copy { index } else { 0 }]);
        if self.copies.get(at).is_some_and(|copy| copy[0] == vertex) {
            let [_, copy] = self.copies.remove(at);
            if !is_copy {
                self.indices[vertex as usize] = copy;
            }
            return true;
        }
        let Removed { ears, last, is_flat, .. } = self.take_out(vertex);
        if !is_flat {
            self.stars.put_back(&ears);
            let triangles = ears.into_iter().chain([last]);
            self.stars.make_delaunay(triangles.flat_map(|h| [h, next(h), prev(h)]).collect());
        }
        !is_flat
    }

    /// Removes a vertex. The triangles are perhaps not Delaunay then.
    pub(super) fn take_out(&mut self, vertex: u32) -> Removed {
        let removed = self.stars.remove(vertex);
        for slot in removed.free {
            self.stars.slots.put(slot, [GHOST; 3]);
        }
        self.free_slots.push(removed.free);
        self.free_vertices.push(vertex);
        removed
    }

    /// Whether a slot has no triangle: then all its corners are the symbolic vertex.
    pub(super) fn is_free(&self, slot: u32) -> bool {
        self.stars.slots.slots[slot as usize].corners[..2] == [GHOST; 2]
    }

    /// A vertex that has an edge to the vertex of a point.
    pub(super) fn neighbour(&self, index: u32) -> u32 {
        self.neighbour_of(self.vertices[index as usize])
    }

    pub(super) fn neighbour_of(&self, vertex: u32) -> u32 {
        let mut ends = self.stars.star(vertex).map(|h| self.stars.slots.origin(next(h)));
        ends.find(|&end| end != GHOST).unwrap_or(vertex)
    }

    /// Where a walk to a place begins: at this vertex, if it is in a triangle, or where the last one ended. If that is far
    /// away, some others may be nearer.
    fn start(&self, near: Option<u32>, place: DVec2) -> u32 {
        let Stars { points, half_edges, .. } = &self.stars;
        let is_there = |&vertex: &u32| half_edges[vertex as usize] != NONE;
        if let Some(near) = near.filter(is_there) {
            return near;
        }
        let count = points.len();
        let step = if self.is_close(place) { count } else { count >> (count.ilog2() / 3) };
        let others = (0..count as u32).step_by(step).chain([self.last]).filter(is_there);
        let distance = |&vertex: &u32| points[vertex as usize].distance_squared(place);
        let nearest = others.min_by(|p, q| distance(p).total_cmp(&distance(q)));
        nearest.or_else(|| (0..count as u32).find(is_there)).unwrap_or_default()
    }

    /// Whether a place is only some edges away from the vertex where the last walk ended.
    fn is_close(&self, place: DVec2) -> bool {
        let Some(&h) = self.stars.half_edges.get(self.last as usize).filter(|&&h| h != NONE) else {
            return false;
        };
        let end = self.stars.slots.origin(next(h));
        end != GHOST && {
            let [p, q] = self.stars.points([self.last, end]);
            p.distance_squared(place) < 100.0 * p.distance_squared(q)
        }
    }

    /// The triangles by the caller's indices.
    pub(super) fn triangles(&self, threads: &Threads) -> Vec<u32> {
        threads.enter(|| self.numbered(threads).triangles)
    }

    /// The same, and the twins.
    pub(super) fn with_twins(&self, threads: &Threads) -> (Vec<u32>, Vec<u32>) {
        threads.enter(|| self.numbered(threads).with_twins(&self.stars.slots.slots, threads))
    }

    fn numbered(&self, threads: &Threads) -> Numbered {
        numbered(&self.stars.slots.slots, &self.indices, self.vertices.len(), threads)
    }

    /// The hull from some vertex, counter-clockwise.
    pub(super) fn hull(&self) -> Vec<u32> {
        let slots = &self.stars.slots;
        let is_ghost =
            |&slot: &u32| !self.is_free(slot) && slots.slots[slot as usize].corners[..3].contains(&GHOST);
        let Some(ghost) = (0..slots.slots.len() as u32).find(is_ghost) else { return Vec::new() };
        let to_symbolic = (4 * ghost..4 * ghost + 3).find(|&h| slots.origin(next(h)) == GHOST);
        slots.hull(to_symbolic.unwrap_or(4 * ghost))
    }

    /// The pairs of equal points, sorted.
    pub(super) fn duplicates(&self) -> Vec<[u32; 2]> {
        let pair = |&[vertex, index]: &[u32; 2]| [index, self.indices[vertex as usize]];
        let mut pairs: Vec<_> = self.copies.iter().map(pair).collect();
        sort_pairs(&mut pairs);
        pairs
    }

    /// The triangle at a place, by the caller's indices from the smallest. Of several, the least.
    pub(super) fn triangle_at(&mut self, place: DVec2) -> Option<[u32; 3]> {
        let half_edges = match self.stars.place(self.start(None, place), place) {
            Place::Vertex(vertex) => self.stars.star(vertex).collect(),
            Place::Edge(h) => vec![h, self.stars.slots.twin(h)],
            Place::Inside(h) => vec![h],
            Place::Outside(h) => {
                self.last = self.stars.slots.origin(h);
                return None;
            }
        };
        let corners = half_edges.into_iter().map(|h| self.stars.corners(h));
        let real = corners.filter(|corners| !corners.contains(&GHOST));
        let triangles = real.map(|corners| {
            let mut indices = corners.map(|vertex| self.indices[vertex as usize]);
            let least = (0..3).min_by_key(|&i| indices[i]).unwrap_or(0);
            indices.rotate_left(least);
            indices
        });
        let triangle = triangles.min()?;
        self.last = self.vertices[triangle[0] as usize];
        Some(triangle)
    }

    /// The point that is nearest to a place; of several, the one with the smallest index. From every other vertex, an edge
    /// of a Delaunay triangulation leads to a nearer one.
    pub(super) fn nearest(&mut self, place: DVec2) -> u32 {
        let mut at = self.start(None, place);
        while let Some(nearer) = self.beside(at, place, |order| order.is_lt()).next() {
            at = nearer;
        }
        self.last = at;
        // Edges join those that are as near.
        let (mut ties, mut left) = (vec![at], vec![at]);
        while let Some(tie) = left.pop() {
            let others = self.beside(tie, place, |order| order.is_eq());
            left.extend(others.filter(|&other| insert(&mut ties, other)));
        }
        ties.into_iter().map(|vertex| self.indices[vertex as usize]).min().unwrap_or_default()
    }

    /// The ends of the edges of a vertex whose distance from a place, compared with that of the vertex, is as wanted.
    fn beside(
        &self,
        vertex: u32,
        place: DVec2,
        is_wanted: fn(std::cmp::Ordering) -> bool,
    ) -> impl Iterator<Item = u32> {
        let ends = self.stars.star(vertex).map(|h| self.stars.slots.origin(next(h)));
        ends.filter(move |&end| {
            end != GHOST && {
                let [p, q] = self.stars.points([end, vertex]);
                is_wanted(nearer(p, q, place))
            }
        })
    }
}

/// Inserts an item into a sorted list. Returns whether it is new.
fn insert<T: Ord>(list: &mut Vec<T>, item: T) -> bool {
    list.binary_search(&item).map_err(|at| list.insert(at, item)).is_err()
}
