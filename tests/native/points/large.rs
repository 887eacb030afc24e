//! Ten sets of a million points in the full run, else of a few thousand: each as the oracle defines it, and with the same
//! bits on one thread and on eight.

use super::{KINDS, is_full, oracle::check, points, shuffled, threads::on_threads, wide};
use oorandom::Rand64;

/// Points with whole coordinates. The oracle decides most of them in words.
fn whole(points: &[[f64; 2]], scale: f64) -> Vec<[f64; 2]> {
    points.iter().map(|point| point.map(|x| (scale * x).round())).collect()
}

/// A set of the tests with few points, rounded to multiples of 2^-30.
fn of_kind(name: &str, n: usize) -> Vec<[f64; 2]> {
    let (_, kind) = KINDS.into_iter().find(|&(other, _)| other == name).unwrap();
    whole(&points(kind, n, 1), libm::exp2(30.0))
}

/// Points of the parabola y = x², which are exact: two pairs with the same sum but for its sign are on one circle.
fn parabola(n: usize) -> Vec<[f64; 2]> {
    (0..n).map(|i| i as f64 - (n / 2) as f64).map(|x| [x, x * x]).collect()
}

/// Like the borders of a map: lines of short steps on a lattice. Most are there twice, as those between two
/// countries are, in both directions.
fn borders(n: usize) -> Vec<[f64; 2]> {
    let mut random = Rand64::new(1);
    let mut points: Vec<[f64; 2]> = Vec::with_capacity(n);
    while points.len() < n {
        let start = points.len();
        let mut place = [0; 2].map(|_| random.rand_range(0..1 << 16) as f64);
        let mut angle = std::f64::consts::TAU * random.rand_float();
        for _ in 0..random.rand_range(2..60) {
            points.push(place.map(f64::round));
            angle += random.rand_float() - 0.5;
            let step = 12.0 * random.rand_float();
            place = [place[0] + step * libm::cos(angle), place[1] + step * libm::sin(angle)];
        }
        if random.rand_range(0..10) != 0 {
            points.extend_from_within(start..);
            let middle = start.midpoint(points.len());
            points[middle..].reverse();
        }
    }
    points.truncate(n);
    points
}

#[test]
fn ten_sets_are_as_the_oracle_defines_them() {
    let side: usize = if is_full() { 1000 } else { 60 };
    let n = side * side;
    let sorted = of_kind("sorted", n);
    let sets = [
        ("uniform", of_kind("uniform", n)),
        ("clusters", of_kind("clusters", n)),
        ("lattice", whole(&points(KINDS[10].1, n, 1), 1024.0)),
        ("circle", whole(&points(KINDS[5].1, n, 1), libm::exp2(52.0))),
        ("parabola", parabola(n)),
        ("spiral", of_kind("spiral", n)),
        ("two lines", of_kind("two lines", n)),
        ("shuffled", shuffled(&sorted, &mut Rand64::new(2))),
        ("sorted", sorted),
        ("borders", borders(n)),
    ];
    for (name, points) in sets {
        let positions = wide(&points);
        let one = on_threads(&positions, 1).unwrap();
        assert!(one == on_threads(&positions, 8).unwrap(), "{name}");
        let ties = check(&positions, &one).into_iter().filter(|&tied| tied).count() / 2;
        let repeated = one.duplicates.len();
        println!(
            "{name}: {} triangles, {} points on the hull, {repeated} repeated, {ties} ties",
            one.triangles.len() / 3,
            one.hull.len()
        );
        match name {
            "lattice" => assert_eq!(ties, (side - 1).pow(2)),
            "borders" => assert!((45..50).contains(&(100 * repeated / n)), "{repeated}"),
            _ => {}
        }
    }
}
