//! What is right in each component of a mesh alone, and what keeps it from having a triangulation.

use super::oracle::{Point, apexes, area, blocks, crossing, in_circle, is_beside, sides};
use std::collections::{HashMap, HashSet};

/// Triangles that are joined by edges of exactly two triangles of one orientation.
pub(super) struct Component {
    pub(super) triangles: Vec<u32>,
    /// The half-edges without another one on the other side, sorted.
    pub(super) boundary: Vec<[u32; 2]>,
    pub(super) vertices: Vec<u32>,
    /// At each vertex, the fans: the first and the last vertex around it; none of a closed fan.
    pub(super) fans: Vec<(u32, Option<[u32; 2]>)>,
    /// The edges of two triangles (u, v, c) and (v, u, d): u, v, c, d.
    pub(super) quads: Vec<[u32; 4]>,
}

/// The components of a mesh, in the order of their first triangles.
pub(super) fn components(triangles: &[u32]) -> Vec<Component> {
    let mut edges: HashMap<[u32; 2], Vec<usize>> = HashMap::new();
    for (t, corners) in triangles.chunks(3).enumerate() {
        for (k, [u, v]) in sides(corners).into_iter().enumerate() {
            edges.entry([u.min(v), u.max(v)]).or_default().push(3 * t + k);
        }
    }
    let from = |h: usize| triangles[h];
    let next = |h: usize| h / 3 * 3 + (h + 1) % 3;
    let prev = |h: usize| h / 3 * 3 + (h + 2) % 3;
    let mut twins = vec![None; triangles.len()];
    for sides in edges.values() {
        if let &[h, g] = &sides[..]
            && from(h) != from(g)
        {
            (twins[h], twins[g]) = (Some(g), Some(h));
        }
    }
    let mut number = vec![None; triangles.len() / 3];
    let mut all: Vec<Vec<usize>> = Vec::new();
    for seed in 0..number.len() {
        if number[seed].is_some() {
            continue;
        }
        let mut open = vec![seed];
        number[seed] = Some(all.len());
        let mut of_component = Vec::new();
        while let Some(t) = open.pop() {
            of_component.push(t);
            for twin in twins[3 * t..3 * t + 3].iter().flatten() {
                if number[twin / 3].is_none() {
                    number[twin / 3] = Some(all.len());
                    open.push(twin / 3);
                }
            }
        }
        all.push(of_component);
    }
    let component = |of: Vec<usize>| {
        let corners: Vec<usize> = of.iter().flat_map(|t| 3 * t..3 * t + 3).collect();
        let mut boundary: Vec<[u32; 2]> =
            corners.iter().filter(|&&h| twins[h].is_none()).map(|&h| [from(h), from(next(h))]).collect();
        boundary.sort_unstable();
        let mut vertices: Vec<u32> = corners.iter().map(|&h| from(h)).collect();
        vertices.sort_unstable();
        vertices.dedup();
        let mut fans = Vec::new();
        let mut is_visited = HashSet::new();
        for &corner in &corners {
            if is_visited.contains(&corner) {
                continue;
            }
            // Clockwise to the first corner of the fan.
            let mut first = corner;
            let mut is_closed = false;
            while let Some(twin) = twins[first] {
                first = next(twin);
                if first == corner {
                    is_closed = true;
                    break;
                }
            }
            let mut last = first;
            is_visited.insert(last);
            while let Some(twin) = twins[prev(last)] {
                if twin == first {
                    break;
                }
                last = twin;
                is_visited.insert(last);
            }
            fans.push((from(corner), (!is_closed).then(|| [from(next(first)), from(prev(last))])));
        }
        fans.sort_unstable();
        let quad = |&h: &usize| {
            let g = twins[h].filter(|&g| h < g)?;
            Some([h, g, prev(h), prev(g)].map(from))
        };
        let quads = corners.iter().filter_map(quad).collect();
        Component {
            triangles: of.iter().flat_map(|t| triangles[3 * t..3 * t + 3].to_vec()).collect(),
            boundary,
            vertices,
            fans,
            quads,
        }
    };
    all.into_iter().map(component).collect()
}

impl Component {
    /// 1, or -1 if the area is negative.
    pub(super) fn winding(&self, points: &[Point]) -> i128 {
        let at = |v: u32| points[v as usize];
        let sum: i128 = self.triangles.chunks(3).map(|t| area(at(t[0]), at(t[1]), at(t[2]))).sum();
        if sum < 0 { -1 } else { 1 }
    }

