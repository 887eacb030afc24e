//! Label: each triangle tests its three edges and keeps the best one that may flip.

use super::{BLOCKED, Geometry, Thresholds, Topology, key};
use crate::adjacency::{CREASE, LOCKED, next, prev, unflagged};
use crate::mesh::Dimension;
use crate::predicates::{Quad, area_sign, in_circle_sign};
use crate::star::{Star, any_in_either};
use crate::winding::Winding;
use crate::{NONE, Positions, Reason};
use glam::DVec2;

/// What the test of an interior edge says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Verdict {
    Delaunay,
    /// Non-Delaunay, and may not flip.
    Blocked(Reason),
    /// Non-Delaunay, and may flip.
    Labelled,
}

/// For each triangle the twin of its labelled edge with the smallest key, or [`BLOCKED`], or [`NONE`].
pub(crate) fn label(geometry: &Geometry, mesh: Topology, iteration: u32) -> Vec<u32> {
    let best = |t: u32| {
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
        choice
    };
    (0..mesh.triangles.len() as u32 / 3).map(best).collect()
}

/// An interior edge with its two triangles (a, b, c) and (b, a, d).
#[derive(Clone, Copy, Default)]
pub(crate) struct Diamond {
    /// The half-edge from a to b.
    pub(crate) h: u32,
    /// Its entry in the twins.
    pub(crate) twin: u32,
    /// a, b, c, d.
    pub(crate) corners: [u32; 4],
}

impl Diamond {
    /// That of half-edge `h`.
    #[inline(always)]
    pub(crate) fn new(mesh: Topology, h: u32) -> Self {
        let twin = mesh.twins[h as usize];
        let corner = |x: u32| mesh.triangles[x as usize];
        let corners = [corner(h), corner(next(h)), corner(prev(h)), corner(prev(unflagged(twin)))];
        Self { h, twin, corners }
    }
}

/// Tests the interior edge of half-edge `h`. Both half-edges give the same answer, since it is exact.
pub(crate) fn verdict(geometry: &Geometry, mesh: Topology, h: u32) -> Verdict {
    let diamond = Diamond::new(mesh, h);
    if keep_non_delaunay(geometry, &[diamond], &mut [0]) == 0 {
        return Verdict::Delaunay;
    }
    match verdict_of_shape(geometry, &diamond) {
        Verdict::Labelled if makes_duplicate(geometry, mesh, h) => Verdict::Blocked(Reason::Duplicate),
        verdict => verdict,
    }
}

/// Writes which of the edges are not Delaunay, as places in `diamonds`, and returns how many they are.
pub(crate) fn keep_non_delaunay(geometry: &Geometry, diamonds: &[Diamond], kept: &mut [u32]) -> usize {
    let winding = geometry.winding;
    match (geometry.dimension, geometry.positions) {
        (Dimension::Two, Positions::F32(numbers)) => {
            keep(diamonds, kept, |diamond| is_non_delaunay_in_plane(numbers, winding, diamond))
        }
        (Dimension::Two, Positions::F64(numbers)) => {
            keep(diamonds, kept, |diamond| is_non_delaunay_in_plane(numbers, winding, diamond))
        }
        (Dimension::Three, positions) => {
            keep(diamonds, kept, |diamond| quad(positions, diamond).is_non_delaunay())
        }
    }
}

/// Without a branch on the answers, which nothing could predict.
#[inline(always)]
fn keep(diamonds: &[Diamond], kept: &mut [u32], is_kept: impl Fn(&Diamond) -> bool) -> usize {
    let mut count = 0;
    for (i, diamond) in (0..).zip(diamonds) {
        kept[count] = i;
        count += usize::from(is_kept(diamond));
    }
    count
}

#[inline(always)]
fn is_non_delaunay_in_plane<T: Copy + Into<f64>>(
    numbers: &[T],
    winding: &Winding,
    diamond: &Diamond,
) -> bool {
    let (points, _) = numbers.as_chunks::<2>();
    let point = |v: u32| DVec2::new(points[v as usize][0].into(), points[v as usize][1].into());
    let [a, b, c, d] = diamond.corners;
    let sign = in_circle_sign(point(a), point(b), point(c), point(d));
    sign == winding.positive(diamond.h / 3).reverse()
}

#[inline(always)]
fn quad(positions: &Positions, diamond: &Diamond) -> Quad {
    let [a, b, c, d] = positions.points3(diamond.corners);
    Quad::new(a, b, c, d)
}

/// Whether a non-Delaunay edge may flip as far as its two triangles say, or why it may not.
pub(crate) fn verdict_of_shape(geometry: &Geometry, diamond: &Diamond) -> Verdict {
    if diamond.twin & LOCKED != 0 {
        return Verdict::Blocked(Reason::Locked);
    }
    match geometry.dimension {
        // The angles at a and b are together smaller than π, if both triangles are positive.
        Dimension::Two if geometry.winding.is_strict => {}
        Dimension::Two => {
            let [a, b, c, d] = geometry.positions.points2(diamond.corners);
            let positive = geometry.winding.positive(diamond.h / 3);
            if area_sign(a, d, c) != positive || area_sign(b, c, d) != positive {
                return Verdict::Blocked(Reason::Fold);
            }
        }
        Dimension::Three => {
            let quad = quad(geometry.positions, diamond);
            let Thresholds { cos, deviation } = geometry.thresholds;
            if diamond.twin & CREASE != 0 || quad.exceeds_angle(cos) {
                return Verdict::Blocked(Reason::Angle);
            }
            if quad.turns_over() {
                return Verdict::Blocked(Reason::Fold);
            }
            if deviation.is_finite() && quad.deviates(deviation.into()) {
                return Verdict::Blocked(Reason::Deviation);
            }
        }
    }
    Verdict::Labelled
}

/// Whether an edge joins the far corners c and d of an edge already, or c is d.
pub(crate) fn makes_duplicate(geometry: &Geometry, mesh: Topology, h: u32) -> bool {
    let [at_c, at_d] = [prev(h), prev(unflagged(mesh.twins[h as usize]))];
    let [c, d] = [at_c, at_d].map(|corner| mesh.triangles[corner as usize]);
    if geometry.embedded.at(c) || geometry.embedded.at(d) {
        return false;
    }
    let star = |corner| Star::new(mesh.triangles, mesh.twins, mesh.fans, corner);
    let joins = |corner: u32, to: u32| {
        mesh.triangles[next(corner) as usize] == to || mesh.triangles[prev(corner) as usize] == to
    };
    c == d || any_in_either((star(at_c), |corner| joins(corner, d)), (star(at_d), |corner| joins(corner, c)))
}
