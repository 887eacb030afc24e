//! Checks a triangulation with exact integers, from the definitions and not from the way it was made.

use edgeflip::{NONE, Positions, Triangulation};
use num_bigint::BigInt;
use std::cmp::Ordering;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::{Add, AddAssign, Mul, Sub};

pub type Point = [BigInt; 2];

/// Integers that the checks calculate with.
pub trait Integer:
    Ord + Default + AddAssign + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self>
{
    /// The sign of the determinant of three points relative to a fourth.
    fn circle_sign(rows: [[Self; 2]; 3]) -> Ordering;
}

pub trait Operand<N>: Copy + Sub<Output = N> + Mul<Output = N> {}

impl<'a, N> Operand<N> for &'a N where &'a N: Sub<Output = N> + Mul<Output = N> {}

impl Integer for BigInt {
    fn circle_sign(rows: [[Self; 2]; 3]) -> Ordering {
        sign(&determinant(rows))
    }
}

/// A million points are checked in seconds, if these suffice.
impl Integer for i128 {
    fn circle_sign(rows: [[Self; 2]; 3]) -> Ordering {
        // The squares and the minors are at most 2^61, and three of their products less than 2^124.
        if rows.as_flattened().iter().all(|x| x.abs() <= 1 << 30) {
            sign(&determinant(rows))
        } else {
            BigInt::circle_sign(rows.map(|row| row.map(BigInt::from)))
        }
    }
}

/// Mantissa and exponent of a finite number.
fn decode(x: f64) -> (i64, i32) {
    let bits = x.to_bits();
    let exponent = (bits >> 52 & 0x7ff) as i32;
    let fraction = (bits & ((1 << 52) - 1)) as i64;
    let magnitude = if exponent == 0 { fraction } else { fraction | 1 << 52 };
    let zeros = if magnitude == 0 { 0 } else { magnitude.trailing_zeros() };
    (if x < 0.0 { -1 } else { 1 } * (magnitude >> zeros), exponent.max(1) - 1075 + zeros as i32)
}

/// The numbers as multiples of one power of two: a factor, and how far to shift it.
fn shifted(positions: &Positions) -> Vec<(i64, i32)> {
    let decoded: Vec<(i64, i32)> = positions.iter().map(decode).collect();
    let unit = decoded.iter().filter(|number| number.0 != 0).map(|number| number.1).min().unwrap_or(0);
    decoded.into_iter().map(|(m, e)| if m == 0 { (0, 0) } else { (m, e - unit) }).collect()
}

/// The points as integers times one power of two.
pub fn integers(positions: &Positions) -> Vec<Point> {
    let integer = |&(m, shift): &(i64, i32)| BigInt::from(m) << shift;
    shifted(positions).as_chunks::<2>().0.iter().map(|pair| pair.each_ref().map(integer)).collect()
}

/// The same if no integer is larger than 2^53.
fn small_integers(positions: &Positions) -> Option<Vec<[i128; 2]>> {
    let integer = |(m, shift): (i64, i32)| {
        // A longer shift gives a larger integer, too.
        let integer = i128::from(m) << shift.min(54);
        (integer.abs() <= 1 << 53).then_some(integer)
    };
    let numbers: Option<Vec<i128>> = shifted(positions).into_iter().map(integer).collect();
    numbers.map(|numbers| numbers.as_chunks().0.to_vec())
}

/// Twice the area of (a, b, c).
pub fn area<N: Integer>(a: &[N; 2], b: &[N; 2], c: &[N; 2]) -> N
where
    for<'a> &'a N: Operand<N>,
{
    (&b[0] - &a[0]) * (&c[1] - &a[1]) - (&b[1] - &a[1]) * (&c[0] - &a[0])
}

/// The determinant of Guibas and Stolfi, of three points relative to a fourth.
fn determinant<N: Integer>(rows: [[N; 2]; 3]) -> N
where
    for<'a> &'a N: Operand<N>,
{
    let square = |[x, y]: &[N; 2]| x * x + y * y;
    let minor = |[px, py]: &[N; 2], [qx, qy]: &[N; 2]| px * qy - py * qx;
    square(&rows[0]) * minor(&rows[1], &rows[2]) - square(&rows[1]) * minor(&rows[0], &rows[2])
        + square(&rows[2]) * minor(&rows[0], &rows[1])
}

fn sign<N: Integer>(x: &N) -> Ordering {
    x.cmp(&N::default())
}

fn after(h: usize) -> usize {
    if h % 3 == 2 { h - 2 } else { h + 1 }
}

