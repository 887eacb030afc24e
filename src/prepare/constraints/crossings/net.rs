//! A triangulation that grows: triangles of a mesh in the plane, whose edges flip, and new vertices in triangles and on
//! edges. Every vertex has one fan: the other fans of a vertex of the mesh are copies of it.

use crate::mesh::adjacency::Adjacency;
use crate::mesh::embedded::Embedded;
use crate::mesh::half_edge::{LOCKED, lock, next, prev, unflagged};
use crate::mesh::named_edges::ordered;
use crate::mesh::star::Star;
use crate::predicates::{area_sign, in_circle_sign};
use crate::prepare::constraints::state::Links;
use crate::prepare::constraints::walk::Region;
use crate::system::memory;
use crate::system::threads::{Threads, shared};
use crate::{Dimension, Error, MAX_TRIANGLES, Mesh, NONE, Positions};
use glam::DVec2;
use std::cmp::Ordering;

pub(super) struct Net {
    /// The positions of all vertices: those of the mesh, then copies, then new ones.
    points: Mesh,
    pub(super) triangles: Vec<u32>,
    /// With the flags of locked edges.
    twins: Vec<u32>,
    /// A half-edge that starts at each vertex, if it has triangles.
    corners: Vec<u32>,
    /// The stars of the mesh that were embedded, and still are.
    embedded: Embedded,
    /// The vertex of the mesh that each copy stands for, in ascending order.
    copies: Vec<u32>,
    /// The number of vertices of the mesh.
    pub(super) given: u32,
    /// The sign of the triangles that the present line crosses: what counts as positive.
    pub(super) sign: Ordering,
    /// What [`Net::count_doubled`] was in the beginning.
    doubled: usize,
}

impl Net {
    /// `positions` are those of the mesh, perhaps in wider numbers. `locked`: both half-edges of each edge that may not
    /// flip.
    pub(super) fn new(mesh: &Mesh, positions: Positions, locked: &[u32]) -> Self {
        let (vertices, triangles) = (mesh.vertex_count(), mesh.triangles().to_vec());
        let mut twins = Adjacency::of_triangles(vertices, &triangles, &Threads::one()).twins;
        let (_, embedded) = Embedded::with_winding(mesh, &twins, None, &mut None, &Threads::one());
        lock(&mut twins, locked);
        let points = Mesh::of_checked(Dimension::Two, positions, Vec::new());
        let corners = vec![NONE; vertices];
        let (copies, given, sign) = (Vec::new(), vertices as u32, Ordering::Greater);
        let mut net = Self { points, triangles, twins, corners, embedded, copies, given, sign, doubled: 0 };
        net.doubled = net.count_doubled();
        net.separate_fans();
        net
    }

    /// Gives each fan but the first of a vertex a copy of the vertex. A vertex whose star is embedded has one fan.
    fn separate_fans(&mut self) {
        let mut is_seen = vec![false; self.triangles.len()];
        let mut further = Vec::new();
        for h in 0..self.triangles.len() as u32 {
            let v = self.vertex(h);
            if self.embedded.at(v) {
                self.corners[v as usize] = h;
            } else if !is_seen[h as usize] {
                Star::of_fan(&self.twins, h).for_each(|corner| is_seen[corner as usize] = true);
                match self.corners[v as usize] {
                    NONE => self.corners[v as usize] = h,
                    _ => further.push((v, h)),
                }
            }
        }
        further.sort_unstable();
        for (v, h) in further {
            let copy = self.corners.len() as u32;
            let fan: Vec<u32> = Star::of_fan(&self.twins, h).collect();
            fan.into_iter().for_each(|corner| self.triangles[corner as usize] = copy);
            self.points.push_vertex(self.points.point2(v));
            self.corners.push(h);
            self.copies.push(v);
        }
    }

    /// Whether flips have made an edge that the mesh has elsewhere, where it overlaps itself.
    pub(super) fn has_doubled(&self) -> bool {
        self.count_doubled() > self.doubled
    }

    /// Whether the triangles at a vertex are known to have one sign and not to overlap.
    pub(super) fn is_embedded(&self, v: u32) -> bool {
        v >= self.given + self.copies.len() as u32 || self.embedded.at(v)
    }

    /// The number of half-edges beyond two at an edge. A flip makes such an edge only between two vertices whose stars are
    /// not embedded.
    fn count_doubled(&self) -> usize {
        let mut pairs: Vec<[u32; 2]> = Vec::new();
        for h in 0..self.triangles.len() as u32 {
            let [u, v] = self.ends(h);
            if !self.is_embedded(u) && !self.is_embedded(v) {
                pairs.push(ordered([u, v].map(|v| self.original(v))));
            }
        }
        pairs.sort_unstable();
        pairs.chunk_by(|one, other| one == other).map(|pairs| pairs.len().saturating_sub(2)).sum()
    }

