//! The plane: orientation and the in-circle test, as the sine of the sum of the opposite angles.

use super::exact::{Bounded, Differences, Ring, Unbounded, decode, difference_is_exact};
use glam::{DVec2, Vec4};
use std::array;
use std::cmp::Ordering;

/// Unit roundoff of f64.
pub(super) const EPSILON: f64 = f64::EPSILON / 2.0;

/// A generous bound for the error that underflow adds to a filter. A product that underflows is off by at most η =
/// 2^-1075; sums and differences do not underflow. If anything overflows, the bound of the filter is infinite or NaN,
/// and the filter decides nothing.
pub(super) const UNDERFLOW: f64 = f64::MIN_POSITIVE;

/// With differences up to this width, degree 2 fits i64 and degree 4 fits i128: a cross or dot product of two such
/// vectors is below 2^61, the product of two of these is below 2^122, and a sum of two products is below 2^123.
pub(super) const NARROW_BITS: u32 = 30;

/// With differences up to this width, degree 2 fits i128: a cross or dot product of two such vectors is below 2^125.
pub(super) const MIDDLE_BITS: u32 = 62;

/// Whether there are tiers for ties of 64-bit floats and of lattices. Points have many ties. In the modules of the npm
/// package that run and repair meshes, which do without them, they would be 1.2 KB to download.
const HAS_TIERS_FOR_TIES: bool =
    cfg!(not(any(feature = "js-session", feature = "js-webgl2", feature = "js-untangle")));

/// With differences up to this width, degree 4 fits 20 limbs, 1280 bits: 4·319 + 3 = 1279. Differences of f32 have at
/// most 278 bits.
pub(super) const WIDE_BITS: u32 = 319;

/// The sign of cross(λ)·dot(γ) + dot(λ)·cross(γ), where λ and γ are the angles at `c` and `d`, opposite to the edge
/// (`a`, `b`) of the triangles (a, b, c) and (b, a, d). For counter-clockwise triangles it is negative if λ + γ > π. It
/// is the sign of minus the in-circle determinant.
#[inline(always)]
pub(crate) fn in_circle_sign(a: DVec2, b: DVec2, c: DVec2, d: DVec2) -> Ordering {
    let (p, q, r, s) = (a - c, b - c, a - d, b - d);
    let (cross1, dot1, cross2, dot2) = (p.perp_dot(q), p.dot(q), s.perp_dot(r), s.dot(r));
    let value = cross1 * dot2 + dot1 * cross2;
    // Without underflow, each difference, product and sum has a relative error of at most ε. So a cross or dot product
    // is off by at most ((1+ε)^4 - 1) times the sum of the magnitudes of its two products, and the value by at most
    // ((1+ε)^10 - 1) < 10.1ε times the sum of the magnitudes of its products. For the cross and the dot product of two
    // vectors, these magnitudes sum to the product of the 1-norms. So the sum of the magnitudes for the value is at
    // most the true `size1 * size2`, which is at most (1+ε)^9 times the computed one. Underflow puts each of the four
    // sums of products off by at most 2.1η, and so the value by at most 2.2η(size1 + size2) + 3η; its effect on the
    // sizes is smaller.
    let size = |v: DVec2| v.x.abs() + v.y.abs();
    let (size1, size2) = (size(p) * size(q), size(s) * size(r));
    if value.abs() > 16.0 * EPSILON * (size1 * size2) + UNDERFLOW * (size1 + size2 + 1.0) {
        return sign(value);
    }
    in_circle_exact(a, b, c, d)
}

