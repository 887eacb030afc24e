//! The plane: orientation and the in-circle test, as the sine of the sum of the opposite angles.

use super::exact::{Grid, Int, Ring, difference_is_exact};
use glam::DVec2;
use std::cmp::Ordering;

/// Unit roundoff of f64.
const EPSILON: f64 = f64::EPSILON / 2.0;

/// Integers up to this width keep degree 4 within i128: a cross or dot product of two such vectors is below
/// 2^61, the product of two of those below 2^122, the sum of two below 2^123.
const NARROW_BITS: u32 = 30;

/// The sign of cross(λ)·dot(γ) + dot(λ)·cross(γ), where λ = angle at `c` and γ = angle at `d`, opposite to
/// the edge (`a`, `b`) of the triangles (a, b, c) and (b, a, d): negative when λ + γ > π, for
/// counter-clockwise triangles. It is minus the in-circle determinant.
pub(crate) fn in_circle_sign(a: DVec2, b: DVec2, c: DVec2, d: DVec2) -> Ordering {
    let (p, q, r, s) = (a - c, b - c, a - d, b - d);
    let (cross1, dot1, cross2, dot2) = (p.perp_dot(q), p.dot(q), s.perp_dot(r), s.dot(r));
    let value = cross1 * dot2 + dot1 * cross2;
    // Each difference, product and sum has a relative error of at most ε. A cross or dot product so differs
    // from the true one by at most ((1+ε)^4 - 1) of the sum of the magnitudes of its two products, the value
    // by at most ((1+ε)^10 - 1) < 10.1ε of `magnitude` taken with the true differences, which is at most
    // (1+ε)^10 times the computed one. No f32 input can overflow or underflow f64 here.
    let (pa, qa, ra, sa) = (p.abs(), q.abs(), r.abs(), s.abs());
    let magnitude = (pa.x * qa.y + pa.y * qa.x) * sa.dot(ra) + pa.dot(qa) * (sa.x * ra.y + sa.y * ra.x);
    if value.abs() > 16.0 * EPSILON * magnitude {
        return sign(value);
    }
    in_circle_exact(a, b, c, d)
}

/// The sign of the area of (a, b, c): positive when counter-clockwise.
pub(crate) fn area_sign(a: DVec2, b: DVec2, c: DVec2) -> Ordering {
    let (p, q) = (a - c, b - c);
    let (left, right) = (p.x * q.y, p.y * q.x);
    let value = left - right;
    // As above: ((1+ε)^4 - 1) of the sum of the magnitudes.
    if value.abs() > 8.0 * EPSILON * (left.abs() + right.abs()) {
        return sign(value);
    }
    let points = [a.x, a.y, b.x, b.y, c.x, c.y];
    let [ax, ay, bx, by, cx, cy] = Grid::new(&points).wide::<12>();
    let cross = ax.sub(&cx).mul(&by.sub(&cy)).sub(&ay.sub(&cy).mul(&bx.sub(&cx)));
    cross.sign()
}

/// The sign of the sum of the areas of triangles.
pub(crate) fn total_area_sign(triangles: impl Iterator<Item = [DVec2; 3]> + Clone) -> Ordering {
    let mut sum = 0.0;
    let mut magnitude = 0.0;
    let mut count = 0.0;
    for [a, b, c] in triangles.clone() {
        let (p, q) = (a - c, b - c);
        let (left, right) = (p.x * q.y, p.y * q.x);
        sum += left - right;
        magnitude += left.abs() + right.abs();
        count += 1.0;
    }
    // Each term errs by at most 5ε of its magnitude; summing n terms one after the other by (n - 1)ε of the
    // sum of the magnitudes.
    if sum.abs() > (count + 8.0) * 2.0 * EPSILON * magnitude {
        return sign(sum);
    }
    // Every f32 is an integer times 2^-149; a term is below 2^(2·278 + 1), and there are fewer than 2^32.
    let unit = |x: f64| {
        let (mantissa, exponent) = super::exact::decode(x);
        Int::<12>::new(mantissa, if mantissa == 0 { 0 } else { (exponent + 149) as u32 })
    };
    let mut sum = Int::<12>::new(0, 0);
    for [a, b, c] in triangles {
        let [ax, ay, bx, by, cx, cy] = [a.x, a.y, b.x, b.y, c.x, c.y].map(unit);
        sum = sum.add(&ax.sub(&cx).mul(&by.sub(&cy)).sub(&ay.sub(&cy).mul(&bx.sub(&cx))));
    }
    sum.sign()
}

fn in_circle_exact(a: DVec2, b: DVec2, c: DVec2, d: DVec2) -> Ordering {
    let pairs = [(a, c), (b, c), (a, d), (b, d)];
    if pairs.iter().all(|(u, v)| difference_is_exact(u.x, v.x) && difference_is_exact(u.y, v.y)) {
        let [p, q, r, s] = pairs.map(|(u, v)| u - v);
        let grid = Grid::new(&[p.x, p.y, q.x, q.y, r.x, r.y, s.x, s.y]);
        return if grid.bits <= NARROW_BITS {
            in_circle(&grid.narrow())
        } else {
            in_circle(&grid.wide::<20>())
        };
    }
    let [ax, ay, bx, by, cx, cy, dx, dy] = Grid::new(&[a.x, a.y, b.x, b.y, c.x, c.y, d.x, d.y]).wide::<20>();
    in_circle(&[
        ax.sub(&cx),
        ay.sub(&cy),
        bx.sub(&cx),
        by.sub(&cy),
        ax.sub(&dx),
        ay.sub(&dy),
        bx.sub(&dx),
        by.sub(&dy),
    ])
}

/// The polynomial of [`in_circle_sign`] over exact differences p, q, r, s (x and y of each).
fn in_circle<R: Ring>([px, py, qx, qy, rx, ry, sx, sy]: &[R; 8]) -> Ordering {
    let cross1 = px.mul(qy).sub(&py.mul(qx));
    let dot1 = px.mul(qx).add(&py.mul(qy));
    let cross2 = sx.mul(ry).sub(&sy.mul(rx));
    let dot2 = sx.mul(rx).add(&sy.mul(ry));
    cross1.mul(&dot2).add(&dot1.mul(&cross2)).sign()
}

fn sign(x: f64) -> Ordering {
    x.partial_cmp(&0.0).unwrap_or(Ordering::Equal)
}
