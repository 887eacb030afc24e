//! Points are triangulated as an oracle of integers of any size defines it, and as another crate does, up to ties.

mod cells;
mod constraints;
mod large;
mod long;
mod motions;
pub mod oracle;
mod session;
mod threads;
mod voronoi;

use crate::points_of::{KINDS, Kind, points};
use edgeflip::{Error, NONE, Positions, Triangulation, triangulate};
use oorandom::Rand64;
use oracle::check;
use std::collections::BTreeSet;

fn is_full() -> bool {
    std::env::var("EDGEFLIP_FULL").is_ok_and(|full| full == "1")
}

/// Each kind of points as often as this. The full run has the number that the project promises.
fn seeds() -> u64 {
    if is_full() { 1000 } else { 25 }
}

fn wide(points: &[[f64; 2]]) -> Positions {
    Positions::from(points.as_flattened().to_vec())
}

/// The triangulation, and for each half-edge whether its four points are on one circle.
fn checked(positions: &Positions) -> (Triangulation, Vec<bool>) {
    let result = triangulate(positions).unwrap();
    let tied = check(positions, &result);
    (result, tied)
}

/// From 1 to `most` points, more often few.
fn set(kind: Kind, most: f64, seed: u64) -> Vec<[f64; 2]> {
    let n = libm::pow(most, Rand64::new(seed.into()).rand_float());
    points(kind, n as usize, seed)
}

/// The points in another order.
fn shuffled(points: &[[f64; 2]], random: &mut Rand64) -> Vec<[f64; 2]> {
    let mut points = points.to_vec();
    for i in (1..points.len()).rev() {
        points.swap(i, random.rand_range(0..i as u64 + 1) as usize);
    }
    points
}

/// The triangles by their coordinates, from the least corner.
fn by_coordinates(points: &[[f64; 2]], result: &Triangulation) -> BTreeSet<[[u64; 2]; 3]> {
    let corner = |&v: &u32| points[v as usize].map(f64::to_bits);
    let turned = |triangle: &[u32; 3]| {
        let mut corners = triangle.each_ref().map(corner);
        let least = (0..3).min_by_key(|&i| corners[i]).unwrap();
        corners.rotate_left(least);
        corners
    };
    result.triangles.as_chunks().0.iter().map(turned).collect()
}

#[test]
fn every_kind_is_as_the_oracle_defines_it() {
    for (name, kind) in KINDS {
        let [mut triangles, mut flat, mut ties] = [0; 3];
        let mut add = |positions: &Positions| {
            let (result, tied) = checked(positions);
            triangles += result.triangles.len() / 3;
            flat += usize::from(result.is_flat());
            ties += tied.iter().filter(|&&tied| tied).count() / 2;
        };
        for seed in 1..=seeds() {
            let wide = wide(&set(kind, 300.0, seed));
            add(&Positions::from(wide.to_f32()));
            add(&wide);
        }
        // Many columns.
        add(&wide(&points(kind, 2000, 1)));
        println!("{name}: {triangles} triangles, {flat} sets without one, {ties} ties");
    }
}

#[test]
fn the_order_of_the_points_has_no_effect() {
    let mut random = Rand64::new(1);
    for (name, kind) in KINDS {
        for seed in 1..=seeds() {
            let points = set(kind, 1000.0, seed);
            let turned = shuffled(&points, &mut random);
            let [one, other] =
                [&points, &turned].map(|points| by_coordinates(points, &triangulate(&wide(points)).unwrap()));
            assert!(one == other, "{name}, seed {seed}");
        }
    }
}

/// The numbers are far apart, subnormal or near the ends of their range.
#[test]
fn coordinates_of_any_size_are_decided() {
    let mut random = Rand64::new(1);
    for round in 0..2 * seeds() {
        let n = 3 + round as usize % 40;
        let small = |most: u64, random: &mut Rand64| random.rand_range(0..most) as f64 - most as f64 / 2.0;
        let mut sets: Vec<Positions> = Vec::new();
        for scale in [1e-300, 5e-324, 1e-45, 1e300, f64::MAX / 5.0] {
            sets.push(Positions::from(
                (0..2 * n).map(|_| scale * small(9, &mut random)).collect::<Vec<f64>>(),
            ));
        }
        let far_apart = |random: &mut Rand64, range: i32| {
            let exponent = random.rand_range(0..2 * range as u64 + 1) as i32 - range;
            libm::scalbn(small(17, random), exponent)
        };
        for range in [30, 300, 1000] {
            sets.push(Positions::from(
                (0..2 * n).map(|_| far_apart(&mut random, range)).collect::<Vec<f64>>(),
            ));
        }
        let subnormal = |random: &mut Rand64| f32::from_bits(random.rand_range(0..9) as u32);
        sets.push(Positions::from((0..2 * n).map(|_| subnormal(&mut random)).collect::<Vec<f32>>()));
        let largest = |random: &mut Rand64| f32::MAX * (small(5, random) / 2.5) as f32;
        sets.push(Positions::from((0..2 * n).map(|_| largest(&mut random)).collect::<Vec<f32>>()));
        sets.iter().for_each(|positions| {
            checked(positions);
        });
    }
}