/// The filter of [`in_circle_sign`] in f32, for four quads (a, b, c, d): a bit mask of the negative ones and one of the
/// positive ones. Quads in neither are undecided.
#[inline(always)]
pub(crate) fn in_circle_filter(quads: &[[&[f32; 2]; 4]; 4]) -> [u32; 2] {
    let [a, b, c, d] = array::from_fn(|k| by_coordinate(array::from_fn(|lane| quads[lane][k])));
    let minus = |u: [Vec4; 2], v: [Vec4; 2]| [u[0] - v[0], u[1] - v[1]];
    let (p, q, r, s) = (minus(a, c), minus(b, c), minus(a, d), minus(b, d));
    let cross = |u: [Vec4; 2], v: [Vec4; 2]| u[0] * v[1] - u[1] * v[0];
    let dot = |u: [Vec4; 2], v: [Vec4; 2]| u[0] * v[0] + u[1] * v[1];
    let value = cross(p, q) * dot(s, r) + dot(p, q) * cross(s, r);
    let size = |v: [Vec4; 2]| v[0].abs() + v[1].abs();
    let (size1, size2) = (size(p) * size(q), size(s) * size(r));
    // The bound of the f64 filter, with the ε and the η of f32. Differences do not underflow here either.
    let bound = size1 * size2 * (8.0 * f32::EPSILON) + (size1 + size2 + Vec4::ONE) * f32::MIN_POSITIVE;
    [value.cmplt(-bound).bitmask(), value.cmpgt(bound).bitmask()]
}

/// The x coordinates of four points, and the y coordinates.
#[cfg(not(any(target_feature = "simd128", target_arch = "x86_64")))]
#[inline(always)]
fn by_coordinate(points: [&[f32; 2]; 4]) -> [Vec4; 2] {
    array::from_fn(|i| Vec4::from_array(array::from_fn(|lane| points[lane][i])))
}

/// The same, with one load per point.
#[cfg(target_arch = "x86_64")]
#[expect(unsafe_code, reason = "for safe code, the compiler emits a load and an insertion per coordinate")]
#[inline(always)]
fn by_coordinate(points: [&[f32; 2]; 4]) -> [Vec4; 2] {
    use std::arch::x86_64::{_mm_castsi128_ps, _mm_set_epi64x, _mm_shuffle_ps};
    let bits = |p: &[f32; 2]| -> i64 { zerocopy::transmute!(*p) };
    // SAFETY: every x86-64 has SSE2.
    unsafe {
        let two = |p, q| _mm_castsi128_ps(_mm_set_epi64x(bits(q), bits(p)));
        let (first, second) = (two(points[0], points[1]), two(points[2], points[3]));
        [_mm_shuffle_ps::<0x88>(first, second).into(), _mm_shuffle_ps::<0xdd>(first, second).into()]
    }
}

/// The same.
#[cfg(target_feature = "simd128")]
#[expect(unsafe_code, reason = "for safe code, the compiler emits a load and an insertion per coordinate")]
#[inline(always)]
fn by_coordinate(points: [&[f32; 2]; 4]) -> [Vec4; 2] {
    use std::arch::wasm32::{u32x4_shuffle, v128_load64_lane, v128_load64_zero};
    let two = |p: &[f32; 2], q: &[f32; 2]| {
        // SAFETY: both references are to 8 bytes, and these loads accept any alignment.
        unsafe { v128_load64_lane::<1>(v128_load64_zero(p.as_ptr().cast()), q.as_ptr().cast()) }
    };
    let (first, second) = (two(points[0], points[1]), two(points[2], points[3]));
    [u32x4_shuffle::<0, 2, 4, 6>(first, second).into(), u32x4_shuffle::<1, 3, 5, 7>(first, second).into()]
}

/// The sign of the area of (a, b, c): positive when counter-clockwise.
#[inline]
pub(crate) fn area_sign(a: DVec2, b: DVec2, c: DVec2) -> Ordering {
    let (p, q) = (a - c, b - c);
    let (left, right) = (p.x * q.y, p.y * q.x);
    let value = left - right;
    // As in `in_circle_sign`: the error is at most ((1+ε)^4 - 1) times the sum of the magnitudes, plus 2.1η.
    if value.abs() > 8.0 * EPSILON * (left.abs() + right.abs()) + UNDERFLOW {
        return sign(value);
    }
    area_exact(a, b, c)
}

