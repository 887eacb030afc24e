//! Constraints are brought in as integers of any size define it.

use super::oracle::{Point, area, check, integers};
use super::{KINDS, points, seeds, set, wide};
use edgeflip::{Error, LeftOut, PointOptions, Positions, Triangulation, triangulate_with};
use num_bigint::BigInt;
use oorandom::Rand64;

fn constrained(positions: &Positions, constraints: &[[u32; 2]], skips: bool) -> Result<Triangulation, Error> {
    let constraints = constraints.to_vec();
    triangulate_with(positions, &PointOptions { constraints, skips_constraints: skips, ..Default::default() })
}

/// What constraints should become.
struct Expected {
    edges: Vec<[u32; 2]>,
    /// Those that are left out, and the constraints that each of them crosses.
    left_out: Vec<(usize, Vec<usize>)>,
}

fn expected(points: &[Point], duplicates: &[[u32; 2]], constraints: &[[u32; 2]]) -> Expected {
    let sign = |x: BigInt| x.cmp(&BigInt::ZERO);
    let at = |v: u32| &points[v as usize];
    let side = |a: u32, b: u32, c: u32| sign(area(at(a), at(b), at(c)));
    let is_copy = |v: &u32| duplicates.iter().any(|[copy, _]| copy == v);
    let first = |v: u32| duplicates.iter().find(|[copy, _]| *copy == v).map_or(v, |[_, first]| *first);
    let (mut edges, mut left_out) = (Vec::<(usize, [u32; 2])>::new(), Vec::new());
    for (index, ends) in constraints.iter().enumerate() {
        let [a, b] = ends.map(first);
        let ahead = |v: u32| {
            let [p, q, r] = [a, b, v].map(at);
            (&q[0] - &p[0]) * (&r[0] - &p[0]) + (&q[1] - &p[1]) * (&r[1] - &p[1])
        };
        let mut chain: Vec<u32> = (0..points.len() as u32).filter(|v| !is_copy(v)).collect();
        chain.retain(|&v| side(a, b, v).is_eq() && ahead(v) >= BigInt::ZERO && ahead(v) <= ahead(b));
        chain.sort_by_key(|&v| ahead(v));
        let pieces: Vec<[u32; 2]> =
            if a == b { vec![] } else { chain.windows(2).map(|pair| [pair[0], pair[1]]).collect() };
        let crosses = |[c, d]: [u32; 2], [e, f]: [u32; 2]| {
            let [one, two] = [side(c, d, e), side(c, d, f)];
            let [three, four] = [side(e, f, c), side(e, f, d)];
            one.is_ne() && one == two.reverse() && three.is_ne() && three == four.reverse()
        };
        let crossed: Vec<usize> = edges
            .iter()
            .filter(|&&(_, edge)| pieces.iter().any(|&piece| crosses(piece, edge)))
            .map(|&(other, _)| other)
            .collect();
        if crossed.is_empty() {
            edges.extend(pieces.into_iter().map(|piece| (index, piece)));
        } else {
            left_out.push((index, crossed));
        }
    }
    Expected { edges: edges.into_iter().map(|(_, edge)| edge).collect(), left_out }
}

#[test]
fn constraints_come_in_as_the_oracle_defines_it() {
    let mut random = Rand64::new(1);
    for (name, kind) in KINDS {
        let [mut all, mut edges, mut left_out] = [0; 3];
        for seed in 1..=seeds() {
            let points = set(kind, 60.0, seed);
            let positions = wide(&points);
            let integers = integers(&positions);
            let n = points.len() as u64;
            let mut constraints: Vec<[u32; 2]> = Vec::new();
            for _ in 0..random.rand_range(0..n + 4) {
                constraints.push([0; 2].map(|_| random.rand_range(0..n) as u32));
            }
            // A polygon through the first points, and some again.
            let polygon = random.rand_range(0..n) as u32;
            constraints.extend((0..polygon).map(|i| [i, (i + 1) % polygon]));
            constraints.extend_from_within(..constraints.len() / 4);
            let result = constrained(&positions, &constraints, true).unwrap();
            check(&positions, &result);
            let expected = expected(&integers, &result.duplicates, &constraints);
            assert_eq!(result.constraint_edges, expected.edges, "{name}, seed {seed}");
            assert_eq!(result.left_out.len(), expected.left_out.len(), "{name}, seed {seed}");
            for (LeftOut { index, reason }, (left, crossed)) in result.left_out.iter().zip(&expected.left_out)
            {
                let [a, b] = constraints[*index];
                let says = |other: &usize| {
                    let [c, d] = constraints[*other];
                    format!(
                        "constraint {index} between {a} and {b} crosses constraint {other} between {c} and {d}"
                    )
                };
                assert!(index == left && crossed.iter().any(|other| says(other) == *reason), "{reason}");
            }
            // The order of those that come in has no effect.
            let mut those = constraints.clone();
            let mut index = 0;
            those.retain(|_| {
                index += 1;
                !expected.left_out.iter().any(|(left, _)| left + 1 == index)
            });
            those.reverse();
            those.iter_mut().for_each(|ends| ends.reverse());
            let other = constrained(&positions, &those, false).unwrap();
            assert!(
                other.triangles == result.triangles && other.twins == result.twins,
                "{name}, seed {seed}"
            );
            all += constraints.len();
            edges += result.constraint_edges.len();
            left_out += result.left_out.len();
        }
        println!("{name}: {all} constraints, {left_out} left out, {edges} edges");
    }
}

#[test]
fn a_constraint_that_crosses_another_is_an_error() {
    let square = wide(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
    let message = |constraints: &[[u32; 2]]| match constrained(&square, constraints, false).unwrap_err() {
        Error::Option { option: "constraints", message } => message,
        error => panic!("{error}"),
    };
    assert_eq!(
        message(&[[0, 2], [1, 1], [1, 3]]),
        "constraint 2 between 1 and 3 crosses constraint 0 between 0 and 2"
    );
    assert_eq!(message(&[[0, 1], [4, 0]]), "constraint 1 joins 4 and 0; there are 4 points");
    let [one, other] = [[[0, 2]], [[1, 3]]].map(|one| constrained(&square, &one, false).unwrap());
    assert_eq!((one.triangles, other.triangles), (vec![0, 1, 2, 0, 2, 3], vec![0, 1, 3, 1, 2, 3]));
}

/// Many constraints end at one point, pass through it, or cross all edges between two rows.
#[test]
fn many_constraints_are_fast() {
    let n = 20_000_u32;
    let mut wheel = points(KINDS[5].1, n as usize, 1);
    wheel.push([0.5, 0.5]);
    let spokes: Vec<[u32; 2]> = (0..n).map(|i| if i % 2 == 0 { [i, n] } else { [n, i] }).collect();
    let result = constrained(&wide(&wheel), &spokes, false).unwrap();
    assert_eq!(result.constraint_edges, spokes);
    assert_eq!(result.triangles.len(), 3 * n as usize);

    let mut track: Vec<[f64; 2]> = points(KINDS[0].1, n as usize, 1);
    track.iter_mut().for_each(|[x, y]| (*x, *y) = (*x * f64::from(n), *y - 0.5));
    track.extend([[-1.0, 0.0], [f64::from(n) + 1.0, 0.0]]);
    let positions = wide(&track);
    let result = constrained(&positions, &[[n, n + 1]], false).unwrap();
    check(&positions, &result);
    assert_eq!(result.constraint_edges, [[n, n + 1]]);
}
