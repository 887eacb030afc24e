//! Where two lines cross, rounded once, and how far a point is from a segment.

use super::exact::{Differences, Ring, Unbounded, quotient};
use super::rounded::{Double, Polynomial, cross, in_unit, rounded, rounded_quickly};
use glam::DVec2;
use std::array;
use std::cmp::Ordering;

/// A segment, by its ends.
pub(crate) type Segment = [DVec2; 2];

/// Where the lines through two segments cross: each coordinate is the exact one, rounded once, to 32 bits unless
/// `is_double`. Infinite or NaN if the lines are parallel, and infinite beyond the range of the numbers.
pub(crate) fn line_crossing(first: Segment, second: Segment, is_double: bool) -> DVec2 {
    let doubles = quick(first, second)
        .or_else(|| slow(first, second))
        .unwrap_or_else(|| DVec2::from_array(array::from_fn(|axis| exact(first, second, axis))));
    // Adding 0 turns -0 into 0.
    let doubles = doubles + DVec2::ZERO;
    if is_double {
        return doubles;
    }
    DVec2::from_array(array::from_fn(|axis| {
        let double = doubles[axis];
        let single = double as f32;
        let other = if f64::from(single) < double { single.next_up() } else { single.next_down() };
        let middle = (f64::from(single) + f64::from(other)) / 2.0;
        if middle != double {
            return single.into();
        }
        // The exact number may be on either side of the middle of two 32-bit floats.
        let (low, high) = (single.min(other), single.max(other));
        f64::from(match side(first, second, axis, double) {
            Ordering::Less => low,
            Ordering::Equal => single,
            Ordering::Greater => high,
        })
    }))
}

/// In f64: with p = b - a, q = d - c and w = c - a, the crossing of a-b and c-d is a + (w × q) / (p × q) p.
fn quick([a, b]: Segment, [c, d]: Segment) -> Option<DVec2> {
    let (p, q, w) = (b - a, d - c, c - a);
    let cross = |u: DVec2, v: DVec2| {
        let [left, right] = [u.x * v.y, u.y * v.x];
        [left - right, left.abs() + right.abs()]
    };
    let (above, below) = (cross(w, q), cross(p, q));
    // At most six roundings: the differences have one each, the product and the difference two, the factor two.
    let along = |axis: usize| [above[0] * p[axis], above[1] * p[axis].abs()];
    let x = rounded_quickly(a.x, along(0), below)?;
    let y = rounded_quickly(a.y, along(1), below)?;
    // Then the products are not off by underflow.
    (above[1].min(below[1]) > 1e-290).then(|| DVec2::new(x, y))
}

/// The same with twice the precision.
fn slow([a, b]: Segment, [c, d]: Segment) -> Option<DVec2> {
    let minus = |u: DVec2, v: DVec2| [Double::difference(u.x, v.x), Double::difference(u.y, v.y)];
    let (p, q, w) = (minus(b, a), minus(d, c), minus(c, a));
    let ([px, py, qx, qy, wx, wy], unit) = in_unit([p[0], p[1], q[0], q[1], w[0], w[1]])?;
    let (above, below) = (cross([wx, wy], [qx, qy]), cross([px, py], [qx, qy]));
    let along = |p: Double| Polynomial { value: above.value * p, size: above.size * p.abs() };
    let x = rounded(a.x, along(px), below, unit)?;
    let y = rounded(a.y, along(py), below, unit)?;
    Some(DVec2::new(x, y))
}

#[cold]
fn exact(first: Segment, second: Segment, axis: usize) -> f64 {
    let (numerator, denominator, exponent) = from_line(first, second, axis, 0.0);
    if denominator.sign().is_eq() { f64::NAN } else { quotient(&numerator, &denominator, exponent) }
}

/// The coordinate of the crossing on the axis, compared with a number.
#[cold]
fn side(first: Segment, second: Segment, axis: usize, at: f64) -> Ordering {
    let (numerator, denominator, _) = from_line(first, second, axis, at);
    if denominator.sign().is_lt() { numerator.sign().reverse() } else { numerator.sign() }
}

/// The coordinate of the crossing less a number: a numerator, a denominator, and the exponent of their unit.
fn from_line([a, b]: Segment, [c, d]: Segment, axis: usize, at: f64) -> (Unbounded, Unbounded, i32) {
    let differences = Differences::new([
        (b.x, a.x),
        (b.y, a.y),
        (d.x, c.x),
        (d.y, c.y),
        (c.x, a.x),
        (c.y, a.y),
        (a[axis], at),
        (0.0, 0.0),
    ]);
    let [px, py, qx, qy, wx, wy, base, _] = differences.integers::<Unbounded>();
    let above = wx.mul(&qy).sub(&wy.mul(&qx));
    let below = px.mul(&qy).sub(&py.mul(&qx));
    let along = if axis == 0 { px } else { py };
    (above.mul(&along).add(&base.mul(&below)), below, differences.unit)
}

