//! Meshes of 424 vertices, and motions that turn their triangles over: the table of the design.

use super::oracle::{Point, boundary};
use edgeflip::{Dimension, Mesh, Options, constrained, make_delaunay};
use std::f64::consts::TAU;
use std::ops::ControlFlow;

pub(super) const RING: usize = 24;

/// Numbers from 0 to 1.
#[derive(Clone)]
pub(super) struct Random(pub(super) u64);

impl Random {
    pub(super) fn next(&mut self) -> f64 {
        for (left, by) in [(true, 13), (false, 7), (true, 17)] {
            self.0 ^= if left { self.0 << by } else { self.0 >> by };
        }
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
}

pub(super) type Place = [f64; 2];

/// A mesh at rest.
#[derive(Clone)]
pub(super) struct Scene {
    pub(super) places: Vec<Place>,
    pub(super) triangles: Vec<u32>,
    pub(super) locked: Vec<[u32; 2]>,
}

/// Where a place goes in a frame.
type Stirrer = fn(Place, usize) -> Place;

/// What a motion makes of the places in a frame.
pub(super) type Step = Box<dyn Fn(&mut State)>;

/// A moving mesh.
pub(super) struct State {
    pub(super) frame: usize,
    pub(super) places: Vec<Place>,
    pub(super) triangles: Vec<u32>,
    pub(super) random: Random,
}

pub(super) struct Motion {
    pub(super) name: String,
    pub(super) scene: Scene,
    /// Whether each frame begins from rest.
    pub(super) resets: bool,
    pub(super) frames: usize,
    pub(super) step: Step,
    /// Whether the boundary is a convex ring and no four places are cocircular: then the Delaunay triangles are those of
    /// delaunator.
    pub(super) is_convex: bool,
}

pub(super) fn is_inside([x, y]: Place) -> bool {
    x * x + y * y <= 0.9
}

fn on_grid(places: &[Place]) -> Vec<Point> {
    places.iter().map(|p| p.map(|x| (x * f64::from(1 << 20)).round() as i64)).collect()
}

fn numbers(places: &[Place]) -> Vec<f64> {
    on_grid(places).into_iter().flatten().map(|x| x as f64 / f64::from(1 << 20)).collect()
}

/// The Delaunay triangles of places.
pub(super) fn delaunay(numbers: &[f64]) -> Vec<u32> {
    let points: Vec<_> = numbers.chunks(2).map(|p| delaunator::Point { x: p[0], y: p[1] }).collect();
    let triangles = delaunator::triangulate(&points).triangles;
    // The crate's y axis points down.
    triangles.chunks(3).flat_map(|t| [t[0], t[2], t[1]]).map(|v| v as u32).collect()
}

/// A ring of `RING` vertices around `count` others.
pub(super) fn disc(count: usize, seed: u64) -> Scene {
    let ring = (0..RING).map(|i| {
        let angle = TAU * i as f64 / RING as f64;
        [angle.cos(), angle.sin()]
    });
    let mut random = Random(seed.wrapping_mul(2_654_435_761).wrapping_add(88_172_645_463_325_252));
    let mut places: Vec<Place> = ring.collect();
    while places.len() < RING + count {
        let place = [2.0 * random.next() - 1.0, 2.0 * random.next() - 1.0];
        if is_inside(place) {
            places.push(place);
        }
    }
    let triangles = delaunay(&numbers(&places));
    Scene { places, triangles, locked: Vec::new() }
}

/// A disc in which `chain` gives the first places inside, joined in their order; the others stay away from them.
fn with_chain(chain: &[Place], is_hole: bool) -> Scene {
    let mut scene = disc(400, 3);
    let count = chain.len();
    scene.places[RING..RING + count].copy_from_slice(chain);
    let mut random = Random(7919);
    let is_near = |p: Place| {
        let within = |q: Place, r: f64| (p[0] - q[0]).hypot(p[1] - q[1]) < r;
        chain.iter().any(|&q| within(q, 0.03)) || is_hole && within([0.4, 0.0], 0.21)
    };
    for place in &mut scene.places[RING + count..] {
        while is_near(*place) || !is_inside(*place) {
            *place = [2.0 * random.next() - 1.0, 2.0 * random.next() - 1.0];
        }
    }
    let vertex = |i: usize| (RING + i % count) as u32;
    let edges: Vec<[u32; 2]> =
        (0..if is_hole { count } else { count - 1 }).map(|i| [vertex(i), vertex(i + 1)]).collect();
    let numbers = numbers(&scene.places);
    let mesh = Mesh::new(Dimension::Two, numbers.clone(), delaunay(&numbers)).unwrap();
    let made = constrained(&mesh, &edges, &[], false, 0.0, None).unwrap();
    scene.triangles = made.mesh.triangles().to_vec();
    if is_hole {
        let is_in_hole = |t: &[u32]| t.iter().all(|&v| (RING..RING + count).contains(&(v as usize)));
        scene.triangles = scene.triangles.chunks(3).filter(|t| !is_in_hole(t)).flatten().copied().collect();
        assert_eq!(boundary(&scene.triangles).len(), RING + count);
    } else {
        scene.locked = edges;
    }
    let mesh = mesh.with_triangles(scene.triangles).unwrap();
    let options = Options { locked_edges: scene.locked.clone(), ..Options::default() };
    scene.triangles = make_delaunay(&mesh, &options, |_, _| ControlFlow::Continue(())).unwrap().triangles;
    scene
}

/// A place at most `most` away from `from`, inside.
fn near(from: Place, most: f64, state: &mut Random, is_exact: bool) -> Place {
    loop {
        let angle = TAU * state.next();
        let length = if is_exact { most } else { most * state.next() };
        let place = [from[0] + length * angle.cos(), from[1] + length * angle.sin()];
        if is_inside(place) {
            return place;
        }
    }
}

fn anywhere(random: &mut Random) -> Place {
    loop {
        let place = [2.0 * random.next() - 1.0, 2.0 * random.next() - 1.0];
        if is_inside(place) {
            return place;
        }
    }
}

fn turned([x, y]: Place, angle: f64) -> Place {
    let (sin, cos) = angle.sin_cos();
    [x * cos - y * sin, x * sin + y * cos]
}

/// All motions on a disc of `count` vertices inside; those with a chain have 400.
pub(super) fn motions(count: usize) -> Vec<Motion> {
    let length = 2.0 / (count as f64).sqrt();
    let rest = disc(count, 1);
    let mut all = Vec::new();
    let mut add = |name: String, scene: &Scene, frames, resets, is_convex, step: Step| {
        all.push(Motion { name, scene: scene.clone(), frames, resets, is_convex, step });
    };
    for k in [0.5, 1.0, 2.0, 4.0, 8.0] {
        let step = move |state: &mut State| loop {
            let v = RING + (state.random.next() * count as f64) as usize;
            let angle = TAU * state.random.next();
            let [x, y] = state.places[v];
            let place = [x + k * length * angle.cos(), y + k * length * angle.sin()];
            if is_inside(place) {
                state.places[v] = place;
                break;
            }
        };
        add(format!("drag {k}"), &rest, 60, true, true, Box::new(step));
    }
    for k in [0.05, 0.1, 0.2, 0.5, 1.0] {
        let step = move |State { places, random, .. }: &mut State| {
            for place in &mut places[RING..] {
                *place = near(*place, k * length, random, false);
            }
        };
        add(format!("all move {k}"), &rest, 60, false, true, Box::new(step));
    }
    for factor in [1.0, 1.6, 1.9] {
        add(format!("lloyd {factor}"), &rest, 60, false, true, Box::new(move |state| lloyd(state, factor)));
    }
    let stirrers: [(&str, Stirrer); 3] = [
        ("rigid", |p, _| if p[0] * p[0] + p[1] * p[1] < 0.36 { turned(p, 0.3) } else { p }),
        ("smooth", |p, _| turned(p, 0.5 * (-6.0 * (p[0] * p[0] + p[1] * p[1])).exp())),
        ("paddle", |p, frame| {
            let [u, w] = turned(p, -(frame as f64) * 0.35);
            if u.abs() < 0.7 && w.abs() < 0.12 { turned(p, 0.35) } else { p }
        }),
    ];
    for (name, stir) in stirrers {
        let step = move |State { places, frame, .. }: &mut State| {
            places[RING..].iter_mut().for_each(|place| *place = stir(*place, *frame));
        };
        add(format!("stirrer {name}"), &rest, 60, false, true, Box::new(step));
    }
    for wave in [0.1, 0.2, 0.3, 0.45] {
        let origin = rest.places.clone();
        let step = move |State { places, frame, random, .. }: &mut State| {
            let f = *frame as f64;
            for (v, (place, [x, y])) in places.iter_mut().zip(&origin).enumerate() {
                let (r, a) = (x.hypot(*y), y.atan2(*x));
                let g = 1.0 + wave * (5.0 * a + f * 0.9).sin() * r - wave * 0.3 * (f * 1.7).sin();
                let angle = a + 0.4 * (f * 0.7).sin() * r;
                let mut noise = || if v < RING { 0.0 } else { 0.3 * length * (random.next() - 0.5) };
                *place = [0.8 * r * g * angle.cos() + noise(), 0.8 * r * g * angle.sin() + noise()];
            }
        };
        add(format!("boundary wave {wave}"), &rest, 60, false, false, Box::new(step));
    }
    for k in [0.1, 0.3, 0.6] {
        let origin = rest.places.clone();
        let step = move |State { places, random, .. }: &mut State| {
            for (v, (place, [x, y])) in places.iter_mut().zip(&origin).enumerate() {
                let angle = TAU * random.next();
                let by = k * if v < RING { 0.26 } else { length } * random.next();
                *place = [x + by * angle.cos(), y + by * angle.sin()];
            }
        };
        add(format!("boundary jitter {k}"), &rest, 60, false, false, Box::new(step));
    }
    for (name, part, frames) in [("all jump", 1.0, 10), ("5 % jump", 0.05, 60)] {
        let step = move |State { places, random, .. }: &mut State| {
            for place in &mut places[RING..] {
                if random.next() < part {
                    *place = anywhere(random);
                }
            }
        };
        add(name.to_owned(), &rest, frames, false, true, Box::new(step));
    }
    for per_length in [6.4, 20.0, 100.0] {
        let steps = per_length * (count as f64).sqrt() / 2.0;
        let step = move |State { places, random, .. }: &mut State| {
            for place in &mut places[RING..] {
                loop {
                    let moved =
                        near(*place, 0.3 * length, random, false).map(|x| (x * steps).round() / steps);
                    if is_inside(moved) {
                        *place = moved;
                        break;
                    }
                }
            }
        };
        add(format!("lattice {per_length}"), &rest, 60, false, false, Box::new(step));
    }
    const HOLE: usize = 14;
    let around = |[x, y]: Place, turn: f64, i: usize| {
        let angle = TAU * i as f64 / HOLE as f64 + turn;
        [x + 0.15 * angle.cos(), y + 0.15 * angle.sin()]
    };
    let hole: Vec<Place> = (0..HOLE).map(|i| around([0.4, 0.0], 0.0, i)).collect();
    let holed = with_chain(&hole, true);
    for by in [0.02, 0.1, 0.2, 0.4] {
        let step = move |State { places, frame, .. }: &mut State| {
            let f = *frame as f64 + 1.0;
            let center = turned([0.4, 0.0], f * by / 0.4);
            for i in 0..HOLE {
                places[RING + i] = around(center, 0.1 * f, i);
            }
            for place in &mut places[RING + HOLE..] {
                let [x, y] = [0, 1].map(|k| place[k] - center[k]);
                let d = x.hypot(y);
                if d < 0.17 {
                    let k = (0.17 + 0.2 * d) / d.max(1e-6);
                    *place = [center[0] + x * k, center[1] + y * k];
                }
            }
        };
        add(format!("hole {by}"), &holed, 60, false, false, Box::new(step));
    }
    let bar: Vec<Place> = (0..9).map(|i| [-0.4 + 0.1 * f64::from(i) + 0.003, 0.0017]).collect();
    let barred = with_chain(&bar, false);
    for angle in [0.02, 0.1, 0.35, 1.5] {
        let bar = bar.clone();
        let step = move |State { places, frame, .. }: &mut State| {
            for (place, from) in places[RING..].iter_mut().zip(&bar) {
                *place = turned(*from, angle * (*frame as f64 + 1.0));
            }
        };
        add(format!("bar {angle}"), &barred, 60, false, false, Box::new(step));
    }
    all
}

/// Moves each vertex towards the centre of its triangles, and by `factor` of the way.
fn lloyd(State { places, triangles, .. }: &mut State, factor: f64) {
    let mut sums = vec![[0.0; 3]; places.len()];
    for t in triangles.chunks(3) {
        let [a, b, c] = [0, 1, 2].map(|i| places[t[i] as usize]);
        let area = ((a[0] - c[0]) * (b[1] - c[1]) - (a[1] - c[1]) * (b[0] - c[0])).abs();
        for &v in t {
            for k in 0..2 {
                sums[v as usize][k] += area * (a[k] + b[k] + c[k]) / 3.0;
            }
            sums[v as usize][2] += area;
        }
    }
    for (place, sum) in places.iter_mut().zip(&sums).skip(RING) {
        for k in 0..2 {
            place[k] += factor * (sum[k] / sum[2].max(1e-9) - place[k]);
        }
    }
}
