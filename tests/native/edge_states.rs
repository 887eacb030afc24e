//! The states of the edges predict every step, on the CPU and the GPU: which edges flip, wait or are blocked.
#![cfg(feature = "gpu")]

use crate::{matrix, meshes};
use edgeflip::{Adjacency, Backend, EdgeState, Error, Mesh, NONE, Options, Order, Reason, Session};
use pollster::block_on;

/// The number of edges in each state. Both half-edges of an interior edge must agree.
fn edges(session: &mut Session, mesh: &Mesh) -> Seen {
    let states = block_on(session.edge_states()).unwrap();
    let triangles = block_on(session.triangles()).unwrap();
    assert_eq!(states.len(), triangles.len());
    let twins = Adjacency::new(&mesh.with_triangles(triangles).unwrap()).twins;
    let mut edges = [0; EdgeState::ALL.len()];
    for (h, (&state, &twin)) in states.iter().zip(&twins).enumerate() {
        let has_twin =
            !matches!(state, EdgeState::Boundary | EdgeState::NonManifold | EdgeState::Inconsistent);
        assert_eq!(twin != NONE, has_twin, "half-edge {h} is {state:?}");
        if has_twin {
            assert_eq!(state, states[twin as usize], "half-edges {h} and {twin}");
        }
        if !has_twin || h < twin as usize {
            edges[state as usize] += 1;
        }
    }
    edges
}

/// The number of edges seen in each state.
type Seen = [u64; EdgeState::ALL.len()];

/// Steps to the end, and compares each step with the states before it. Returns the number of iterations, or `None` if
/// the backend refuses the mesh.
fn compare_steps(name: &str, mesh: &Mesh, options: Options, seen: &mut Seen) -> Option<u32> {
    let backend = options.backend;
    let mut session = match block_on(Session::new(mesh.clone(), options)) {
        Err(Error::BackendLimit { .. }) if backend == Backend::Gpu => return None,
        session => session.unwrap(),
    };
    loop {
        let now = edges(&mut session, mesh);
        seen.iter_mut().zip(now).for_each(|(seen, now)| *seen += now);
        let count = |state: EdgeState| now[state as usize];
        let name = format!("{name}, {backend:?}, iteration {}", session.iterations());
        let step = block_on(session.step()).unwrap();
        let (labelled, flips) = step.map_or((0, 0), |step| (step.labelled, step.flips));
        assert_eq!(count(EdgeState::Flips), u64::from(flips), "{name}");
        assert_eq!(count(EdgeState::Flips) + count(EdgeState::Waits), u64::from(labelled), "{name}");
        let outcome;
        let blocked = match &step {
            Some(step) => &step.blocked,
            None => {
                outcome = block_on(session.outcome()).unwrap();
                assert_eq!(count(EdgeState::Boundary), outcome.boundary_edges, "{name}");
                &outcome.remaining
            }
        };
        for (reason, state) in [
            (Reason::Angle, EdgeState::Angle),
            (Reason::Fold, EdgeState::Fold),
            (Reason::Duplicate, EdgeState::Duplicate),
            (Reason::Locked, EdgeState::Locked),
            (Reason::Deviation, EdgeState::Deviation),
        ] {
            assert_eq!(blocked[reason], count(state), "{name}: {state:?}");
        }
        if step.is_none() {
            return Some(session.iterations());
        }
    }
}

#[test]
fn states_foretell_every_step() {
    let (mut on_cpu, mut on_gpu, mut seen) = (0, 0, Seen::default());
    for case in matrix::cases().iter().filter(|case| case.mesh.triangle_count() <= 2000) {
        let options = case.options(Backend::Cpu);
        let iterations = compare_steps(&case.name, &case.mesh, options.clone(), &mut seen).unwrap();
        on_cpu += 1;
        if iterations <= 12 && case.mesh.triangle_count() <= 800 {
            let options = Options { backend: Backend::Gpu, ..options };
            let gpu = compare_steps(&case.name, &case.mesh, options, &mut seen);
            on_gpu += usize::from(gpu == Some(iterations));
        }
    }
    assert!(on_cpu > 100 && on_gpu > 50, "{on_cpu} on the CPU, {on_gpu} on the GPU");
    assert!(!seen.contains(&0), "some state has no edge: {seen:?}");
}

/// Three triangles at the edge 0-1, two of them with the same orientation. A fourth triangle has the opposite
/// orientation of its neighbour.
///
/// ```text
///       2
///     / | \      4 is above 0-1 too; (1, 2, 3) has the opposite orientation
///   0---1---3
/// ```
#[test]
fn frozen_edges_are_named_whatever_their_angles() {
    let points = [[0.0, 0.0], [4.0, 0.0], [3.0, 2.0], [6.0, 0.0], [2.0, 3.0]];
    let mesh = meshes::plane(&points, &[[0, 1, 2], [0, 1, 4], [1, 0, 3], [1, 2, 3]]);
    let options = Options { backend: Backend::Cpu, ..Options::default() };
    let mut session = block_on(Session::new(mesh, options)).unwrap();
    use EdgeState::{Boundary as B, Inconsistent as I, NonManifold as N};
    assert_eq!(block_on(session.edge_states()).unwrap(), [N, I, B, N, B, B, N, B, I, I, B, I]);
}

#[test]
fn lawsons_algorithm_selects_nothing() {
    let mesh = edgeflip::families::by_name("random 12").unwrap();
    let options = Options { backend: Backend::Cpu, order: Order::Any, ..Options::default() };
    let mut session = block_on(Session::new(mesh.clone(), options)).unwrap();
    let before = edges(&mut session, &mesh);
    assert!(before[EdgeState::Waits as usize] > 0);
    assert_eq!(before[EdgeState::Flips as usize], 0);
    block_on(session.step()).unwrap();
    assert_eq!(edges(&mut session, &mesh)[EdgeState::Waits as usize], 0);
}
