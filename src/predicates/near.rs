//! Whether points are near a line, and their order along it.

use super::crossings::Segment;
use super::exact::{Differences, Ring, Unbounded};
use super::plane::{EPSILON, UNDERFLOW, sign};
use glam::DVec2;
use std::cmp::Ordering;

/// Whether the distance of `p` from the line through the ends of a segment, which differ, is at most `most`: a finite
/// number that is not negative.
pub(crate) fn is_near([u, v]: Segment, p: DVec2, most: f64) -> bool {
    let (along, across) = (v - u, p - u);
    let (left, right) = (along.x * across.y, along.y * across.x);
    let square = along.length_squared();
    let reach = most * square.sqrt();
    let value = (left - right).abs() - reach;
    // The products of the area are off by at most ((1+ε)^4 - 1) of their magnitudes, and by underflow; the reach by less
    // than 5ε of itself, unless a product of the square underflows.
    let bound = 8.0 * EPSILON * (left.abs() + right.abs() + reach) + UNDERFLOW;
    if value.abs() > bound && square > 1e-290 {
        return value < 0.0;
    }
    let differences = Differences::new([(v.x, u.x), (v.y, u.y), (p.x, u.x), (p.y, u.y), (most, 0.0)]);
    let [x, y, px, py, most]: [Unbounded; 5] = differences.integers();
    let area = x.mul(&py).sub(&y.mul(&px));
    let reach = most.mul(&most).mul(&x.mul(&x).add(&y.mul(&y)));
    area.mul(&area).sub(&reach).sign().is_le()
}

/// The order of two points along the direction of a segment: `Less` if `p` comes before `q`.
pub(crate) fn compare_along([u, v]: Segment, p: DVec2, q: DVec2) -> Ordering {
    // (v - u) · (q - p), as an area.
    compare_across([u, v], p.perp(), q.perp())
}

/// The order of two points across the direction of a segment, from right to left.
pub(crate) fn compare_across([u, v]: Segment, p: DVec2, q: DVec2) -> Ordering {
    let (along, apart) = (v - u, p - q);
    let (left, right) = (along.x * apart.y, along.y * apart.x);
    let value = left - right;
    // As in `area_sign`.
    if value.abs() > 8.0 * EPSILON * (left.abs() + right.abs()) + UNDERFLOW {
        return sign(value);
    }
    let differences = Differences::new([(v.x, u.x), (v.y, u.y), (p.x, q.x), (p.y, q.y)]);
    let [x, y, px, py]: [Unbounded; 4] = differences.integers();
    x.mul(&py).sub(&y.mul(&px)).sign()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::array;

    /// By integers of 128 bits, for coordinates that are small integers.
    #[test]
    fn lattices_agree_with_integers() {
        let mut random = oorandom::Rand64::new(7);
        let mut counts = [0; 2];
        for _ in 0..20_000 {
            let [u, v, p, q]: [[i128; 2]; 4] =
                array::from_fn(|_| array::from_fn(|_| i128::from(random.rand_range(0..40)) - 20));
            if u == v {
                continue;
            }
            let most = random.rand_range(0..5) as i128;
            let minus = |a: [i128; 2], b: [i128; 2]| [a[0] - b[0], a[1] - b[1]];
            let (d, w, z) = (minus(v, u), minus(p, u), minus(p, q));
            let dot = |a: [i128; 2], b: [i128; 2]| a[0] * b[0] + a[1] * b[1];
            let cross = |a: [i128; 2], b: [i128; 2]| a[0] * b[1] - a[1] * b[0];
            // At any scale and with any offset that the floats hold.
            let scale = libm::scalbn(1.0, random.rand_range(0..1000) as i32 - 500);
            let offset = if random.rand_range(0..2) == 0 { 0.0 } else { libm::scalbn(scale, 45) };
            let point = |a: [i128; 2]| DVec2::from_array(a.map(|x| x as f64 * scale + offset));
            let line = [point(u), point(v)];
            let near = cross(d, w).pow(2) <= most.pow(2) * dot(d, d);
            counts[usize::from(near)] += 1;
            assert_eq!(is_near(line, point(p), most as f64 * scale), near);
            assert_eq!(compare_along(line, point(p), point(q)), dot(d, z).cmp(&0));
            assert_eq!(compare_across(line, point(p), point(q)), cross(d, z).cmp(&0));
        }
        assert!(counts[0] > 1000 && counts[1] > 1000);
    }

    #[test]
    fn a_number_decides_by_its_last_bit() {
        // The distance of (1, 3) from the line through (0, 0) and (4, 3) is 9/5.
        let line = [DVec2::ZERO, DVec2::new(4.0, 3.0)];
        let p = DVec2::new(1.0, 3.0);
        for exponent in [0, -1000, 900] {
            let scale = libm::scalbn(1.0, exponent);
            let [line, p] = [[line[0], line[1]], [p, p]].map(|points| points.map(|point| point * scale));
            // 1.8 is above 9/5.
            assert!(is_near(line, p[0], 1.8 * scale) && !is_near(line, p[0], 1.8f64.next_down() * scale));
        }
        let [x, y] = [1e300, 1e-300];
        let line = [DVec2::new(-x, 0.0), DVec2::new(x, y)];
        assert!(is_near(line, DVec2::new(0.0, y / 2.0), 0.0));
        assert!(!is_near(line, DVec2::new(0.0, y), y / 4.0) && is_near(line, DVec2::new(0.0, y), y / 2.0));
    }
}
