//! The number of threads does not change the triangulation.

use super::{KINDS, is_full, oracle::check, points, wide};
use edgeflip::{Error, MOST_THREADS, PointOptions, Positions, Triangulation, triangulate_with};
use oorandom::Rand64;
use std::num::NonZeroUsize;

pub fn on_threads(positions: &Positions, threads: usize) -> Result<Triangulation, Error> {
    triangulate_with(positions, &PointOptions { threads: NonZeroUsize::new(threads), ..Default::default() })
}

/// The triangulation, which is the same on any number of threads.
fn same(name: &str, positions: &Positions) -> Triangulation {
    let one = on_threads(positions, 1).unwrap();
    for threads in [2, 3, 8, 0] {
        assert!(one == on_threads(positions, threads).unwrap(), "{name} on {threads} threads");
    }
    one
}

/// Sets that leave columns empty, or that have nearly all points in one, once or several times over.
fn odd_sets(n: usize) -> Vec<(&'static str, Vec<[f64; 2]>)> {
    let mut random = Rand64::new(1);
    let mut uniform = || [random.rand_float(), random.rand_float()];
    let mut every = |point: fn(f64, f64) -> [f64; 2]| -> Vec<[f64; 2]> {
        (0..n).map(|_| uniform()).map(|[x, y]| point(x, y)).collect()
    };
    let mut far = every(|x, y| [x, y]);
    for (i, scale) in [1e9, 1e18, 1e40, 1e300].into_iter().enumerate() {
        far.push([scale, 0.1 * i as f64]);
        far.insert(n / 2, [0.5 * -scale, scale]);
    }
    vec![
        ("far away", far),
        ("two clusters, far apart", every(|x, y| [x + if y < 0.5 { 0.0 } else { 1e6 }, y])),
        ("ever closer", every(|x, y| [libm::exp2(-900.0 * x), y])),
        ("one value of x", every(|x, y| [3.0, x - y])),
        ("one value of y", every(|x, y| [x - y, -7.0])),
        ("few values", every(|x, y| [(40.0 * x).round(), (50.0 * y - 25.0).round()])),
        ("zeros of both signs", every(|x, y| [(4.0 * x - 2.0).round() * y, (4.0 * y - 2.0).round() * x])),
        ("one point", every(|x, _| [0.0 * (x - 0.5), 2.0])),
        ("wide", every(|x, y| [1e7 * x, y])),
        ("wide, normal", every(|x, y| [1e4 * libm::log(x + 1e-9) * libm::cos(9.0 * y), 1e-3 * y])),
    ]
}

#[test]
fn few_points() {
    for (name, kind) in KINDS {
        for (n, seed) in [(40, 1), (100, 2), (1000, 3), (3000, 4)] {
            let positions = wide(&points(kind, n, seed));
            same(name, &positions);
            same(name, &Positions::from(positions.to_f32()));
        }
    }
    for (name, points) in odd_sets(2000) {
        let positions = wide(&points);
        check(&positions, &same(name, &positions));
    }
}

/// So many that every loop has several pieces.
#[test]
fn many_points() {
    for (name, kind) in KINDS {
        if is_full() || ["uniform", "lattice", "half of them repeated", "tight clusters"].contains(&name) {
            same(name, &wide(&points(kind, 200_000, 1)));
        }
    }
    for (name, points) in odd_sets(200_000) {
        if is_full() || ["far away", "ever closer", "few values", "wide, normal"].contains(&name) {
            same(name, &wide(&points));
        }
    }
}

#[test]
fn too_many_threads_are_refused() {
    let positions = wide(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]);
    assert_eq!(on_threads(&positions, MOST_THREADS).unwrap().triangles, [0, 1, 2]);
    let error = on_threads(&positions, MOST_THREADS + 1).unwrap_err();
    assert!(matches!(error, Error::Option { option: "threads", .. }), "{error}");
}
