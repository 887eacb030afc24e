//! The audit's own exact tests: an f64 evaluation if it is far enough from zero, or else integers.

use glam::DVec3;
use num_bigint::{BigInt, Sign};
use robust::Coord;
use std::cmp::Ordering;

/// Three points p, q, r. The normal is (p - r) × (q - r), and the angle is the one at r.
pub(super) type Triangle = [DVec3; 3];

/// Relative error bound of every f64 evaluation below. Let u = 2^-53 and s = |p - r|·|q - r|. A component of the normal
/// is off by at most 8us, the normal by 16us, its length by 24us, and the dot product at r by 8us. A product of two
/// such terms of triangles with s1 and s2 is off by 64u·s1·s2, and the sum of two products by 150u·s1·s2, which is
/// below 1.7e-14·s1·s2. The bound holds only for [`ordinary`] coordinates.
const BOUND: f64 = 1e-13;

/// Whether each number is 0 or has a magnitude from 2^-160 to 2^160. Such numbers and their differences are multiples
/// of 2^-212. So a polynomial of degree 4 in the differences, and each of its terms, is 0 or has a magnitude from
/// 2^-848 to 2^660: nothing overflows or underflows, also not in `robust`.
fn ordinary(numbers: &[f64]) -> bool {
    numbers.iter().all(|&x| x == 0.0 || (LEAST..=1.0 / LEAST).contains(&x.abs()))
}

/// 2^-160.
const LEAST: f64 = f64::from_bits((1023 - 160) << 52);

struct Corner {
    normal: DVec3,
    dot: f64,
    /// |p - r|·|q - r|, to which the errors are relative; infinite if the bound does not hold.
    size: f64,
}

impl Corner {
    fn new([p, q, r]: Triangle) -> Self {
        let (x, y) = (p - r, q - r);
        let is_ordinary = [p, q, r].iter().all(|p| ordinary(&p.to_array()));
        let size = if is_ordinary { x.length() * y.length() } else { f64::INFINITY };
        Self { normal: x.cross(y), dot: x.dot(y), size }
    }
}

struct ExactCorner {
    normal: [BigInt; 3],
    dot: BigInt,
}

impl ExactCorner {
    fn new([p, q, r]: &[[BigInt; 3]; 3]) -> Self {
        let from_r = |s: &[BigInt; 3]| [&s[0] - &r[0], &s[1] - &r[1], &s[2] - &r[2]];
        let (x, y) = (from_r(p), from_r(q));
        let minor = |i: usize, j: usize| &x[i] * &y[j] - &x[j] * &y[i];
        Self { normal: [minor(1, 2), minor(2, 0), minor(0, 1)], dot: dot(&x, &y) }
    }

    fn squared(&self) -> BigInt {
        dot(&self.normal, &self.normal)
    }
}

fn dot(x: &[BigInt; 3], y: &[BigInt; 3]) -> BigInt {
    &x[0] * &y[0] + &x[1] * &y[1] + &x[2] * &y[2]
}

/// Mantissa and exponent with x = mantissa · 2^exponent; the mantissa is odd, or 0.
fn decode(x: f64) -> (i64, i32) {
    if x == 0.0 {
        return (0, 0);
    }
    let bits = x.to_bits();
    let biased = (bits >> 52 & 0x7ff) as i32;
    let fraction = (bits & ((1 << 52) - 1)) as i64;
    let (mantissa, exponent) =
        if biased == 0 { (fraction, -1074) } else { (fraction | 1 << 52, biased - 1075) };
    let zeros = mantissa.trailing_zeros();
    let odd = mantissa >> zeros;
    (if x < 0.0 { -odd } else { odd }, exponent + zeros as i32)
}

/// The corners of both triangles as integers, all scaled by the same power of two.
fn exact_corners(first: Triangle, second: Triangle) -> [ExactCorner; 2] {
    let unit = ExactSum::unit(first.iter().chain(&second).flat_map(|p| p.to_array()));
    [first, second]
        .map(|triangle| ExactCorner::new(&triangle.map(|p| p.to_array().map(|x| integer(x, unit)))))
}

/// `x` in units of 2^`unit`, of which it is a multiple.
fn integer(x: f64, unit: i32) -> BigInt {
    let (mantissa, exponent) = decode(x);
    if mantissa == 0 { BigInt::ZERO } else { BigInt::from(mantissa) << (exponent - unit) as u32 }
}

fn sign(x: &BigInt) -> Ordering {
    match x.sign() {
        Sign::Minus => Ordering::Less,
        Sign::NoSign => Ordering::Equal,
        Sign::Plus => Ordering::Greater,
    }
}

