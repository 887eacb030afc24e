//! Brings constraints in. The triangles that a constraint crosses make way for two polygons, one on each side of it. Each
//! is triangulated from the constraint's first end to its second, and then flips make all Delaunay but for the
//! constraints: so the result depends on points and constraints only.
//!
//! All vertices of a polygon see the constraint: each crossed edge joins two of them across it. So each convex corner is an
//! ear: no other vertex is in its triangle. It comes off, and the rest is such a polygon again. An edge that has the polygon
//! on both sides is in its boundary twice, once in each direction.

use super::circle::turn;
use super::distribution::Record;
use super::ears::Corners;
use super::slots::{next, prev};
use super::stars::Stars;
use crate::mesh::named_edges::{LeftOut, ordered};
use crate::system::memory;
use glam::DVec2;
use std::cmp::Ordering;
use std::ops::Range;

/// The most bytes that an edge takes beyond the first of its constraint: in a list that grows (36), and what the result has
/// of it (32).
const BYTES_PER_EDGE: u64 = 68;

/// Constraints, by the vertices of the slots.
pub(super) struct Constraints<'a> {
    pub(super) given: &'a [[u32; 2]],
    pub(super) skips: bool,
}

/// A part of a constraint, without a vertex between its ends.
struct Part {
    ends: [u32; 2],
    way: Way,
}

/// How a part lies in the triangulation.
enum Way {
    /// It is the edge of this half-edge.
    Edge(u32),
    /// It crosses the triangles of these slots.
    Across {
        slots: Vec<u32>,
        /// The other sides of these triangles: those on the right from its first end to its second, and those on the
        /// left from its second end to its first.
        right: Vec<u32>,
        left: Vec<u32>,
    },
}

/// What was brought in.
pub(super) struct Brought {
    /// The edges of the constraints: the index of the constraint, and the ends.
    pub(super) edges: Vec<[u32; 3]>,
    /// The constraints that were left out: the index of each, and the ends of the edge that it crosses.
    left_out: Vec<[u32; 3]>,
}

impl Constraints<'_> {
    /// Brings them in, one after another. Without `skips`, the first that cannot be brought in is the last.
    ///
    /// # Errors
    /// The bytes that are not there, for constraints through very many points.
    pub(super) fn bring_in(&self, stars: &mut Stars) -> Result<Brought, u64> {
        let mut brought = Brought { edges: Vec::with_capacity(self.given.len()), left_out: Vec::new() };
        for (index, &ends) in (0..).zip(self.given) {
            match stars.walk(ends) {
                Ok(parts) => {
                    let edges = brought.edges.len() + parts.len();
                    if edges > brought.edges.capacity() {
                        let bytes = BYTES_PER_EDGE * edges as u64;
                        memory::check(bytes).map_err(|_| bytes)?;
                    }
                    brought.edges.extend(parts.iter().map(|&Part { ends: [a, b], .. }| [index, a, b]));
                    let mut changed = Vec::new();
                    parts.into_iter().for_each(|part| stars.bring_in(part, &mut changed));
                    stars.make_delaunay(changed);
                }
                Err(crossed) => {
                    let [a, b] = [crossed, next(crossed)].map(|h| stars.slots.origin(h));
                    brought.left_out.push([index, a, b]);
                    if !self.skips {
                        break;
                    }
                }
            }
        }
        Ok(brought)
    }
}

impl Brought {
    /// The constraints that were left out, with their reasons. `given` has the constraints by the caller's indices.
    pub(super) fn left_out(&self, given: &[[u32; 2]]) -> Vec<LeftOut> {
        if self.left_out.is_empty() {
            return Vec::new();
        }
        // The ends of each edge, and the constraint that it is a part of.
        let record = |[index, a, b]: [u32; 3]| {
            let [a, b] = ordered([a, b]);
            Record::of([a, b, index])
        };
        let mut origins: Vec<Record> = self.edges.iter().copied().map(record).collect();
        Record::sort(&mut origins);
        let reason = |&[index, a, b]: &[u32; 3]| {
            let first = record([0, a, b]);
            let at = origins.partition_point(|origin| origin.is_before(&first));
            let other = origins.get(at).map_or(0, |origin| origin.index);
            let [[a, b], [c, d]] = [index, other].map(|i| given[i as usize]);
            let reason = format!(
                "constraint {index} between {a} and {b} crosses constraint {other} between {c} and {d}"
            );
            LeftOut { index: index as usize, reason }
        };
        self.left_out.iter().map(reason).collect()
    }
}

