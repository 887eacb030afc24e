//! What would take quadratic time with a fan of long triangles, or without a bound: one constraint, one vertex with many
//! neighbours, and a motion with many flips. Each is compared with the triangulation made anew.

use super::{oracle::check, wide};
use edgeflip::{PointOptions, PointSession, Positions, triangulate, triangulate_with};
use std::time::{Duration, Instant};

/// Far more than any of this takes, and far less than quadratic time.
const LONG: Duration = Duration::from_secs(3);

/// Points on a parabola, from -1 to 1.
fn parabola(n: u32, height: f64) -> Vec<[f64; 2]> {
    (0..=n).map(|i| 2.0 * f64::from(i) / f64::from(n) - 1.0).map(|t| [t, height * t * t]).collect()
}

#[test]
fn one_constraint_across_many_edges() {
    let n = 20_000;
    let mut points = parabola(n, 0.001);
    points.extend([[0.5, 100.0], [-1.5, 0.002], [1.5, 0.002]]);
    let positions = wide(&points);
    let start = Instant::now();
    let options = PointOptions { constraints: vec![[n + 3, n + 2]], ..PointOptions::default() };
    let result = triangulate_with(&positions, &options).unwrap();
    assert!(start.elapsed() < LONG, "{:?}", start.elapsed());
    check(&positions, &result);
    assert_eq!(result.constraint_edges, [[n + 3, n + 2]]);
}

#[test]
fn one_point_with_many_neighbours() {
    let n = 20_000;
    let mut points = parabola(n, 0.001);
    points.push([0.0, 100.0]);
    let mut session = PointSession::new(&wide(&points), None).unwrap();
    let start = Instant::now();
    for place in [[0.0, 90.0], [0.1, -90.0], [0.0, 0.0005]] {
        session.move_to(n + 1, place).unwrap();
        points[n as usize + 1] = place;
        assert!(session.triangulation().unwrap() == triangulate(&wide(&points)).unwrap());
    }
    assert!(start.elapsed() < LONG, "{:?}", start.elapsed());
}

/// One row of points moves along another one. No triangle turns over.
#[test]
fn a_motion_with_many_flips() {
    let m = 20_000;
    let row = |y: f64, by: f64| (0..m).flat_map(move |i| [f64::from(i) + by, y]);
    let rows = |by: f64| Positions::from(row(0.0, 0.0).chain(row(1.0, by)).collect::<Vec<f64>>());
    let mut session = PointSession::new(&rows(0.25), None).unwrap();
    let start = Instant::now();
    for by in [f64::from(m) / 2.0, 3.5] {
        session.update(&rows(by)).unwrap();
        assert!(session.triangulation().unwrap() == triangulate(&rows(by)).unwrap());
    }
    assert!(start.elapsed() < LONG, "{:?}", start.elapsed());
}