/// The sign of x·√m + y·√n. m and n are not negative.
fn sign_of_sum(x: &BigInt, m: &BigInt, y: &BigInt, n: &BigInt) -> Ordering {
    let (left, right) = (sign(&(x * m)), sign(&(y * n)));
    if left == Ordering::Equal || left == right {
        return right;
    }
    if right == Ordering::Equal {
        return left;
    }
    match (x * x * m).cmp(&(y * y * n)) {
        Ordering::Greater => left,
        Ordering::Equal => Ordering::Equal,
        Ordering::Less => right,
    }
}

/// The sign of |n1|·dot2 + |n2|·dot1: `Less` if the angles at the third points sum to more than π.
pub(super) fn sum_of_angles(first: Triangle, second: Triangle) -> Ordering {
    let (one, two) = (Corner::new(first), Corner::new(second));
    let value = one.normal.length() * two.dot + two.normal.length() * one.dot;
    if value.abs() > BOUND * one.size * two.size {
        return value.total_cmp(&0.0);
    }
    let [one, two] = exact_corners(first, second);
    sign_of_sum(&two.dot, &one.squared(), &one.dot, &two.squared())
}

/// Compares the angles at the third points of two triangles that are not flat.
pub(super) fn compare_angles(first: Triangle, second: Triangle) -> Ordering {
    let (one, two) = (Corner::new(first), Corner::new(second));
    let value = one.normal.length() * two.dot - two.normal.length() * one.dot;
    if value.abs() > BOUND * one.size * two.size {
        return value.total_cmp(&0.0);
    }
    let [one, two] = exact_corners(first, second);
    sign_of_sum(&two.dot, &one.squared(), &-one.dot, &two.squared())
}

/// Whether the angle between the normals is larger than acos(`cosine`): n1·n2 < cosine·|n1|·|n2|. False for a zero
/// normal.
pub(super) fn normals_differ(first: Triangle, second: Triangle, cosine: f64) -> bool {
    let (one, two) = (Corner::new(first), Corner::new(second));
    let value = one.normal.dot(two.normal) - cosine * (one.normal.length() * two.normal.length());
    if value.abs() > BOUND * one.size * two.size {
        return value < 0.0;
    }
    let [one, two] = exact_corners(first, second);
    let (mantissa, exponent) = decode(cosine);
    let mut product = dot(&one.normal, &two.normal);
    let mut cosine = BigInt::from(-mantissa);
    if exponent < 0 {
        product <<= exponent.unsigned_abs();
    } else {
        cosine <<= exponent as u32;
    }
    let lengths = one.squared() * two.squared();
    sign_of_sum(&product, &BigInt::from(1), &cosine, &lengths) == Ordering::Less
}

/// Whether the normals have a strictly negative dot product.
pub(super) fn normals_oppose(first: Triangle, second: Triangle) -> bool {
    let (one, two) = (Corner::new(first), Corner::new(second));
    let value = one.normal.dot(two.normal);
    if value.abs() > BOUND * one.size * two.size {
        return value < 0.0;
    }
    let [one, two] = exact_corners(first, second);
    dot(&one.normal, &two.normal).sign() == Sign::Minus
}

/// Whether the lines through a, b and through c, d are further apart than `most`. False for parallel lines.
pub(super) fn lines_apart([a, b, c, d]: [DVec3; 4], most: f64) -> bool {
    let (x, y, z) = (b - a, d - c, c - a);
    let across = x.cross(y);
    let value = across.dot(z).abs() - most * across.length();
    let size = x.length() * y.length() * (z.length() + most);
    if [a, b, c, d].iter().all(|p| ordinary(&p.to_array())) && ordinary(&[most]) && value.abs() > BOUND * size
    {
        return value > 0.0;
    }
    let numbers = [a, b, c, d, DVec3::new(most, 0.0, 0.0)].map(|p| p.to_array());
    let unit = ExactSum::unit(numbers.iter().flatten().copied());
    let [a, b, c, d, most] = numbers.map(|p| p.map(|x| integer(x, unit)));
    let minus = |u: &[BigInt; 3], v: &[BigInt; 3]| [&u[0] - &v[0], &u[1] - &v[1], &u[2] - &v[2]];
    let corner = ExactCorner::new(&[minus(&b, &a), minus(&d, &c), [(); 3].map(|()| BigInt::ZERO)]);
    let (volume, [most, ..]) = (dot(&corner.normal, &minus(&c, &a)), most);
    &volume * &volume > &most * &most * corner.squared()
}