impl Stars {
    /// The parts of a constraint, from its first end to its second. The error is a locked half-edge that it crosses.
    fn walk(&self, [mut from, mut to]: [u32; 2]) -> Result<Vec<Part>, u32> {
        let (mut parts, mut last_parts) = (Vec::new(), Vec::new());
        while from != to {
            // One of the stars may be large.
            let [first, second] = [[from, to], [to, from]];
            let found = self.star(from).zip(self.star(to)).find_map(|(h, g)| {
                let start = |ends: [u32; 2], h: u32| Some((ends, self.start(ends, h)?));
                start(first, h).or_else(|| start(second, g))
            });
            let Some((ends, start)) = found else { break };
            let part = match start {
                Start::Edge(h) => Part { ends: [ends[0], self.slots.origin(next(h))], way: Way::Edge(h) },
                Start::Triangle(h) => self.across(ends, h)?,
            };
            if ends == first {
                from = part.ends[1];
                parts.push(part);
            } else {
                to = part.ends[1];
                last_parts.push(part);
            }
        }
        parts.extend(last_parts.into_iter().rev().map(Part::turned));
        Ok(parts)
    }

    /// How the constraint begins if it begins with this half-edge, or in its triangle.
    fn start(&self, [at, to]: [u32; 2], h: u32) -> Option<Start> {
        let point = |vertex: u32| self.points.get(vertex as usize).copied();
        let ends = [point(at)?, point(to)?];
        let x = point(self.slots.origin(next(h)))?;
        match turn(ends[0], ends[1], x) {
            Ordering::Equal => is_ahead(ends, x).then_some(Start::Edge(h)),
            Ordering::Less => {
                let y = point(self.slots.apex(h))?;
                turn(ends[0], ends[1], y).is_gt().then_some(Start::Triangle(h))
            }
            Ordering::Greater => None,
        }
    }

    /// The part that begins in the triangle of this half-edge.
    fn across(&self, [at, to]: [u32; 2], start: u32) -> Result<Part, u32> {
        let ends = [at, to].map(|vertex| self.points[vertex as usize]);
        let (mut slots, mut right, mut left) = (vec![start >> 2], vec![start], vec![prev(start)]);
        let mut h = next(start);
        loop {
            if self.slots.is_locked(h) {
                return Err(h);
            }
            let g = self.slots.twin(h);
            let far = self.slots.apex(g);
            slots.push(g >> 2);
            let side = turn(ends[0], ends[1], self.points[far as usize]);
            if side.is_le() {
                right.push(next(g));
            }
            if side.is_ge() {
                left.push(prev(g));
            }
            h = match side {
                Ordering::Greater => next(g),
                Ordering::Less => prev(g),
                Ordering::Equal => {
                    left.reverse();
                    return Ok(Part { ends: [at, far], way: Way::Across { slots, right, left } });
                }
            };
        }
    }

    /// Locks the edge of a part. Adds the half-edges of the triangles that are new.
    fn bring_in(&mut self, Part { ends: [from, to], way }: Part, changed: &mut Vec<u32>) {
        let (slots, right, left) = match way {
            Way::Edge(h) => return self.lock(h, true),
            Way::Across { slots, right, left } => (slots, right, left),
        };
        let sides: Vec<u32> = right.iter().chain(&left).copied().collect();
        let mut polygons = Polygons::new(self, &sides);
        let mut free = slots.iter().copied();
        let ears = [
            polygons.fill(self, from, 0..right.len(), &mut free),
            polygons.fill(self, to, right.len()..sides.len(), &mut free),
        ];
        if let [[first @ .., h], [second @ .., g]] = ears.each_ref().map(Vec::as_slice) {
            self.slots.join(*h, *g);
            self.lock(*h, true);
            self.put_back(first);
            self.put_back(second);
        }
        for slot in slots {
            changed.extend(4 * slot..4 * slot + 3);
        }
    }
}