    /// Why these points have no triangulation with this boundary, if so.
    pub(super) fn obstacle(&self, points: &[Point]) -> Option<&'static str> {
        let winding = self.winding(points);
        let at = |v: u32| [points[v as usize][0], points[v as usize][1] * winding as i64];
        let turn = |a: u32, b: u32, c: u32| area(at(a), at(b), at(c)).signum();
        let (edges, count) = ((3 * self.triangle_count() + self.boundary.len()) / 2, self.triangle_count());
        let (mut loops, mut outer) = (0, 0);
        let mut left: HashMap<[u32; 2], usize> = HashMap::new();
        for &(v, fan) in &self.fans {
            if let Some([first, last]) = fan {
                left.insert([last, v], first as usize);
            }
        }
        // A loop of the boundary: each side (last, v) is followed by (v, first).
        let mut open: HashSet<[u32; 2]> = self.boundary.iter().copied().collect();
        while let Some(&side) = open.iter().next() {
            let (mut here, mut twice) = (side, 0);
            while open.remove(&here) {
                let [p, q] = here.map(|v| at(v).map(i128::from));
                twice += p[0] * q[1] - p[1] * q[0];
                here = [here[1], left[&here] as u32];
            }
            loops += 1;
            outer += usize::from(twice > 0);
        }
        if self.fans.len() as i64 - edges as i64 + count as i64 != 2 - loops {
            return Some("a handle");
        }
        let places: HashSet<_> = self.vertices.iter().map(|&v| at(v)).collect();
        if places.len() < self.vertices.len() {
            return Some("two vertices are at one point");
        }
        if let Some(how) = crossing(points, &self.boundary) {
            return Some(how);
        }
        for (i, (v, fan)) in self.fans.iter().enumerate() {
            for (_, other) in self.fans[i + 1..].iter().take_while(|(w, _)| w == v) {
                let (Some([a, b]), Some([c, d])) = (*fan, *other) else {
                    return Some("a closed fan and another one");
                };
                let is_in = |[s, e]: [u32; 2], d: u32| match turn(*v, s, e) {
                    1 => turn(*v, s, d) > 0 && turn(*v, d, e) > 0,
                    _ => !(turn(*v, e, d) >= 0 && turn(*v, d, s) >= 0),
                };
                if is_in([a, b], c) || is_in([a, b], d) || is_in([c, d], a) || is_in([c, d], b) {
                    return Some("two fans overlap");
                }
            }
        }
        let rounds = |v: u32| {
            let mut rounds = 0;
            for &[a, b] in self.boundary.iter().filter(|side| !side.contains(&v)) {
                let side = turn(a, b, v);
                if side == 0 && is_beside(points, a, b, v) {
                    return None;
                }
                let [low, high, y] = [a, b, v].map(|v| at(v)[1]);
                if low <= y && y < high && side > 0 {
                    rounds += 1;
                } else if high <= y && y < low && side < 0 {
                    rounds -= 1;
                }
            }
            Some(rounds)
        };
        let on_boundary: HashSet<u32> = self.boundary.iter().flatten().copied().collect();
        if self.vertices.iter().any(|v| !on_boundary.contains(v) && rounds(*v) != Some(1)) {
            return Some("a vertex is outside");
        }
        // With a simple boundary, the interior is on the left of each side: a point just beside it has one round.
        let is_right = |&[a, b]: &[u32; 2]| {
            let middle = [0, 1].map(|k| at(a)[k] + at(b)[k]);
            let mut twice = 0;
            for &[c, d] in self.boundary.iter().filter(|side| **side != [a, b]) {
                let [p, q] = [c, d].map(|v| at(v).map(|x| 2 * x));
                let side = area(p, q, middle).signum();
                // A ray to the right through the middle, but not the side itself.
                if p[1] <= middle[1] && middle[1] < q[1] && side > 0 {
                    twice += 1;
                } else if q[1] <= middle[1] && middle[1] < p[1] && side < 0 {
                    twice -= 1;
                }
            }
            // The ray starts on the side: it is inside just to the right of a side that goes down, and just above one
            // that goes to the right.
            let [up, across] = [at(b)[1] - at(a)[1], at(b)[0] - at(a)[0]];
            match (up.signum(), across.signum()) {
                (1, _) | (0, -1) => twice == 0,
                _ => twice == 1,
            }
        };
        if outer != 1 || !self.boundary.iter().all(is_right) {
            return Some("a ring is where it cannot be");
        }
        None
    }

    fn triangle_count(&self) -> usize {
        self.triangles.len() / 3
    }

    /// What is wrong with the triangles, if anything. `all` are those of the mesh: an edge that another component has, too,
    /// would be an edge of more than two triangles.
    pub(super) fn fault(&self, points: &[Point], all: &[u32], locked: &[[u32; 2]]) -> Option<String> {
        let winding = self.winding(points);
        let at = |v: u32| points[v as usize];
        for t in self.triangles.chunks(3) {
            if area(at(t[0]), at(t[1]), at(t[2])).signum() != winding {
                return Some(format!("triangle {t:?} is not positive"));
            }
        }
        let apexes = apexes(&self.triangles);
        let joined: HashSet<[u32; 2]> = all.chunks(3).flat_map(sides).collect();
        let is_joined = |u: u32, v: u32| joined.contains(&[u, v]) || joined.contains(&[v, u]);
        let locked: HashSet<_> = locked.iter().flat_map(|&[u, v]| [[u, v], [v, u]]).collect();
        let boundary: HashSet<_> = self.boundary.iter().copied().collect();
        for (&[u, v], &c) in apexes.iter().filter(|(side, _)| !boundary.contains(*side)) {
            if let Some(&d) = apexes.get(&[v, u])
                && !locked.contains(&[u, v])
                && in_circle(at(u), at(v), at(c), at(d)) * winding > 0
                && !is_joined(c, d)
            {
                return Some(format!("edge {u}-{v} is not Delaunay"));
            }
        }
        None
    }

    /// The lost edges that this component had at first.
    pub(super) fn lost(&self, lost: &[[u32; 2]], before: &[Component]) -> Vec<[u32; 2]> {
        let first = self.at_first(before);
        let sides: HashSet<[u32; 2]> = first.triangles.chunks(3).flat_map(sides).collect();
        lost.iter().copied().filter(|&[u, v]| sides.contains(&[u, v]) || sides.contains(&[v, u])).collect()
    }

    fn at_first<'a>(&self, before: &'a [Component]) -> &'a Component {
        before.iter().find(|c| c.boundary == self.boundary && c.vertices == self.vertices).unwrap()
    }

    /// Whether the locked edges of this component meet each other, its boundary or its vertices, or another component has
    /// one of them.
    pub(super) fn is_blocked(&self, points: &[Point], locked: &[[u32; 2]], before: &[Component]) -> bool {
        let mut lost = self.lost(locked, before);
        let present: HashSet<[u32; 2]> = self.triangles.chunks(3).flat_map(sides).collect();
        lost.extend(locked.iter().filter(|&&[u, v]| present.contains(&[u, v]) || present.contains(&[v, u])));
        let local: HashMap<u32, u32> = self.vertices.iter().zip(0..).map(|(&v, i)| (v, i)).collect();
        let own: Vec<Point> = self.vertices.iter().map(|&v| points[v as usize]).collect();
        let name =
            |edges: &[[u32; 2]]| -> Vec<[u32; 2]> { edges.iter().map(|e| e.map(|v| local[&v])).collect() };
        let mut lost: Vec<_> = lost.into_iter().map(|[u, v]| [u.min(v), u.max(v)]).collect();
        lost.sort_unstable();
        lost.dedup();
        let boundary: HashSet<[u32; 2]> = self.boundary.iter().copied().collect();
        let is_outside = |&[u, v]: &[u32; 2]| {
            let middle = [0, 1].map(|k| points[u as usize][k] + points[v as usize][k]);
            let mut rounds = 0;
            for &[a, b] in &self.boundary {
                let [p, q] = [a, b].map(|v| points[v as usize].map(|x| 2 * x));
                let side = area(p, q, middle).signum();
                if p[1] <= middle[1] && middle[1] < q[1] && side > 0 {
                    rounds += 1;
                } else if q[1] <= middle[1] && middle[1] < p[1] && side < 0 {
                    rounds -= 1;
                }
            }
            !boundary.contains(&[u, v]) && !boundary.contains(&[v, u]) && rounds == 0
        };
        lost.iter().any(is_outside) || blocks(&own, &name(&self.boundary), &name(&lost))
    }
}
