//! Why positions in the plane have no triangulation with the boundary of a mesh, whatever its triangles are. All tests are
//! exact. A boundary may overlap itself without turning a triangle over, so counting triangles cannot tell.

use super::components::{Component, Side, components};
use crate::mesh::adjacency::Adjacency;
use crate::predicates::total_area_sign;
use crate::system::threads::Threads;
use crate::{Dimension, Error, Mesh, Session};
use glam::{DVec2, dvec2};
use rstar::{AABB, RTreeObject};
use std::cmp::Reverse;

/// What keeps positions from having a triangulation. Each component of a mesh counts alone: components may overlap.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Problems {
    /// Vertices that are not inside the boundary of their component, in ascending order. If a whole ring of the boundary
    /// is where it cannot be, such as a hole outside, all its vertices; if the component has a handle, so that no
    /// positions have a triangulation, all of its vertices.
    pub outside: Vec<u32>,
    /// Pairs of vertices at one point, the vertex with the smaller number first. A vertex is paired with itself if
    /// triangles go all round it, and others of its component touch it there.
    pub coincident: Vec<[u32; 2]>,
    /// Pairs of boundary edges that cross or touch, other than in a common vertex, or that are edges of two corners at a
    /// common vertex that overlap. Each edge has the direction of its triangle.
    pub crossing: Vec<[[u32; 2]; 2]>,
}