/// How a constraint begins: with the edge of a half-edge, or in its triangle.
enum Start {
    Edge(u32),
    Triangle(u32),
}

impl Part {
    /// The same from its second end to its first.
    fn turned(self) -> Self {
        let [from, to] = self.ends;
        let way = match self.way {
            Way::Across { slots, right, left } => Way::Across { slots, right: left, left: right },
            edge @ Way::Edge(_) => edge,
        };
        Self { ends: [to, from], way }
    }
}

/// Whether a point on the line through two points is on the side of the second, as seen from the first.
fn is_ahead([from, to]: [DVec2; 2], point: DVec2) -> bool {
    // One coordinate that differs decides.
    let [from, to, point] = if from.x == to.x { [from.y, to.y, point.y] } else { [from.x, to.x, point.x] };
    (from < to && from < point) || (from > to && from > point)
}

/// The sides of the two polygons of a part. They are half-edges of triangles that make way.
struct Polygons {
    sides: Vec<Side>,
}

/// A side of a polygon.
struct Side {
    /// The vertex at its end.
    end: u32,
    is_locked: bool,
    beyond: Beyond,
}

/// What is beyond a side: a half-edge, or another side, until the triangle of one of them is known.
#[derive(Clone, Copy)]
enum Beyond {
    HalfEdge(u32),
    Side(usize),
}

/// An edge of the polygon: a side, or the half-edge of the ear that came off along it.
#[derive(Clone, Copy)]
enum Link {
    Side(usize),
    Cut(u32),
}

impl Polygons {
    fn new(stars: &mut Stars, half_edges: &[u32]) -> Self {
        let slots = &mut stars.slots;
        let side = |&h: &u32| Side {
            end: slots.origin(next(h)),
            is_locked: slots.is_locked(h),
            beyond: Beyond::HalfEdge(slots.twin(h)),
        };
        let mut sides: Vec<Side> = half_edges.iter().map(side).collect();
        // No number of a half-edge is 3 modulo 4: so the twin of a side can be the side's number.
        for (i, &h) in (0..).zip(half_edges) {
            slots.set_twin(h, 4 * i + 3);
        }
        for side in &mut sides {
            if let Beyond::HalfEdge(g) = side.beyond {
                let twin = slots.twin(g);
                if twin & 3 == 3 {
                    side.beyond = Beyond::Side(twin as usize >> 2);
                }
            }
        }
        Self { sides }
    }

    /// Triangulates the polygon of these sides and one more, which closes it. `first` is its first vertex. Takes slots for
    /// the triangles. Returns the half-edges along which ears came off; the last is that of the side that closes the
    /// polygon.
    fn fill(
        &mut self,
        stars: &mut Stars,
        first: u32,
        sides: Range<usize>,
        free: &mut impl Iterator<Item = u32>,
    ) -> Vec<u32> {
        let count = sides.len() + 1;
        let mut links: Vec<Link> = sides.clone().map(Link::Side).collect();
        let vertex =
            |corner: usize| if corner == 0 { first } else { self.sides[sides.start + corner - 1].end };
        let vertices: Vec<u32> = (0..count).map(vertex).collect();
        let mut corners = Corners::new(count, 1..count - 1);
        let mut ears = Vec::new();
        while let Some(three @ [before, corner, _]) = corners.next() {
            let ends = three.map(|corner| vertices[corner]);
            let [p, q, r] = stars.points(ends);
            if turn(p, q, r).is_gt()
                && let Some(slot) = free.next()
            {
                let h = stars.put(slot, ends);
                self.join(stars, links[before], h);
                self.join(stars, links[corner], next(h));
                links[before] = Link::Cut(prev(h));
                ears.push(prev(h));
                corners.cut(three);
            }
        }
        ears
    }

    /// Makes an edge of the polygon and a half-edge twins of each other.
    fn join(&mut self, stars: &mut Stars, link: Link, h: u32) {
        match link {
            Link::Cut(g) => stars.slots.join(h, g),
            Link::Side(i) => {
                stars.slots.set_locked(h, self.sides[i].is_locked);
                match self.sides[i].beyond {
                    Beyond::HalfEdge(g) => stars.slots.join(h, g),
                    Beyond::Side(other) => self.sides[other].beyond = Beyond::HalfEdge(h),
                }
            }
        }
    }
}
