//! A surface as the audit sees it: edge table, components, areas, and the edges that are not Delaunay.

use super::audit_exact::{self, ExactSum, Triangle};
use super::edges::{Class, Edge, EdgeTable, next, prev};
use crate::{Dimension, Mesh, Reason};
use num_bigint::{BigInt, Sign};
use std::cmp::Ordering;

/// An edge of a result that is not Delaunay.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RemainingEdge {
    /// Smaller end.
    pub u: u32,
    /// Larger end.
    pub v: u32,
    /// Why it does not flip; `Stopped` if it could.
    pub reason: Reason,
}

/// Limits for flips in space.
#[derive(Clone, Copy)]
pub(super) struct Limits {
    /// cos β.
    pub cosine: f64,
    /// The largest distance between the lines of the two diagonals.
    pub deviation: f64,
}

/// The vertices of a mesh with the triangles of the input or of the result, and data for the audit.
pub(super) struct Surface<'a> {
    pub mesh: &'a Mesh,
    triangles: &'a [u32],
    pub table: EdgeTable<'a>,
    /// The edge-connected component of each triangle.
    component_of: Vec<u32>,
    /// The doubled signed area of each component; 0 in 3D.
    pub areas: Vec<BigInt>,
}

impl<'a> Surface<'a> {
    pub fn new(mesh: &'a Mesh, triangles: &'a [u32]) -> Self {
        let table = EdgeTable::new(triangles, mesh.vertex_count());
        let (component_of, count) = components(&table, triangles.len() / 3);
        let areas = match mesh.dimension() {
            Dimension::Two => areas(mesh, triangles, &component_of, count),
            Dimension::Three => vec![BigInt::ZERO; count],
        };
        Self { mesh, triangles, table, component_of, areas }
    }

    pub fn triangle_count(&self) -> usize {
        self.triangles.len() / 3
    }

    pub fn used(&self) -> Vec<bool> {
        let mut used = vec![false; self.mesh.vertex_count()];
        for &v in self.triangles {
            used[v as usize] = true;
        }
        used
    }

    pub fn euler(&self) -> i64 {
        let vertices = self.used().into_iter().filter(|&used| used).count() as i64;
        vertices - self.table.edges().count() as i64 + (self.triangles.len() / 3) as i64
    }

    pub fn sorted_areas(&self) -> Vec<&BigInt> {
        let mut areas: Vec<_> = self.areas.iter().collect();
        areas.sort_unstable();
        areas
    }

    /// The sign, reversed if the component of the triangle has a negative area.
    fn oriented(&self, triangle: usize, sign: Ordering) -> Ordering {
        let negative = self.areas[self.component_of[triangle] as usize].sign() == Sign::Minus;
        if negative { sign.reverse() } else { sign }
    }

    /// The triangles that have the opposite sign of their component (2D), and the flat ones.
    pub fn inverted_and_flat(&self) -> [Vec<u32>; 2] {
        let sign = |t: u32| match self.mesh.dimension() {
            Dimension::Two => {
                let corners = [0, 1, 2].map(|k| self.triangles[3 * t as usize + k]);
                self.oriented(t as usize, audit_exact::turn(corners.map(|v| self.coord(v))))
            }
            Dimension::Three if audit_exact::flat(self.triangle_of(3 * t)).is_some() => Ordering::Equal,
            Dimension::Three => Ordering::Greater,
        };
        let signs: Vec<_> = (0..self.triangle_count() as u32).map(sign).collect();
        let those = |wanted| (0..).zip(&signs).filter(|&(_, &sign)| sign == wanted).map(|(t, _)| t).collect();
        [Ordering::Less, Ordering::Equal].map(those)
    }

    pub fn coord(&self, v: u32) -> robust::Coord<f64> {
        let p = self.mesh.point2(v);
        robust::Coord { x: p.x, y: p.y }
    }

    fn points(&self, corners: [u32; 3]) -> Triangle {
        corners.map(|v| self.mesh.point3(v))
    }