/// If the triangle's points are collinear, the sign of the dot product at the third point.
pub(super) fn flat(triangle: Triangle) -> Option<Ordering> {
    let corner = Corner::new(triangle);
    if corner.normal.length() > BOUND * corner.size {
        return None;
    }
    let [exact, _] = exact_corners(triangle, triangle);
    (exact.squared() == BigInt::ZERO).then(|| sign(&exact.dot))
}

/// The sign of the area of a triangle in the plane: `Greater` if it is counter-clockwise.
pub(super) fn turn(triangle: [Coord<f64>; 3]) -> Ordering {
    let [p, q, r] = triangle;
    if ordinary(&[p.x, p.y, q.x, q.y, r.x, r.y]) {
        return sign_of(robust::orient2d(p, q, r));
    }
    let triangle = triangle.map(in_space);
    let [corner, _] = exact_corners(triangle, triangle);
    sign(&corner.normal[2])
}

/// For the way from `p` to `q`, the sign of its part along the line from `u` to `v`, and of the part to the left of it.
pub(super) fn ahead([u, v]: [Coord<f64>; 2], [p, q]: [Coord<f64>; 2]) -> [Ordering; 2] {
    let (way, line) = ([q.x - p.x, q.y - p.y], [v.x - u.x, v.y - u.y]);
    let values = [line[0] * way[0] + line[1] * way[1], line[0] * way[1] - line[1] * way[0]];
    let size = line[0].hypot(line[1]) * way[0].hypot(way[1]);
    let numbers = [u.x, u.y, v.x, v.y, p.x, p.y, q.x, q.y];
    if ordinary(&numbers) && values.iter().all(|value| value.abs() > BOUND * size) {
        return values.map(sign_of);
    }
    let unit = ExactSum::unit(numbers.into_iter());
    let [ux, uy, vx, vy, px, py, qx, qy] = numbers.map(|x| integer(x, unit));
    let ([x, y], [a, b]) = ([vx - ux, vy - uy], [qx - px, qy - py]);
    [&x * &a + &y * &b, &x * &b - &y * &a].map(|value| sign(&value))
}

/// Whether the distance of `p` from the line through `u` and `v` is at most `most`.
pub(super) fn near([u, v]: [Coord<f64>; 2], p: Coord<f64>, most: f64) -> bool {
    let (line, way) = ([v.x - u.x, v.y - u.y], [p.x - u.x, p.y - u.y]);
    let (length, size) = (line[0].hypot(line[1]), way[0].hypot(way[1]) + most);
    let value = (line[0] * way[1] - line[1] * way[0]).abs() - most * length;
    let numbers = [u.x, u.y, v.x, v.y, p.x, p.y, most];
    if ordinary(&numbers) && value.abs() > BOUND * length * size {
        return value < 0.0;
    }
    let unit = ExactSum::unit(numbers.into_iter());
    let [ux, uy, vx, vy, px, py, most] = numbers.map(|x| integer(x, unit));
    let ([x, y], [a, b]) = ([vx - &ux, vy - &uy], [px - ux, py - uy]);
    let area = &x * b - &y * a;
    &area * &area <= &most * &most * (&x * &x + &y * &y)
}

/// The sign of the in-circle determinant: `Greater` if d is inside the circle of the counter-clockwise triangle a, b,
/// c. For any orientation it is the sign of the polynomial -(cross1·dot2 + dot1·cross2) of the angles at c and d.
pub(super) fn in_circle([a, b, c, d]: [Coord<f64>; 4]) -> Ordering {
    if ordinary(&[a.x, a.y, b.x, b.y, c.x, c.y, d.x, d.y]) {
        return sign_of(robust::incircle(a, b, c, d));
    }
    let [one, two] = exact_corners([a, b, c].map(in_space), [b, a, d].map(in_space));
    sign(&(&one.normal[2] * &two.dot + &one.dot * &two.normal[2])).reverse()
}

/// The sign of a number, which may be -0.
fn sign_of(x: f64) -> Ordering {
    (x + 0.0).total_cmp(&0.0)
}

fn in_space(p: Coord<f64>) -> DVec3 {
    DVec3::new(p.x, p.y, 0.0)
}

/// An exact sum of products of two numbers: integers in bins of 32 bits.
pub(super) struct ExactSum {
    /// Each number is a multiple of 2^unit.
    unit: i32,
    bins: Vec<i128>,
}

impl ExactSum {
    pub fn new(unit: i32) -> Self {
        Self { unit, bins: Vec::new() }
    }

