//! Random locks on random meshes: the engines agree with the simulation, and every locked edge stays. Pairs that are
//! not edges are refused.
#![cfg(feature = "gpu")]

use crate::matrix::named;
use crate::meshes;
use crate::runs::{options, rounds, unwatched, watched};
use crate::simulation::{simulate, simulate_with};
use edgeflip::quality::audit;
use edgeflip::{Backend, Error, Mesh, Options, Order, Outcome, Reason, Session, families::by_name};
use oorandom::Rand64;
use pollster::block_on;
use std::collections::HashSet;
use std::ops::ControlFlow;

/// A random share of the edges, either way round.
fn some_edges(mesh: &Mesh, random: &mut Rand64) -> Vec<[u32; 2]> {
    let share = random.rand_float();
    let mut locked = meshes::edges(mesh);
    locked.retain(|_| random.rand_float() < share);
    locked.iter_mut().filter(|_| random.rand_float() < 0.5).for_each(|pair| pair.reverse());
    locked
}

/// Compares each engine with the simulation, and Lawson's algorithm with the audit. Returns the flips.
fn assert_locked(name: &str, mesh: &Mesh, beta: f64, locked: &[[u32; 2]], on_gpu: bool) -> u64 {
    let locks = |backend| Options { locked_edges: locked.to_vec(), ..options(backend, beta) };
    let want = simulate_with(mesh, &locks(Backend::Cpu));
    for backend in [Backend::Cpu, Backend::Gpu].into_iter().take(1 + usize::from(on_gpu)) {
        assert_eq!(watched(mesh, &locks(backend)).unwrap(), want, "{name} at β = {beta}, {backend:?}");
    }
    let any = Options { order: Order::Any, ..locks(Backend::Cpu) };
    let any = unwatched(mesh, &any).unwrap();
    for (triangles, remaining) in [(&want.triangles, want.remaining), (&any.triangles, any.remaining)] {
        let audit = audit(mesh, triangles, &locks(Backend::Cpu));
        assert!(audit.violations.is_empty(), "{name} at β = {beta}: {:?}", audit.violations);
        assert_eq!(audit.remaining, remaining, "{name} at β = {beta}");
        assert_eq!(remaining[Reason::Stopped], 0, "{name} at β = {beta}");
    }
    want.flips()
}

#[test]
fn random_locks_hold_on_random_meshes() {
    let mut flips = 0;
    for seed in 0..rounds(200) {
        let random = &mut Rand64::new(u128::from(seed));
        let n = 3 + seed as usize % 6;
        let (flat, bent) = meshes::soup(seed, n, seed as usize / 5 % 23);
        let family = |name: &str| by_name(&format!("{name} {n} seed={seed}")).unwrap();
        for mesh in [flat, bent, family("random"), family("uvsphere")] {
            let locked = some_edges(&mesh, random);
            // The software GPU takes a tenth of them.
            flips += assert_locked(&format!("seed {seed}"), &mesh, 40.0, &locked, seed % 10 == 0);
        }
    }
    assert!(flips > 20 * rounds(200), "{flips}");
}

#[test]
fn locks_on_the_boundary_change_nothing() {
    let case = named("locked-boundary");
    let with = watched(&case.mesh, &case.options(Backend::Cpu)).unwrap();
    assert_eq!(with, simulate(&case.mesh, case.beta, None));
}

/// Also with `auto`, which would take the error of an engine for a reason to try the next engine.
#[test]
fn pairs_that_are_no_edges_are_refused() {
    let mesh = by_name("random 8").unwrap();
    let edge = [mesh.triangles()[0], mesh.triangles()[1]];
    for backend in [Backend::Auto, Backend::Cpu, Backend::Gpu] {
        for [u, v] in [[0, 63], [63, 0], [5, 5], [3, 64], [u32::MAX, u32::MAX]] {
            let options = Options { backend, locked_edges: vec![edge, [u, v]], ..Options::default() };
            let error = block_on(Session::new(mesh.clone(), options)).err().unwrap();
            assert!(matches!(error, Error::Option { option: "locked_edges", .. }));
            let expected = format!("option locked_edges: the mesh has no edge between vertices {u} and {v}");
            assert_eq!(error.to_string(), expected);
        }
    }
}

/// The corners of a triangle, from the smallest on.
fn turned(triangle: &[u32]) -> [u32; 3] {
    let first = (0..3).min_by_key(|&i| triangle[i]).unwrap();
    [0, 1, 2].map(|i| triangle[(first + i) % 3])
}

