//! Why positions in the plane have no triangulation with the boundary of a mesh, whatever its triangles are. All tests are
//! exact. A boundary may overlap itself without turning a triangle over, so counting triangles cannot tell.

use crate::mesh::adjacency::Adjacency;
use crate::mesh::half_edge::{next, unflagged};
use crate::mesh::winding::Outline;
use crate::predicates::area_sign;
use crate::system::threads::Threads;
use crate::{Dimension, Error, Mesh, NONE, Session};
use glam::{DVec2, Vec2Swizzles};
use std::cmp::Ordering;

/// What keeps positions from having a triangulation. Each component of a mesh counts alone: components may overlap.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Problems {
    /// Vertices that are not inside the boundary of their component, in ascending order. If a whole ring of the boundary
    /// is where it cannot be, such as a hole outside, all its vertices.
    pub outside: Vec<u32>,
    /// Pairs of vertices at one point. If there are several at one point, the first of them with each other.
    pub coincident: Vec<[u32; 2]>,
    /// Pairs of boundary edges that cross or touch, other than in a common vertex. Each edge has the direction of its
    /// triangle.
    pub crossing: Vec<[[u32; 2]; 2]>,
}

impl Problems {
    /// Whether there are none: then a triangulation exists.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}

/// A boundary edge, in the direction of its triangle.
#[derive(Clone, Copy)]
struct Side {
    ends: [u32; 2],
    ring: usize,
}

/// A component of a mesh.
struct Component<'a> {
    mesh: &'a Mesh,
    is_clockwise: bool,
    sides: Vec<Side>,
    /// The number of its rings.
    rings: usize,
    vertices: Vec<u32>,
}

/// Finds out whether the vertices of a mesh have a triangulation with its boundary. In space there are no problems.
pub fn problems(mesh: &Mesh) -> Problems {
    let mut problems = Problems::default();
    if mesh.dimension() == Dimension::Three {
        return problems;
    }
    let triangles = mesh.triangles();
    let twins = Adjacency::of_triangles(mesh.vertex_count(), triangles, &Threads::one()).twins;
    for component in components(mesh, &twins) {
        component.find_coincident(&mut problems);
        component.find_crossing(&mut problems);
        component.find_outside(&mut problems);
    }
    problems.outside.sort_unstable();
    problems.outside.dedup();
    problems.coincident.sort_unstable();
    problems.crossing.sort_unstable();
    problems
}

impl Session {
    /// What keeps the present positions from having a triangulation. After updates, it ends the motion, as
    /// [`Session::verify`] does.
    ///
    /// # Errors
    /// [`Error::Device`]; after updates, those of [`Session::set_positions`].
    pub async fn problems(&mut self) -> Result<Problems, Error> {
        self.come_to_rest().await?;
        // Neither flips nor a repair change the boundary.
        Ok(problems(self.input().0))
    }
}

fn components<'a>(mesh: &'a Mesh, twins: &[u32]) -> Vec<Component<'a>> {
    let outline = Outline::new(mesh.triangles(), twins);
    let winding = outline.winding(mesh);
    let mut components: Vec<Component> = Vec::new();
    for (t, &component) in (0..).zip(outline.components()) {
        if component as usize == components.len() {
            let is_clockwise = winding.is_clockwise(t);
            let (sides, vertices) = (Vec::new(), Vec::new());
            components.push(Component { mesh, is_clockwise, sides, rings: 0, vertices });
        }
        let corners = &mesh.triangles()[3 * t as usize..3 * t as usize + 3];
        components[component as usize].vertices.extend_from_slice(corners);
    }
    let mut is_visited = vec![false; twins.len()];
    for first in (0..twins.len() as u32).filter(|&h| twins[h as usize] == NONE) {
        let component = &mut components[outline.components()[first as usize / 3] as usize];
        let mut h = first;
        while !std::mem::replace(&mut is_visited[h as usize], true) {
            let ends = [h, next(h)].map(|x| mesh.triangles()[x as usize]);
            component.sides.push(Side { ends, ring: component.rings });
            h = next(h);
            while twins[h as usize] != NONE {
                h = next(unflagged(twins[h as usize]));
            }
        }
        component.rings +=
            usize::from(component.sides.last().is_some_and(|side| side.ring == component.rings));
    }
    for component in &mut components {
        component.vertices.sort_unstable();
        component.vertices.dedup();
    }
    components
}