    /// The exponent of the largest power of two of which all numbers are multiples.
    pub fn unit(numbers: impl Iterator<Item = f64>) -> i32 {
        numbers.filter(|&x| x != 0.0).map(|x| decode(x).1).min().unwrap_or(0)
    }

    /// Adds x·y. Fewer than 2^40 additions cannot overflow a bin: each half of a product is below 2^54, and is shifted
    /// by less than 32.
    pub fn add(&mut self, x: f64, y: f64) {
        let ((m, e), (n, f)) = (decode(x), decode(y));
        let product = i128::from(m) * i128::from(n);
        if product == 0 {
            return;
        }
        let low = (e + f - 2 * self.unit) as usize;
        let high = low + 53;
        if self.bins.len() <= high / 32 {
            self.bins.resize(high / 32 + 1, 0);
        }
        self.bins[low / 32] += (product & ((1 << 53) - 1)) << (low % 32);
        self.bins[high / 32] += (product >> 53) << (high % 32);
    }

    /// The sum, in units of 2^(2·unit).
    pub fn total(&self) -> BigInt {
        self.bins.iter().rev().fold(BigInt::ZERO, |sum, &bin| (sum << 32u32) + BigInt::from(bin))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn p(x: f32, y: f32, z: f32) -> DVec3 {
        DVec3::new(x.into(), y.into(), z.into())
    }

    #[test]
    fn ties_and_their_neighbours() {
        let (a, b, c) = (p(0., 0., 0.), p(1., 1., 0.), p(0., 1., 0.));
        let up = 1.0 + f32::EPSILON;
        for scale in [1.0, 1e30, 1e-38] {
            let s = f64::from(scale as f32);
            let test = |d: DVec3| sum_of_angles([a * s, b * s, c * s], [b * s, a * s, d * s]);
            assert_eq!(test(p(1., 0., 0.)), Ordering::Equal);
            if scale == 1.0 {
                assert_eq!(test(p(up, 0., 0.)), Ordering::Greater);
                assert_eq!(test(p(1. - f32::EPSILON, 0., 0.)), Ordering::Less);
                assert_eq!(test(p(1., 0., 1e-30)), Ordering::Greater);
            }
        }
    }

    #[test]
    fn angle_between_normals() {
        let first = [p(0., 0., 0.), p(1., 0., 0.), p(0., 1., 0.)];
        let second = |y: f32, z: f32| [p(1., 0., 0.), p(0., 0., 0.), p(0., y, z)];
        assert!(!normals_differ(first, second(-1., 0.), 1.0));
        assert!(normals_differ(first, second(-1., 1e-30), 1.0));
        assert!(!normals_differ(first, second(0., 1.), 0.0));
        assert!(normals_differ(first, second(1e-30, 1.), 0.0));
        assert!(!normals_differ(first, second(1., 0.), -1.0));
        assert!(!normals_differ(first, second(0., 0.), 1.0));
        assert!(normals_oppose(first, second(1e-30, 1.)) && !normals_oppose(first, second(0., 1.)));
        // 60 degrees, and their neighbours.
        let (first, second) =
            ([p(0., 0., 1.), p(1., -1., 0.), DVec3::ZERO], [p(1., 0., 0.), p(0., 1., -1.), DVec3::ZERO]);
        let differ = [0.5_f64.next_down(), 0.5, 0.5_f64.next_up()].map(|c| normals_differ(first, second, c));
        assert_eq!(differ, [false, false, true]);
    }

    #[test]
    fn flat_triangles() {
        let (a, b) = (p(0.1, 0.1, 0.1), p(0.3, 0.3, 0.3));
        assert_eq!(flat([a, b, p(0.2, 0.2, 0.2)]), Some(Ordering::Less));
        assert_eq!(flat([a, b, b]), Some(Ordering::Equal));
        assert_eq!(flat([a, b, p(0.4, 0.4, 0.4)]), Some(Ordering::Greater));
        assert_eq!(flat([a, b, p(0.2, 0.2, 0.200_000_02)]), None);
    }

    #[test]
    fn sums_keep_every_bit() {
        let tiny = f64::from_bits(1);
        let terms =
            [(f64::MAX, f64::MAX), (tiny, tiny), (-f64::MAX, f64::MAX), (tiny, -3.0 * tiny), (0.0, 5.0)];
        let mut sum = ExactSum::new(ExactSum::unit(terms.iter().flat_map(|&(x, y)| [x, y])));
        for (x, y) in terms {
            sum.add(x, y);
        }
        assert_eq!(sum.total(), BigInt::from(-2));
    }
}
