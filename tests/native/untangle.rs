//! Meshes whose vertices go anywhere: whenever a triangulation exists, the session ends with the right one.
//!
//! Exact integers decide. The motions are those of the table in the design of the repair. The full run has all frames, and
//! 20,000 vertices too.

mod census;
mod components;
mod motions;
mod oracle;
mod sessions;
mod setup;
mod updates;
mod wild;

use edgeflip::{Backend, Dimension, Mesh, Options, Outcome, Session};
use motions::{Motion, State, delaunay, motions};
use oracle::{Point, blocks, boundary, fault, obstacle, set};
use pollster::block_on;
use std::num::NonZeroUsize;
use std::ops::ControlFlow;

fn is_full() -> bool {
    std::env::var("EDGEFLIP_FULL").is_ok_and(|full| full == "1")
}

/// How places become positions.
#[derive(Clone, Copy, Debug)]
enum Form {
    Plain,
    Shifted,
    Mirrored,
    Double,
}

impl Form {
    fn bits(self) -> u32 {
        if matches!(self, Self::Double) { 26 } else { 20 }
    }

    fn points(self, places: &[[f64; 2]]) -> Vec<Point> {
        let unit = (1i64 << self.bits()) as f64;
        let point = |p: &[f64; 2]| {
            let [x, y] = p.map(|x| (x * unit).round() as i64);
            match self {
                Self::Shifted => [x + (3 << self.bits()), y - (2 << self.bits())],
                Self::Mirrored => [-x, y],
                Self::Plain | Self::Double => [x, y],
            }
        };
        places.iter().map(point).collect()
    }

    fn numbers(self, points: &[Point]) -> Vec<f64> {
        points.iter().flatten().map(|&x| x as f64 / (1i64 << self.bits()) as f64).collect()
    }

    fn winding(self) -> i128 {
        if matches!(self, Self::Mirrored) { -1 } else { 1 }
    }
}

/// What became of the frames of a motion.
#[derive(Debug, Default, PartialEq)]
struct Tally {
    frames: usize,
    possible: usize,
    right: usize,
    tangled: usize,
}

fn session(motion: &Motion, form: Form, options: &Options) -> Session {
    let points = form.points(&motion.scene.places);
    let mesh = Mesh::new(Dimension::Two, form.numbers(&points), motion.scene.triangles.clone()).unwrap();
    let options = Options { locked_edges: motion.scene.locked.clone(), ..options.clone() };
    block_on(Session::new(mesh, options)).unwrap()
}

/// Runs a motion, and panics at the first frame that is not what it has to be.
fn run(motion: &Motion, form: Form, options: &Options, frames: usize) -> Tally {
    let mut session = session(motion, form, options);
    let border = boundary(&motion.scene.triangles);
    let count = motion.scene.triangles.len();
    let mut state = State {
        frame: 0,
        places: motion.scene.places.clone(),
        triangles: motion.scene.triangles.clone(),
        random: motions::Random(12345),
    };
    let mut tally = Tally::default();
    for frame in 0..frames {
        if motion.resets {
            session = self::session(motion, form, options);
            state.places.clone_from(&motion.scene.places);
        }
        state.frame = frame;
        (motion.step)(&mut state);
        let points = form.points(&state.places);
        let before = block_on(session.triangles()).unwrap();
        block_on(session.set_positions(form.numbers(&points))).unwrap();
        block_on(session.run(|_, _| ControlFlow::Continue(()))).unwrap();
        let outcome = block_on(session.outcome()).unwrap();
        let name = format!("{} {form:?}, frame {frame}", motion.name);
        assert_eq!(outcome.triangles.len(), count, "{name}");
        assert_eq!(boundary(&outcome.triangles), border, "{name}");
        let locked = &motion.scene.locked;
        tally.frames += 1;
        tally.tangled +=
            usize::from(fault(&points, &before, &[], form.winding()).is_some_and(|f| f.contains("positive")));
        let may_be_right =
            obstacle(&points, &border, form.winding()).is_none() && !blocks(&points, &border, locked);
        let fault = fault(&points, &outcome.triangles, locked, form.winding());
        tally.right += usize::from(fault.is_none());
        if may_be_right {
            tally.possible += 1;
            if let Some(fault) = fault {
                panic!("{name}: {fault}; {} inverted", outcome.inverted);
            }
            assert_eq!((outcome.inverted, outcome.flat), (0, 0), "{name}");
            if motion.is_convex
                && locked.is_empty()
                && matches!(form, Form::Plain | Form::Double | Form::Shifted)
            {
                let expected = delaunay(&form.numbers(&points));
                assert!(set(&outcome.triangles) == set(&expected), "{name}: not the triangles of delaunator");
            }
        }
        state.triangles = outcome.triangles;
    }
    tally
}