/// The distance of a point from a segment, in f64, with a relative error of a few units in the last place; `None` for
/// coordinates near the ends of the range of f64.
pub(crate) fn distance_from_segment([a, b]: Segment, point: DVec2) -> Option<f64> {
    let minus = |u: DVec2, v: DVec2| [Double::difference(u.x, v.x), Double::difference(u.y, v.y)];
    let (p, w, z) = (minus(b, a), minus(point, a), minus(point, b));
    let ([px, py, wx, wy, zx, zy], unit) = in_unit([p[0], p[1], w[0], w[1], z[0], z[1]])?;
    let dot = |[ax, ay]: [Double; 2], [bx, by]: [Double; 2]| (ax * bx + ay * by).high;
    let length = |x: Double, y: Double| libm::hypot(x.high, y.high);
    let distance = if dot([px, py], [wx, wy]) <= 0.0 {
        length(wx, wy)
    } else if dot([px, py], [zx, zy]) >= 0.0 {
        length(zx, zy)
    } else {
        cross([px, py], [wx, wy]).value.abs() / length(px, py)
    };
    Some(distance * unit)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "what fails here is a failed test")]

    use super::*;
    use proptest::prelude::*;

    /// Numbers of one size, neighbours in a lattice up to one unit in the last place, and numbers of all sizes.
    fn number() -> impl Strategy<Value = f64> {
        let nudged = (0i32..6, -1i64..2).prop_map(|(i, ulps)| {
            let x = 0.1 * f64::from(i) + 7.0;
            f64::from_bits(x.to_bits().wrapping_add_signed(ulps))
        });
        let any = (-1.0f64..1.0, -1074i32..1020).prop_map(|(x, e)| libm::scalbn(x, e));
        prop_oneof![4 => -1.0f64..1.0, 4 => nudged, 1 => any]
    }

    fn segment() -> impl Strategy<Value = Segment> {
        [number(), number(), number(), number()].prop_map(|[x, y, z, w]| [DVec2::new(x, y), DVec2::new(z, w)])
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]

        #[test]
        fn quick_crossings_are_the_exact_ones(first in segment(), second in segment()) {
            let want = DVec2::from_array([0, 1].map(|axis| exact(first, second, axis)));
            prop_assume!(want.is_finite());
            let found = line_crossing(first, second, true);
            prop_assert_eq!(found, want);
            prop_assert_eq!(quick(first, second).unwrap_or(want), want);
            prop_assert_eq!(slow(first, second).unwrap_or(want), want);
            let other_way = line_crossing([second[1], second[0]], first, true);
            prop_assert_eq!(other_way.to_array().map(f64::to_bits), found.to_array().map(f64::to_bits));
            let single = line_crossing(first, second, false);
            for axis in [0, 1] {
                let nearest = single[axis] as f32;
                if single[axis].is_finite() {
                    let [low, high] = [nearest.next_down(), nearest.next_up()]
                        .map(|other| (f64::from(other) + f64::from(nearest)) / 2.0);
                    prop_assert!(side(first, second, axis, low).is_ge());
                    prop_assert!(side(first, second, axis, high).is_le());
                }
            }
        }
    }

    /// The crossing is just above the middle of two 32-bit floats, and rounds to that middle in f64.
    #[test]
    fn a_crossing_is_rounded_once() {
        let middle = 1.0 + f64::from(f32::EPSILON) / 2.0;
        let tiny = libm::scalbn(1.0, -70);
        // x = middle + tiny, where y = 1 on a line from (middle, 0) by tiny in each unit of y.
        let first = [DVec2::new(middle, 0.0), DVec2::new(middle + 1.0, 1.0 / tiny)];
        let second = [DVec2::new(0.0, 1.0), DVec2::new(3.0, 1.0)];
        assert_eq!(line_crossing(first, second, true).x, middle);
        assert_eq!(line_crossing(first, second, false).x, 1.0 + f64::from(f32::EPSILON));
    }

    #[test]
    fn distances() {
        let segment = [DVec2::new(0.0, 0.0), DVec2::new(4.0, 0.0)];
        let distance = |x, y| distance_from_segment(segment, DVec2::new(x, y)).unwrap();
        assert_eq!([distance(1.0, -2.0), distance(-3.0, 4.0), distance(7.0, 4.0)], [2.0, 5.0, 5.0]);
        let near = [DVec2::new(1e6, 1e6), DVec2::new(3e6 + 1.0, 3e6 + 1.0)];
        let nudged = DVec2::new(2e6, 2e6f64.next_up());
        let found = distance_from_segment(near, nudged).unwrap();
        let want = (2e6f64.next_up() - 2e6) / 2f64.sqrt();
        assert!((found / want - 1.0).abs() < 1e-12);
    }
}
