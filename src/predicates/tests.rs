//! Compares the predicates with independent arithmetic: the crate `robust` in 2D, and big integers.

use super::{
    Quad, area_sign, cos_degrees, has_area, in_circle_filter, in_circle_sign, obtuse, total_area_sign,
};
use glam::{DVec2, DVec3, Vec2};
use num_bigint::{BigInt, Sign};
use proptest::prelude::*;
use std::cmp::Ordering;

/// A finite f32: of the usual sizes, with any exponent, a small integer, or subnormal.
fn coordinate() -> BoxedStrategy<f32> {
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
    .boxed()
}

/// A finite f64, of the same kinds.
fn double() -> BoxedStrategy<f64> {
    prop_oneof![
        4 => coordinate().prop_map(f64::from),
        4 => -1.0f64..1.0,
        2 => (-300i32..300).prop_map(|i| f64::from(i) * 0.1),
        2 => any::<u64>().prop_map(f64::from_bits).prop_filter("finite", |x| x.is_finite()),
        1 => (0u64..1000).prop_map(f64::from_bits),
        1 => prop_oneof![Just(f64::MAX), Just(-f64::MAX), Just(f64::MIN_POSITIVE)],
    ]
    .boxed()
}

fn nudged(x: f64, ulps: i64) -> f64 {
    f64::from_bits(x.to_bits().wrapping_add_signed(ulps))
}

/// Four points of f32, of f64, or of f64 scaled by a common power of two.
fn quad<const K: usize>() -> impl Strategy<Value = [[f64; K]; 4]> {
    let narrow = [(); 4].map(|()| [(); K].map(|()| coordinate().prop_map(f64::from)));
    let wide = [(); 4].map(|()| [(); K].map(|()| double()));
    let unit = [(); 4].map(|()| [(); K].map(|()| -1.0f64..1.0));
    let scaled = (unit, -1074i32..1024).prop_map(|(points, e)| points.map(|p| p.map(|x| libm::scalbn(x, e))));
    prop_oneof![narrow, wide, scaled]
}

/// Points that are often cocircular, collinear or equal, exactly or up to one unit in the last place.
fn quad2() -> impl Strategy<Value = [DVec2; 4]> {
    let lattice = (0i32..4, 0i32..4, -2i32..=2).prop_map(|(x, y, ulps)| {
        let nudged = f32::from_bits((x as f32 * 0.1 + 100.0).to_bits().wrapping_add_signed(ulps / 2));
        DVec2::new(nudged.into(), (y as f32 * 0.1 + 7.0).into())
    });
    let wide = (0i32..4, 0i32..4, -2i64..=2)
        .prop_map(|(x, y, ulps)| [nudged(f64::from(x + 1), ulps / 2), f64::from(y)]);
    // The spacing is a power of two, or a tenth with an offset that no f32 holds.
    let wide = ([wide.clone(), wide.clone(), wide.clone(), wide], -1074i32..1021, any::<bool>());
    let wide = wide.prop_map(|(points, e, tenths)| {
        points.map(|p| DVec2::from(p.map(|x| if tenths { 0.1 * x + 1e6 } else { libm::scalbn(x, e) })))
    });
    prop_oneof![
        quad::<2>().prop_map(|points| points.map(DVec2::from)),
        [lattice.clone(), lattice.clone(), lattice.clone(), lattice],
        wide
    ]
}

/// Opposite angles whose sum is π, exactly or up to one unit in the last place: the product of the heights over the
/// common edge, 5 and 20, is the square of half its length.
fn angles_of_pi() -> impl Strategy<Value = [DVec3; 4]> {
    (-1070i32..1018, 0usize..12, -1i64..=1).prop_map(|(e, index, ulps)| {
        let mut points = [[-10., 0., 0.], [10., 0., 0.], [0., 5., 0.], [0., -12., -16.]];
        let number = &mut points.as_flattened_mut()[index];
        *number = nudged(*number, ulps);
        points.map(|p| DVec3::from(p.map(|x| libm::scalbn(x, e))))
    })
}