/// Checks everything that the documentation of a triangulation promises, but for which constraints come in. Returns for
/// each half-edge whether it is a tie: whether its four points are on one circle.
pub fn check(positions: &Positions, result: &Triangulation) -> Vec<bool> {
    match small_integers(positions) {
        Some(points) => check_integers(&points, result),
        None => check_integers(&integers(positions), result),
    }
}

fn check_integers<N: Integer>(points: &[[N; 2]], result: &Triangulation) -> Vec<bool>
where
    for<'a> &'a N: Operand<N>,
{
    let at = |v: u32| &points[v as usize];
    let Triangulation { triangles, twins, hull, duplicates, constraint_edges, .. } = result;
    let ordered = |[a, b]: [u32; 2]| [a.min(b), a.max(b)];
    let mut constraints: BTreeSet<[u32; 2]> = constraint_edges.iter().copied().map(ordered).collect();

    let mut first = BTreeMap::new();
    let expected: Vec<[u32; 2]> = (0..)
        .zip(points)
        .filter_map(|(i, point)| Some([i, *first.entry(point).or_insert(i)]).filter(|[i, used]| i != used))
        .collect();
    assert_eq!(*duplicates, expected);
    let distinct: BTreeSet<u32> = first.values().copied().collect();

    if result.is_flat() {
        assert!(twins.is_empty());
        let line: Vec<u32> = first.values().copied().collect();
        assert_eq!(*hull, line);
        if let [a, b, rest @ ..] = line.as_slice() {
            assert!(rest.iter().all(|&c| sign(&area(at(*a), at(*b), at(c))).is_eq()), "there is a triangle");
        }
        return Vec::new();
    }

    let rows = triangles.as_chunks::<3>().0;
    assert!(
        rows.iter().all(|[a, b, c]| a < b && a < c),
        "a triangle begins with another than its smallest index"
    );
    assert!(rows.windows(2).all(|pair| pair[0][..2] < pair[1][..2]), "the triangles are not sorted");
    assert_eq!(triangles.iter().copied().collect::<BTreeSet<u32>>(), distinct);
    let mut sum = N::default();
    for &[a, b, c] in rows {
        let area = area(at(a), at(b), at(c));
        assert!(sign(&area).is_gt(), "{a} {b} {c} is not positive");
        sum += area;
    }

    let (mut tied, mut next_on_hull) = (vec![false; triangles.len()], BTreeMap::new());
    assert_eq!(twins.len(), triangles.len());
    for (h, &g) in twins.iter().enumerate() {
        let [a, b, c] = [h, after(h), after(after(h))].map(|x| triangles[x]);
        let is_free = !constraints.contains(&ordered([a, b]));
        if g == NONE {
            assert_eq!(next_on_hull.insert(a, b), None, "vertex {a} is on the hull twice");
            continue;
        }
        let g = g as usize;
        assert_eq!((twins[g], triangles[g], triangles[after(g)]), (h as u32, b, a));
        if g < h {
            // The twin has decided.
            tied[h] = tied[g];
            continue;
        }
        let d = triangles[after(after(g))];
        let relative = |v: u32| [0, 1].map(|axis| &at(v)[axis] - &at(d)[axis]);
        match N::circle_sign([a, b, c].map(relative)) {
            _ if !is_free => {}
            Ordering::Less => {}
            Ordering::Equal => {
                tied[h] = true;
                let least = [a, b, c, d].into_iter().min_by_key(|&v| at(v));
                assert!(least == Some(a) || least == Some(b), "{a} {b} does not fan out from the least");
            }
            Ordering::Greater => panic!("{d} is in the circle of {a} {b} {c}"),
        }
    }

    for (h, &a) in triangles.iter().enumerate() {
        constraints.remove(&ordered([a, triangles[after(h)]]));
    }
    assert!(constraints.is_empty(), "{constraints:?} are no edges");

    assert_eq!(hull.len(), next_on_hull.len());
    assert_eq!(hull.iter().min(), hull.first());
    let mut outline = N::default();
    for (i, &b) in hull.iter().enumerate() {
        let [a, c] = [hull.len() - 1, 1].map(|step| hull[(i + step) % hull.len()]);
        assert_eq!(next_on_hull[&b], c);
        let [p, q, r] = [a, b, c].map(at);
        let turn = sign(&area(p, q, r));
        let ahead = (&q[0] - &p[0]) * (&r[0] - &q[0]) + (&q[1] - &p[1]) * (&r[1] - &q[1]);
        assert!(turn.is_gt() || turn.is_eq() && sign(&ahead).is_gt(), "the hull is not convex at {b}");
        outline += &q[0] * &r[1] - &q[1] * &r[0];
    }
    assert!(sum == outline, "the triangles do not cover the hull once");
    assert_eq!(rows.len(), 2 * distinct.len() - 2 - hull.len());
    tied
}
