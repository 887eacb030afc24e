//! Where a line and the chains of a locked edge meet.

use super::reach::Seen;
use super::splitter::{After, Front, Splitter, overlaps};
use crate::Error;
use crate::mesh::half_edge::{next, prev};
use crate::predicates::{Segment, distance_from_segment, line_crossing};
use glam::DVec2;
use std::array;
use std::cmp::Ordering;

/// Where a point is, as seen from a half-edge of the edge that a line meets.
enum Place {
    /// At this end of the edge.
    End(u32),
    /// On the edge.
    Edge,
    /// In one of the triangles before the edge that the line has crossed since its last vertex: its number, and the
    /// vertex that is there. Nothing is in the triangle of the edge and the point.
    Before(usize, Option<u32>),
    /// Behind the edge.
    Behind,
    /// Farther away.
    Elsewhere,
}

impl Splitter {
    /// Crosses the locked edge of `h`, from its triangle.
    pub(super) fn cross(&mut self, h: u32, front: &mut Front) -> Result<After, Error> {
        let other = self.chains.first_line(self.net.ends(h)).unwrap_or(front.line);
        let (points, is_near, step) = self.candidates(front, h, other);
        if is_near
            && self.is_direct(h, points[0], front)
            && let Some(after) = self.meet(h, points[0], front, other)?
        {
            return Ok(after);
        }
        let vertices =
            self.net.ends(h).into_iter().chain([h, self.net.twin(h)].map(|side| self.net.apex(side)));
        let points = points.into_iter().chain(vertices.map(|v| self.net.point(v)));
        let mut ranked: Vec<_> =
            points.map(|point| (self.rank(h, point, front, other, step), point)).collect();
        ranked.sort_by(|(one, _), (two, _)| {
            one.0.total_cmp(&two.0).then(one.1.cmp(&two.1)).then(one.2.total_cmp(&two.2))
        });
        for (_, point) in ranked {
            if let Some(after) = self.meet(h, point, front, other)? {
                return Ok(after);
            }
        }
        // The ends of the edge are among these points.
        Err(overlaps())
    }

    /// What decides between points for the crossing of the line and the locked edge of `h`; the least is best. A chain turns
    /// back rather than deviate by more than two units in the last place, each a `step`.
    fn rank(&self, h: u32, point: DVec2, front: &Front, other: u32, step: f64) -> (f64, bool, f64) {
        let (deviation, vertex) = self.deviation(h, point, front, other);
        let is_passed = vertex.is_some_and(|vertex| {
            self.is_passed(vertex, front.line) && (vertex != front.at || !front.gates.is_empty())
        });
        let is_between = |[from, to]: Segment| {
            let along = (to - from).normalize_or_zero();
            (point - from).dot(along) > -4.0 * step && (to - point).dot(along) > -4.0 * step
        };
        let ways = [[self.net.point(front.at), front.ends[1]], self.net.ends(h).map(|v| self.net.point(v))];
        let turns_back = is_passed || !ways.into_iter().all(is_between);
        (deviation.max(2.0 * step), turns_back, deviation)
    }

    /// Whether the line and the locked edge of `h` can meet at a point, and no other vertex or locked edge is in the way.
    fn is_direct(&self, h: u32, point: DVec2, front: &Front) -> bool {
        match self.place(h, point, front) {
            Place::End(_) | Place::Edge | Place::Before(..) => true,
            Place::Behind => {
                let seen = self.net.look(self.net.twin(h), point, &self.chains);
                matches!(seen, Seen::Vertex(_) | Seen::Inside(_) | Seen::On(_))
            }
            Place::Elsewhere => false,
        }
    }