impl Problems {
    /// Whether there are none: then each component has a triangulation. If components overlap, two of them may still need
    /// the same edge, which can have only two triangles.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}

/// Sides are compared along an axis if each of them has at most so many others beside it there, on average.
const FEW: usize = 16;

/// Finds out whether the vertices of a mesh have a triangulation with its boundary. In space there are no problems.
pub fn problems(mesh: &Mesh) -> Problems {
    let mut problems = Problems::default();
    if mesh.dimension() == Dimension::Three {
        return problems;
    }
    let triangles = mesh.triangles();
    let twins = Adjacency::of_triangles(mesh.vertex_count(), triangles, &Threads::one()).twins;
    for component in components(mesh, &twins) {
        component.find(&mut problems);
    }
    problems.outside.sort_unstable();
    problems.outside.dedup();
    problems.coincident.sort_unstable();
    problems.coincident.dedup();
    problems.crossing.sort_unstable();
    problems.crossing.dedup();
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
    fn find(&self, problems: &mut Problems) {
        let mut own = Problems::default();
        let mut is_border: Vec<u32> = self.sides.iter().map(|side| side.ends[0]).collect();
        is_border.sort_unstable();
        self.find_coincident(&is_border, &mut own);
        self.find_crossing(&mut own);
        self.find_overlaps(&mut own);
        self.find_outside(&is_border, &mut own);
        problems.outside.append(&mut own.outside);
        problems.coincident.append(&mut own.coincident);
        problems.crossing.append(&mut own.crossing);
    }

    fn find_coincident(&self, is_border: &[u32], problems: &mut Problems) {
        let order = order(self.vertices.iter().map(|&v| self.point(v)));
        let vertices: Vec<u32> = order.into_iter().map(|i| self.vertices[i]).collect();
        for alike in vertices.chunk_by(|&u, &v| self.point(u) == self.point(v)) {
            problems.coincident.extend(alike[1..].iter().map(|&v| [alike[0], v]));
        }
        for fans in self.closed.chunk_by(|u, v| u == v) {
            if fans.len() > 1 || is_border.binary_search(&fans[0]).is_ok() {
                problems.coincident.push([fans[0]; 2]);
            }
        }
    }

    /// Compares each side with those that begin before it ends, along an axis where these are few; else by position.
    fn find_crossing(&self, problems: &mut Problems) {
        let mut compare = |one: usize, other: usize| {
            let [first, second] = [one, other].map(|side| self.sides[side].ends);
            if self.meet(first, second) {
                problems.crossing.push([first.min(second), first.max(second)]);
            }
        };
        // Rounding keeps the order of sums, so sides that meet overlap along each axis.
        let axes: [fn(DVec2) -> f64; 4] = [|p| p.x, |p| p.y, |p| p.x + p.y, |p| p.x - p.y];
        for along in axes {
            let span = |side: &Side| {
                let [p, q] = side.ends.map(|v| along(self.point(v)));
                dvec2(p.min(q), p.max(q))
            };
            let order = order(self.sides.iter().map(span));
            let spans: Vec<DVec2> = order.iter().map(|&i| span(&self.sides[i])).collect();
            let ends: Vec<usize> =
                spans.iter().map(|one| spans.partition_point(|other| other.x <= one.y)).collect();
            if (0..).zip(&ends).map(|(i, end)| end - i).sum::<usize>() > FEW * ends.len() {
                continue;
            }
            for (i, &end) in ends.iter().enumerate() {
                (i + 1..end).for_each(|k| compare(order[i], order[k]));
            }
            return;
        }
        for one in self.tree() {
            let others = self.tree().locate_in_envelope_intersecting(one.envelope());
            others.filter(|other| one.side < other.side).for_each(|other| compare(one.side, other.side));
        }
    }

    /// Whether two sides meet, other than in a common vertex.
    fn meet(&self, [a, b]: [u32; 2], [c, d]: [u32; 2]) -> bool {
        let [[p, q], [r, s]] = [[a, b], [c, d]].map(|ends| ends.map(|v| self.point(v)));
        if p.max(q).cmplt(r.min(s)).any() || r.max(s).cmplt(p.min(q)).any() {
            return false;
        }
        // Whether `v` is on the side from u to w, or at the point of an end.
        let is_on = |[u, w]: [u32; 2], v: u32| self.turn([u, w, v]).is_eq() && self.is_beside([u, w], v);
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

    /// Whether the box of a side has a vertex.
    fn is_beside(&self, ends: [u32; 2], v: u32) -> bool {
        let [p, q, r] = [ends[0], ends[1], v].map(|v| self.point(v));
        p.min(q).cmple(r).all() && r.cmple(p.max(q)).all()
    }

    /// Looks for corners of the boundary at a common vertex that overlap: around it, the first side of a corner is not
    /// followed by the second.
    fn find_overlaps(&self, problems: &mut Problems) {
        let mut corners: Vec<Side> = self.sides.clone();
        corners.sort_unstable_by_key(|side| (side.ends, side.before));
        for corners in corners.chunk_by(|one, other| one.ends[0] == other.ends[0]) {
            let v = corners[0].ends[0];
            let far = |side: &Side| [side.ends[1], side.before];
            // Vertices at the same point are another problem.
            if corners.len() == 1 || corners.iter().flat_map(far).any(|w| self.point(w) == self.point(v)) {
                continue;
            }
            let mut rays: Vec<(u32, usize, bool)> = (0..)
                .zip(corners)
                .flat_map(|(i, side)| [(side.ends[1], i, true), (side.before, i, false)])
                .collect();
            let is_down = |w: u32| {
                let [from, to] = [v, w].map(|v| self.point(v));
                to.y < from.y || to.y == from.y && to.x < from.x
            };
            rays.sort_by(|&(u, _, is_out), &(w, _, is_other_out)| {
                is_down(u)
                    .cmp(&is_down(w))
                    .then_with(|| self.turn([v, w, u]))
                    .then((u, is_out).cmp(&(w, is_other_out)))
            });
            for (i, &(out, corner, _)) in rays.iter().enumerate().filter(|(_, ray)| ray.2) {
                let (far, other, is_out) = rays[(i + 1) % rays.len()];
                if other != corner {
                    let mut pair = [[v, out], if is_out { [v, far] } else { [far, v] }];
                    pair.sort_unstable();
                    problems.crossing.push(pair);
                }
            }
        }
    }

    /// Counts how often the boundary goes round vertices.
    fn find_outside(&self, is_border: &[u32], problems: &mut Problems) {
        let is_inner = |v: &u32| is_border.binary_search(v).is_err();
        let once = |v: &u32| is_inner(v) && self.closed.binary_search(v).is_err();
        // By Euler's formula: a component without a handle is a part of the plane.
        let vertices =
            self.sides.len() + self.closed.len() + self.vertices.iter().filter(|v| once(v)).count();
        if 2 * (vertices + self.rings) != self.triangles.len() + self.sides.len() + 4 {
            problems.outside.extend_from_slice(&self.vertices);
            return;
        }
        for (v, group, is_hole) in self.group_firsts() {
            let rounds = self.rounds(v, Some(group));
            if rounds.is_some_and(|rounds| rounds != i32::from(is_hole)) {
                let of_group = self.sides.iter().filter(|side| side.group == group);
                problems.outside.extend(of_group.map(|side| side.ends[0]));
            }
        }
        self.find_parts(problems);
        // Positive triangles in a boundary without problems cover each point inside once.
        let corners = |t: u32| [3 * t, 3 * t + 1, 3 * t + 2].map(|h| self.mesh.triangles()[h as usize]);
        if problems.is_empty() && self.triangles.iter().all(|&t| self.turn(corners(t)).is_gt()) {
            return;
        }
        let inner = self.vertices.iter().copied().filter(is_inner);
        problems.outside.extend(inner.filter(|&v| self.rounds(v, None).is_none_or(|rounds| rounds < 1)));
    }

    /// A component is in one part, so only one of its rings can go round it outside: that with the most sides counts.
    fn find_parts(&self, problems: &mut Problems) {
        let is_outer = |ring: &&[Side]| {
            let triangle =
                |i: usize| [ring[0].ends[0], ring[i].ends[0], ring[i].ends[1]].map(|v| self.point(v));
            total_area_sign(ring.len(), &triangle).is_gt()
        };
        let mut outer: Vec<&[Side]> =
            self.sides.chunk_by(|one, other| one.ring == other.ring).filter(is_outer).collect();
        outer.sort_by_key(|ring| (Reverse(ring.len()), ring.iter().map(|side| side.ends).min()));
        let others = outer.into_iter().skip(1).flatten();
        problems.outside.extend(others.map(|side| side.ends[0]));
    }

    /// The leftmost vertex of each group of rings, and whether the group is that of a hole: whether the component is on
    /// the left of it.
    fn group_firsts(&self) -> Vec<(u32, u32, bool)> {
        let mut firsts = Vec::new();
        let mut sides = self.sides.clone();
        sides.sort_by_key(|side| side.group);
        for group in sides.chunk_by(|one, other| one.group == other.group) {
            let place = |side: &Side| (self.point(side.ends[0]), side.ends[0]);
            let compare = |(p, u): (DVec2, u32), (q, w): (DVec2, u32)| {
                p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y)).then(u.cmp(&w))
            };
            let Some(first) = group.iter().min_by(|one, other| compare(place(one), place(other))) else {
                continue;
            };
            let v = first.ends[0];
            let is_open = |side: &&Side| side.ends[0] == v;
            let is_hole = |side: &Side| !self.turn([side.before, v, side.ends[1]]).is_gt();
            firsts.push((v, first.group, group.iter().filter(is_open).any(is_hole)));
        }
        firsts
    }

