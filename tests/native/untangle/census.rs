//! Counts the triangles that are not positive and the edges that are not Delaunay, of a mesh that may be moving.

use super::components::Component;
use super::oracle::{Point, area, in_circle, sides};
use edgeflip::{Reason, Reasons};
use std::collections::HashSet;

#[derive(Debug, Default)]
pub(super) struct Census {
    pub(super) inverted: u32,
    pub(super) flat: u32,
    /// Triangles with a number that is not finite.
    pub(super) undecided: u32,
    /// Edges of two triangles with such a number.
    pub(super) skipped: u32,
    pub(super) remaining: Reasons,
}

/// Counts in a mesh with these components. They have the winding of the points and triangles at rest; where these had no
/// area, that of a mesh without positive triangles.
pub(super) fn census(
    parts: &[Component],
    triangles: &[u32],
    points: &[Option<Point>],
    (rest, at_rest): (&[Point], &[u32]),
    locked: &[[u32; 2]],
) -> Census {
    let joined: HashSet<[u32; 2]> =
        triangles.chunks(3).flat_map(sides).flat_map(|[u, v]| [[u, v], [v, u]]).collect();
    let at = |v: u32| points[v as usize];
    let mut all = Census::default();
    let sign_at_rest =
        |t: &[u32]| area(rest[t[0] as usize], rest[t[1] as usize], rest[t[2] as usize]).signum();
    let signs: HashSet<i128> = at_rest.chunks(3).map(sign_at_rest).collect();
    let is_all_clockwise = signs.contains(&-1) && !signs.contains(&1);
    for part in parts {
        let winding = if is_all_clockwise { -1 } else { part.winding(rest) };
        let sign = |a, b, c| (area(a, b, c) * winding).signum();
        for t in part.triangles.chunks(3) {
            match (at(t[0]), at(t[1]), at(t[2])) {
                (Some(a), Some(b), Some(c)) => match sign(a, b, c) {
                    0 => all.flat += 1,
                    -1 => all.inverted += 1,
                    _ => {}
                },
                _ => all.undecided += 1,
            }
        }
        for &[u, v, c, d] in &part.quads {
            let [Some(p), Some(q), Some(r), Some(s)] = [u, v, c, d].map(at) else {
                all.skipped += 1;
                continue;
            };
            if in_circle(p, q, r, s) * winding <= 0 {
                continue;
            }
            let reason = if locked.binary_search(&[u.min(v), u.max(v)]).is_ok() {
                Reason::Locked
            } else if sign(p, s, r) <= 0 || sign(q, r, s) <= 0 {
                Reason::Fold
            } else if c == d || joined.contains(&[c, d]) {
                Reason::Duplicate
            } else {
                Reason::Stopped
            };
            all.remaining[reason] += 1;
        }
    }
    all
}