#[test]
fn locked_triangles_stay_as_they_are() {
    for (seed, name) in [(1, "random 9"), (2, "uvsphere 7"), (3, "roof 6")] {
        let mesh = by_name(name).unwrap();
        let random = &mut Rand64::new(seed);
        let mut locked: Vec<u32> = (0..mesh.triangle_count() as u32).collect();
        locked.retain(|_| random.rand_float() < 0.2);
        let free = unwatched(&mesh, &options(Backend::Cpu, 60.0)).unwrap();
        let lost = |outcome: &Outcome| {
            let at = |triangles: &[u32], t: u32| turned(&triangles[3 * t as usize..3 * t as usize + 3]);
            let is_lost = |&&t: &&u32| at(mesh.triangles(), t) != at(&outcome.triangles, t);
            locked.iter().filter(is_lost).count()
        };
        assert!(lost(&free) > 0, "{name}");
        for backend in [Backend::Cpu, Backend::Gpu] {
            let options = Options { locked_triangles: locked.clone(), ..options(backend, 60.0) };
            let outcome = unwatched(&mesh, &options).unwrap();
            assert_eq!(lost(&outcome), 0, "{name} on {backend:?}");
            assert!(outcome.flips > 0 && outcome.remaining[Reason::Locked] > 0, "{name}: {outcome:?}");
        }
    }
}

#[test]
fn groups_keep_their_borders() {
    for name in ["random 12", "uvsphere 9"] {
        let mesh = by_name(name).unwrap();
        let groups: Vec<u32> = (0..mesh.triangle_count() as u32).map(|t| t / 31 % 5).collect();
        // The border of a group: its directed edges without those that it has both ways.
        let border = |triangles: &[u32], group: u32| {
            let mine = triangles.chunks(3).zip(&groups).filter(|&(_, &of)| of == group);
            let edges: HashSet<_> =
                mine.flat_map(|(t, _)| [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])]).collect();
            let is_outer = |&&(u, v): &&(u32, u32)| !edges.contains(&(v, u));
            let mut outer: Vec<_> = edges.iter().filter(is_outer).copied().collect();
            outer.sort_unstable();
            outer
        };
        let borders = |triangles: &[u32]| (0..5).map(|group| border(triangles, group)).collect::<Vec<_>>();
        let free = unwatched(&mesh, &options(Backend::Cpu, 60.0)).unwrap();
        assert_ne!(borders(&free.triangles), borders(mesh.triangles()), "{name}");
        for backend in [Backend::Cpu, Backend::Gpu] {
            let options = Options { groups: groups.clone(), ..options(backend, 60.0) };
            let outcome = unwatched(&mesh, &options).unwrap();
            assert_eq!(borders(&outcome.triangles), borders(mesh.triangles()), "{name} on {backend:?}");
            assert!(outcome.flips > 0 && outcome.remaining[Reason::Locked] > 0, "{name}: {outcome:?}");
            let one = Options { groups: vec![7; groups.len()], ..options };
            assert_eq!(unwatched(&mesh, &one).unwrap().triangles, free.triangles);
        }
    }
}

#[test]
fn triangles_and_groups_that_are_not_of_the_mesh_are_refused() {
    let mesh = by_name("random 8").unwrap();
    let refused = |options: Options| block_on(Session::new(&mesh, options)).err().unwrap().to_string();
    assert_eq!(
        refused(Options { locked_triangles: vec![97, 98], ..Options::default() }),
        "option locked_triangles: there is no triangle 98; the mesh has 98"
    );
    assert_eq!(
        refused(Options { groups: vec![0; 97], ..Options::default() }),
        "option groups: it has 97 numbers, the mesh has 98 triangles"
    );
}

/// For a GPU, doubles need another form, and so a new engine.
#[test]
fn locks_stay_when_vertices_move_to_doubles() {
    let mesh = by_name("uvsphere 9").unwrap();
    let locked: Vec<_> = meshes::edges(&mesh).into_iter().step_by(3).collect();
    let moved: Vec<f64> = mesh.positions().iter().zip(0..).map(|(x, i)| x * [0.1, 0.7, 0.9][i % 3]).collect();
    let run = |backend| {
        let options = Options { locked_edges: locked.clone(), ..options(backend, 60.0) };
        let mut session = block_on(Session::new(mesh.clone(), options)).unwrap();
        block_on(session.step()).unwrap();
        block_on(session.set_positions(moved.clone())).unwrap();
        block_on(session.run(|_, _| ControlFlow::Continue(()))).unwrap();
        assert!(block_on(session.verify()).unwrap().is_clean());
        let Outcome { triangles, flips, remaining, .. } = block_on(session.outcome()).unwrap();
        (triangles, flips, remaining)
    };
    let (triangles, flips, remaining) = run(Backend::Cpu);
    assert!(flips > 0 && remaining[Reason::Locked] > 0, "{flips} flips, {remaining:?}");
    assert_eq!(run(Backend::Gpu), (triangles, flips, remaining));
}