    /// The points of the triangle of half-edge `h`, from its start on. The third point is opposite to `h`.
    pub fn triangle_of(&self, h: u32) -> Triangle {
        self.points([h, next(h), prev(h)].map(|x| self.triangles[x as usize]))
    }

    /// The edges that are not Delaunay, in the order of the table. The edges in `creases` and `locked` never flip,
    /// whatever their present angle. Both lists are in the order of the table.
    pub fn remaining(
        &self,
        limits: Limits,
        creases: &[(u32, u32)],
        locked: &[(u32, u32)],
    ) -> Vec<RemainingEdge> {
        let mut remaining = Vec::new();
        for edge in self.table.edges() {
            let is_among = |list: &[(u32, u32)]| list.binary_search(&(edge.u, edge.v)).is_ok();
            let reason = match edge.class {
                Class::Boundary => None,
                Class::Twins(h, g) => {
                    let judged = match self.mesh.dimension() {
                        Dimension::Two => self.judge_in_plane(h, g),
                        Dimension::Three => self.judge_in_space(h, g, limits),
                    };
                    judged.map(|reason| match () {
                        () if is_among(locked) => Reason::Locked,
                        () if is_among(creases) => Reason::Angle,
                        () => reason,
                    })
                }
                Class::NonManifold => self.frozen_excess(&edge).then_some(Reason::NonManifold),
                Class::Inconsistent => self.frozen_excess(&edge).then_some(Reason::Inconsistent),
            };
            remaining.extend(reason.map(|reason| RemainingEdge { u: edge.u, v: edge.v, reason }));
        }
        remaining
    }

    /// The ends a, b of an edge and the opposite corners c, d: its triangles are (a, b, c) and (b, a, d).
    fn quad(&self, h: u32, g: u32) -> [u32; 4] {
        [h, next(h), prev(h), prev(g)].map(|x| self.triangles[x as usize])
    }

    /// Why the edge remains, if it is not Delaunay (2D).
    fn judge_in_plane(&self, h: u32, g: u32) -> Option<Reason> {
        let [a, b, c, d] = self.quad(h, g);
        let oriented = |sign| self.oriented(h as usize / 3, sign);
        let [pa, pb, pc, pd] = [a, b, c, d].map(|v| self.coord(v));
        let positive = |triangle| oriented(audit_exact::turn(triangle)).is_gt();
        if oriented(audit_exact::in_circle([pa, pb, pc, pd])).is_le() {
            None
        } else if !positive([pa, pd, pc]) || !positive([pb, pc, pd]) {
            Some(Reason::Fold)
        } else if self.table.contains(c, d) {
            Some(Reason::Duplicate)
        } else {
            Some(Reason::Stopped)
        }
    }

    /// Why the edge remains, if it is not Delaunay (3D).
    fn judge_in_space(&self, h: u32, g: u32, Limits { cosine, deviation }: Limits) -> Option<Reason> {
        let [a, b, c, d] = self.quad(h, g);
        let [old1, old2] = [[a, b, c], [b, a, d]].map(|corners| self.points(corners));
        let [new1, new2] = [[a, d, c], [b, c, d]].map(|corners| self.points(corners));
        if audit_exact::sum_of_angles(old1, old2) != Ordering::Less {
            return None;
        }
        let oppose = |old| audit_exact::normals_oppose(old, new1) || audit_exact::normals_oppose(old, new2);
        Some(
            if audit_exact::normals_differ(old1, old2, cosine)
                || audit_exact::normals_differ(new1, new2, cosine)
            {
                Reason::Angle
            } else if oppose(old1) || oppose(old2) {
                Reason::Fold
            } else if audit_exact::lines_apart([a, b, c, d].map(|v| self.mesh.point3(v)), deviation) {
                Reason::Deviation
            } else if c == d || self.table.contains(c, d) {
                Reason::Duplicate
            } else {
                Reason::Stopped
            },
        )
    }