/// The sign of the sum of the areas of `count` triangles.
#[inline(never)] // else `triangle` would be inlined three times
pub(crate) fn total_area_sign(count: usize, triangle: &dyn Fn(usize) -> [DVec2; 3]) -> Ordering {
    let mut sum = 0.0;
    let mut magnitude = 0.0;
    for [a, b, c] in (0..count).map(triangle) {
        let (p, q) = (a - c, b - c);
        let (left, right) = (p.x * q.y, p.y * q.x);
        sum += left - right;
        magnitude += left.abs() + right.abs();
    }
    let terms = count as f64;
    // Each term is off by at most 5ε of its magnitude plus 2.1η. Summing n terms one after another adds at most (n -
    // 1)ε times the sum of the magnitudes.
    if sum.abs() > (terms + 8.0) * 2.0 * EPSILON * magnitude + terms * UNDERFLOW {
        return sign(sum);
    }
    let mut unit = i32::MAX;
    for p in (0..count).flat_map(triangle) {
        unit = unit.min(decode(p.x).1).min(decode(p.y).1);
    }
    let integer = |x: f64| {
        let (mantissa, exponent) = decode(x);
        Unbounded::new(mantissa, if mantissa == 0 { 0 } else { (exponent - unit) as u32 })
    };
    let mut sum = Unbounded::new(0, 0);
    for corners in (0..count).map(triangle) {
        let [a, b, c] = corners.map(|p| p.to_array().map(integer));
        let differences = [(&a, 0), (&a, 1), (&b, 0), (&b, 1)].map(|(point, i)| point[i].sub(&c[i]));
        sum = sum.add(&doubled_area(&differences));
    }
    sum.sign()
}

#[cold]
fn in_circle_exact(a: DVec2, b: DVec2, c: DVec2, d: DVec2) -> Ordering {
    // On each axis, one factor of the dot product is 0: right angles, as all ties of a lattice along the axes have.
    let is_right = |v: DVec2| (a.cmpeq(v) | b.cmpeq(v)).all();
    if is_right(c) && is_right(d) {
        return Ordering::Equal;
    }
    if HAS_TIERS_FOR_TIES && are_short(&[(a, c), (b, c), (a, d), (b, d)], 12) {
        let (p, q, r, s) = (a - c, b - c, a - d, b - d);
        return sign(p.perp_dot(q) * s.dot(r) + p.dot(q) * s.perp_dot(r));
    }
    let [p, q, r, s] = [(a, c), (b, c), (a, d), (b, d)].map(|(u, v)| [(u.x, v.x), (u.y, v.y)]);
    let differences = Differences::new([p[0], p[1], q[0], q[1], r[0], r[1], s[0], s[1]]);
    if differences.bits <= NARROW_BITS {
        let [cross1, dot1, cross2, dot2] = crosses_and_dots::<i64>(&differences.integers()).map(i128::from);
        (cross1 * dot2 + dot1 * cross2).cmp(&0)
    } else if HAS_TIERS_FOR_TIES && differences.bits <= MIDDLE_BITS {
        let [px, py, qx, qy, rx, ry, sx, sy] = differences.integers::<i64>().map(i128::from);
        let [cross1, dot1] = [px * qy - py * qx, px * qx + py * qy];
        let [cross2, dot2] = [sx * ry - sy * rx, sx * rx + sy * ry];
        // The sum is positive where the first product is greater than the negated second one.
        product(cross1, dot2).cmp(&product(-dot1, cross2))
    } else if differences.bits <= WIDE_BITS {
        in_circle::<Bounded<20>>(&differences.integers())
    } else {
        in_circle::<Unbounded>(&differences.integers())
    }
}

