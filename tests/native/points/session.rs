//! After each call, a session has the triangulation that `triangulate` makes of the present points, and finds what a search
//! through all of them finds.

use super::oracle::{area, integers};
use super::{KINDS, Kind, points, seeds, wide};
use edgeflip::{Error, PointSession, Positions, Triangulation, triangulate};
use num_bigint::BigInt;
use oorandom::Rand64;

/// A session, and the points that it should have.
struct Pair {
    session: PointSession,
    points: Vec<Option<[f64; 2]>>,
}

impl Pair {
    fn new(points: Vec<[f64; 2]>) -> Self {
        let session = PointSession::new(&wide(&points), None).unwrap();
        Self { session, points: points.into_iter().map(Some).collect() }
    }

    fn present(&self) -> Vec<u32> {
        (0..).zip(&self.points).filter_map(|(i, point)| point.is_some().then_some(i)).collect()
    }

    fn any(&self, random: &mut Rand64) -> Option<u32> {
        let present = self.present();
        (!present.is_empty()).then(|| present[random.rand_range(0..present.len() as u64) as usize])
    }

    fn add(&mut self, point: [f64; 2]) {
        assert_eq!(self.session.add(point).unwrap() as usize, self.points.len());
        self.points.push(Some(point));
    }

    fn remove(&mut self, index: u32) {
        assert!(self.session.remove(index) && !self.session.remove(index));
        self.points[index as usize] = None;
    }

    fn move_to(&mut self, index: u32, point: [f64; 2]) {
        self.session.move_to(index, point).unwrap();
        self.points[index as usize] = Some(point);
    }

    fn update(&mut self, mut at: impl FnMut([f64; 2]) -> [f64; 2]) {
        self.points.iter_mut().flatten().for_each(|point| *point = at(*point));
        let points: Vec<_> = self.points.iter().map(|point| point.unwrap_or([f64::NAN; 2])).collect();
        self.session.update(&wide(&points)).unwrap();
    }

    fn check(&mut self, what: &str) {
        let present = self.present();
        let points: Vec<_> = self.points.iter().flatten().copied().collect();
        let index = |vertex: u32| present[vertex as usize];
        let expected = triangulate(&wide(&points)).unwrap();
        let expected = Triangulation {
            triangles: expected.triangles.into_iter().map(index).collect(),
            hull: expected.hull.into_iter().map(index).collect(),
            duplicates: expected.duplicates.into_iter().map(|pair| pair.map(index)).collect(),
            ..expected
        };
        assert!(self.session.triangulation().unwrap() == expected, "{what}");
        let parts = (self.session.triangles().unwrap(), self.session.hull());
        assert!(parts == (expected.triangles, expected.hull), "{what}");
    }

    /// Asks for the triangle and the point at a place.
    fn ask(&mut self, place: [f64; 2], what: &str) {
        let present = self.present();
        let mut numbers: Vec<f64> = self.points.iter().flatten().flatten().copied().collect();
        numbers.extend(place);
        let integers = integers(&Positions::from(numbers));
        let (place_at, at) = integers.split_last().unwrap();
        let distance = |i: usize| -> BigInt { (0..2).map(|k| (&at[i][k] - &place_at[k]).pow(2)).sum() };
        let nearest = (0..at.len()).min_by_key(|&i| (distance(i), i)).map(|i| present[i]);
        assert_eq!(self.session.nearest(place), nearest, "{what}");
        let of = |index: u32| &at[present.binary_search(&index).unwrap()];
        let triangles = self.session.triangulation().unwrap().triangles;
        let is_there = |&&[a, b, c]: &&[u32; 3]| {
            [[a, b], [b, c], [c, a]].iter().all(|&[u, v]| area(of(u), of(v), place_at) >= BigInt::ZERO)
        };
        let triangle = triangles.as_chunks().0.iter().find(is_there).copied();
        assert_eq!(self.session.locate(place), triangle, "{what}");
    }
}

/// A place near a point, at one, between two, or anywhere.
fn place(pair: &Pair, random: &mut Rand64) -> [f64; 2] {
    let mut any = || pair.any(random).map_or([0.0; 2], |index| pair.points[index as usize].unwrap());
    let [p, q] = [any(), any()];
    let mut jitter = || random.rand_float() - 0.5;
    match random_of(&mut jitter, 5) {
        0 => p,
        1 => [p[0] + 0.1 * jitter(), p[1] + 0.1 * jitter()],
        2 => [0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1])],
        3 => [1e3 * jitter(), 1e3 * jitter()],
        _ => [p[0], q[1]],
    }
}

