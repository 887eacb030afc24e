//! Integers decide what is right, and whether anything can be. Shares no code with the crate.

use std::collections::{HashMap, HashSet};

/// A vertex on a grid of integers below 2^30.
pub(super) type Point = [i64; 2];

/// Twice the area.
pub(super) fn area(a: Point, b: Point, c: Point) -> i128 {
    let [[px, py], [qx, qy]] = [a, b].map(|p| [i128::from(p[0] - c[0]), i128::from(p[1] - c[1])]);
    px * qy - py * qx
}

/// Positive if `d` is inside the circle through a, b, c, counter-clockwise.
pub(super) fn in_circle(a: Point, b: Point, c: Point, d: Point) -> i128 {
    let [p, q, r] = [a, b, c].map(|p| [i128::from(p[0] - d[0]), i128::from(p[1] - d[1])]);
    let size = |p: [i128; 2]| p[0] * p[0] + p[1] * p[1];
    let cross = |p: [i128; 2], q: [i128; 2]| p[0] * q[1] - p[1] * q[0];
    size(p) * cross(q, r) + size(q) * cross(r, p) + size(r) * cross(p, q)
}

pub(super) fn sides(t: &[u32]) -> [[u32; 2]; 3] {
    [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]]
}

/// The third corner of the triangle of each half-edge. Panics if two triangles have the same half-edge.
pub(super) fn apexes(triangles: &[u32]) -> HashMap<[u32; 2], u32> {
    let mut apexes = HashMap::new();
    for t in triangles.chunks(3) {
        for (i, side) in sides(t).into_iter().enumerate() {
            assert!(
                apexes.insert(side, t[(i + 2) % 3]).is_none(),
                "two triangles have the half-edge {side:?}"
            );
        }
    }
    apexes
}

/// The half-edges without another one on the other side, sorted.
pub(super) fn boundary(triangles: &[u32]) -> Vec<[u32; 2]> {
    let apexes = apexes(triangles);
    let mut boundary: Vec<_> =
        apexes.keys().copied().filter(|&[u, v]| !apexes.contains_key(&[v, u])).collect();
    boundary.sort_unstable();
    boundary
}

/// What is wrong with a triangulation, if anything: all triangles have the sign of `winding`, all edges but the locked
/// ones are Delaunay, and all locked edges are there.
pub(super) fn fault(
    points: &[Point],
    triangles: &[u32],
    locked: &[[u32; 2]],
    winding: i128,
) -> Option<String> {
    let at = |v: u32| points[v as usize];
    for t in triangles.chunks(3) {
        if area(at(t[0]), at(t[1]), at(t[2])).signum() != winding {
            return Some(format!("triangle {t:?} is not positive"));
        }
    }
    let apexes = apexes(triangles);
    let is_edge = |&[u, v]: &[u32; 2]| apexes.contains_key(&[u, v]) || apexes.contains_key(&[v, u]);
    if let Some(edge) = locked.iter().find(|edge| !is_edge(edge)) {
        return Some(format!("the locked edge {edge:?} is missing"));
    }
    let locked: HashSet<_> = locked.iter().flat_map(|&[u, v]| [[u, v], [v, u]]).collect();
    for (&[u, v], &c) in &apexes {
        if let Some(&d) = apexes.get(&[v, u])
            && !locked.contains(&[u, v])
            && in_circle(at(u), at(v), at(c), at(d)) * winding > 0
        {
            return Some(format!("edge {u}-{v} is not Delaunay"));
        }
    }
    None
}

/// Whether z is in the box of x and y.
pub(super) fn is_beside(points: &[Point], x: u32, y: u32, z: u32) -> bool {
    (0..2).all(|k| {
        let [x, y, z] = [x, y, z].map(|v| points[v as usize][k]);
        x.min(y) <= z && z <= x.max(y)
    })
}