/// The table of the design.
#[test]
fn every_possible_frame_is_right() {
    let all = motions(400);
    let options = Options { backend: Backend::Cpu, ..Options::default() };
    for form in [Form::Plain, Form::Shifted, Form::Mirrored, Form::Double] {
        for motion in &all {
            let frames = if is_full() || matches!(form, Form::Plain) { motion.frames } else { 12 };
            let tally = run(motion, form, &options, frames);
            println!("{} {form:?}: {tally:?}", motion.name);
        }
    }
}

/// 20,000 vertices; `EDGEFLIP_MOTION` is a part of the names of those to run.
#[test]
fn many_vertices_are_right() {
    let only = std::env::var("EDGEFLIP_MOTION").unwrap_or_else(|_| "move".to_owned());
    let only = if is_full() { String::new() } else { only };
    let options = Options { backend: Backend::Cpu, ..Options::default() };
    let count = if is_full() { 20_000 } else { 3000 };
    let is_asked = |motion: &&Motion| motion.scene.places.len() > 1000 && motion.name.contains(&only);
    for motion in motions(count).iter().filter(is_asked) {
        let tally = run(motion, Form::Plain, &options, 3);
        println!("{}: {tally:?}", motion.name);
    }
}

/// The present triangles of a session, after a run.
fn flipped(session: &mut Session) -> Outcome {
    block_on(session.run(|_, _| ControlFlow::Continue(()))).unwrap();
    block_on(session.outcome()).unwrap()
}

/// A square of two triangles for each cell, whose vertices inside move by `move_by`, and the same again, mirrored and
/// apart: two components of opposite winding.
fn two_components(side: u32, seed: u64, move_by: f64) -> Mesh {
    let mut random = motions::Random(seed);
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for sign in [1.0, -1.0] {
        let first = positions.len() as u32 / 2;
        for v in 0..side * side {
            let (x, y) = (v % side, v / side);
            let is_inside = x > 0 && y > 0 && x < side - 1 && y < side - 1;
            let by = if is_inside { move_by } else { 0.0 };
            let mut at = |x: u32| (32768.0 * (f64::from(x) + by * (random.next() - 0.5))).round() / 32768.0;
            let (x, y) =
                (at(x).clamp(0.25, f64::from(side) - 1.25), at(y).clamp(0.25, f64::from(side) - 1.25));
            let (x, y) = if is_inside { (x, y) } else { (f64::from(v % side), f64::from(v / side)) };
            positions.extend([sign * (x + 1.0), y]);
        }
        for v in (0..side * (side - 1)).filter(|v| v % side < side - 1) {
            let [a, b, c, d] = [v, v + 1, v + side, v + side + 1].map(|v| first + v);
            triangles.extend([a, b, d, a, d, c]);
        }
    }
    Mesh::new(Dimension::Two, positions, triangles).unwrap()
}

/// Moves two components of opposite winding, with locked edges, on several engines: the same bits after each run.
fn compare(sides: u32, frames: u64, choices: &[Options]) {
    let mesh = two_components(sides, 1, 0.0);
    let locked_edges = mesh.triangles().chunks(3 * 7).map(|t| [t[0], t[1]]).collect::<Vec<_>>();
    let mut sessions: Vec<_> = choices
        .iter()
        .map(|options| {
            let options = Options { locked_edges: locked_edges.clone(), ..options.clone() };
            block_on(Session::new(mesh.clone(), options)).unwrap()
        })
        .collect();
    let border = boundary(mesh.triangles());
    let (mut tangled, mut lost) = (0, 0);
    for frame in 0..frames {
        let moved = two_components(sides, 77 + frame, [0.5, 1.5, 3.0, 0.0][frame as usize % 4]);
        let mut first: Option<Outcome> = None;
        for session in &mut sessions {
            let positions = moved.positions().iter().collect::<Vec<_>>();
            // Updates only flip; the run repairs what they leave.
            if frame % 2 == 1 {
                session.update(Some(moved.positions().clone()), 3).unwrap();
                tangled += u64::from(block_on(session.counters()).unwrap().inverted > 0);
            } else {
                block_on(session.set_positions(positions)).unwrap();
            }
            let outcome = flipped(session);
            let found = block_on(session.problems()).unwrap();
            assert_eq!((outcome.inverted, outcome.flat), (0, 0), "frame {frame}: {found:?}");
            assert!(block_on(session.verify()).unwrap().is_clean(), "frame {frame}");
            assert!(block_on(session.problems()).unwrap().is_empty(), "frame {frame}");
            match &first {
                None => {
                    assert_eq!(boundary(&outcome.triangles), border);
                    lost += outcome.lost_edges.len();
                    first = Some(outcome);
                }
                Some(first) => {
                    assert!(first.triangles == outcome.triangles, "frame {frame}");
                    assert_eq!(first.flips_per_iteration, outcome.flips_per_iteration, "frame {frame}");
                    assert_eq!(first.lost_edges, outcome.lost_edges, "frame {frame}");
                    assert_eq!(first.remaining, outcome.remaining, "frame {frame}");
                }
            }
        }
        // At rest all locked edges are there again.
        if frame % 4 == 3 {
            assert_eq!(first.unwrap().lost_edges, Vec::<[u32; 2]>::new(), "frame {frame}");
        }
    }
    println!("{tangled} tangled frames, {lost} locked edges lost");
    assert!(tangled > 0 && lost > 0);
}

