//! Meshes with everything at once: several layers over each other, of both orientations, with holes, pinched vertices and
//! triangles that stand alone, whose vertices go anywhere.

use super::components::{Component, components};
use super::motions::{Random, delaunay};
use super::oracle::{Point, sides};
use edgeflip::quality::problems;
use edgeflip::{Backend, Dimension, Mesh, Options, Order, Outcome, Positions, Session};
use pollster::block_on;
use std::collections::{HashMap, HashSet};
use std::ops::ControlFlow;

/// How integers become positions: times a power of two.
const SCALES: [i32; 5] = [-20, 0, -1074, 900, -30];

/// Layers of triangles over each other, and their points.
pub(super) fn scene(random: &mut Random) -> (Vec<Point>, Vec<u32>) {
    let mut below = |count: usize| (random.next() * count as f64) as usize;
    let (mut points, mut triangles): (Vec<Point>, Vec<u32>) = Default::default();
    let size = [4, 12, 100, 1 << 20][below(4)];
    for _ in 0..1 + below(3) {
        let first = points.len() as u32;
        let most = [4, 12, 40][below(3)];
        let (count, half, offset) = (3 + below(most), size / 2, below(size) as i64);
        let mut taken = HashSet::new();
        for _ in 0..count {
            let point = [below(size) as i64 - half as i64 + offset, below(size) as i64 - half as i64];
            if taken.insert(point) {
                points.push(point);
            }
        }
        let numbers: Vec<f64> = points[first as usize..].iter().flatten().map(|&x| x as f64).collect();
        let removed = [0, 0, 10, 40][below(4)];
        let is_reversed = below(2) == 0;
        for t in delaunay(&numbers).chunks_mut(3) {
            if below(100) < removed {
                continue;
            }
            if is_reversed {
                t.reverse();
            }
            triangles.extend(t.iter().map(|v| first + v));
        }
    }
    // Vertices that two layers have.
    if below(4) == 0 && points.len() > 6 {
        for _ in 0..below(3) {
            let [u, v] = [below(points.len()) as u32, below(points.len()) as u32];
            let mut joined = triangles.clone();
            joined.iter_mut().filter(|w| **w == u).for_each(|w| *w = v);
            if joined.chunks(3).all(|t| t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) {
                triangles = joined;
            }
        }
    }
    (points, triangles)
}

/// Moves some of the points.
pub(super) fn moved(start: &[Point], last: &[Point], triangles: &[u32], random: &mut Random) -> Vec<Point> {
    let mut below = |count: usize| (random.next() * count as f64) as i64;
    let (low, high) = start.iter().flatten().fold((i64::MAX, i64::MIN), |(l, h), &x| (l.min(x), h.max(x)));
    let size = (high - low).max(1) as usize;
    let mut points = if below(3) == 0 { last.to_vec() } else { start.to_vec() };
    let on_boundary: HashSet<u32> =
        components(triangles).iter().flat_map(|c| c.boundary.iter().flatten().copied()).collect();
    let kind = below(9);
    let inner_only = below(3) > 0;
    let part = [3, 30, 100][below(3) as usize];
    let by = (size / [50, 8, 2, 1][below(4) as usize]).max(2);
    for (v, point) in points.iter_mut().enumerate() {
        if below(100) >= part || inner_only && on_boundary.contains(&(v as u32)) {
            continue;
        }
        match kind {
            0 => *point = [low + below(size + 1), low + below(size + 1)],
            1 => *point = [low + below(size + 1), 0],
            _ => *point = point.map(|x| x + below(by) - by as i64 / 2),
        }
    }
    match below(12) {
        0 => points.iter_mut().for_each(|p| p[0] = -p[0]),
        1 => points.iter_mut().for_each(|p| *p = [p[1], -p[0]]),
        2 => points.iter_mut().for_each(|p| p[1] = p[0]),
        _ => {}
    }
    points
}

pub(super) fn numbers(points: &[Point], scale: i32, random: &mut Random) -> Vec<f64> {
    let scaled = |&x: &i64| {
        let half = 2f64.powi(scale / 2);
        let scaled = x as f64 * half * 2f64.powi(scale - scale / 2);
        if scaled == 0.0 && random.next() < 0.5 { -0.0 } else { scaled }
    };
    points.iter().flatten().map(scaled).collect()
}