    /// Makes sure that there is memory for a new vertex.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`], [`Error::TooLarge`].
    pub(super) fn reserve_vertex(&mut self) -> Result<(), Error> {
        if self.triangles.len() / 3 + 2 > MAX_TRIANGLES {
            let count = self.triangles.len() / 3 + 2;
            return Err(Error::TooLarge { what: "triangles", count, limit: MAX_TRIANGLES });
        }
        if self.triangles.capacity() < self.triangles.len() + 6 {
            // All arrays may double.
            memory::check(2 * (8 * self.triangles.len() as u64 + 20 * self.corners.len() as u64) + 1024)?;
        }
        Ok(())
    }

    /// The vertex that a vertex stands for, which is itself unless it is a copy. New vertices follow those of the mesh.
    pub(super) fn original(&self, v: u32) -> u32 {
        match v.checked_sub(self.given) {
            None => v,
            Some(i) => self.copies.get(i as usize).copied().unwrap_or(v - self.copies.len() as u32),
        }
    }

    /// A vertex of the mesh and its copies.
    pub(super) fn all(&self, v: u32) -> impl Iterator<Item = u32> {
        let range = match v < self.given {
            true => {
                self.copies.partition_point(|&w| w < v) as u32
                    ..self.copies.partition_point(|&w| w <= v) as u32
            }
            false => 0..0,
        };
        let given = self.given;
        [v].into_iter().chain(range.map(move |i| given + i))
    }

    /// The triangles and positions, by the vertices that they stand for.
    pub(super) fn into_parts(mut self) -> (Positions, Vec<u32>) {
        for h in 0..self.triangles.len() {
            self.triangles[h] = self.original(self.triangles[h]);
        }
        let mut positions = self.points.positions().clone();
        let copies = 2 * self.given as usize..2 * (self.given as usize + self.copies.len());
        match &mut positions {
            Positions::F32(numbers) => drop(numbers.drain(copies)),
            Positions::F64(numbers) => drop(numbers.drain(copies)),
        }
        (positions, self.triangles)
    }

    pub(super) fn is_double(&self) -> bool {
        self.points.positions().is_double()
    }

    pub(super) fn point(&self, v: u32) -> DVec2 {
        self.points.point2(v)
    }

    pub(super) fn points<const N: usize>(&self, vertices: [u32; N]) -> [DVec2; N] {
        self.points.positions().points2(vertices)
    }

    pub(super) fn vertex(&self, h: u32) -> u32 {
        self.triangles[h as usize]
    }

    /// Both ends of a half-edge.
    pub(super) fn ends(&self, h: u32) -> [u32; 2] {
        [self.vertex(h), self.vertex(next(h))]
    }

    /// The third corner of the triangle of a half-edge.
    pub(super) fn apex(&self, h: u32) -> u32 {
        self.vertex(prev(h))
    }

    /// The half-edge on the other side of an edge, or [`NONE`].
    pub(super) fn twin(&self, h: u32) -> u32 {
        unflagged(self.twins[h as usize])
    }

    pub(super) fn is_locked(&self, h: u32) -> bool {
        let entry = self.twins[h as usize];
        entry != NONE && entry & LOCKED != 0
    }

    /// Sets whether an edge is locked.
    pub(super) fn set_locked(&mut self, h: u32, is_locked: bool) {
        for h in [h, self.twin(h)] {
            if h != NONE && self.twins[h as usize] != NONE {
                let entry = &mut self.twins[h as usize];
                *entry = if is_locked { *entry | LOCKED } else { *entry & !LOCKED };
            }
        }
    }

