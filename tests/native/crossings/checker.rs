//! Checks lines that were brought into a mesh with a vertex where they cross, with integers of any size, from the
//! definitions and not from the way it was done.

use crate::points::oracle::{Point, area, integers};
use edgeflip::{Mesh, Positions, SplitCrossings};
use num_bigint::BigInt;
use std::cmp::Ordering;
use std::collections::{BTreeMap, BTreeSet};

fn sign(x: &BigInt) -> Ordering {
    x.cmp(&BigInt::ZERO)
}

/// The points as integers, and the size of their unit.
fn in_unit(positions: &Positions) -> (Vec<Point>, f64) {
    let points = integers(positions);
    let numbers = points.as_flattened().iter().zip(positions.iter());
    let mut unit = numbers.filter(|(_, x)| *x != 0.0).map(|(integer, x)| {
        let (top, shift) = scaled(&integer.magnitude().clone().into());
        x.abs() / top / 2f64.powi(shift as i32)
    });
    let unit = unit.next_back().unwrap_or(1.0);
    (points, unit)
}

fn ordered([u, v]: [u32; 2]) -> [u32; 2] {
    [u.min(v), u.max(v)]
}

fn edges(mesh: &Mesh) -> BTreeMap<[u32; 2], u32> {
    let mut edges = BTreeMap::new();
    for [a, b, c] in mesh.triangles().as_chunks::<3>().0 {
        for pair in [[*a, *b], [*b, *c], [*c, *a]] {
            *edges.entry(ordered(pair)).or_insert(0) += 1;
        }
    }
    edges
}

fn border(edges: &BTreeMap<[u32; 2], u32>) -> Vec<[u32; 2]> {
    edges.iter().filter(|(_, n)| **n == 1).map(|(pair, _)| *pair).collect()
}

/// As f64, of any size: a mantissa and an exponent.
fn scaled(x: &BigInt) -> (f64, i64) {
    let bits = x.bits() as i64;
    let shift = (bits - 60).max(0);
    let top: BigInt = x >> shift;
    let (_, digits) = top.to_u64_digits();
    (digits.first().copied().unwrap_or(0) as f64, shift)
}

/// The distance of c from the segment a-b, in units.
fn distance(a: &Point, b: &Point, c: &Point) -> f64 {
    let dot = |u: [&Point; 2], v: [&Point; 2]| {
        (&u[1][0] - &u[0][0]) * (&v[1][0] - &v[0][0]) + (&u[1][1] - &u[0][1]) * (&v[1][1] - &v[0][1])
    };
    let root = |x: BigInt| {
        let (m, e) = scaled(&x);
        if e % 2 == 0 {
            m.sqrt() * 2f64.powi((e / 2) as i32)
        } else {
            (2.0 * m).sqrt() * 2f64.powi((e / 2) as i32)
        }
    };
    if sign(&dot([a, b], [a, c])).is_le() {
        return root(dot([a, c], [a, c]));
    }
    if sign(&dot([b, a], [b, c])).is_le() {
        return root(dot([b, c], [b, c]));
    }
    let area = area(a, b, c);
    root(((&area * &area) << 200) / dot([a, b], [a, b])) / 2f64.powi(100)
}

/// Checks a result. Returns the largest distance of a chain from its line, in the units in the last place of the largest
/// coordinate of the line's ends.
pub fn check(mesh: &Mesh, lines: &[[u32; 2]], split: &SplitCrossings) -> f64 {
    let given = mesh.vertex_count();
    let (points, unit) = in_unit(split.mesh.positions());
    assert!(mesh.positions().iter().eq(split.mesh.positions().iter().take(2 * given)), "a vertex has moved");
    let at = |v: u32| &points[v as usize];
    for &[a, b, c] in split.mesh.triangles().as_chunks::<3>().0 {
        assert!(sign(&area(at(a), at(b), at(c))).is_gt(), "{a} {b} {c} is not positive");
    }
    let (before, after) = (edges(mesh), edges(&split.mesh));
    let (border_before, border_after) = (border(&before), border(&after));
    assert_eq!(border_before, border_after);
    assert!(after.values().all(|&n| n <= 2));
    let added = split.crossings.len();
    assert_eq!(split.mesh.vertex_count(), given + added);
    assert_eq!(split.mesh.triangle_count(), mesh.triangle_count() + 2 * added);
    let used: BTreeSet<u32> = split.mesh.triangles().iter().copied().collect();
    assert!((given..given + added).all(|v| used.contains(&(v as u32))));

    let (mut largest, mut largest_in_places) = (0.0f64, 0.0f64);
    assert_eq!(split.chains.len(), lines.len());
    for (i, (chain, &[u, v])) in split.chains.iter().zip(lines).enumerate() {
        assert_eq!((chain.first(), chain.last()), (Some(&u), Some(&v)), "line {i}");
        assert!(chain.windows(2).all(|pair| after.contains_key(&ordered([pair[0], pair[1]]))), "line {i}");
        let far = chain.iter().map(|&w| distance(at(u), at(v), at(w))).fold(0.0, f64::max);
        let size =
            [u, v].map(|w| split_point(split, w)).concat().into_iter().map(f64::abs).fold(0.0, f64::max);
        let place = match split.mesh.positions() {
            Positions::F32(_) => f64::from((size as f32).next_up() - size as f32),
            Positions::F64(_) => size.next_up() - size,
        };
        let far = far * unit;
        largest = largest.max(far);
        largest_in_places = largest_in_places.max(far / place);
        // No vertex is between the chain and the line.
        let on: BTreeSet<u32> = chain.iter().copied().collect();
        let [p, q] = [u, v].map(|w| split_point(split, w));
        let reach = far + 8.0 * place;
        for w in 0..given as u32 {
            let r = split_point(split, w);
            let rough = ((q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])).abs()
                / ((q[0] - p[0]).hypot(q[1] - p[1]));
            let is_near = rough <= 2.0 * reach
                && (0..2).all(|k| r[k] >= p[k].min(q[k]) - reach && r[k] <= p[k].max(q[k]) + reach);
            if on.contains(&w) || !is_near || !used.contains(&w) {
                continue;
            }
            let mut is_inside = false;
            let closed = chain.windows(2).map(|pair| [pair[0], pair[1]]).chain([[v, u]]);
            for [a, b] in closed {
                let (a, b, c) = (at(a), at(b), at(w));
                let (low, high) = if a[1] <= b[1] { (a, b) } else { (b, a) };
                if low[1] <= c[1] && c[1] < high[1] && sign(&area(low, high, c)).is_gt() {
                    is_inside = !is_inside;
                }
            }
            assert!(!is_inside, "line {i} passes {w} on the wrong side");
        }
    }
    let near = |x: f64, y: f64| (x - y).abs() <= 1e-9 * y.abs() + f64::MIN_POSITIVE;
    assert!(near(split.deviation, largest), "{} {largest}", split.deviation);
    for (i, crossing) in split.crossings.iter().enumerate() {
        let [first, second] = crossing.constraints;
        assert!(first < second && second < lines.len() && (0.0..=1.0).contains(&crossing.at), "{i}");
    }
    largest_in_places
}

fn split_point(split: &SplitCrossings, v: u32) -> [f64; 2] {
    match split.mesh.positions() {
        Positions::F32(numbers) => [0, 1].map(|k| numbers[2 * v as usize + k].into()),
        Positions::F64(numbers) => [0, 1].map(|k| numbers[2 * v as usize + k]),
    }
}