/// What each frame of all sessions has to be.
fn check(seed: u64) -> (usize, usize) {
    let mut random = Random(seed.wrapping_mul(2_654_435_761).wrapping_add(88_172_645_463_325_252));
    let (start, triangles) = scene(&mut random);
    if triangles.is_empty() {
        return (0, 0);
    }
    let scale = SCALES[(random.next() * SCALES.len() as f64) as usize];
    let mesh = Mesh::new(Dimension::Two, numbers(&start, scale, &mut random), triangles.clone()).unwrap();
    let mut locked_edges = Vec::new();
    if random.next() < 0.5 {
        let part = random.next() * random.next();
        locked_edges.extend(triangles.chunks(3).filter(|_| random.next() < part).map(|t| [t[0], t[1]]));
    }
    // Borders of groups are locked, too.
    let groups: Vec<u32> = if random.next() < 0.3 {
        let part = random.next();
        (0..triangles.len() / 3).map(|_| u32::from(random.next() < part * part)).collect()
    } else {
        Vec::new()
    };
    let named = locked_edges.clone();
    let mut first = HashMap::new();
    for (side, group) in
        triangles.chunks(3).zip(&groups).flat_map(|(t, group)| sides(t).map(|side| (side, group)))
    {
        let edge = [side[0].min(side[1]), side[0].max(side[1])];
        if first.entry(edge).or_insert(group) != &group {
            locked_edges.push(edge);
        }
    }
    let mut sessions: Vec<Session> = [Order::Reproducible, Order::Any]
        .into_iter()
        .map(|order| {
            let backend = Backend::Cpu;
            let (locked_edges, groups) = (named.clone(), groups.clone());
            let options = Options { backend, order, locked_edges, groups, ..Options::default() };
            block_on(Session::new(mesh.clone(), options)).unwrap()
        })
        .collect();
    let before = components(&triangles);
    let (mut last, mut possible, mut frames) = (start.clone(), 0, 0);
    for frame in 0..6 {
        last = moved(&start, &last, &triangles, &mut random);
        let positions = numbers(&last, scale, &mut random);
        // Updates before the frame, to positions that need not be finite.
        let updates: Vec<(Vec<f64>, u32)> = (0..(random.next() * 4.0) as usize)
            .map(|_| {
                let points = moved(&start, &last, &triangles, &mut random);
                let mut numbers = numbers(&points, scale, &mut random);
                if random.next() < 0.2 {
                    let i = (random.next() * numbers.len() as f64) as usize;
                    numbers[i] = [f64::NAN, f64::INFINITY][i % 2];
                }
                (numbers, (random.next() * 6.0) as u32)
            })
            .collect();
        for (i, session) in sessions.iter_mut().enumerate() {
            let name = format!("seed {seed}, frame {frame}, session {i}");
            for (update, (numbers, iterations)) in updates.iter().enumerate() {
                session.update(Some(Positions::F64(numbers.clone())), *iterations).unwrap();
                let found = components(&block_on(session.triangles()).unwrap());
                assert_eq!(outlines(&before), outlines(&found), "{name}, update {update}");
            }
            if updates.is_empty() {
                block_on(session.set_positions(positions.clone())).unwrap();
            } else {
                session.update(Some(Positions::F64(positions.clone())), 3).unwrap();
            }
            block_on(session.run(|_, _| ControlFlow::Continue(()))).unwrap();
            let outcome = block_on(session.outcome()).unwrap();
            let audit = block_on(session.verify()).unwrap();
            assert!(audit.violations.is_empty(), "{name}: {:?}", audit.violations);
            frames += 1;
            possible += right(&name, &before, &last, &outcome, &locked_edges);
            let found = block_on(session.problems()).unwrap();
            let obstacles: Vec<_> = before.iter().filter_map(|c| c.obstacle(&last)).collect();

            assert_eq!(
                found.is_empty(),
                obstacles.is_empty(),
                "{name}: {found:?} {obstacles:?} {last:?} {triangles:?}"
            );
            let mesh = Mesh::new(Dimension::Two, positions.clone(), triangles.clone()).unwrap();
            assert_eq!(problems(&mesh), found, "{name}");
        }
    }
    (frames, possible)
}

/// What no repair and no flip changes: the number of triangles, the boundary, the vertices and their fans.
pub(super) fn outlines(all: &[Component]) -> Vec<impl Ord + std::fmt::Debug + use<>> {
    let outline = |c: &Component| (c.triangles.len(), c.boundary.clone(), c.vertices.clone(), c.fans.clone());
    let mut outlines: Vec<_> = all.iter().map(outline).collect();
    outlines.sort_unstable();
    outlines
}

/// Counts the components that have a triangulation. Panics if one of them has not the right one.
pub(super) fn right(
    name: &str,
    before: &[Component],
    points: &[Point],
    outcome: &Outcome,
    locked: &[[u32; 2]],
) -> usize {
    let after = components(&outcome.triangles);
    assert_eq!(outlines(before), outlines(&after), "{name}");
    let mut possible = 0;
    for component in &after {
        if component.obstacle(points).is_some() {
            continue;
        }
        possible += 1;
        // An edge of two components would be an edge of more than two triangles.
        let is_common = |v: &&u32| component.vertices.binary_search(v).is_ok();
        let others = after.iter().filter(|other| other.boundary != component.boundary);
        let shares =
            others.map(|other| other.vertices.iter().filter(is_common).count()).any(|count| count > 1);
        let name = format!("{name}, {} triangles", component.triangles.len() / 3);
        if let Some(fault) = component.fault(points, &outcome.triangles, locked) {
            if shares && outcome.inverted + outcome.flat > 0 {
                continue;
            }
            panic!("{name}: {fault}; {points:?} {:?}| {:?}", component.triangles, outcome.triangles);
        }
        let lost: Vec<_> = component.lost(&outcome.lost_edges, before);
        if !lost.is_empty() && !component.is_blocked(points, locked, before) {
            panic!(
                "{name}: lost {lost:?} of {locked:?}; {points:?} {:?}| {:?}",
                component.triangles, outcome.triangles
            );
        }
    }
    possible
}

