//! Label: each triangle tests its three edges and keeps the best one that may flip.

use super::{BLOCKED, Geometry, Topology, key};
use crate::adjacency::{CREASE, LOCKED, next, prev, unflagged};
use crate::mesh::Dimension;
use crate::predicates::{Quad, area_sign, in_circle_sign};
use crate::star::{Star, any_in_either};
use crate::{NONE, Reason};
use std::cmp::Ordering;

/// What the test of an interior edge says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Verdict {
    Delaunay,
    /// Non-Delaunay, and may not flip.
    Blocked(Reason),
    /// Non-Delaunay, and may flip.
    Labelled,
}

/// Writes `best[t]` for each active triangle t: the twin of its labelled edge with the smallest key, or
/// [`BLOCKED`], or [`NONE`].
pub(crate) fn label(
    geometry: &Geometry,
    mesh: Topology,
    iteration: u32,
    active: impl Iterator<Item = u32>,
    best: &mut [u32],
) {
    for t in active {
        let mut choice = NONE;
        let mut smallest = u32::MAX;
        for h in 3 * t..3 * t + 3 {
            let g = mesh.twins[h as usize];
            if g >= LOCKED {
                // No twin, or an edge that stays.
                continue;
            }
            match verdict(geometry, mesh, h) {
                Verdict::Labelled => {
                    let key = key(h.min(g), iteration);
                    if choice >= BLOCKED || key < smallest {
                        (choice, smallest) = (g, key);
                    }
                }
                Verdict::Blocked(Reason::Duplicate) if choice == NONE => choice = BLOCKED,
                _ => {}
            }
        }
        best[t as usize] = choice;
    }
}

/// Tests the interior edge of half-edge `h`. Both half-edges give the same answer, since it is exact.
pub(crate) fn verdict(geometry: &Geometry, mesh: Topology, h: u32) -> Verdict {
    let entry = mesh.twins[h as usize];
    let g = unflagged(entry);
    let [a, b, c, d] = [h, next(h), prev(h), prev(g)].map(|x| mesh.triangles[x as usize]);
    let blocked = match geometry.dimension {
        Dimension::Two => {
            let clockwise = geometry.winding.is_clockwise(h / 3);
            let signed = |sign: Ordering| if clockwise { sign.reverse() } else { sign };
            let [a, b, c, d] = geometry.positions.points2([a, b, c, d]);
            if signed(in_circle_sign(a, b, c, d)).is_ge() {
                return Verdict::Delaunay;
            }
            let positive = |a, b, c| signed(area_sign(a, b, c)).is_gt();
            (!(positive(a, d, c) && positive(b, c, d))).then_some(Reason::Fold)
        }
        Dimension::Three => {
            let [a, b, c, d] = geometry.positions.points3([a, b, c, d]);
            let quad = Quad::new(a, b, c, d);
            if !quad.is_non_delaunay() {
                return Verdict::Delaunay;
            }
            if entry & CREASE != 0 || quad.exceeds_angle(geometry.cos) {
                Some(Reason::Angle)
            } else {
                quad.turns_over().then_some(Reason::Fold)
            }
        }
    };
    match blocked {
        _ if entry & LOCKED != 0 => Verdict::Blocked(Reason::Locked),
        Some(reason) => Verdict::Blocked(reason),
        None if edge_exists(mesh, prev(h), prev(g)) => Verdict::Blocked(Reason::Duplicate),
        None => Verdict::Labelled,
    }
}

/// Whether an edge joins the vertices c and d that the half-edges `at_c` and `at_d` start at, or c is d.
fn edge_exists(mesh: Topology, at_c: u32, at_d: u32) -> bool {
    let [c, d] = [at_c, at_d].map(|x| mesh.triangles[x as usize]);
    let star = |corner| Star::new(mesh.triangles, mesh.twins, mesh.fans, corner);
    let joins = |corner: u32, to: u32| {
        mesh.triangles[next(corner) as usize] == to || mesh.triangles[prev(corner) as usize] == to
    };
    c == d || any_in_either((star(at_c), |corner| joins(corner, d)), (star(at_d), |corner| joins(corner, c)))
}
