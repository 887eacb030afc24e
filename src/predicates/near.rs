//! Whether a point is near a line.

use super::exact::{Differences, Ring, Unbounded};
use super::plane::{EPSILON, UNDERFLOW, cross_sign};
use glam::DVec2;
use std::cmp::Ordering;

/// Whether the distance of `p` from the line through `u` and `v` is at most `most`: |(v - u) × (p - u)| <= `most` |v - u|.
/// `most` is finite and not negative, and `u` and `v` differ.
pub(crate) fn is_near(u: DVec2, v: DVec2, p: DVec2, most: f64) -> bool {
    let (along, across) = (v - u, p - u);
    let (left, right) = (along.x * across.y, along.y * across.x);
    let square = along.length_squared();
    let reach = most * square.sqrt();
    let value = (left - right).abs() - reach;
    // The differences, products and sums on the left are off by at most ((1+ε)^4 - 1) times the magnitudes. On the right,
    // the root is off by 3ε of it, unless its square is so small that a product underflows, and the product by one more.
    let bound = 8.0 * EPSILON * (left.abs() + right.abs() + reach) + UNDERFLOW;
    if value.abs() > bound && square > 1e-290 {
        return value < 0.0;
    }
    exactly_near(u, v, p, most)
}

/// The sign of the dot product of `v` - `u` and `q` - `p`: whether `q` is ahead of `p`, seen along the direction from `u`
/// to `v`.
pub(crate) fn dot_sign(u: DVec2, v: DVec2, p: DVec2, q: DVec2) -> Ordering {
    cross_sign(u, v, p.perp(), q.perp())
}

#[cold]
fn exactly_near(u: DVec2, v: DVec2, p: DVec2, most: f64) -> bool {
    let differences = Differences::new([(v.x, u.x), (v.y, u.y), (p.x, u.x), (p.y, u.y), (most, 0.0)]);
    let [x, y, px, py, most]: [Unbounded; 5] = differences.integers();
    let area = x.mul(&py).sub(&y.mul(&px));
    let reach = most.mul(&most).mul(&x.mul(&x).add(&y.mul(&y)));
    area.mul(&area).sub(&reach).sign().is_le()
}
