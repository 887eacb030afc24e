//! A session on the CPU, and a triangulation of points, never take more memory than they check for before they start. This
//! is a program of its own, because its allocator counts the bytes of a whole process.
// Clippy's exemption for tests does not reach their shared functions.
#![allow(clippy::unwrap_used)]
#![allow(unsafe_code, reason = "the trait for allocators is unsafe")]

#[path = "points/mod.rs"]
mod points_of;

use edgeflip::{
    Backend, Dimension, Edges, Mesh, Options, Order, PointOptions, PointSession, Positions, Session,
    families::by_name, triangulate, triangulate_with,
};
use std::alloc::{GlobalAlloc, Layout, System};
use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

/// Counts allocated bytes, except those of the check itself, which is larger than any array.
struct Counter;

#[global_allocator]
static COUNTER: Counter = Counter;

static NOW: AtomicUsize = AtomicUsize::new(0);
static MOST: AtomicUsize = AtomicUsize::new(0);
static ONLY_ASKED_FOR: AtomicUsize = AtomicUsize::new(usize::MAX);
static ASKED_FOR: AtomicUsize = AtomicUsize::new(0);

// SAFETY: the system's allocator keeps the contract.
unsafe impl GlobalAlloc for Counter {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        if layout.size() < ONLY_ASKED_FOR.load(Relaxed) {
            MOST.fetch_max(NOW.fetch_add(layout.size(), Relaxed) + layout.size(), Relaxed);
        } else {
            ASKED_FOR.fetch_max(layout.size(), Relaxed);
        }
        // SAFETY: as above.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        if layout.size() < ONLY_ASKED_FOR.load(Relaxed) {
            NOW.fetch_sub(layout.size(), Relaxed);
        }
        // SAFETY: as above.
        unsafe { System.dealloc(pointer, layout) }
    }
}

/// Bytes that do not depend on the mesh: threads, and short lists.
const SLACK: u64 = 1 << 18;

/// Runs a session, and returns its peak memory in addition to the mesh.
fn bytes_of(mesh: &Arc<Mesh>, options: Options, asked: u64) -> u64 {
    let base = NOW.load(Relaxed);
    MOST.store(base, Relaxed);
    ONLY_ASKED_FOR.store(asked as usize / 3, Relaxed);
    pollster::block_on(async {
        let mut session = Session::new(mesh.clone(), options).await.unwrap();
        session.step().await.unwrap();
        session.run(|_, _| ControlFlow::Continue(())).await.unwrap();
        session.outcome().await.unwrap();
    });
    ONLY_ASKED_FOR.store(usize::MAX, Relaxed);
    (MOST.load(Relaxed) - base) as u64
}

/// Bytes per triangle that a change of the positions asks for, and a repair.
const MOVE: u64 = 44 + 128;

/// Moves the vertices of a session. Returns the part of the memory asked for that this takes.
fn move_vertices(mesh: &Mesh, locked_edges: Vec<[u32; 2]>, positions: Vec<f64>) -> f64 {
    let options =
        Options { backend: Backend::Cpu, threads: NonZeroUsize::new(1), locked_edges, ..Options::default() };
    let mut session = pollster::block_on(Session::new(mesh.clone(), options)).unwrap();
    let asked = MOVE * mesh.triangle_count() as u64;
    let base = NOW.load(Relaxed);
    MOST.store(base, Relaxed);
    ONLY_ASKED_FOR.store(64 * mesh.triangle_count(), Relaxed);
    pollster::block_on(session.set_positions(positions)).unwrap();
    ONLY_ASKED_FOR.store(usize::MAX, Relaxed);
    let taken = (MOST.load(Relaxed) - base) as u64;
    assert!(taken <= asked + SLACK, "{taken} bytes taken, {asked} asked for");
    taken as f64 / asked as f64
}

/// Vertices go anywhere: the worst cases of a repair.
fn moves_take_what_they_ask_for() {
    let mut random = 1u64;
    let mut next = || {
        random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (random >> 33) as f64 / f64::from(1u32 << 31)
    };
    let mut most = 0.0f64;
    for (spec, by) in [
        ("random 120", 2.0),
        ("random 120", 0.02),
        ("random 120", 0.005),
        ("strips 6000", 0.5),
        ("fan2 6000", 0.5),
    ] {
        let mesh = by_name(spec).unwrap();
        let mut moved = || {
            mesh.positions().iter().map(|x| (x + by * (next() - 0.5)).clamp(-0.1, 1.1)).collect::<Vec<f64>>()
        };
        let all: Vec<[u32; 2]> = mesh.triangles().chunks(3).map(|t| [t[0], t[1]]).collect();
        for locked in [Vec::new(), all] {
            most = most.max(move_vertices(&mesh, locked, moved()));
        }
    }
    assert!(most > 0.8, "far more is asked for than is ever taken: {most}");
}

/// Does some work, whose check asks for more bytes than `least`, and no other allocation. Returns the part of these that the
/// work takes.
fn part_of<T>(what: &str, least: usize, work: impl FnOnce() -> T) -> (f64, T) {
    let base = NOW.load(Relaxed);
    MOST.store(base, Relaxed);
    ASKED_FOR.store(0, Relaxed);
    ONLY_ASKED_FOR.store(least, Relaxed);
    let result = work();
    ONLY_ASKED_FOR.store(usize::MAX, Relaxed);
    let (taken, asked) = (MOST.load(Relaxed) - base, ASKED_FOR.load(Relaxed));
    assert!(taken <= asked + SLACK as usize, "{what}: {taken} bytes taken, {asked} asked for");
    (taken as f64 / asked as f64, result)
}

