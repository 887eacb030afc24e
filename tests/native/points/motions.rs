//! 424 points of a disc move in 430 frames: by little and by much, alone and together, across the hull and back. After each
//! frame a session has the triangulation of the points as they are, which is as the oracle defines it.

use super::{oracle::check, wide};
use edgeflip::{PointSession, triangulate};
use oorandom::Rand64;
use std::f64::consts::TAU;

/// Around a disc of radius 1, and in it.
const RING: usize = 24;
const INSIDE: usize = 400;

/// The mean distance between neighbours.
const SPACING: f64 = 0.1;

/// Moves points from a frame to the next. It gets the number of the frame, and where the points were at first.
type Motion = fn(f64, &[[f64; 2]], &mut [[f64; 2]], &mut Rand64);

/// Motions, and how many frames each has.
const MOTIONS: [(&str, u32, Motion); 8] = [
    ("each by up to 0.05 spacings", 60, |_, _, points, random| wander(points, 0.05, random)),
    ("each by up to 0.2 spacings", 60, |_, _, points, random| wander(points, 0.2, random)),
    ("each by up to 0.5 spacings", 60, |_, _, points, random| wander(points, 0.5, random)),
    ("each by up to 1 spacing", 60, |_, _, points, random| wander(points, 1.0, random)),
    ("one by 8 spacings, and back", 60, |_, first, points, random| {
        points.copy_from_slice(first);
        let [dx, dy] = on_circle(8.0 * SPACING, random);
        let [x, y] = one_of(points, random);
        (*x, *y) = (*x + dx, *y + dy);
    }),
    ("one to any place", 60, |_, _, points, random| {
        let radius = 1.4 * random.rand_float();
        *one_of(points, random) = on_circle(radius, random);
    }),
    ("all to any place", 10, |_, _, points, random| {
        points.iter_mut().for_each(|point| *point = anywhere(random));
    }),
    ("all turn, with a wave", 60, |frame, first, points, _| {
        let (sin, cos) = (libm::sin(0.05 * frame), libm::cos(0.05 * frame));
        let [wide, high] = [libm::sin(0.3 * frame), libm::cos(0.2 * frame)].map(|x| 1.0 + 0.5 * x);
        for (point, &[x, y]) in points.iter_mut().zip(first) {
            let wave = 0.3 * libm::sin(4.0 * x + 0.5 * frame);
            *point = [wide * (x * cos - y * sin), high * (x * sin + y * cos) + wave];
        }
    }),
];

fn anywhere(random: &mut Rand64) -> [f64; 2] {
    [0; 2].map(|_| 2.0 * random.rand_float() - 1.0)
}

fn on_circle(radius: f64, random: &mut Rand64) -> [f64; 2] {
    let angle = TAU * random.rand_float();
    [radius * libm::cos(angle), radius * libm::sin(angle)]
}

fn one_of<'a>(points: &'a mut [[f64; 2]], random: &mut Rand64) -> &'a mut [f64; 2] {
    let count = points.len() as u64;
    &mut points[random.rand_range(0..count) as usize]
}

/// Each point moves by up to so many spacings, and stays in a disc of radius 1.5.
fn wander(points: &mut [[f64; 2]], most: f64, random: &mut Rand64) {
    for point in points {
        let [dx, dy] = on_circle(most * SPACING * random.rand_float(), random);
        let [x, y] = [point[0] + dx, point[1] + dy];
        let scale = (1.5 / libm::hypot(x, y)).min(1.0);
        *point = [scale * x, scale * y];
    }
}

/// On a lattice, so that the oracle decides in words.
fn rounded(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let unit = libm::exp2(24.0);
    points.iter().map(|point| point.map(|x| (x * unit).round() / unit)).collect()
}

#[test]
fn every_frame_has_the_triangulation_of_its_points() {
    let mut random = Rand64::new(1);
    let mut first: Vec<[f64; 2]> = (0..RING)
        .map(|i| TAU * i as f64 / RING as f64)
        .map(|angle| [libm::cos(angle), libm::sin(angle)])
        .collect();
    while first.len() < RING + INSIDE {
        let [x, y] = anywhere(&mut random);
        if x * x + y * y <= 0.9 {
            first.push([x, y]);
        }
    }
    for (name, frames, motion) in MOTIONS {
        let mut points = first.clone();
        let mut session = PointSession::new(&wide(&rounded(&points)), None).unwrap();
        for frame in 0..frames {
            motion(f64::from(frame), &first, &mut points, &mut random);
            let positions = wide(&rounded(&points));
            session.update(&positions).unwrap();
            let expected = triangulate(&positions).unwrap();
            check(&positions, &expected);
            assert!(session.triangulation().unwrap() == expected, "{name}, frame {frame}");
        }
    }
    assert_eq!(MOTIONS.iter().map(|(_, frames, _)| frames).sum::<u32>(), 430);
}