/// How two sides meet, other than in one common vertex, if so.
fn meeting(points: &[Point], [a, b]: [u32; 2], [c, d]: [u32; 2]) -> Option<&'static str> {
    let turn = |x: u32, y: u32, z: u32| {
        let [x, y, z] = [x, y, z].map(|v| points[v as usize]);
        area(x, y, z).signum()
    };
    let is_beside = |x: u32, y: u32, z: u32| is_beside(points, x, y, z);
    let common: Vec<u32> = [a, b].into_iter().filter(|v| [c, d].contains(v)).collect();
    if common.len() == 2 {
        return Some("two sides join the same vertices");
    }
    if let [o] = common[..] {
        let [p, q] = [[a, b], [c, d]].map(|ends| if ends[0] == o { ends[1] } else { ends[0] });
        let is_folded = turn(o, p, q) == 0 && (is_beside(o, p, q) || is_beside(o, q, p));
        return is_folded.then_some("a side lies on another");
    }
    let signs = [turn(a, b, c), turn(a, b, d), turn(c, d, a), turn(c, d, b)];
    let touches = [(a, b, c), (a, b, d), (c, d, a), (c, d, b)];
    let touches = touches.into_iter().zip(signs).any(|((x, y, z), sign)| sign == 0 && is_beside(x, y, z));
    let crosses = signs[0] * signs[1] < 0 && signs[2] * signs[3] < 0;
    (touches || crosses).then_some("the boundary crosses itself")
}

/// How sides of a boundary meet, other than in common vertices, if so.
pub(super) fn crossing(points: &[Point], boundary: &[[u32; 2]]) -> Option<&'static str> {
    let mut pairs =
        (1..).zip(boundary).flat_map(|(i, &one)| boundary[i..].iter().map(move |&other| (one, other)));
    pairs.find_map(|(one, other)| meeting(points, one, other))
}

/// Why points have no triangulation with this boundary, if so.
pub(super) fn obstacle(points: &[Point], boundary: &[[u32; 2]], winding: i128) -> Option<&'static str> {
    let at = |v: u32| points[v as usize];
    let turn = |a: u32, b: u32, c: u32| (area(at(a), at(b), at(c)) * winding).signum();
    if let Some(how) = crossing(points, boundary) {
        return Some(how);
    }
    let on_boundary: HashSet<u32> = boundary.iter().flatten().copied().collect();
    for v in (0..points.len() as u32).filter(|v| !on_boundary.contains(v)) {
        let mut rounds = 0;
        for &[a, b] in boundary {
            let side = turn(a, b, v);
            if side == 0 && is_beside(points, a, b, v) {
                return Some("a vertex is on the boundary");
            }
            let [low, high, y] = [a, b, v].map(|v| at(v)[1] * winding as i64);
            if low <= y && y < high && side > 0 {
                rounds += 1;
            } else if high <= y && y < low && side < 0 {
                rounds -= 1;
            }
        }
        if rounds != 1 {
            return Some("a vertex is outside");
        }
    }
    let places: HashSet<_> = points.iter().collect();
    (places.len() < points.len()).then_some("two vertices are at one point")
}

/// Whether a locked edge meets another one, the boundary or a vertex. Then not all of them can be edges.
pub(super) fn blocks(points: &[Point], boundary: &[[u32; 2]], locked: &[[u32; 2]]) -> bool {
    let turn = |a: u32, b: u32, c: u32| {
        let [a, b, c] = [a, b, c].map(|v| points[v as usize]);
        area(a, b, c).signum()
    };
    let crosses = |[a, b]: [u32; 2], [c, d]: [u32; 2]| {
        turn(a, b, c) * turn(a, b, d) < 0 && turn(c, d, a) * turn(c, d, b) < 0
    };
    locked.iter().enumerate().any(|(i, &edge @ [a, b])| {
        let meets_vertex = (0..points.len() as u32)
            .any(|v| !edge.contains(&v) && turn(a, b, v) == 0 && is_beside(points, a, b, v));
        meets_vertex || locked[i + 1..].iter().chain(boundary).any(|&other| crosses(edge, other))
    })
}

/// The triangles without their order, each from its lowest vertex on.
pub(super) fn set(triangles: &[u32]) -> HashSet<[u32; 3]> {
    let turned = |t: &[u32]| {
        let lowest = (0..3).min_by_key(|&i| t[i]).unwrap_or(0);
        [0, 1, 2].map(|i| t[(lowest + i) % 3])
    };
    triangles.chunks(3).map(turned).collect()
}
