//! The predicates against independent arithmetic: `robust` in 2D, big integers everywhere.

use super::{Quad, area_sign, corner, cos_degrees, in_circle_sign, total_area_sign};
use glam::{DVec2, DVec3};
use num_bigint::{BigInt, Sign};
use proptest::prelude::*;
use std::cmp::Ordering;

/// Any finite f32: of the usual sizes, of any exponent, small integers, or subnormal.
fn coordinate() -> impl Strategy<Value = f32> {
    prop_oneof![
        4 => -1.0f32..1.0,
        4 => (-8i32..8).prop_map(|i| i as f32),
        2 => (-300i32..300).prop_map(|i| i as f32 * 0.1),
        1 => any::<u32>().prop_map(|bits| {
            let x = f32::from_bits(bits);
            if x.is_finite() { x } else { 0.0 }
        }),
        1 => (0u32..1000).prop_map(f32::from_bits),
        1 => Just(6.1e-17f32),
    ]
}

fn point2() -> impl Strategy<Value = DVec2> {
    [coordinate(), coordinate()].prop_map(|[x, y]| DVec2::new(x.into(), y.into()))
}

fn point3() -> impl Strategy<Value = DVec3> {
    [coordinate(), coordinate(), coordinate()].prop_map(|[x, y, z]| DVec3::new(x.into(), y.into(), z.into()))
}

/// Points that are often cocircular, collinear or equal, or are so up to one unit in the last place.
fn quad2() -> impl Strategy<Value = [DVec2; 4]> {
    let lattice = (0i32..4, 0i32..4, -2i32..=2).prop_map(|(x, y, ulps)| {
        let nudged = f32::from_bits((x as f32 * 0.1 + 100.0).to_bits().wrapping_add_signed(ulps / 2));
        DVec2::new(nudged.into(), (y as f32 * 0.1 + 7.0).into())
    });
    prop_oneof![
        [point2(), point2(), point2(), point2()],
        [lattice.clone(), lattice.clone(), lattice.clone(), lattice]
    ]
}

/// As `quad2`, and often coplanar.
fn quad3() -> impl Strategy<Value = [DVec3; 4]> {
    prop_oneof![
        [point3(), point3(), point3(), point3()],
        (quad2(), 0usize..3, coordinate()).prop_map(|(points, axis, w)| points.map(|p| {
            let mut v = p.extend(w.into()).to_array();
            v.rotate_right(axis);
            DVec3::from_array(v)
        })),
    ]
}

/// x·2^1074, an integer for every f64.
fn big(x: f64) -> BigInt {
    let (mantissa, exponent) = super::exact::decode(x);
    if mantissa == 0 { BigInt::ZERO } else { BigInt::from(mantissa) << (exponent + 1074) }
}

fn order(x: &BigInt) -> Ordering {
    match x.sign() {
        Sign::Minus => Ordering::Less,
        Sign::NoSign => Ordering::Equal,
        Sign::Plus => Ordering::Greater,
    }
}

type Vector = [BigInt; 3];

fn minus(u: DVec3, v: DVec3) -> Vector {
    let (u, v) = (u.to_array(), v.to_array());
    [0, 1, 2].map(|i| big(u[i]) - big(v[i]))
}

fn dot(u: &Vector, v: &Vector) -> BigInt {
    (0..3).map(|i| &u[i] * &v[i]).sum()
}

fn cross(u: &Vector, v: &Vector) -> Vector {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| &u[i] * &v[j] - &u[j] * &v[i])
}

fn normal([a, b, c]: [DVec3; 3]) -> Vector {
    cross(&minus(b, a), &minus(c, a))
}

/// The sign of f·√(x) + g·√(y).
fn root_sum_sign(f: &BigInt, x: &BigInt, g: &BigInt, y: &BigInt) -> Ordering {
    let signed_square = |f: &BigInt, x: &BigInt| f * f * x * if f.sign() == Sign::Minus { -1 } else { 1 };
    order(&(signed_square(f, x) + signed_square(g, y)))
}