fn points_take_what_they_ask_for() {
    let n = 50_000;
    let mut most = [0.0f64; 4];
    for (name, kind) in points_of::KINDS {
        let points = points_of::points(kind, n, 1);
        let wide = Positions::from(points.as_flattened().to_vec());
        for (positions, threads) in [(&wide, 1), (&wide, 3), (&Positions::from(wide.to_f32()), 1)] {
            let threads = NonZeroUsize::new(threads);
            // Through many points, a constraint would be many edges.
            let few_edges = ["uniform", "circle", "sorted"].contains(&name);
            let ring: Vec<_> = (0..n as u32).map(|i| [i, (i + 1) % n as u32]).filter(|_| few_edges).collect();
            for constraints in [Vec::new(), ring] {
                let kind = usize::from(!constraints.is_empty());
                let options = PointOptions { threads, constraints, skips_constraints: true };
                let work = || triangulate_with(positions, &options).unwrap();
                let (part, _) = part_of(name, 100 * n, work);
                most[kind] = most[kind].max(part);
            }
            let turned = Positions::from(points.iter().flat_map(|&[x, y]| [y, x]).collect::<Vec<f64>>());
            let session = || {
                let mut session = PointSession::new(positions, threads).unwrap();
                session.triangulation().unwrap();
                session.update(&turned).unwrap();
                session.triangulation().unwrap();
            };
            let (part, ()) = part_of(name, 150 * n, session);
            most[2] = most[2].max(part);
        }
        let triangulation = triangulate_with(&wide, &PointOptions::default()).unwrap();
        let (part, _) =
            part_of(name, 200 * n, || triangulation.voronoi(&wide, [0.0, 0.0, 1.0, 1.0]).unwrap());
        most[3] = most[3].max(part);
    }
    assert!(most.iter().all(|&most| most > 0.8), "far more is asked for than is ever taken: {most:?}");
}

/// A row of points up to 20 beside a line, and that line as a constraint: it crosses most of the triangles.
fn a_long_constraint_takes_what_it_asks_for() {
    let count = 20_000u32;
    // A sequence without order.
    let height =
        |i: u32| f64::from(i.wrapping_mul(2_654_435_769) >> 12) / f64::from(1u32 << 20) * 40.0 - 20.0;
    let mut points: Vec<f64> = (0..count).flat_map(|i| [f64::from(i), height(i)]).collect();
    points[1] = 0.0;
    *points.last_mut().unwrap() = 0.0;
    let triangles = triangulate(&points.clone().into()).unwrap().triangles;
    let mesh = Arc::new(Mesh::new(Dimension::Two, points, triangles).unwrap());
    // Within the tolerance are no vertices but its ends, half of them, or all.
    for (threads, constraint_tolerance) in [(1, 0.0), (4, 0.0), (1, 10.0), (1, 20.0)] {
        let options = Options {
            backend: Backend::Cpu,
            threads: NonZeroUsize::new(threads),
            constraints: vec![[0, count - 1]],
            constraint_tolerance,
            ..Options::default()
        };
        let asked = Session::bytes(&mesh, &options);
        let taken = bytes_of(&mesh, options, asked);
        assert!(
            taken <= asked + SLACK,
            "{threads} threads, {constraint_tolerance}: {taken} bytes taken, {asked} asked for"
        );
    }
}

/// One test, since the program has only one peak.
#[test]
fn sessions_take_what_they_ask_for() {
    moves_take_what_they_ask_for();
    points_take_what_they_ask_for();
    a_long_constraint_takes_what_it_asks_for();
    let mut most = 0.0f64;
    for spec in [
        "random 120",
        "shuffled random 120",
        "shear 120",
        "shear 120 30",
        "regular 120",
        "strips 6000",
        "fan2 6000",
        "sweep 6000",
        "uvsphere 100",
        "shuffled uvsphere 100",
        "uvsphere 100 0.5",
        "roof 100",
        "pillow 6000",
        "pole 6000",
    ] {
        let mesh = by_name(spec).unwrap();
        let doubles: Vec<f64> = mesh.positions().iter().map(|x| x + x * 1e-10).collect();
        let doubles = Mesh::new(mesh.dimension(), doubles, mesh.triangles().to_vec()).unwrap();
        let Edges { v1, v2, .. } = Edges::new(mesh.vertex_count(), mesh.triangles());
        let all: Vec<[u32; 2]> = v1.into_iter().zip(v2).map(|(u, v)| [u, v]).collect();
        for mesh in [mesh, doubles].map(Arc::new) {
            for (order, threads) in
                [(Order::Reproducible, 1), (Order::Reproducible, 4), (Order::Any, 1), (Order::Any, 4)]
            {
                let in_plane = if mesh.dimension() == Dimension::Two { all.clone() } else { Vec::new() };
                for [locked_edges, constraints] in
                    [[Vec::new(), Vec::new()], [all.clone(), Vec::new()], [Vec::new(), in_plane]]
                {
                    let options = Options {
                        backend: Backend::Cpu,
                        order,
                        threads: NonZeroUsize::new(threads),
                        max_normal_angle: 180.0,
                        // The worst cases have thousands of iterations of a few flips each.
                        max_iterations: Some(20),
                        locked_edges,
                        constraints,
                        ..Options::default()
                    };
                    let asked = Session::bytes(&mesh, &options);
                    let [locked, constraints] = [&options.locked_edges, &options.constraints].map(Vec::len);
                    let taken = bytes_of(&mesh, options, asked);
                    assert!(
                        taken <= asked + SLACK,
                        "{spec}, {order:?}, {threads} threads, {locked} locked, {constraints} constraints: {taken} bytes taken, {asked} asked for"
                    );
                    most = most.max(taken as f64 / asked as f64);
                }
            }
        }
    }
    assert!(most > 0.8, "far more is asked for than is ever taken: {most}");
}