/// Nearly all points are in one of the first columns, and these are in one of the next.
#[test]
fn points_far_away_from_the_others_are_decided() {
    for (_, kind) in KINDS {
        let mut points = points(kind, 1000, 1);
        points.extend([[1e9, 0.25], [-1e40, 0.5], [1e40, -1e15], [3e9, 0.5]]);
        checked(&wide(&points));
    }
}

#[test]
fn a_point_with_many_neighbours_may_have_any_index() {
    let rim = points(KINDS[5].1, 1000, 1);
    for hub in [0, 500, 1000] {
        let mut wheel = rim.clone();
        wheel.insert(hub, [0.5, 0.5]);
        checked(&wide(&wheel));
    }
}

#[test]
fn points_without_a_triangle_say_so() {
    let line = [[2.0, 2.0], [0.0, 0.0], [-1.0, -1.0], [0.0, -0.0], [1.0, 1.0]];
    for n in 0..=line.len() {
        let (result, _) = checked(&wide(&line[..n]));
        assert!(result.is_flat());
    }
    let (result, _) = checked(&wide(&line));
    assert_eq!((result.hull, result.duplicates), (vec![2, 1, 4, 0], vec![[3, 1]]));
    let (result, _) = checked(&wide(&[[7.0, -0.0]; 9]));
    assert_eq!(result.hull, [0]);
}

#[test]
fn what_is_no_point_is_named() {
    let refused = |numbers: Vec<f64>| triangulate(&Positions::from(numbers)).unwrap_err();
    assert!(matches!(refused(vec![0.0; 5]), Error::RaggedArray { array: "positions", length: 5, stride: 2 }));
    for (axis, name) in ['x', 'y'].into_iter().enumerate() {
        for wrong in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let mut numbers = vec![0.5; 20];
            numbers[14 + axis] = wrong;
            let error = refused(numbers);
            assert!(matches!(error, Error::NonFinite { vertex: 7, axis, .. } if axis == name), "{error}");
        }
    }
}

/// The edges that both have to have are those without a tie.
#[test]
fn triangles_are_those_of_delaunator_up_to_ties() {
    let edges = |triangles: &[u32]| -> BTreeSet<[u32; 2]> {
        let sides = |&[a, b, c]: &[u32; 3]| [[a, b], [b, c], [c, a]];
        triangles.as_chunks().0.iter().flat_map(sides).map(|[a, b]| [a.min(b), a.max(b)]).collect()
    };
    for (name, kind) in KINDS {
        // The crate decides circles by rounded numbers.
        if ["circle", "parabola", "lattice of spacing 0.1"].contains(&name) {
            continue;
        }
        let points = points(kind, 3000, 1);
        let (result, tied) = checked(&wide(&points));
        let given: Vec<_> = points.iter().map(|&[x, y]| delaunator::Point { x, y }).collect();
        let theirs: Vec<u32> = delaunator::triangulate(&given).triangles.iter().map(|&v| v as u32).collect();
        // Of equal points, the crate may take another.
        let same = |v: u32| {
            result.duplicates.binary_search_by_key(&v, |pair| pair[0]).map_or(v, |i| result.duplicates[i][1])
        };
        let theirs = edges(&theirs.into_iter().map(same).collect::<Vec<u32>>());
        assert_eq!(edges(&result.triangles).len(), theirs.len(), "{name}");
        let corners = |h: usize| [h, if h % 3 == 2 { h - 2 } else { h + 1 }].map(|h| result.triangles[h]);
        for (h, _) in
            result.twins.iter().enumerate().filter(|&(h, &g)| !tied[h] && (g == NONE || h < g as usize))
        {
            let [a, b] = corners(h);
            assert!(theirs.contains(&[a.min(b), a.max(b)]), "{name}: {a} {b}");
        }
    }
}
