//! Where bisectors of points in the plane meet each other and lines along the axes. Each coordinate is the exact one,
//! rounded once: equal coordinates have equal bits, and the order of others never turns over.

use super::exact::{Differences, Ring, Unbounded, quotient};
use super::plane::{EPSILON, UNDERFLOW, sign};
use super::rounded::{Double, Polynomial, cross, in_unit, rounded, rounded_quickly};
use glam::DVec2;
use std::array;
use std::cmp::Ordering;

/// A line of all points whose x, on axis 0, or y, on axis 1, is a number.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Line {
    pub(crate) axis: usize,
    pub(crate) at: f64,
}

/// The circumcentre of (a, b, c), which is counter-clockwise. A coordinate beyond the range of f64 is infinite.
#[inline(always)]
pub(crate) fn circumcentre(corners: [DVec2; 3]) -> DVec2 {
    // Adding 0 turns -0 into 0.
    quick_circumcentre(corners).unwrap_or_else(|| slow_circumcentre(corners)) + DVec2::ZERO
}

/// In f64: with p = b - a and q = c - a, the centre is a + (|p|² q.y - |q|² p.y, p.x |q|² - q.x |p|²) / (2 p × q).
#[inline(always)]
fn quick_circumcentre([a, b, c]: [DVec2; 3]) -> Option<DVec2> {
    let (p, q) = (b - a, c - a);
    let [pp, qq] = [p, q].map(DVec2::length_squared);
    // At most seven roundings: p and q have one, their squares four, and the products and their difference two.
    let cross = |ax: f64, ay: f64, bx: f64, by: f64| {
        let [left, right] = [ax * by, ay * bx];
        [left - right, left.abs() + right.abs()]
    };
    let doubled = cross(p.x, p.y, q.x, q.y).map(|x| 2.0 * x);
    let x = rounded_quickly(a.x, cross(pp, qq, p.y, q.y), doubled)?;
    let y = rounded_quickly(a.y, cross(p.x, q.x, pp, qq), doubled)?;
    // Then the squares are not off by underflow.
    (pp.min(qq) > 1e-290).then(|| DVec2::new(x, y))
}

/// The same with twice the precision.
fn slow_circumcentre([a, b, c]: [DVec2; 3]) -> DVec2 {
    let slow = || {
        let [p, q] = [b, c].map(|v| [Double::difference(v.x, a.x), Double::difference(v.y, a.y)]);
        let ([px, py, qx, qy], unit) = in_unit([p[0], p[1], q[0], q[1]])?;
        let squares = [cross([px, py], [-py, px]).value, cross([qx, qy], [-qy, qx]).value];
        let doubled = cross([px, py], [qx, qy]).doubled();
        let x = rounded(a.x, cross(squares, [py, qy]), doubled, unit)?;
        let y = rounded(a.y, cross([px, qx], squares), doubled, unit)?;
        Some(DVec2::new(x, y))
    };
    slow().unwrap_or_else(|| exact_circumcentre([a, b, c]))
}

#[cold]
fn exact_circumcentre(corners: [DVec2; 3]) -> DVec2 {
    let [x, y] = array::from_fn(|axis| centre_from(corners, Line { axis, at: 0.0 }).rounded());
    DVec2::new(x, y)
}

/// Where the circumcentre of (a, b, c), which is counter-clockwise, is on the axis, compared with the line.
#[cold]
pub(crate) fn compare_circumcentre(corners: [DVec2; 3], line: Line) -> Ordering {
    centre_from(corners, line).numerator.sign()
}

/// Where the bisector of two points meets a line: the coordinate on the other axis. The points differ on that axis.
pub(crate) fn crossing(p: DVec2, q: DVec2, Line { axis, at }: Line) -> f64 {
    let [p, q] = [p, q].map(|v| if axis == 0 { [v.x, v.y] } else { [v.y, v.x] });
    // The vectors d = q - p and w = (v - p) + (v - q) are at right angles for v on the bisector.
    let quick = || {
        let [across, along] = [0, 1].map(|i| Double::difference(q[i], p[i]));
        let ends = [p, q].map(|v| Double::difference(at, v[0]));
        let ([across, along, first, second], unit) = in_unit([across, along, ends[0], ends[1]])?;
        let numerator = cross([along, across], [first + second, along]);
        rounded(p[1], numerator, Polynomial { value: along, size: along.abs() }.doubled(), unit)
    };
    quick().unwrap_or_else(|| exact_crossing(p, q, at)) + 0.0
}

#[cold]
fn exact_crossing(p: [f64; 2], q: [f64; 2], at: f64) -> f64 {
    let ([across, along, first, second, base, _], exponent) =
        integers([(q[0], p[0]), (q[1], p[1]), (at, p[0]), (at, q[0]), (p[1], 0.0), NOTHING]);
    let denominator = along.add(&along);
    let numerator = along.mul(&along).sub(&across.mul(&first.add(&second)));
    let numerator = numerator.add(&base.mul(&denominator));
    Ratio { numerator, denominator, exponent }.rounded()
}

/// The distance of `v` from `p`, compared with that from `q`.
pub(crate) fn nearer(p: DVec2, q: DVec2, v: DVec2) -> Ordering {
    let (d, first, second) = (q - p, v - p, v - q);
    let value = d.dot(first + second);
    // As in `in_circle_sign`, with five roundings.
    let size = d.abs().dot(first.abs() + second.abs());
    if value.abs() > 8.0 * EPSILON * size + UNDERFLOW {
        return sign(value);
    }
    exactly_nearer(p, q, v)
}

