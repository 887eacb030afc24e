//! What a session begins with: positions and options.

use super::motions::Random;
use super::oracle::{Point, sides};
use super::wild::numbers;
use edgeflip::{Backend, Options, Order, Positions};
use std::collections::HashSet;
use std::num::NonZeroUsize;

/// How integers become positions: times a power of two.
const SCALES: [[i32; 4]; 2] = [[-20, 0, -1074, 900], [-20, 0, -149, 100]];

/// Positions, as integers and as a session gets them. A point is `None` if a number of it is not finite.
#[derive(Clone)]
pub(super) struct Places {
    pub(super) points: Vec<Option<Point>>,
    pub(super) positions: Positions,
}

impl Places {
    pub(super) fn new(points: Vec<Point>, is_single: bool, random: &mut Random) -> Self {
        let scale = SCALES[usize::from(is_single)][below(random, 4)];
        let numbers = numbers(&points, scale, random);
        let single = || numbers.iter().map(|&x| x as f32).collect::<Vec<_>>();
        let positions = if is_single { single().into() } else { numbers.into() };
        Self { points: points.into_iter().map(Some).collect(), positions }
    }

    pub(super) fn finite(&self) -> Option<Vec<Point>> {
        self.points.iter().copied().collect()
    }
}

pub(super) fn ordered([u, v]: [u32; 2]) -> [u32; 2] {
    [u.min(v), u.max(v)]
}

pub(super) fn below(random: &mut Random, count: usize) -> usize {
    (random.next() * count as f64) as usize
}

/// Options for a mesh, and the edges that they lock.
pub(super) fn options(triangles: &[u32], random: &mut Random) -> (Options, Vec<[u32; 2]>) {
    let mut options = Options {
        backend: Backend::Cpu,
        order: [Order::Reproducible, Order::Any][below(random, 2)],
        threads: NonZeroUsize::new([1, 8][below(random, 2)]),
        untangle: [None, None, Some(true), Some(false)][below(random, 4)],
        max_iterations: [None, None, None, Some(0), Some(2)][below(random, 5)],
        skips_constraints: true,
        ..Options::default()
    };
    options.track_changes = options.order == Order::Reproducible && below(random, 2) == 0;
    let mut locked: Vec<[u32; 2]> = Vec::new();
    if below(random, 3) == 0 {
        let part = random.next() * random.next();
        options.locked_edges = triangles.chunks(3).map(|t| [t[0], t[1]]).collect();
        options.locked_edges.retain(|_| random.next() < part);
        locked.extend(&options.locked_edges);
    }
    if below(random, 6) == 0 {
        let t = below(random, triangles.len() / 3);
        options.locked_triangles.push(t as u32);
        locked.extend(sides(&triangles[3 * t..3 * t + 3]));
    }
    if below(random, 6) == 0 {
        options.groups = triangles.chunks(3).map(|t| u32::from(t[0] % 3 == 0)).collect();
        let side = |group: u32| -> HashSet<[u32; 2]> {
            let of_group = triangles.chunks(3).zip(&options.groups).filter(|(_, g)| **g == group);
            of_group.flat_map(|(t, _)| sides(t)).map(ordered).collect()
        };
        locked.extend(side(0).intersection(&side(1)));
    }
    if below(random, 5) == 0 {
        let mut corner = || triangles[below(random, triangles.len())];
        options.constraints = (0..3).map(|_| [corner(), corner()]).filter(|[u, v]| u != v).collect();
    }
    (options, locked)
}