/// Whether f64 computes a polynomial of these differences without rounding, as it does for neighbours in a lattice: they
/// are exact, and whole multiples, below 2^`bits`, of a power of two. A polynomial of degree 2 needs at most 25 bits, and
/// one of degree 4 at most 12, so that its value is below 2^53.
fn are_short(pairs: &[(DVec2, DVec2)], bits: u32) -> bool {
    let largest = pairs.iter().fold(DVec2::ZERO, |most, &(u, v)| most.max((u - v).abs())).max_element();
    let power_of_two = f64::from_bits(largest.to_bits() >> 52 << 52);
    // To add this number rounds a difference to a multiple, because it has the power of two in its last place.
    let rounder = 1.5 * power_of_two * (1u64 << (53 - bits)) as f64;
    let is_multiple = |d: f64| (d + rounder) - rounder == d;
    #[cfg(test)]
    super::exact::count(bits);
    // Beyond this range, products could underflow or overflow.
    (1e-60..1e60).contains(&largest)
        && pairs.iter().all(|&(u, v)| {
            let d = u - v;
            is_multiple(d.x)
                && is_multiple(d.y)
                && difference_is_exact(u.x, v.x)
                && difference_is_exact(u.y, v.y)
        })
}

#[cold]
fn area_exact(a: DVec2, b: DVec2, c: DVec2) -> Ordering {
    if HAS_TIERS_FOR_TIES && are_short(&[(a, c), (b, c)], 25) {
        return sign((a - c).perp_dot(b - c));
    }
    let differences = Differences::new([(a.x, c.x), (a.y, c.y), (b.x, c.x), (b.y, c.y)]);
    if HAS_TIERS_FOR_TIES && differences.bits <= MIDDLE_BITS {
        let [px, py, qx, qy] = differences.integers::<i64>().map(i128::from);
        (px * qy).cmp(&(py * qx))
    } else if differences.bits <= WIDE_BITS {
        doubled_area::<Bounded<20>>(&differences.integers()).sign()
    } else {
        doubled_area::<Unbounded>(&differences.integers()).sign()
    }
}

/// The product of two numbers, of which neither is `i128::MIN`: its upper half, rounded down, and its lower half.
fn product(x: i128, y: i128) -> (i128, u128) {
    let halves = |x: u128| [x >> 64, x & u128::from(u64::MAX)];
    let ([a, b], [c, d]) = (halves(x.unsigned_abs()), halves(y.unsigned_abs()));
    let lowest = b * d;
    let middle = a * d + (lowest >> 64);
    let (middle, carry) = middle.overflowing_add(b * c);
    let upper = a * c + (middle >> 64) + (u128::from(carry) << 64);
    let lower = (middle << 64) | (lowest & u128::from(u64::MAX));
    if (x < 0) == (y < 0) {
        (upper as i128, lower)
    } else {
        ((!upper).wrapping_add(u128::from(lower == 0)) as i128, lower.wrapping_neg())
    }
}

/// The polynomial of [`area_sign`] over exact differences p, q (x and y of each).
fn doubled_area<R: Ring>([px, py, qx, qy]: &[R; 4]) -> R {
    px.mul(qy).sub(&py.mul(qx))
}

/// Cross and dot product of p and q, then of s and r, from x and y of p, q, r, s.
fn crosses_and_dots<R: Ring>([px, py, qx, qy, rx, ry, sx, sy]: &[R; 8]) -> [R; 4] {
    let dot = |[ax, ay]: [&R; 2], [bx, by]: [&R; 2]| ax.mul(bx).add(&ay.mul(by));
    let cross = |[ax, ay]: [&R; 2], [bx, by]: [&R; 2]| ax.mul(by).sub(&ay.mul(bx));
    let [p, q, r, s] = [[px, py], [qx, qy], [rx, ry], [sx, sy]];
    [cross(p, q), dot(p, q), cross(s, r), dot(s, r)]
}

/// The polynomial of [`in_circle_sign`] over exact differences p, q, r, s (x and y of each).
fn in_circle<R: Ring>(differences: &[R; 8]) -> Ordering {
    let [cross1, dot1, cross2, dot2] = crosses_and_dots(differences);
    cross1.mul(&dot2).add(&dot1.mul(&cross2)).sign()
}

#[inline]
pub(super) fn sign(x: f64) -> Ordering {
    x.partial_cmp(&0.0).unwrap_or(Ordering::Equal)
}
