//! Sets of points in the plane, for the tests and the benchmarks of `triangulate`.

use oorandom::Rand64;

/// A generator of sets: the number of points, and random numbers.
pub type Kind = fn(usize, &mut Rand64) -> Vec<[f64; 2]>;

/// What applications have, and what makes triangulations slow or wrong.
pub const KINDS: [(&str, Kind); 18] = [
    ("uniform", |n, random| every(n, |_| pair(random))),
    ("normal", |n, random| every(n, |_| normal(random).map(|x| 0.5 + 0.08 * x))),
    ("clusters", |n, random| clusters(n, random, 1.0)),
    ("tight clusters", |n, random| clusters(n, random, 0.03)),
    ("disc", |n, random| {
        every(n, |_| {
            let radius = 0.5 * random.rand_float().sqrt();
            on_circle(random, radius)
        })
    }),
    ("circle", |n, random| every(n, |_| on_circle(random, 0.5))),
    ("parabola", |n, random| {
        every(n, |_| {
            let x = 2.0 * random.rand_float() - 1.0;
            [0.5 + 0.5 * x, x * x]
        })
    }),
    ("spiral", |n, _| {
        every(n, |i| {
            let [angle, radius] = [0.6 * (i as f64).sqrt(), 0.5 * (i as f64 / n as f64).sqrt()];
            [0.5 + radius * libm::cos(angle), 0.5 + radius * libm::sin(angle)]
        })
    }),
    ("two lines", |n, random| {
        every(n, |_| {
            let x = random.rand_float();
            if random.rand_range(0..2) == 0 { [x, 0.5] } else { [0.5, x] }
        })
    }),
    ("few values of x", |n, random| {
        every(n, |_| [random.rand_range(0..8) as f64 / 8.0, random.rand_float()])
    }),
    ("lattice", |n, _| every(n, |i| lattice(i, n).map(|x| x / 1024.0))),
    ("lattice of spacing 0.1", |n, _| every(n, |i| lattice(i, n).map(|x| 0.1 * x))),
    ("turned lattice, repeated", |n, random| {
        let side = (n.isqrt() as u64 / 2).max(2);
        every(n, |_| {
            let [x, y] = [0; 2].map(|_| random.rand_range(0..side) as f64);
            [3.0 * x - y, x + 3.0 * y]
        })
    }),
    ("hexagons", |n, random| {
        every(n, |i| {
            let ([x, y], [dx, dy]) = (lattice(i, n), pair(random));
            [x + 0.5 * (y % 2.0) + 0.1 * dx, y + 0.1 * dy]
        })
    }),
    ("sorted", |n, random| {
        let mut points = every(n, |_| pair(random));
        points.sort_unstable_by(|p, q| p[0].total_cmp(&q[0]));
        points
    }),
    ("half of them repeated", |n, random| {
        let mut points = every(n.div_ceil(2), |_| pair(random));
        while points.len() < n {
            points.push(points[random.rand_range(0..points.len() as u64) as usize]);
        }
        points
    }),
    ("upright line", |n, random| every(n, |_| [0.7, random.rand_range(0..4 * n as u64) as f64])),
    ("slanted line and a point", |n, random| {
        let mut points = every(n, |_| {
            let x = random.rand_range(0..4 * n as u64) as f64;
            [x, 3.0 * x + 1.0]
        });
        if random.rand_range(0..2) == 0 {
            points[0][1] += 1.0;
        }
        points
    }),
];

/// The set of a kind, of `n` points.
pub fn points(kind: Kind, n: usize, seed: u64) -> Vec<[f64; 2]> {
    kind(n, &mut Rand64::new(seed.into()))
}

fn every(n: usize, point: impl FnMut(usize) -> [f64; 2]) -> Vec<[f64; 2]> {
    (0..n).map(point).collect()
}

fn pair(random: &mut Rand64) -> [f64; 2] {
    [random.rand_float(), random.rand_float()]
}

fn on_circle(random: &mut Rand64, radius: f64) -> [f64; 2] {
    let angle = std::f64::consts::TAU * random.rand_float();
    [0.5 + radius * libm::cos(angle), 0.5 + radius * libm::sin(angle)]
}

/// Two normal variates, by Box and Muller.
fn normal(random: &mut Rand64) -> [f64; 2] {
    let radius = (-2.0 * libm::log(1.0 - random.rand_float())).sqrt();
    let angle = std::f64::consts::TAU * random.rand_float();
    [radius * libm::cos(angle), radius * libm::sin(angle)]
}

/// Clusters of normal variates, whose widths differ by a factor of 100.
fn clusters(n: usize, random: &mut Rand64, width: f64) -> Vec<[f64; 2]> {
    let centres = every(random.rand_range(3..23) as usize, |_| pair(random).map(|x| 0.1 + 0.8 * x));
    let widths: Vec<f64> =
        centres.iter().map(|_| width * libm::exp10(-1.0 - 2.0 * random.rand_float())).collect();
    every(n, |_| {
        let i = random.rand_range(0..centres.len() as u64) as usize;
        let offset = normal(random);
        [0, 1].map(|axis| centres[i][axis] + widths[i] * offset[axis])
    })
}

/// A point of a square lattice, row by row.
fn lattice(i: usize, n: usize) -> [f64; 2] {
    let side = n.isqrt().max(1);
    [(i % side) as f64, (i / side) as f64]
}