/// As `quad2`, in space, and often coplanar.
fn quad3() -> impl Strategy<Value = [DVec3; 4]> {
    prop_oneof![
        quad::<3>().prop_map(|points| points.map(DVec3::from)),
        angles_of_pi(),
        (quad2(), 0usize..3, double()).prop_map(|(points, axis, w)| points.map(|p| {
            let mut v = p.extend(w).to_array();
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

/// Whether n·m < k|n||m|, with the cosine k as a fraction over 2^1074.
fn exceeds(n: &Vector, m: &Vector, cos: f64) -> bool {
    let scale = dot(n, n) * dot(m, m);
    let unit = BigInt::from(1) << 1074;
    root_sum_sign(&(dot(n, m) * unit), &BigInt::from(1), &-big(cos), &scale).is_lt()
}

fn compare_in_plane([a, b, c, d]: [DVec2; 4]) {
    let [a3, b3, c3, d3] = [a, b, c, d].map(|p| p.extend(0.0));
    let area = |p, q, r| normal([p, q, r])[2].clone();
    assert_eq!(area_sign(a, b, c), order(&area(a3, b3, c3)));
    let (p, q, r, s) = (minus(a3, c3), minus(b3, c3), minus(a3, d3), minus(b3, d3));
    let expected = &cross(&p, &q)[2] * dot(&s, &r) + dot(&p, &q) * &cross(&s, &r)[2];
    assert_eq!(in_circle_sign(a, b, c, d), order(&expected));
    // The other half-edge of the same edge gives the same answer.
    assert_eq!(in_circle_sign(b, a, d, c), order(&expected));
    let total = total_area_sign(2, &|i| [[a, b, c], [b, a, d]][i]);
    assert_eq!(total, order(&(area(a3, b3, c3) + area(b3, a3, d3))));
}

fn filter(quads: [[[f32; 2]; 4]; 4]) -> [u32; 2] {
    in_circle_filter(&quads.each_ref().map(|quad| quad.each_ref()))
}

/// Compares the filter with the sign, for four quads of the points as f32.
fn compare_filter(points: [DVec2; 4]) {
    let points = points.map(DVec2::as_vec2);
    if points.iter().all(|p| p.is_finite()) {
        let quads =
            [[0, 1, 2, 3], [1, 0, 3, 2], [0, 2, 1, 3], [3, 1, 2, 0]].map(|quad| quad.map(|k| points[k]));
        let [negative, positive] = filter(quads.map(|quad| quad.map(<[f32; 2]>::from)));
        for (lane, quad) in quads.into_iter().enumerate() {
            let [a, b, c, d] = quad.map(Vec2::as_dvec2);
            let sign = in_circle_sign(a, b, c, d);
            assert!(negative >> lane & 1 == 0 || sign.is_lt(), "{quad:?}");
            assert!(positive >> lane & 1 == 0 || sign.is_gt(), "{quad:?}");
        }
    }
}

#[test]
fn the_filter_decides_what_it_can() {
    let quad = |height: f32, size: f32| {
        [[0., 0.], [2., 0.], [1., height], [1., -height]].map(|p| p.map(|x| size * x))
    };
    let filters = |size: f32| filter([0.5, 1.0, 1.0 + 1e-5, 2.0].map(|height| quad(height, size)));
    assert_eq!([1.0, 1e-8, 1e8].map(filters), [[0b0001, 0b1100]; 3]);
    // The products underflow or overflow.
    assert_eq!([1e-12, 1e12].map(filters), [[0, 0]; 2]);
}

fn compare_in_space([a, b, c, d]: [DVec3; 4], degrees: f64, most: f32) {
    let quad = Quad::new(a, b, c, d);
    let (p, q, r, s) = (minus(a, c), minus(b, c), minus(a, d), minus(b, d));
    let (n1, n2) = (normal([a, b, c]), normal([b, a, d]));
    let (m1, m2) = (normal([a, d, c]), normal([b, c, d]));
    let sum = root_sum_sign(&dot(&s, &r), &dot(&n1, &n1), &dot(&p, &q), &dot(&n2, &n2));
    assert_eq!(quad.is_non_delaunay(), sum.is_lt());
    let k = cos_degrees(degrees);
    assert_eq!(quad.exceeds_angle(k), exceeds(&n1, &n2, k) || exceeds(&m1, &m2, k));
    assert_eq!(quad.is_over_angle(k), exceeds(&n1, &n2, k));
    let turned = [&n1, &n2].iter().any(|n| [&m1, &m2].iter().any(|m| dot(n, m).sign() == Sign::Minus));
    assert_eq!(quad.turns_over(), turned);
    // Another formula than in the filter: the determinant of the edge, the diagonal, and a vector between the two.
    let across = cross(&minus(a, b), &minus(c, d));
    let (volume, most_big) = (dot(&across, &minus(a, c)), big(most.into()));
    let deviates = &volume * &volume > &most_big * &most_big * dot(&across, &across);
    assert_eq!(quad.deviates(most.into()), deviates);
    let is_flat = dot(&n1, &n1).sign() == Sign::NoSign;
    assert_eq!(obtuse(a, b, c), (dot(&p, &q).sign() == Sign::Minus).then_some(is_flat));
    assert_eq!(has_area(a, b, c), !is_flat);
}

/// The distance of the two diagonals of a box is its height. It is compared with a float near it, or with itself.
fn compare_box(points: [DVec3; 4], height: f32, ulps: i32) {
    let most = f32::from_bits(height.to_bits().saturating_add_signed(ulps));
    let [p, q, r, s] = points;
    assert_eq!(Quad::new(p, q, r, s).deviates(most.into()), height > most);
    compare_in_space(points, 10.0, most);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(20_000))]

    #[test]
    fn area_and_in_circle_agree_with_big_integers(quad in quad2()) {
        compare_in_plane(quad);
        compare_filter(quad);
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
    fn surface_tests_agree_with_big_integers(quad in quad3(), degrees in prop_oneof![
        Just(0.0), Just(60.0), Just(90.0), Just(120.0), Just(180.0), 0.0..180.0f64,
        Just(90.0f64.next_up()), Just(90.0f64.next_down())
    ], most in coordinate()) {
        compare_in_space(quad, degrees, most.abs());
    }

    #[test]
    fn distances_of_whole_numbers_are_decided(
        [w, d, h] in [1u16..100, 1u16..100, 0u16..100], e in -120i32..100, turn in 0usize..3, ulps in -1i32..=1
    ) {
        let points = [[0, 0, 0], [w, d, 0], [w, 0, h], [0, d, h]].map(|p| {
            let mut p = p.map(|x| libm::scalbn(f64::from(x), e));
            p.rotate_right(turn);
            DVec3::from(p)
        });
        let height = libm::scalbnf(f32::from(h), e);
        compare_box(points, height, ulps);
    }

    /// The boxes are turned and larger, so that products round.
    #[test]
    fn distances_of_turned_boxes_are_decided(
        [w, d, h] in [1u32..1 << 20, 1u32..1 << 20, 0u32..1 << 20], e in -100i32..60, ulps in -1i32..=1
    ) {
        let points = [[0, 0, 0], [w, d, 0], [w, 0, h], [0, d, h]].map(|p| {
            let [x, y, z] = p.map(|x| libm::scalbn(f64::from(x), e));
            // A rotation, 3 times as large.
            DVec3::new(2.0 * x - y + 2.0 * z, 2.0 * x + 2.0 * y - z, -x + 2.0 * y + 2.0 * z)
        });
        let height = libm::scalbnf(3.0 * h as f32, e);
        compare_box(points, height, ulps);
    }
}

#[test]
fn the_largest_and_smallest_floats_are_decided() {
    let (big, tiny) = (f64::from(f32::MAX), f64::from(f32::from_bits(1)));
    let square = [DVec2::new(-big, -big), DVec2::new(big, big), DVec2::new(-big, big), DVec2::new(big, -big)];
    let [a, b, c, d] = square;
    assert_eq!(in_circle_sign(a, b, c, d), Ordering::Equal);
    assert_eq!(in_circle_sign(a, b, c, d - DVec2::new(0.0, 0.0)), Ordering::Equal);
    // One subnormal step beside the line through a and b.
    let inside = DVec2::new(tiny, 0.0);
    let [a, b, c] = [DVec2::new(0.0, -1.0), DVec2::new(0.0, 1.0), DVec2::new(2.0, 0.0)];
    assert_eq!(area_sign(a, b, inside), Ordering::Less);
    assert_eq!(area_sign(a, b, c), Ordering::Less);
}

/// Cases that filters decide wrongly if they ignore overflow and underflow.
#[test]
fn filters_leave_what_overflows_or_underflows() {
    // The differences from c are rounded, and then their products to 5 and 4 times the smallest number.
    let point = |x: i64, y: i64| DVec2::new(x as f64, y as f64) * 2f64.powi(-592);
    let a = point(54_043_195_528_445_928, 54_043_195_528_445_952);
    let b = point(108_086_391_056_891_904, 108_086_391_056_891_952);
    compare_in_plane([a, b, point(-4, -4), DVec2::new(1.0, 0.0)]);

    // The angle at c is 2^-40 below π, the one at d 2^-41: the square of the first normal is rounded to 0.
    let half = 2f64.powi(-252);
    let on_axis = |y: f64| DVec3::new(0.0, y, 0.0);
    let [a, b] = [-half, half].map(|x| DVec3::new(x, 0.0, 0.0));
    compare_in_space([a, b, on_axis(2f64.powi(-293)), on_axis(-2f64.powi(-210))], 10.0, 1e-30);

    // The edge is short, c is far away and d is near: rounding makes the square of the first normal infinite.
    let [a, b] = [DVec3::new(1e90, 1e90, 0.0), DVec3::new(1e90, 1e90, 1e-20)];
    compare_in_space(
        [a, b, DVec3::new(-1e90, 1e90, 1e-20), DVec3::new(1e90, 1e90 + 1e80, 0.0)],
        10.0,
        f32::MAX,
    );
}

/// Includes the widest differences of each kind of integer, and the next wider ones.
#[test]
fn differences_of_every_width_are_decided() {
    let tiny = f64::from_bits(1);
    for bits in 1..2098 {
        let most = libm::scalbn(1.0, bits - 1074).next_down();
        let [a, b, c, d] =
            [[-most, -most], [most, most], [-most, most], [most, tiny - most]].map(DVec2::from_array);
        compare_in_plane([a, b, c, d]);
        compare_in_space([a.extend(most), b.extend(-most), c.extend(-most), d.extend(tiny)], 10.0, 1.0);
    }
}

#[test]
fn cosines_are_right_to_the_last_places() {
    for (degrees, cosine) in [(0.0, 1.0), (60.0, 0.5), (90.0, 0.0), (120.0, -0.5), (180.0, -1.0)] {
        assert_eq!(cos_degrees(degrees), cosine);
    }
    let mut before = 1.0;
    for step in 1..=18_000 {
        let degrees = f64::from(step) / 100.0;
        let cosine = cos_degrees(degrees);
        // The tolerance includes the rounding of the radians.
        let radians = degrees.to_radians();
        let exact = libm::cos(radians);
        assert!(
            (cosine - exact).abs() <= (2.0 * exact.abs() + radians) * f64::EPSILON,
            "{degrees}: {cosine} {exact}"
        );
        assert!(cosine < before, "{degrees}");
        before = cosine;
    }
}

/// On a small grid, every quad: if both new triangles are positive and an old one is not, the edge is not Delaunay. So a
/// flip that mends a fold is a flip of an edge that is not Delaunay, and needs no rule of its own.
#[test]
fn an_edge_that_a_fold_leaves_is_not_delaunay() {
    let points: Vec<DVec2> = (0..25).map(|i| DVec2::new(f64::from(i % 5), f64::from(i / 5))).collect();
    let [mut turned, mut flat] = [0, 0];
    for &a in &points {
        for &b in &points {
            for &c in &points {
                for &d in &points {
                    let old = [area_sign(a, b, c), area_sign(b, a, d)];
                    let new = [area_sign(a, d, c), area_sign(b, c, d)];
                    if new.iter().all(|sign| sign.is_gt()) && old.iter().any(|sign| sign.is_le()) {
                        assert_eq!(in_circle_sign(a, b, c, d), Ordering::Less, "{a} {b} {c} {d}");
                        turned += u32::from(old.iter().any(|sign| sign.is_lt()));
                        flat += u32::from(old.iter().any(|sign| sign.is_eq()));
                    }
                }
            }
        }
    }
    assert!(turned > 1000 && flat > 1000, "{turned} {flat}");
}
