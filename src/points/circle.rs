//! The tests on points: orientation, and the in-circle test with its ties.

use crate::predicates::{area_sign, in_circle_sign};
use glam::DVec2;
use std::cmp::Ordering;

/// Whether a point is before another by x, and then by y.
#[inline(always)]
pub(super) fn is_before(p: DVec2, q: DVec2) -> bool {
    p.x < q.x || (p.x == q.x && p.y < q.y)
}

/// Whether `d` is inside the circle through `a`, `b` and `c`, which are counter-clockwise. Of four points on one circle,
/// the least is taken as a little lower on the paraboloid than it is, so that it is joined to the other three.
#[inline(always)]
pub(super) fn is_inside([a, b, c, d]: [DVec2; 4]) -> bool {
    match in_circle_sign(a, b, c, d) {
        Ordering::Less => true,
        Ordering::Greater => false,
        Ordering::Equal => is_inside_by_order([a, b, c, d]),
    }
}

/// Decides [`is_inside`] for four points on one circle. The in-circle determinant changes its sign if two points change
/// their places: so the lowered one takes the place of `d`, and the orientation of the other three decides.
#[cold]
fn is_inside_by_order([a, b, c, d]: [DVec2; 4]) -> bool {
    let mut others = [b, c, d];
    let mut least = a;
    for (candidate, rest) in [(b, [c, a, d]), (c, [a, b, d])] {
        if is_before(candidate, least) {
            (least, others) = (candidate, rest);
        }
    }
    let [p, q, r] = others;
    is_before(d, least) || area_sign(p, q, r).is_lt()
}

#[inline(always)]
pub(super) fn is_left_turn(a: DVec2, b: DVec2, c: DVec2) -> bool {
    area_sign(a, b, c).is_gt()
}

/// The sign of the area of a triangle, where a call does not cost much: inlined, it would be larger.
#[inline(never)]
pub(super) fn turn(a: DVec2, b: DVec2, c: DVec2) -> Ordering {
    area_sign(a, b, c)
}