/// The indices of points in their order: by the first number, then by the second.
fn order(points: impl Iterator<Item = DVec2>) -> Vec<usize> {
    // The bits of floats as integers of the same order.
    let key = |x: f64| x.to_bits() ^ ((x.to_bits() as i64 >> 63) as u64 | 1 << 63);
    let mut keys: Vec<(u64, u64, usize)> =
        points.enumerate().map(|(i, point)| (key(point.x), key(point.y), i)).collect();
    keys.sort_unstable();
    keys.into_iter().map(|(_, _, i)| i).collect()
}

impl Component<'_> {
    fn point(&self, v: u32) -> DVec2 {
        // A negative zero is at the point of a zero.
        self.mesh.point2(v) + DVec2::ZERO
    }

    /// The side of the edge from u to v on which w lies: positive inside.
    fn turn(&self, [u, v, w]: [u32; 3]) -> Ordering {
        let [a, b, c] = [u, v, w].map(|v| self.point(v));
        let sign = area_sign(a, b, c);
        if self.is_clockwise { sign.reverse() } else { sign }
    }

    fn find_coincident(&self, problems: &mut Problems) {
        let order = order(self.vertices.iter().map(|&v| self.point(v)));
        let vertices: Vec<u32> = order.into_iter().map(|i| self.vertices[i]).collect();
        for alike in vertices.chunk_by(|&u, &v| self.point(u) == self.point(v)) {
            problems.coincident.extend(alike[1..].iter().map(|&v| [alike[0], v]));
        }
    }

    /// Compares each side with those that begin before it ends, from left to right.
    fn find_crossing(&self, problems: &mut Problems) {
        let span = |side: &Side| {
            let [p, q] = side.ends.map(|v| self.point(v).x);
            (p.min(q), p.max(q))
        };
        let order = order(self.sides.iter().map(|side| span(side).into()));
        let sides: Vec<Side> = order.into_iter().map(|i| self.sides[i]).collect();
        for (i, one) in sides.iter().enumerate() {
            let end = span(one).1;
            for other in sides[i + 1..].iter().take_while(|other| span(other).0 <= end) {
                if self.meet(one.ends, other.ends) {
                    let mut pair = [one.ends, other.ends];
                    pair.sort_unstable();
                    problems.crossing.push(pair);
                }
            }
        }
    }

    /// Whether two sides meet, other than in a common vertex.
    fn meet(&self, [a, b]: [u32; 2], [c, d]: [u32; 2]) -> bool {
        let boxes = [[a, b], [c, d]].map(|ends| ends.map(|v| self.point(v).y));
        let [[p, q], [r, s]] = boxes;
        if p.max(q) < r.min(s) || r.max(s) < p.min(q) {
            return false;
        }
        // Whether `v` is on the side from u to w, or at the point of an end.
        let is_on = |[u, w]: [u32; 2], v: u32| {
            let [p, q, r] = [u, w, v].map(|v| self.point(v));
            let is_between = |p: f64, q: f64, r: f64| p.min(q) <= r && r <= p.max(q);
            self.turn([u, w, v]).is_eq() && is_between(p.x, q.x, r.x) && is_between(p.y, q.y, r.y)
        };
        let touches = |ends: [u32; 2], v: u32| !ends.contains(&v) && is_on(ends, v);
        if [c, d].iter().any(|&v| touches([a, b], v)) || [a, b].iter().any(|&v| touches([c, d], v)) {
            return true;
        }
        let have_common = [a, b].iter().any(|v| [c, d].contains(v));
        let are_apart = |ends: [u32; 2], [v, w]: [u32; 2]| {
            let [one, other] = [v, w].map(|v| self.turn([ends[0], ends[1], v]));
            one.is_eq() || other.is_eq() || one == other
        };
        // The same two vertices again.
        have_common && (a == c && b == d || a == d && b == c)
            || !have_common && !are_apart([a, b], [c, d]) && !are_apart([c, d], [a, b])
    }

    /// Counts how often the boundary goes round each vertex, from the lowest to the highest.
    fn find_outside(&self, problems: &mut Problems) {
        let mut is_border: Vec<u32> = self.sides.iter().flat_map(|side| side.ends).collect();
        is_border.sort_unstable();
        let span = |side: &Side| {
            let [p, q] = side.ends.map(|v| self.point(v).y);
            (p.min(q), p.max(q))
        };
        let sides = order(self.sides.iter().map(|side| span(side).into())).into_iter().map(|i| self.sides[i]);
        let ring_firsts = self.ring_firsts();
        // The vertices inside, and the first vertex of each ring with the number of the ring.
        let inner = self.vertices.iter().filter(|v| is_border.binary_search(v).is_err());
        let mut asked: Vec<(u32, Option<usize>)> = inner.map(|&v| (v, None)).collect();
        asked.extend(ring_firsts.iter().enumerate().map(|(ring, &(v, _))| (v, Some(ring))));
        let (mut active, mut coming): (Vec<Side>, _) = (Vec::new(), sides.peekable());
        for i in order(asked.iter().map(|&(v, _)| self.point(v).yx())) {
            let (v, ring) = asked[i];
            let y = self.point(v).y;
            while let Some(side) = coming.next_if(|side| span(side).0 <= y) {
                active.push(side);
            }
            active.retain(|side| span(side).1 >= y);
            let others = active.iter().filter(|side| ring != Some(side.ring));
            let rounds: Option<i32> = others.map(|side| self.round(side.ends, v)).sum();
            match ring {
                None if rounds.is_none_or(|rounds| rounds < 1) => problems.outside.push(v),
                Some(ring) if rounds.is_some_and(|rounds| rounds != i32::from(ring_firsts[ring].1)) => {
                    let of_ring = self.sides.iter().filter(|side| side.ring == ring);
                    problems.outside.extend(of_ring.map(|side| side.ends[0]));
                }
                _ => {}
            }
        }
    }

    /// The leftmost vertex of each ring, and whether the ring is that of a hole: whether it turns the other way there.
    fn ring_firsts(&self) -> Vec<(u32, bool)> {
        let rings = self.sides.chunk_by(|one, other| one.ring == other.ring);
        let first = |ring: &[Side]| {
            let vertex = |i: usize| ring[i % ring.len()].ends[0];
            let i = order((0..ring.len()).map(|i| self.point(vertex(i))))[0];
            let before = vertex(i + ring.len() - 1);
            (vertex(i), self.turn([before, vertex(i), vertex(i + 1)]).is_lt())
        };
        rings.map(first).collect()
    }

    /// What a side adds to the number of rounds about a vertex; `None` if the vertex is on it.
    fn round(&self, [u, w]: [u32; 2], v: u32) -> Option<i32> {
        let [p, q, r] = [u, w, v].map(|v| self.point(v));
        let sign = self.turn([u, w, v]);
        if sign.is_eq()
            && p.x.min(q.x) <= r.x
            && r.x <= p.x.max(q.x)
            && p.y.min(q.y) <= r.y
            && r.y <= p.y.max(q.y)
        {
            return None;
        }
        let goes_up = p.y <= r.y && r.y < q.y;
        let goes_down = q.y <= r.y && r.y < p.y;
        let is_counted = if self.is_clockwise { [goes_down, goes_up] } else { [goes_up, goes_down] };
        Some(i32::from(is_counted[0] && sign.is_gt()) - i32::from(is_counted[1] && sign.is_lt()))
    }
}