fn on(backend: Backend, threads: usize) -> Options {
    Options { backend, threads: NonZeroUsize::new(threads), ..Options::default() }
}

#[cfg(feature = "gpu")]
#[test]
fn engines_agree() {
    let frames = if is_full() { 200 } else { 12 };
    compare(12, frames, &[on(Backend::Cpu, 1), on(Backend::Gpu, 1)]);
}

#[cfg(feature = "threads")]
#[test]
fn threads_agree() {
    // Large enough for several threads.
    compare(
        if cfg!(debug_assertions) { 70 } else { 186 },
        if is_full() { 8 } else { 4 },
        &[on(Backend::Cpu, 1), on(Backend::Cpu, 8)],
    );
}

/// A square around a vertex.
fn square(x: f64, y: f64) -> Mesh {
    let positions = vec![0.0, 0.0, 4.0, 0.0, 4.0, 4.0, 0.0, 4.0, x, y];
    Mesh::new(Dimension::Two, positions, vec![0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4]).unwrap()
}

fn positions(mesh: &Mesh) -> Vec<f64> {
    mesh.positions().iter().collect()
}

#[test]
fn the_option_says_when() {
    // The vertex is outside, over the right side.
    let folded = || {
        let mesh = square(1.0, 1.0);
        let triangles = vec![0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4];
        let far =
            Mesh::new(Dimension::Two, vec![0.0, 0.0, 4.0, 0.0, 4.0, 4.0, 0.0, 4.0, 1.0, 1.0, 3.0, 2.0], {
                let mut all = triangles[..9].to_vec();
                all.extend([3, 0, 5, 0, 4, 5, 4, 3, 5]);
                all
            });
        assert_eq!(mesh.triangle_count(), 4);
        far.unwrap()
    };
    for (untangle, at_start, after) in [(None, 2, 0), (Some(true), 0, 0), (Some(false), 2, 2)] {
        let options = Options { backend: Backend::Cpu, untangle, ..Options::default() };
        let mut session = block_on(Session::new(folded(), options.clone())).unwrap();
        let is_turned = |count: u32| count > 0;
        assert_eq!(is_turned(flipped(&mut session).inverted), at_start > 0, "{untangle:?}");
        block_on(session.set_positions(positions(&folded()))).unwrap();
        assert_eq!(is_turned(flipped(&mut session).inverted), after > 0, "{untangle:?}");
    }
    let space = Mesh::new(Dimension::Three, vec![0.0f32; 9], vec![0, 1, 2]).unwrap();
    let options = Options { untangle: Some(true), ..Options::default() };
    assert!(matches!(
        block_on(Session::new(space, options)),
        Err(edgeflip::Error::Option { option: "untangle", .. })
    ));
}

