//! Leads one line after another through the triangles. The comment of the room says how, and why that ends.

use super::chains::Chains;
use super::net::Net;
use super::reach::Seen;
use super::straight::{Part, Start, Way};
use super::taut::{Gate, taut};
use crate::mesh::half_edge::{next, prev};
use crate::predicates::{Segment, line_crossing};
use crate::prepare::constraints::walk::Obstacle;
use crate::{Error, NONE};
use glam::DVec2;
use std::array;
use std::cmp::Ordering;

pub(super) struct Splitter {
    pub(super) net: Net,
    pub(super) chains: Chains,
    /// The ends of each line.
    lines: Vec<[u32; 2]>,
    /// The two lines of each new vertex.
    pub(super) crossings: Vec<[u32; 2]>,
}

/// A line on its way.
struct Front {
    line: u32,
    ends: Segment,
    /// The last vertex of its chain.
    at: u32,
    /// The edges that it has crossed since, each by the half-edge of the triangle that it has left.
    gates: Vec<u32>,
}

/// How a line goes on after a locked edge.
enum After {
    /// Across it, since the chains of that edge now pass a vertex behind it.
    Across,
    /// From the last vertex of its chain, which it does not pass exactly, into the triangle of this half-edge.
    Into(u32),
    /// From the last vertex of its chain, which is on it.
    On,
}

impl Splitter {
    pub(super) fn new(net: Net, chains: Chains, lines: Vec<[u32; 2]>) -> Self {
        Self { net, chains, lines, crossings: Vec::new() }
    }

    /// Brings a line in, from the first of its ends to the second. The inner error says what keeps it out.
    pub(super) fn bring_in(&mut self, line: u32, [from, to]: [u32; 2]) -> Result<Result<(), Obstacle>, Error> {
        if from == to {
            return Ok(Err(Obstacle::SameVertex));
        }
        let (parts, crosses) = match self.net.straight([from, to], |ends| self.chains.may_change(ends)) {
            Ok(found) => found,
            Err(obstacle) => return Ok(Err(obstacle)),
        };
        self.chains.begin(line, from)?;
        if crosses {
            let ends = [from, to].map(|v| self.net.point(v));
            self.thread(to, Front { line, ends, at: from, gates: Vec::new() })?;
            return Ok(Ok(()));
        }
        for Part { ends: [from, to], way } in parts {
            let h = match way {
                Way::Edge(h) => h,
                Way::Across(half_edges, sign) => {
                    self.net.sign = sign;
                    self.net.bring_in([from, to], half_edges).ok_or_else(overlaps)?
                }
            };
            self.go_along(h, [from, to])?;
        }
        Ok(Ok(()))
    }