    /// How often the boundary goes round a vertex, without the sides of a group; `None` if the vertex is on it. Rays in
    /// four directions take turns, because one may meet far more sides than another.
    fn rounds(&self, v: u32, without: Option<u32>) -> Option<i32> {
        if without.is_some() && self.groups == 1 {
            return Some(0);
        }
        let (r, tree) = (self.point(v), self.tree());
        let infinite = f64::INFINITY;
        let far = [dvec2(infinite, r.y), dvec2(r.x, infinite), dvec2(-infinite, r.y), dvec2(r.x, -infinite)];
        let mut rays = far
            .map(|far| (tree.locate_in_envelope_intersecting(AABB::from_corners(r.into(), far.into())), 0));
        loop {
            for (quarter, (ray, rounds)) in rays.iter_mut().enumerate() {
                let Some(located) = ray.next() else { return Some(*rounds) };
                let Side { ends, group, .. } = self.sides[located.side];
                if without != Some(group) {
                    *rounds += self.round(ends, v, quarter)?;
                }
            }
        }
    }

    /// What a side adds to the number of rounds about a vertex, where it meets a ray to the right, turned by quarters of
    /// a round; `None` if the vertex is on it.
    fn round(&self, [u, w]: [u32; 2], v: u32, quarter: usize) -> Option<i32> {
        let sign = self.turn([u, w, v]);
        if sign.is_eq() && self.is_beside([u, w], v) {
            return None;
        }
        let height = |v: u32| {
            let DVec2 { x, y } = self.point(v);
            [y, -x, -y, x][quarter]
        };
        let [p, q, r] = [u, w, v].map(height);
        let [goes_up, goes_down] = [p <= r && r < q, q <= r && r < p];
        Some(i32::from(goes_up && sign.is_gt()) - i32::from(goes_down && sign.is_lt()))
    }
}