    /// Whether any two triangles at a frozen edge have opposite angles that sum to more than π. One pass compares each
    /// triangle with the widest so far. Flat triangles are handled apart: a cap (angle π) makes such a pair with any
    /// triangle that is not flat.
    fn frozen_excess(&self, edge: &Edge) -> bool {
        let mut widest: Option<Triangle> = None;
        let mut cap = false;
        for h in edge.half_edges() {
            let triangle = self.triangle_of(h);
            if let Some(dot) = audit_exact::flat(triangle) {
                cap |= dot == Ordering::Less;
                continue;
            }
            let Some(widest_so_far) = widest else {
                widest = Some(triangle);
                continue;
            };
            if audit_exact::sum_of_angles(widest_so_far, triangle) == Ordering::Less {
                return true;
            }
            if audit_exact::compare_angles(triangle, widest_so_far) == Ordering::Greater {
                widest = Some(triangle);
            }
        }
        cap && widest.is_some()
    }
}

/// The edge-connected component of each triangle, and the number of components.
fn components(table: &EdgeTable, triangles: usize) -> (Vec<u32>, usize) {
    fn root(parent: &mut [u32], mut t: u32) -> u32 {
        while parent[t as usize] != t {
            parent[t as usize] = parent[parent[t as usize] as usize];
            t = parent[t as usize];
        }
        t
    }
    let mut parent: Vec<u32> = (0..triangles as u32).collect();
    for edge in table.edges() {
        if let Class::Twins(h, g) = edge.class {
            let (s, t) = (root(&mut parent, h / 3), root(&mut parent, g / 3));
            // The smaller root stays, so that a root comes before all its triangles.
            parent[s.max(t) as usize] = s.min(t);
        }
    }
    let mut count = 0;
    let mut component_of = vec![0u32; triangles];
    for t in 0..triangles as u32 {
        let root = root(&mut parent, t);
        component_of[t as usize] = if root == t { count } else { component_of[root as usize] };
        count += u32::from(root == t);
    }
    (component_of, count as usize)
}

/// The exact doubled signed area of each component.
fn areas(mesh: &Mesh, triangles: &[u32], component_of: &[u32], count: usize) -> Vec<BigInt> {
    let mut order: Vec<u32> = (0..component_of.len() as u32).collect();
    order.sort_by_key(|&t| component_of[t as usize]);
    let at = |h: u32| mesh.point2(triangles[h as usize]);
    let unit = ExactSum::unit(mesh.positions().iter());
    let mut areas = Vec::with_capacity(count);
    for members in order.chunk_by(|&s, &t| component_of[s as usize] == component_of[t as usize]) {
        let mut sum = ExactSum::new(unit);
        for h in members.iter().flat_map(|&t| 3 * t..3 * t + 3) {
            let (u, v) = (at(h), at(next(h)));
            sum.add(u.x, v.y);
            sum.add(-v.x, u.y);
        }
        areas.push(sum.total());
    }
    areas
}

#[cfg(test)]
mod tests {
    use super::audit_exact;

    #[test]
    fn in_circle_is_the_angle_polynomial() {
        let s = |p: [i64; 8]| {
            let [ax, ay, bx, by, cx, cy, dx, dy] = p;
            let cross = |x: i64, y: i64, z: i64, w: i64| x * w - y * z;
            let dot = |x: i64, y: i64, z: i64, w: i64| x * z + y * w;
            let (p, q) = ((ax - cx, ay - cy), (bx - cx, by - cy));
            let (r, t) = ((bx - dx, by - dy), (ax - dx, ay - dy));
            cross(p.0, p.1, q.0, q.1) * dot(r.0, r.1, t.0, t.1)
                + dot(p.0, p.1, q.0, q.1) * cross(r.0, r.1, t.0, t.1)
        };
        let mut random = oorandom::Rand64::new(7);
        for _ in 0..10_000 {
            let p = [0; 8].map(|_: i64| random.rand_range(0..9) as i64 - 4);
            // The last two scales are not ordinary.
            for scale in [1.0, 2f64.powi(-1000), 2f64.powi(1000)] {
                let at = |i: usize| robust::Coord { x: p[i] as f64 * scale, y: p[i + 1] as f64 * scale };
                assert_eq!(audit_exact::in_circle([at(0), at(2), at(4), at(6)]), 0.cmp(&s(p)));
            }
        }
    }
}