#[test]
fn wild_meshes_are_right() {
    let from = std::env::var("EDGEFLIP_SEED").map_or(1, |seed| seed.parse().unwrap());
    let count = if super::is_full() { 20_000 } else { 300 };
    let (mut frames, mut possible) = (0, 0);
    for seed in from..from + count {
        let (f, p) = check(seed);
        (frames, possible) = (frames + f, possible + p);
    }
    println!("{frames} frames, {possible} components with a triangulation");
    assert!(possible > 3 * count as usize);
}

/// The component of 0, 4, 9, 1 and 10 would need the edge from 4 to 10, which is on the boundary of another one. So it stays
/// as it is, and the others are repaired.
#[test]
fn a_component_is_repaired_beside_one_that_needs_its_boundary() {
    let points = [0, 42, 60, 26, 53, 10, 63, 7, 29, 28, 50, 11, 56, 61, 9, 21, 46, 63, 13, 40, 42, 3, 26, 28];
    let points: &[Point] = points.as_chunks().0;
    let mut triangles =
        vec![11, 4, 7, 0, 9, 4, 1, 9, 0, 7, 5, 11, 11, 10, 4, 0, 10, 1, 7, 2, 5, 3, 2, 7, 9, 8, 6];
    triangles.extend([2, 10, 5, 5, 10, 11, 8, 3, 7, 2, 3, 10]);
    let before = components(&triangles);
    let mesh = Mesh::new(Dimension::Two, numbers(points, 0, &mut Random(1)), triangles).unwrap();
    let options = Options { backend: Backend::Cpu, untangle: Some(true), ..Options::default() };
    let mut session = block_on(Session::new(mesh, options)).unwrap();
    block_on(session.run(|_, _| ControlFlow::Continue(()))).unwrap();
    let outcome = block_on(session.outcome()).unwrap();
    let parts = components(&outcome.triangles);
    assert_eq!(outlines(&before), outlines(&parts));
    let is_wrong = |c: &&Component| c.fault(points, &outcome.triangles, &[]).is_some();
    let wrong: Vec<_> = parts.iter().filter(is_wrong).map(|c| c.vertices.clone()).collect();
    assert_eq!((parts.len(), wrong), (3, vec![vec![0, 1, 4, 9, 10]]));
}

/// Updates of single precision on both engines: the same bits after each one, and the same surface.
#[cfg(feature = "gpu")]
#[test]
fn engines_agree_in_wild_updates() {
    for seed in 1..if super::is_full() { 2000 } else { 40 } {
        let mut random = Random(seed * 2_654_435_761 + 88_172_645_463_325_252);
        let (start, triangles) = scene(&mut random);
        let positions = |points: &[Point], random: &mut Random| {
            numbers(points, 0, random).into_iter().map(|x| x as f32).collect::<Vec<_>>()
        };
        let mesh = Mesh::new(Dimension::Two, positions(&start, &mut random), triangles.clone()).unwrap();
        let part = (random.next() - 0.5).max(0.0);
        let mut is_locked = |_: &&[u32]| random.next() < part * part;
        let locked_edges: Vec<_> = triangles.chunks(3).filter(&mut is_locked).map(|t| [t[0], t[1]]).collect();
        let mut sessions = [Backend::Cpu, Backend::Gpu].map(|backend| {
            let locked_edges = locked_edges.clone();
            let options = Options { backend, locked_edges, track_changes: true, ..Options::default() };
            block_on(Session::new(mesh.clone(), options)).unwrap()
        });
        let (before, mut last) = (components(&triangles), start.clone());
        for frame in 0..8 {
            last = moved(&start, &last, &triangles, &mut random);
            let mut numbers = positions(&last, &mut random);
            if random.next() < 0.2 && !numbers.is_empty() {
                let i = (random.next() * numbers.len() as f64) as usize;
                numbers[i] = [f32::NAN, f32::INFINITY][i % 2];
            }
            let iterations = [0, 1, 4, 64][(random.next() * 4.0) as usize];
            let [cpu, gpu] = sessions.each_mut().map(|session| {
                session.update(Some(Positions::F32(numbers.clone())), iterations).unwrap();
                let [triangles, changes] = [block_on(session.triangles()), block_on(session.changes())];
                (triangles.unwrap(), changes.unwrap(), block_on(session.counters()).unwrap())
            });
            let name = format!("seed {seed}, frame {frame}");
            assert!(cpu == gpu, "{name}: {:?} {:?}", cpu.2, gpu.2);
            assert_eq!(outlines(&before), outlines(&components(&cpu.0)), "{name}");
        }
    }
}