    /// How far the lines at the locked edge of `h` would be from where they were given, if they met at this point, or if
    /// the chains of that edge were led on the way to it: infinite if they cannot. The vertex there, if there is one.
    fn deviation(&self, h: u32, point: DVec2, front: &Front, other: u32) -> (f64, Option<u32>) {
        let far = |line: u32, point| {
            let ends = self.lines[line as usize].map(|v| self.net.point(v));
            distance_from_segment(ends, point).unwrap_or(f64::MAX)
        };
        let own = far(front.line, point);
        match self.place(h, point, front) {
            Place::End(vertex) => (own, Some(vertex)),
            Place::Edge => (own.max(far(other, point)), None),
            Place::Before(_, vertex) => (own.max(far(other, point)), vertex),
            Place::Elsewhere => (f64::INFINITY, None),
            Place::Behind => {
                let (mut edge, mut line, mut largest) = (h, other, own);
                loop {
                    let e = self.net.twin(edge);
                    let seen = self.net.look(e, point, &self.chains);
                    let target = if let Seen::Before(vertex) = seen { self.net.point(vertex) } else { point };
                    if edge != h && self.would_cross(front, e, target) {
                        return (f64::INFINITY, None);
                    }
                    match seen {
                        Seen::Nothing => return (f64::INFINITY, None),
                        Seen::Behind(behind) => {
                            largest = largest.max(far(line, point));
                            edge = behind;
                            line = self.chains.first_line(self.net.ends(edge)).unwrap_or(other);
                        }
                        Seen::Before(_) if edge == h => return (far(line, target), None),
                        Seen::Vertex(side) => {
                            return (largest.max(far(line, target)), Some(self.net.apex(side)));
                        }
                        _ => return (largest.max(far(line, target)), None),
                    }
                }
            }
        }
    }

    /// Where a point is, as seen from the locked edge of `h`.
    fn place(&self, h: u32, point: DVec2, front: &Front) -> Place {
        let ends = self.net.ends(h);
        if let Some(end) = ends.into_iter().find(|&end| self.net.point(end) == point) {
            return Place::End(end);
        }
        let [p, q] = ends.map(|v| self.net.point(v));
        match self.net.turn(p, q, point) {
            Ordering::Equal if is_between(point, [p, q]) => Place::Edge,
            Ordering::Greater => {
                let (side, vertex) = match self.net.look(h, point, &self.chains) {
                    Seen::Inside(side) => (side, None),
                    Seen::Vertex(side) => (side, Some(self.net.apex(side))),
                    _ => return Place::Elsewhere,
                };
                let mut row = front.gates.iter().chain([&h]);
                row.position(|&gate| gate == side).map_or(Place::Elsewhere, |i| Place::Before(i, vertex))
            }
            Ordering::Less if point.is_finite() => Place::Behind,
            _ => Place::Elsewhere,
        }
    }

    /// Makes the line and the chains of the locked edge of `h` meet at a point, or leads these chains through a vertex on
    /// the way to it. `None` if something that has to stay is in the way.
    fn meet(&mut self, h: u32, point: DVec2, front: &mut Front, other: u32) -> Result<Option<After>, Error> {
        let (g, lines) = (self.net.twin(h), [other, front.line]);
        let place = self.place(h, point, front);
        // A way back to the last vertex would leave out the vertices that it goes around.
        if self.net.point(front.at) == point && !front.gates.is_empty() && !matches!(place, Place::Before(..))
        {
            return Ok(None);
        }
        let after = match place {
            Place::End(vertex) => {
                self.go_to(vertex, h, front)?;
                After::Into(g)
            }
            Place::Edge => {
                let (vertex, [_, other_half]) = self.insert_on(h, point, lines)?;
                self.go_to(vertex, h, front)?;
                // Which half of the edge the line crosses, seen from behind the edge.
                match self.side(front, point) {
                    Ordering::Less => After::Into(g),
                    Ordering::Equal => After::On,
                    Ordering::Greater => After::Into(other_half),
                }
            }
            Place::Before(i, vertex) => {
                let side = front.gates.get(i).copied().unwrap_or(h);
                front.gates.truncate(i);
                let vertex = match vertex {
                    Some(vertex) => vertex,
                    None => self.insert_inside(side, point, lines)?,
                };
                self.lead(g, vertex)?;
                self.go_to(vertex, self.net.twin(g), front)?;
                front.gates.push(self.net.twin(g));
                After::Into(g)
            }
            Place::Behind => match self.reach(h, point, lines, front)? {
                None => return Ok(None),
                Some(vertex) if self.net.point(vertex) != point => {
                    front.gates.push(h);
                    After::Across
                }
                Some(vertex) => {
                    front.gates.push(h);
                    let (g, side) = (self.net.twin(h), self.side(front, point));
                    let behind = self.net.twin(if side.is_gt() { next(g) } else { prev(g) });
                    self.go_to(vertex, g, front)?;
                    if side.is_eq() { After::On } else { After::Into(behind) }
                }
            },
            Place::Elsewhere => return Ok(None),
        };
        Ok(Some(after))
    }