/// The cosine as a fraction over 2^1074.
fn exceeds(n: &Vector, m: &Vector, cos: f64) -> bool {
    let scale = dot(n, n) * dot(m, m);
    let unit = BigInt::from(1) << 1074;
    root_sum_sign(&(dot(n, m) * unit), &BigInt::from(1), &-big(cos), &scale).is_lt()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(20_000))]

    #[test]
    fn area_and_in_circle_agree_with_big_integers([a, b, c, d] in quad2()) {
        let [a3, b3, c3, d3] = [a, b, c, d].map(|p| p.extend(0.0));
        let area = |p, q, r| normal([p, q, r])[2].clone();
        prop_assert_eq!(area_sign(a, b, c), order(&area(a3, b3, c3)));
        let (p, q, r, s) = (minus(a3, c3), minus(b3, c3), minus(a3, d3), minus(b3, d3));
        let expected = &cross(&p, &q)[2] * dot(&s, &r) + dot(&p, &q) * &cross(&s, &r)[2];
        prop_assert_eq!(in_circle_sign(a, b, c, d), order(&expected));
        // The other half-edge of the same edge gives the same answer.
        prop_assert_eq!(in_circle_sign(b, a, d, c), order(&expected));
        let total = total_area_sign([[a, b, c], [b, a, d]].into_iter());
        prop_assert_eq!(total, order(&(area(a3, b3, c3) + area(b3, a3, d3))));
    }

    #[test]
    fn in_circle_agrees_with_robust(
        [a, b, c, d] in [[-1000i32..1000, -1000..1000], [-1000..1000, -1000..1000],
            [-1000..1000, -1000..1000], [-1000..1000, -1000..1000]]
    ) {
        let [a, b, c, d] = [a, b, c, d].map(|[x, y]| DVec2::new(f64::from(x as f32 * 0.01), f64::from(y as f32 * 0.01)));
        let coord = |p: DVec2| robust::Coord { x: p.x, y: p.y };
        let determinant = robust::incircle(coord(a), coord(b), coord(c), coord(d));
        prop_assert_eq!(in_circle_sign(a, b, c, d), 0.0f64.total_cmp(&(determinant + 0.0)));
        let area = robust::orient2d(coord(a), coord(b), coord(c));
        prop_assert_eq!(area_sign(a, b, c), (area + 0.0).total_cmp(&0.0));
    }

    #[test]
    fn surface_tests_agree_with_big_integers([a, b, c, d] in quad3(), degrees in prop_oneof![
        Just(0.0), Just(60.0), Just(90.0), Just(120.0), Just(180.0), 0.0..180.0f64,
        Just(90.0f64.next_up()), Just(90.0f64.next_down())
    ]) {
        let quad = Quad::new(a, b, c, d);
        let (p, q, r, s) = (minus(a, c), minus(b, c), minus(a, d), minus(b, d));
        let (n1, n2) = (normal([a, b, c]), normal([b, a, d]));
        let (m1, m2) = (normal([a, d, c]), normal([b, c, d]));
        let sum = root_sum_sign(&dot(&s, &r), &dot(&n1, &n1), &dot(&p, &q), &dot(&n2, &n2));
        prop_assert_eq!(quad.is_non_delaunay(), sum.is_lt());
        let k = cos_degrees(degrees);
        prop_assert_eq!(quad.exceeds_angle(k), exceeds(&n1, &n2, k) || exceeds(&m1, &m2, k));
        prop_assert_eq!(quad.is_over_angle(k), exceeds(&n1, &n2, k));
        let turned = [&n1, &n2].iter().any(|n| [&m1, &m2].iter().any(|m| dot(n, m).sign() == Sign::Minus));
        prop_assert_eq!(quad.turns_over(), turned);
        let expected = (dot(&p, &q).sign() == Sign::Minus, dot(&n1, &n1).sign() == Sign::NoSign);
        prop_assert_eq!(corner(a, b, c), expected);
    }
}

#[test]
fn the_largest_and_smallest_floats_are_decided() {
    let (big, tiny) = (f64::from(f32::MAX), f64::from(f32::from_bits(1)));
    let square = [DVec2::new(-big, -big), DVec2::new(big, big), DVec2::new(-big, big), DVec2::new(big, -big)];
    let [a, b, c, d] = square;
    assert_eq!(in_circle_sign(a, b, c, d), Ordering::Equal);
    assert_eq!(in_circle_sign(a, b, c, d - DVec2::new(0.0, 0.0)), Ordering::Equal);
    // One subnormal step inside the circle.
    let inside = DVec2::new(tiny, 0.0);
    let [a, b, c] = [DVec2::new(0.0, -1.0), DVec2::new(0.0, 1.0), DVec2::new(2.0, 0.0)];
    assert_eq!(area_sign(a, b, inside), Ordering::Less);
    assert_eq!(area_sign(a, b, c), Ordering::Less);
}