fn random_of(jitter: &mut impl FnMut() -> f64, most: usize) -> usize {
    ((jitter() + 0.5) * most as f64) as usize
}

fn run(name: &str, kind: Kind, n: usize, seed: u64, calls: usize) {
    let mut random = Rand64::new(u128::from(seed));
    let mut pair = Pair::new(points(kind, n, seed));
    for call in 0..calls {
        let what = format!("{name}, {n} points, seed {seed}, call {call}");
        let (index, place) = (pair.any(&mut random), place(&pair, &mut random));
        match (random.rand_range(0..9), index) {
            (0 | 1, _) | (_, None) => pair.add(place),
            (2, Some(index)) => pair.remove(index),
            (3, Some(index)) => pair.move_to(index, place),
            (4, Some(_)) => {
                let all = random.rand_float() < 0.5;
                let size = libm::exp10(-3.0 * random.rand_float());
                let share = if all { 1.0 } else { 0.05 };
                pair.update(|p| {
                    let is_moved = random.rand_float() < share;
                    let size = if is_moved { size } else { 0.0 };
                    p.map(|x| x + size * (random.rand_float() - 0.5))
                });
            }
            (5, Some(_)) => {
                let angle = random.rand_float();
                let (sin, cos) = (libm::sin(angle), libm::cos(angle));
                pair.update(|[x, y]| [cos * x - sin * y, sin * x + cos * y]);
            }
            // Coordinates that are equal, and points that are.
            (6, Some(_)) => pair.update(|p| p.map(|x| (16.0 * x).round() / 16.0)),
            (7, Some(_)) => pair.update(|[x, y]| [x, y + 0.3 * libm::sin(5.0 * x)]),
            (_, Some(_)) => pair.ask(place, &what),
        }
        if random.rand_range(0..4) != 0 {
            pair.check(&what);
        }
    }
    pair.check(name);
}

#[test]
fn every_call_leaves_the_triangulation_of_the_points() {
    for (name, kind) in KINDS {
        for seed in 1..=seeds() {
            let n = libm::pow(250.0, Rand64::new(u128::from(seed)).rand_float()) as usize;
            run(name, kind, n, seed, 60);
        }
        run(name, kind, 2000, 1, 30);
    }
}

#[test]
fn points_come_one_by_one_and_go() {
    let mut random = Rand64::new(1);
    for (name, kind) in KINDS {
        let points = points(kind, 300, 2);
        let mut pair = Pair::new(Vec::new());
        for &point in &points {
            pair.add(point);
            pair.check(name);
        }
        while let Some(index) = pair.any(&mut random) {
            pair.remove(index);
            pair.check(name);
        }
        for point in points {
            pair.add(point);
        }
        pair.check(name);
    }
}

#[test]
fn calls_that_are_refused_change_nothing() {
    let mut pair = Pair::new(points(KINDS[0].1, 100, 1));
    let session = &mut pair.session;
    assert!(matches!(session.add([0.0, f64::NAN]), Err(Error::NonFinite { vertex: 100, axis: 'y', .. })));
    assert!(matches!(
        session.move_to(7, [f64::INFINITY, 0.0]),
        Err(Error::NonFinite { vertex: 7, axis: 'x', .. })
    ));
    assert!(matches!(session.move_to(100, [0.0; 2]), Err(Error::Option { option: "index", .. })));
    let mut numbers = vec![0.5; 200];
    numbers[91] = f64::NEG_INFINITY;
    let update = session.update(&Positions::from(numbers));
    assert!(matches!(update, Err(Error::NonFinite { vertex: 45, axis: 'y', .. })));
    let update = session.update(&Positions::from(vec![0.5; 198]));
    assert!(matches!(update, Err(Error::PositionCount { length: 198, expected: 200 })));
    assert!(!session.remove(100));
    for nowhere in [[f64::NAN, 0.0], [0.0, f64::INFINITY]] {
        assert_eq!((session.locate(nowhere), session.nearest(nowhere)), (None, None));
    }
    pair.check("");
}