    /// Points for the crossing of the line with the edge of `h`, which is one of another line: a point and its neighbours.
    /// The point is the crossing of the two lines, as they were given; true, if so. But if that is elsewhere, because the
    /// lines are nearly parallel, it is the crossing of the line with the edge.
    fn candidates(&self, front: &Front, h: u32, other: u32) -> ([DVec2; 9], bool, f64) {
        let is_double = self.net.is_double();
        let edge = self.net.ends(h).map(|v| self.net.point(v));
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
        let points = STEPS.map(|steps| {
            let moved = centre + step * DVec2::from_array(steps);
            if is_double { moved } else { moved.as_vec2().as_dvec2() }
        });
        (points, is_near, step)
    }

    /// Leads the chains of the edge of `h` through a vertex on its right: one at the point, or one that is before it.
    /// `None` if something that has to stay is before the point.
    fn reach(&mut self, h: u32, point: DVec2, lines: [u32; 2], front: &Front) -> Result<Option<u32>, Error> {
        if !point.is_finite() {
            return Ok(None);
        }
        let mut edge = h;
        loop {
            let e = self.net.twin(edge);
            let seen = self.net.look(e, point, &self.chains);
            let target = match seen {
                Seen::Nothing => return Ok(None),
                Seen::Behind(behind) => {
                    edge = behind;
                    continue;
                }
                Seen::Before(vertex) => self.net.point(vertex),
                Seen::Vertex(_) | Seen::Inside(_) | Seen::On(_) => point,
            };
            if edge != h && self.would_cross(front, e, target) {
                return Ok(None);
            }
            let vertex = match seen {
                Seen::Inside(h) => self.insert_inside(h, point, lines)?,
                Seen::On(h) => self.insert_on(h, point, lines)?.0,
                Seen::Before(vertex) => vertex,
                Seen::Vertex(side) => self.net.apex(side),
                Seen::Nothing | Seen::Behind(_) => return Ok(None),
            };
            self.lead(edge, vertex)?;
            if edge == h {
                return Ok(Some(vertex));
            }
            edge = h;
        }
    }

    /// Whether the chains of an edge that the line does not cross would cross it if they passed a point.
    fn would_cross(&self, front: &Front, e: u32, point: DVec2) -> bool {
        let [p, q] = self.net.ends(e).map(|v| self.side(front, self.net.point(v)));
        let side = self.side(front, point);
        let is_crossed = p.is_ne() && p == q.reverse();
        !is_crossed && side.is_ne() && (p == side.reverse() || q == side.reverse())
    }
}

/// A point and its neighbours, in units in the last place.
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

/// Whether a point on the line through two points is between them.
fn is_between(point: DVec2, [p, q]: Segment) -> bool {
    array::from_fn::<_, 2, _>(|axis| (p[axis].min(q[axis]), point[axis], p[axis].max(q[axis])))
        .into_iter()
        .all(|(low, x, high)| low <= x && x <= high)
}