    /// Leads a line that crosses locked edges to its end.
    fn thread(&mut self, to: u32, mut front: Front) -> Result<(), Error> {
        'vertices: while !self.net.is_same(front.at, to) {
            let mut h = match self.net.start([front.at, to]).map_err(|_| overlaps())? {
                Start::Edge(h, ends) => {
                    self.go_along(h, ends)?;
                    front.at = ends[1];
                    continue;
                }
                Start::Triangle(h, start, sign) => {
                    self.chains.jump(start)?;
                    front.at = start;
                    self.net.sign = sign;
                    h
                }
            };
            loop {
                // An edge at the last vertex is crossed there.
                let is_there = front.gates.is_empty() && self.net.ends(h).contains(&front.at);
                let after = if !is_there && self.net.is_locked(h) {
                    self.cross(h, &mut front)?
                } else {
                    if !is_there {
                        front.gates.push(h);
                    }
                    After::Across
                };
                let g = match after {
                    After::Across => self.net.twin(h),
                    After::Into(g) => g,
                    After::On => continue 'vertices,
                };
                if g == NONE {
                    return Err(overlaps());
                }
                let far = self.net.apex(g);
                h = match self.side(&front, self.net.point(far)) {
                    Ordering::Greater => next(g),
                    Ordering::Less => prev(g),
                    Ordering::Equal => {
                        self.go_to(far, g, &mut front)?;
                        continue 'vertices;
                    }
                };
            }
        }
        Ok(())
    }

    /// The side of the line on which a point is: greater on the left.
    fn side(&self, front: &Front, point: DVec2) -> Ordering {
        self.net.turn(front.ends[0], front.ends[1], point)
    }

    /// Crosses the locked edge of `h`, from its triangle.
    fn cross(&mut self, h: u32, front: &mut Front) -> Result<After, Error> {
        let (g, [a, b]) = (self.net.twin(h), self.net.ends(h));
        let [p, q] = [a, b].map(|v| self.net.point(v));
        let other = self.chains.first_line([a, b]).unwrap_or(front.line);
        let lines = [other, front.line];
        for point in self.candidates(front, [p, q], other) {
            if point == p || point == q {
                self.go_to(if point == p { a } else { b }, h, front)?;
                return Ok(After::Into(g));
            }
            match self.net.turn(p, q, point) {
                Ordering::Equal if is_between(point, [p, q]) => {
                    let (vertex, [_, other_half]) = self.insert_on(h, point, lines)?;
                    self.go_to(vertex, h, front)?;
                    // Which half of the edge the line crosses, seen from behind the edge.
                    return Ok(match self.side(front, point) {
                        Ordering::Less => After::Into(g),
                        Ordering::Equal => After::On,
                        Ordering::Greater => After::Into(other_half),
                    });
                }
                Ordering::Equal => {}
                Ordering::Greater => {
                    let apex = self.net.apex(h);
                    let r = self.net.point(apex);
                    let vertex = if point == r {
                        apex
                    } else if self.net.turn(q, r, point).is_gt() && self.net.turn(r, p, point).is_gt() {
                        self.insert_inside(h, point, lines)?
                    } else {
                        continue;
                    };
                    self.lead(h, vertex)?;
                    self.go_to(vertex, h, front)?;
                    front.gates.push(h);
                    return Ok(After::Into(g));
                }
                Ordering::Less => match self.reach(g, point, lines, front)? {
                    None => {}
                    Some(vertex) if self.net.point(vertex) != point => {
                        front.gates.push(h);
                        return Ok(After::Across);
                    }
                    Some(vertex) => {
                        front.gates.push(h);
                        let side = self.side(front, point);
                        let behind = self.net.twin(if side.is_gt() { next(g) } else { prev(g) });
                        self.go_to(vertex, g, front)?;
                        return Ok(if side.is_eq() { After::On } else { After::Into(behind) });
                    }
                },
            }
        }
        let [first, second] = [p, q].map(|v| (front.ends[1] - front.ends[0]).perp_dot(v - front.ends[0]).abs());
        self.go_to(if first < second { a } else { b }, h, front)?;
        Ok(After::Into(g))
    }

    /// Points for the crossing of the line with an edge of another line: first that of the two lines, as they were given,
    /// or if it is not next to it that of the line and the edge; then its neighbours.
    fn candidates(&self, front: &Front, edge: Segment, other: u32) -> [DVec2; 9] {
        let is_double = self.net.is_double();
        let near = line_crossing(front.ends, edge, is_double);
        let size = near.abs().max_element();
        let step = if is_double {
            size.next_up() - size
        } else {
            let size = size as f32;
            (size.next_up() - size).into()
        };
        let whole = self.lines[other as usize].map(|v| self.net.point(v));
        let crossing = line_crossing(front.ends, whole, is_double);
        let is_near = (crossing - near).abs().max_element() <= 2.0 * step;
        let centre = if is_near { crossing } else { near };
        const STEPS: [[f64; 2]; 9] = [
            [0.0, 0.0],
            [1.0, 0.0],
            [-1.0, 0.0],
            [0.0, 1.0],
            [0.0, -1.0],
            [1.0, 1.0],
            [-1.0, -1.0],
            [1.0, -1.0],
            [-1.0, 1.0],
        ];
        STEPS.map(|steps| {
            let moved = centre + step * DVec2::from_array(steps);
            if is_double { moved } else { moved.as_vec2().as_dvec2() }
        })
    }

    /// Leads the chains of the edge of `g` through a vertex on its left: one at the point, or one that is before the point.
    /// `None` if something that has to stay is before the point.
    fn reach(
        &mut self,
        g: u32,
        point: DVec2,
        lines: [u32; 2],
        front: &Front,
    ) -> Result<Option<u32>, Error> {
        if !point.is_finite() {
            return Ok(None);
        }
        let mut e = g;
        loop {
            let seen = self.net.look(e, point, &self.chains);
            let target = match seen {
                Seen::Nothing => return Ok(None),
                Seen::Behind(behind) => {
                    e = behind;
                    continue;
                }
                Seen::Before(vertex) | Seen::Vertex(vertex) => self.net.point(vertex),
                Seen::Inside(_) | Seen::On(_) => point,
            };
            if e != g && self.would_cross(front, e, target) {
                return Ok(None);
            }
            let vertex = match seen {
                Seen::Inside(h) => self.insert_inside(h, point, lines)?,
                Seen::On(h) => self.insert_on(h, point, lines)?.0,
                Seen::Before(vertex) | Seen::Vertex(vertex) => vertex,
                Seen::Nothing | Seen::Behind(_) => return Ok(None),
            };
            self.lead(e, vertex)?;
            if e == g {
                return Ok(Some(vertex));
            }
            e = g;
        }
    }

    /// Whether the chains of an edge that the line does not cross would cross it if they passed a point.
    fn would_cross(&self, front: &Front, e: u32, point: DVec2) -> bool {
        let [p, q] = self.net.ends(e).map(|v| self.side(front, self.net.point(v)));
        let side = self.side(front, point);
        let is_crossed = p.is_ne() && p == q.reverse();
        !is_crossed && side.is_ne() && (p == side.reverse() || q == side.reverse())
    }

    /// Leads the chains of the edge of `e` through a vertex on its left instead: nothing is in the triangle of both.
    fn lead(&mut self, e: u32, vertex: u32) -> Result<(), Error> {
        let ends = self.net.ends(e);
        if self.net.apex(e) != vertex {
            for end in ends {
                let (mut parts, crosses) =
                    self.net.straight([vertex, end], |_| true).map_err(|_| overlaps())?;
                match parts.pop() {
                    Some(Part { ends, way: Way::Across(half_edges, _) }) if parts.is_empty() && !crosses => {
                        self.net.bring_in(ends, half_edges).ok_or_else(overlaps)?;
                    }
                    Some(Part { way: Way::Edge(_), .. }) if parts.is_empty() => {}
                    _ => return Err(overlaps()),
                }
            }
            if self.net.apex(e) != vertex {
                return Err(overlaps());
            }
        }
        self.net.set_locked(e, false);
        self.net.set_locked(next(e), true);
        self.net.set_locked(prev(e), true);
        self.chains.split(ends, vertex)
    }

    fn insert_inside(&mut self, h: u32, point: DVec2, lines: [u32; 2]) -> Result<u32, Error> {
        self.net.reserve_vertex()?;
        self.crossings.push(lines);
        Ok(self.net.insert_inside(h, point))
    }

    /// Adds a vertex on an edge, and to the chains that pass the edge.
    fn insert_on(&mut self, h: u32, point: DVec2, lines: [u32; 2]) -> Result<(u32, [u32; 2]), Error> {
        self.net.reserve_vertex()?;
        self.crossings.push(lines);
        let (ends, is_locked) = (self.net.ends(h), self.net.is_locked(h));
        let (vertex, halves) = self.net.insert_on(h, point);
        if is_locked {
            self.chains.split(ends, vertex)?;
        }
        Ok((vertex, halves))
    }

    /// Leads the chain of the line to a vertex: by the shortest path between the ends of the edges that the line has
    /// crossed. `h` is a half-edge of a triangle of the vertex, also of the last one of the chain if no edge was crossed.
    fn go_to(&mut self, vertex: u32, h: u32, front: &mut Front) -> Result<(), Error> {
        let gates = std::mem::take(&mut front.gates);
        let at = std::mem::replace(&mut front.at, vertex);
        if at == vertex {
            return Ok(());
        }
        if gates.is_empty() {
            let star = || self.net.star(vertex).find_map(|corner| self.net.side_of(corner, [at, vertex]));
            let side = self.net.side_of(h, [at, vertex]).or_else(star).ok_or_else(overlaps)?;
            return self.go_along(side, [at, vertex]);
        }
        let [from, to] = [at, vertex].map(|v| self.net.point(v));
        let is_seen = |&gate: &u32| {
            let [right, left] = self.net.ends(gate).map(|v| self.net.turn(from, to, self.net.point(v)));
            right.is_lt() && left.is_gt()
        };
        if gates.iter().all(is_seen) {
            let side = self.net.bring_in([at, vertex], gates).ok_or_else(overlaps)?;
            return self.go_along(side, [at, vertex]);
        }
        let gates: Vec<Gate> = gates.into_iter().map(|gate| self.net.ends(gate)).collect();
        let mut from = at;
        for to in taut(&self.net, at, &gates, vertex) {
            if from == to {
                continue;
            }
            let (parts, crosses) = self.net.straight([from, to], |_| true).map_err(|_| overlaps())?;
            if crosses {
                return Err(overlaps());
            }
            for Part { ends, way } in parts {
                let side = match way {
                    Way::Edge(side) => side,
                    Way::Across(half_edges, _) => {
                        self.net.bring_in(ends, half_edges).ok_or_else(overlaps)?
                    }
                };
                self.go_along(side, ends)?;
            }
            from = to;
        }
        Ok(())
    }

    /// Leads the chain of the line along an edge.
    fn go_along(&mut self, h: u32, [from, to]: [u32; 2]) -> Result<(), Error> {
        self.net.set_locked(h, true);
        self.chains.jump(from)?;
        self.chains.extend(to)
    }
}

/// Whether a point on the line through two points is between them.
fn is_between(point: DVec2, [p, q]: Segment) -> bool {
    array::from_fn::<_, 2, _>(|axis| (p[axis].min(q[axis]), point[axis], p[axis].max(q[axis])))
        .into_iter()
        .all(|(low, x, high)| low <= x && x <= high)
}

fn overlaps() -> Error {
    let message = "the mesh overlaps itself where constraints cross; --untangle may mend it".to_owned();
    Error::Option { option: "constraints", message }
}