/// A locked edge through a vertex is lost, and comes back; a constraint that came in later stays.
#[test]
fn a_lost_lock_comes_back() {
    let at = |x: f64, y: f64| vec![0.0, 0.0, 4.0, 0.0, 4.0, 4.0, 0.0, 4.0, 2.0, 1.0, x, y];
    let triangles = vec![0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 5, 0, 4, 5, 4, 3, 5];
    let mesh = Mesh::new(Dimension::Two, at(3.0, 3.0), triangles).unwrap();
    let options = Options {
        locked_edges: vec![[1, 4], [4, 0], [5, 0]],
        constraints: vec![[4, 5]],
        untangle: Some(true),
        ..on(Backend::Cpu, 1)
    };
    // The edge from 0 to 5 would go through 4 if that were at (2, 2).
    let mut through = at(3.0, 3.0);
    through[9] = 2.0;
    let start = Mesh::new(Dimension::Two, through.clone(), mesh.triangles().to_vec()).unwrap();
    let mut session = block_on(Session::new(start, options)).unwrap();
    let check = |session: &mut Session, lost: &[[u32; 2]]| {
        let outcome = flipped(session);
        assert_eq!((outcome.inverted, outcome.flat), (0, 0));
        assert_eq!((&outcome.lost_edges[..], &outcome.constraint_edges[..]), (lost, &[[4, 5]][..]));
        assert!(block_on(session.verify()).unwrap().is_clean());
    };
    check(&mut session, &[[0, 5]]);
    block_on(session.set_positions(at(3.0, 3.0))).unwrap();
    check(&mut session, &[]);
    block_on(session.set_positions(through)).unwrap();
    check(&mut session, &[[0, 5]]);
    block_on(session.set_positions(at(3.0, 3.5))).unwrap();
    check(&mut session, &[]);
}

#[test]
fn positions_without_a_triangulation_are_named() {
    let mut session = block_on(Session::new(square(1.0, 1.0), on(Backend::Cpu, 1))).unwrap();
    let mut at = |points: [f64; 10]| {
        block_on(session.set_positions(points.to_vec())).unwrap();
        let outcome = flipped(&mut session);
        (block_on(session.problems()).unwrap(), outcome.inverted, outcome.flat)
    };
    let ring = |x, y| [0.0, 0.0, 4.0, 0.0, 4.0, 4.0, 0.0, 4.0, x, y];
    assert_eq!(at(ring(3.0, 2.0)), Default::default());
    let (found, inverted, _) = at(ring(9.0, 2.0));
    assert!(found.outside == [4] && found.coincident.is_empty() && found.crossing.is_empty() && inverted > 0);
    let (found, _, flat) = at(ring(4.0, 2.0));
    assert!(found.outside == [4] && flat > 0, "on the boundary");
    let (found, _, flat) = at(ring(4.0, 4.0));
    assert_eq!((found.outside, found.coincident), (vec![4], vec![[2, 4]]));
    assert!(flat > 0);
    // The first possible frame is right again.
    assert_eq!(at(ring(1.0, 3.0)), Default::default());
    let (found, ..) = at([0.0, 0.0, 4.0, 4.0, 4.0, 0.0, 0.0, 4.0, 1.0, 2.0]);
    assert_eq!(found.crossing, [[[0, 1], [2, 3]]]);
    assert_eq!(at(ring(2.0, 1.0)), Default::default());
}

/// A hole that has left its ring crosses nothing, and no vertex inside tells.
#[test]
fn a_hole_outside_is_a_problem() {
    let square = |x: f64, y: f64, r: f64| [x - r, y - r, x + r, y - r, x + r, y + r, x - r, y + r];
    let triangles: Vec<u32> =
        (0..4).flat_map(|i| [i, (i + 1) % 4, 4 + i, (i + 1) % 4, 4 + (i + 1) % 4, 4 + i]).collect();
    for mirror in [1.0, -1.0] {
        let mesh = |x: f64| {
            let numbers = [square(0.0, 0.0, 4.0), square(x, 0.0, 1.0)].concat();
            let numbers = numbers.chunks(2).flat_map(|p| [mirror * p[0], p[1]]).collect::<Vec<f64>>();
            Mesh::new(Dimension::Two, numbers, triangles.clone()).unwrap()
        };
        assert!(edgeflip::quality::problems(&mesh(1.0)).is_empty());
        assert_eq!(edgeflip::quality::problems(&mesh(9.0)).outside, [4, 5, 6, 7]);
        assert!(!edgeflip::quality::problems(&mesh(4.0)).crossing.is_empty());
    }
}

