//! Leads one line after another through the triangles. The comment of the room says how, and why that ends.

use super::chains::Chains;
use super::net::Net;
use super::straight::{Part, Start, Way};
use super::taut::{Gate, taut};
use crate::mesh::half_edge::{next, prev};
use crate::predicates::Segment;
use crate::prepare::constraints::walk::Obstacle;
use crate::{Error, NONE};
use glam::DVec2;
use std::cmp::Ordering;

pub(super) struct Splitter {
    pub(super) net: Net,
    pub(super) chains: Chains,
    /// The ends of each line.
    pub(super) lines: Vec<[u32; 2]>,
    /// The two lines of each new vertex.
    pub(super) crossings: Vec<[u32; 2]>,
    /// The last line that has passed each vertex, or [`NONE`]; shorter if the last vertices have none.
    passed: Vec<u32>,
}

/// A line on its way.
pub(super) struct Front {
    pub(super) line: u32,
    pub(super) ends: Segment,
    /// The last vertex of its chain.
    pub(super) at: u32,
    /// The edges that it has crossed since, each by the half-edge of the triangle that it has left.
    pub(super) gates: Vec<u32>,
}

/// How a line goes on after a locked edge.
pub(super) enum After {
    /// Across it, since the chains of that edge now pass a vertex behind it.
    Across,
    /// From the last vertex of its chain, which it does not pass exactly, into the triangle of this half-edge.
    Into(u32),
    /// From the last vertex of its chain, which is on it.
    On,
}

impl Splitter {
    pub(super) fn new(net: Net, chains: Chains, lines: Vec<[u32; 2]>) -> Self {
        Self { net, chains, lines, crossings: Vec::new(), passed: Vec::new() }
    }

    /// Brings a line in, from the first of its ends to the second. The inner error says what keeps it out.
    pub(super) fn bring_in(
        &mut self,
        line: u32,
        [from, to]: [u32; 2],
    ) -> Result<Result<(), Obstacle>, Error> {
        if from == to {
            return Ok(Err(Obstacle::SameVertex));
        }
        let (parts, crosses) = match self.net.straight([from, to], |ends| self.chains.may_change(ends)) {
            Ok(found) => found,
            Err(obstacle) => return Ok(Err(obstacle)),
        };
        self.chains.begin(line, from)?;
        if crosses {
            // Then the triangles at an edge that the line crosses have the vertices near to the crossing.
            for Part { way, .. } in &parts {
                if let Way::Across(half_edges, sign) = way {
                    self.net.sign = *sign;
                    self.net.make_delaunay(half_edges.iter().map(|h| h / 3));
                }
            }
            let ends = [from, to].map(|v| self.net.point(v));
            self.thread(to, Front { line, ends, at: from, gates: Vec::new() })?;
            return Ok(Ok(()));
        }
        for Part { ends: [from, to], way } in parts {
            let h = match way {
                Way::Edge(h) => h,
                Way::Across(half_edges, sign) => {
                    self.net.sign = sign;
                    self.net.bring_in(&half_edges).ok_or_else(overlaps)?
                }
            };
            self.go_along(h, [from, to])?;
        }
        Ok(Ok(()))
    }

    /// Leads a line that crosses locked edges to its end.
    fn thread(&mut self, to: u32, mut front: Front) -> Result<(), Error> {
        self.pass(front.at, &mut front);
        'vertices: while !self.net.is_same(front.at, to) {
            let mut h = match self.net.start([front.at, to]).map_err(|_| overlaps())? {
                Start::Edge(h, ends) => {
                    self.go_along(h, ends)?;
                    self.pass(ends[1], &mut front);
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

    /// The line has come to a vertex.
    fn pass(&mut self, vertex: u32, front: &mut Front) {
        front.at = vertex;
        let index = self.net.original(vertex) as usize;
        self.passed.resize(self.passed.len().max(index + 1), NONE);
        self.passed[index] = front.line;
    }

    /// Whether the present line has passed a vertex.
    pub(super) fn is_passed(&self, vertex: u32, line: u32) -> bool {
        self.passed.get(self.net.original(vertex) as usize) == Some(&line)
    }

    /// The side of the line on which a point is: greater on the left.
    pub(super) fn side(&self, front: &Front, point: DVec2) -> Ordering {
        self.net.turn(front.ends[0], front.ends[1], point)
    }

    /// Leads the chains of the edge of `h` through a vertex on its right instead: nothing is in the triangle of both.
    pub(super) fn lead(&mut self, h: u32, vertex: u32) -> Result<(), Error> {
        let ends = self.net.ends(h);
        if self.net.apex(self.net.twin(h)) != vertex {
            for end in ends {
                let (mut parts, crosses) =
                    self.net.straight([vertex, end], |_| true).map_err(|_| overlaps())?;
                match parts.pop() {
                    Some(Part { way: Way::Edge(_), .. }) if parts.is_empty() => {}
                    Some(Part { way: Way::Across(half_edges, _), .. }) if parts.is_empty() && !crosses => {
                        self.net.bring_in(&half_edges).ok_or_else(overlaps)?;
                    }
                    _ => return Err(overlaps()),
                }
            }
        }
        // Flips have moved the half-edge.
        let e = self.net.twin(h);
        if self.net.apex(e) != vertex {
            return Err(overlaps());
        }
        self.net.set_locked(e, false);
        self.net.set_locked(next(e), true);
        self.net.set_locked(prev(e), true);
        self.chains.split(ends, vertex)
    }

    pub(super) fn insert_inside(&mut self, h: u32, point: DVec2, lines: [u32; 2]) -> Result<u32, Error> {
        self.net.reserve_vertex()?;
        self.crossings.push(lines);
        Ok(self.net.insert_inside(h, point))
    }

    /// Adds a vertex on an edge, and to the chains that pass the edge.
    pub(super) fn insert_on(
        &mut self,
        h: u32,
        point: DVec2,
        lines: [u32; 2],
    ) -> Result<(u32, [u32; 2]), Error> {
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
    pub(super) fn go_to(&mut self, vertex: u32, h: u32, front: &mut Front) -> Result<(), Error> {
        let gates = std::mem::take(&mut front.gates);
        let at = front.at;
        self.pass(vertex, front);
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
            let [right, left] = self.net.points(self.net.ends(gate));
            self.net.turn(from, to, right).is_lt() && self.net.turn(from, to, left).is_gt()
        };
        if gates.iter().all(is_seen) {
            let side = self.net.bring_in(&gates).ok_or_else(overlaps)?;
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
                    Way::Across(half_edges, _) => self.net.bring_in(&half_edges).ok_or_else(overlaps)?,
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

pub(super) fn overlaps() -> Error {
    let message = "the mesh overlaps itself where constraints cross; --untangle may mend it".to_owned();
    Error::Option { option: "constraints", message }
}