#[cold]
fn exactly_nearer(p: DVec2, q: DVec2, v: DVec2) -> Ordering {
    let ([dx, dy, px, py, qx, qy], _) =
        integers([(q.x, p.x), (q.y, p.y), (v.x, p.x), (v.y, p.y), (v.x, q.x), (v.y, q.y)]);
    dx.mul(&px.add(&qx)).add(&dy.mul(&py.add(&qy))).sign()
}

const NOTHING: (f64, f64) = (0.0, 0.0);

/// The differences of pairs of numbers as integers, and the exponent of their unit. One function for all, with the number
/// of pairs that the in-circle test has, because a module of the npm package is smaller with it.
#[inline(never)]
fn integers(pairs: [(f64, f64); 6]) -> ([Unbounded; 6], i32) {
    let [a, b, c, d, e, f] = pairs;
    let differences = Differences::new([a, b, c, d, e, f, NOTHING, NOTHING]);
    let [a, b, c, d, e, f, ..] = differences.integers();
    ([a, b, c, d, e, f], differences.unit)
}

/// `numerator / denominator * 2^exponent`.
struct Ratio {
    numerator: Unbounded,
    denominator: Unbounded,
    exponent: i32,
}

impl Ratio {
    fn rounded(&self) -> f64 {
        quotient(&self.numerator, &self.denominator, self.exponent)
    }
}

/// Where the circumcentre is, from the line. The denominator is positive.
fn centre_from([a, b, c]: [DVec2; 3], Line { axis, at }: Line) -> Ratio {
    let ([px, py, qx, qy, base, _], exponent) =
        integers([(b.x, a.x), (b.y, a.y), (c.x, a.x), (c.y, a.y), (a[axis], at), NOTHING]);
    let cross = |ax: &Unbounded, ay: &Unbounded, bx: &Unbounded, by: &Unbounded| ax.mul(by).sub(&ay.mul(bx));
    let squares = [(&px, &py), (&qx, &qy)].map(|(x, y)| x.mul(x).add(&y.mul(y)));
    let area = cross(&px, &py, &qx, &qy);
    let denominator = area.add(&area);
    let from_a = if axis == 0 {
        cross(&squares[0], &squares[1], &py, &qy)
    } else {
        cross(&px, &qx, &squares[0], &squares[1])
    };
    let numerator = from_a.add(&base.mul(&denominator));
    Ratio { numerator, denominator, exponent }
}

#[cfg(test)]
mod tests {
    use super::super::area_sign;
    use super::*;
    use proptest::prelude::*;

    /// Numbers of one size, neighbours in a lattice up to one unit in the last place, and numbers of all sizes.
    fn points() -> impl Strategy<Value = [DVec2; 3]> {
        let unit = || -1.0f64..1.0;
        let nudged = || {
            (0i32..6, -1i64..2).prop_map(|(i, ulps)| {
                let x = 0.1 * f64::from(i) + 7.0;
                f64::from_bits(x.to_bits().wrapping_add_signed(ulps))
            })
        };
        let any = || (unit(), -1074i32..1024).prop_map(|(x, e)| libm::scalbn(x, e));
        let flat = (unit(), unit(), 0i64..4).prop_map(|(x, y, ulps)| {
            let p = DVec2::new(x, y);
            let far = f64::from_bits((3.0 * x).to_bits().wrapping_add_signed(ulps));
            [p, DVec2::new(far, 3.0 * y), 2.0 * p]
        });
        let three = |number: BoxedStrategy<f64>| {
            [(); 3].map(|()| [number.clone(), number.clone()].prop_map(DVec2::from))
        };
        prop_oneof![three(unit().boxed()), three(nudged().boxed()), three(any().boxed()), flat]
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]

        #[test]
        fn quick_results_are_the_exact_ones(points in points(), axis in 0usize..2, e in -1074i32..1024) {
            let [a, mut b, mut c] = points;
            if area_sign(a, b, c).is_lt() {
                (b, c) = (c, b);
            }
            if area_sign(a, b, c).is_gt() {
                let centre = circumcentre([a, b, c]);
                prop_assert_eq!(centre, exact_circumcentre([a, b, c]));
                prop_assert_eq!(centre, slow_circumcentre([a, b, c]));
                let order = |at: f64| compare_circumcentre([a, b, c], Line { axis, at });
                if centre[axis].is_finite() {
                    prop_assert!(order(centre[axis].next_up()).is_le() && order(centre[axis].next_down()).is_ge());
                }
            }
            prop_assert_eq!(nearer(a, b, c), exactly_nearer(a, b, c));
            prop_assert_eq!(nearer(a, b, c), nearer(b, a, c).reverse());
            for at in [c[axis], a[axis], libm::scalbn(0.7, e)] {
                if a[1 - axis] != b[1 - axis] {
                    let [p, q] = [a, b].map(|v| [v[axis], v[1 - axis]]);
                    let line = Line { axis, at };
                    prop_assert_eq!(crossing(a, b, line), exact_crossing(p, q, at));
                    prop_assert_eq!(crossing(a, b, line).to_bits(), crossing(b, a, line).to_bits());
                }
            }
        }
    }
}