    /// The half-edges that start at a vertex.
    pub(super) fn star(&self, v: u32) -> Star<'_> {
        Star::of_fan(&self.twins, self.corners[v as usize])
    }

    pub(super) fn is_used(&self, v: u32) -> bool {
        self.corners[v as usize] != NONE
    }

    /// The turn from a to b to c, as the present line has it: positive triangles turn left.
    pub(super) fn turn(&self, a: DVec2, b: DVec2, c: DVec2) -> Ordering {
        let sign = area_sign(a, b, c);
        if self.sign.is_lt() { sign.reverse() } else { sign }
    }

    /// The half-edge of the triangle of `h` whose edge joins two vertices.
    pub(super) fn side_of(&self, h: u32, ends: [u32; 2]) -> Option<u32> {
        [h, next(h), prev(h)].into_iter().find(|&side| {
            let [x, y] = self.ends(side);
            [x, y] == ends || [y, x] == ends
        })
    }

    /// Makes two vertices an edge, whose line crosses the edges of these half-edges and no vertex. Each half-edge belongs
    /// to the triangle that the line leaves. None of them is locked. Returns a half-edge of the new edge.
    pub(super) fn bring_in(&mut self, half_edges: &[u32]) -> Option<u32> {
        let region = Region::across(half_edges, |h| self.twin(h), self.sign);
        let links = Links {
            mesh: &self.points,
            triangles: shared(&mut self.triangles),
            twins: shared(&mut self.twins),
            fans: &[],
        };
        let ears = links.ears(&region, None).ok()?;
        let h = links.fill(&region, &ears);
        self.set_corners(&region.triangles);
        Some(h)
    }

    /// Flips edges that are not Delaunay, from those of some triangles on, but for locked ones, and for those between
    /// vertices whose stars may overlap.
    pub(super) fn make_delaunay(&mut self, triangles: impl Iterator<Item = u32>) {
        let mut stack: Vec<u32> = triangles.flat_map(|t| 3 * t..3 * t + 3).collect();
        while let Some(h) = stack.pop() {
            let g = self.twin(h);
            if g == NONE || self.is_locked(h) {
                continue;
            }
            let [u, v] = self.ends(h);
            let quad = [u, v, self.apex(h), self.apex(g)];
            let [p, q, r, s] = self.points(quad);
            let [p, q] = if self.sign.is_lt() { [q, p] } else { [p, q] };
            if quad.into_iter().all(|v| self.is_embedded(v)) && in_circle_sign(p, q, r, s).is_lt() {
                self.flip(h, g);
                stack.extend([h, prev(h), g, prev(g)]);
            }
        }
    }

    /// Flips the edge of two half-edges. Each then starts where it did, at the edge after it.
    fn flip(&mut self, h: u32, g: u32) {
        let [[c, after_h], [d, after_g]] =
            [h, g].map(|side| [self.apex(side), self.twins[next(side) as usize]]);
        self.triangles[next(h) as usize] = d;
        self.triangles[next(g) as usize] = c;
        self.link(h, after_g);
        self.link(g, after_h);
        self.link(next(h), next(g));
        self.set_corners(&[h / 3, g / 3]);
    }

    fn set_corners(&mut self, triangles: &[u32]) {
        for h in triangles.iter().flat_map(|t| 3 * t..3 * t + 3) {
            self.corners[self.triangles[h as usize] as usize] = h;
        }
    }

    /// Adds a vertex inside the triangle of `h`, which stays a half-edge of the same ends.
    pub(super) fn insert_inside(&mut self, h: u32, point: DVec2) -> u32 {
        let [a, b, c] = [h, next(h), prev(h)].map(|x| self.vertex(x));
        let p = self.push_vertex(point);
        let [beside_b, beside_c] = [next(h), prev(h)].map(|x| self.twins[x as usize]);
        let first = self.push_triangle([b, c, p]);
        let second = self.push_triangle([c, a, p]);
        self.triangles[prev(h) as usize] = p;
        self.link(first, beside_b);
        self.link(second, beside_c);
        self.link(first + 1, second + 2);
        self.link(next(h), first + 2);
        self.link(second + 1, prev(h));
        self.set_corners(&[h / 3, first / 3, second / 3]);
        p
    }

    /// Adds a vertex on the edge of `e`, which has two triangles. Both half-edges of the edge stay and now end at it.
    /// Returns it, and the new half-edges from it to the ends of `e` and of its twin.
    pub(super) fn insert_on(&mut self, e: u32, point: DVec2) -> (u32, [u32; 2]) {
        let f = self.twin(e);
        let flags = self.twins[e as usize] & LOCKED;
        let [[x, y, c], [_, _, d]] = [e, f].map(|h| [h, next(h), prev(h)].map(|h| self.vertex(h)));
        let p = self.push_vertex(point);
        let [beside_y, beside_x] = [next(e), next(f)].map(|h| self.twins[h as usize]);
        let first = self.push_triangle([p, y, c]);
        let second = self.push_triangle([p, x, d]);
        self.triangles[next(e) as usize] = p;
        self.triangles[next(f) as usize] = p;
        self.link(first + 1, beside_y);
        self.link(second + 1, beside_x);
        self.link(next(e), first + 2);
        self.link(next(f), second + 2);
        self.link(e, second | flags);
        self.link(f, first | flags);
        self.set_corners(&[e / 3, f / 3, first / 3, second / 3]);
        (p, [first, second])
    }

    fn push_vertex(&mut self, point: DVec2) -> u32 {
        self.points.push_vertex(point);
        self.corners.push(NONE);
        self.corners.len() as u32 - 1
    }

    /// Adds a triangle. Returns its first half-edge.
    fn push_triangle(&mut self, corners: [u32; 3]) -> u32 {
        let h = self.triangles.len() as u32;
        self.triangles.extend(corners);
        self.twins.extend([NONE; 3]);
        h
    }

    /// Makes a half-edge and that of an entry, with its flags, twins of each other.
    fn link(&mut self, h: u32, entry: u32) {
        self.twins[h as usize] = entry;
        if entry != NONE {
            self.twins[unflagged(entry) as usize] = h | entry & LOCKED;
        }
    }
}