/// A vertex that two components have is free in the one that it is inside.
#[test]
fn a_vertex_of_two_components_is_lifted() {
    let at = |x: f64, y: f64| vec![0.0, 0.0, 4.0, 0.0, 4.0, 4.0, 0.0, 4.0, x, y, 3.0, 9.0, 2.0, 9.0];
    let triangles = vec![0, 1, 4, 1, 2, 7, 2, 3, 7, 3, 4, 7, 3, 0, 4, 1, 7, 4, 4, 5, 6];
    let at = |x: f64, y: f64| [at(x, y), vec![2.0, 2.0]].concat();
    let mesh = Mesh::new(Dimension::Two, at(1.0, 2.0), triangles).unwrap();
    let mut session = block_on(Session::new(mesh, on(Backend::Cpu, 1))).unwrap();
    for (x, y) in [(3.5, 2.0), (2.0, 0.5), (0.5, 3.5)] {
        block_on(session.set_positions(at(x, y))).unwrap();
        let outcome = flipped(&mut session);
        assert_eq!((outcome.inverted, outcome.flat), (0, 0), "{x}, {y}");
        assert!(block_on(session.problems()).unwrap().is_empty());
    }
}

/// A ring that meets itself in a vertex crosses itself there, but none of its edges cross.
#[test]
fn corners_that_overlap_are_a_problem() {
    // Two triangles with a common vertex, joined by a strip that goes round it.
    let inner = |y: f64| [[0.0, 0.0], [4.0, -1.0], [4.0, 1.0], [1.0, y], [-1.0, y]];
    let rest = [[9.0, -1.0], [9.0, 1.0], [9.0, 9.0], [1.0, 6.0], [-1.0, 9.0]];
    let triangles = vec![0, 1, 2, 1, 5, 2, 5, 6, 2, 2, 6, 8, 6, 7, 8, 8, 7, 9, 3, 8, 9, 3, 9, 4, 0, 3, 4];
    let mesh = |points: &[[f64; 2]]| Mesh::new(Dimension::Two, points.concat(), triangles.clone()).unwrap();
    let mut points = [inner(4.0).as_slice(), &rest].concat();
    assert!(edgeflip::quality::problems(&mesh(&points)).is_empty());
    // The corner of the upper triangle goes into that of the right one.
    (points[3], points[4]) = ([2.0, 0.25], [-1.0, 4.0]);
    let found = edgeflip::quality::problems(&mesh(&points));
    assert!(
        found.crossing.contains(&[[0, 1], [0, 3]]) || found.crossing.contains(&[[0, 3], [2, 0]]),
        "{found:?}"
    );
}

/// The border of a region may have far more sides than a star.
#[test]
fn a_hub_of_many_triangles_is_lifted() {
    let count = 20_000u32;
    let place = |v: u32, by: f64| {
        let angle = std::f64::consts::TAU * f64::from(v) / f64::from(count);
        let far = 1.0 + by * (9.0 * angle).sin();
        [far * (angle + far).cos(), far * (angle + far).sin()]
    };
    let at = |hub: f64, by: f64| [vec![hub, 0.0], (0..count).flat_map(|v| place(v, by)).collect()].concat();
    let triangles = (0..count).flat_map(|v| [0, 1 + v, 1 + (v + 1) % count]).collect();
    let mesh = Mesh::new(Dimension::Two, at(0.0, 0.0), triangles).unwrap();
    let mut session = block_on(Session::new(mesh, on(Backend::Cpu, 1))).unwrap();
    block_on(session.set_positions(at(0.3, 0.4))).unwrap();
    let outcome = flipped(&mut session);
    assert_eq!((outcome.inverted, outcome.flat, outcome.remaining.total()), (0, 0, 0));
}

/// Many sides of a border cross others: neither the repair nor the search takes long.
#[test]
fn a_long_border_that_crosses_itself_ends() {
    let count = 100_000u32;
    let at = |is_bad: bool| -> Vec<f64> {
        let low = |i: u32| if is_bad && i % 3 == 1 { 2.0 } else { 0.0 };
        (0..=count).flat_map(|i| [f64::from(i), low(i), f64::from(i) + 0.5, 1.0]).collect()
    };
    let triangles = (0..count).map(|i| 2 * i).flat_map(|i| [i, i + 2, i + 1, i + 1, i + 2, i + 3]).collect();
    let mesh = Mesh::new(Dimension::Two, at(false), triangles).unwrap();
    let mut session = block_on(Session::new(mesh, on(Backend::Cpu, 1))).unwrap();
    block_on(session.set_positions(at(true))).unwrap();
    assert!(!block_on(session.problems()).unwrap().crossing.is_empty());
    block_on(session.set_positions(at(false))).unwrap();
    assert!(flipped(&mut session).inverted == 0 && block_on(session.problems()).unwrap().is_empty());
}
