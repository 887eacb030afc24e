//! Runs that the parity matrix lacks: Lawson's algorithm, random dirty meshes, and capped runs.

#![allow(clippy::unwrap_used, clippy::panic, reason = "what fails here is a failed test")]

mod meshes;
mod runs;
mod simulation;

use edgeflip::quality::audit;
use edgeflip::{Backend, Mesh, Options, Order, Reason, Status};
use runs::{options, unwatched, watched};
use simulation::{expected, simulate};
use std::ops::ControlFlow;

#[test]
fn any_order_ends_where_nothing_is_left_to_flip() {
    for (case, want) in meshes::all().into_iter().zip(expected()) {
        let options = Options { order: Order::Any, ..case.options(Backend::Cpu) };
        let outcome = unwatched(&case.mesh, &options).unwrap();
        let audit = audit(&case.mesh, &outcome.triangles, &options);
        assert!(audit.is_clean(), "{}: {:?}", case.name, audit.violations);
        assert_eq!(audit.remaining, outcome.remaining, "{}", case.name);
        assert_eq!(outcome.remaining[Reason::Stopped], 0, "{}", case.name);
        if want.remaining.total() == 0 && case.mesh.dimension() == edgeflip::Dimension::Two {
            assert_eq!(outcome.remaining.total(), 0, "{}", case.name);
        }
    }
}

/// Random meshes to try; `EDGEFLIP_ROUNDS` asks for more.
fn rounds() -> u64 {
    std::env::var("EDGEFLIP_ROUNDS").ok().and_then(|n| n.parse().ok()).unwrap_or(200)
}

fn assert_simulated(name: &str, mesh: &Mesh, beta: f64, backends: &[Backend]) {
    let want = simulate(mesh, beta, None);
    for &backend in backends {
        let run = watched(mesh, &options(backend, beta)).unwrap();
        assert_eq!(run, want, "{name} at β = {beta}, {backend:?}");
    }
}

#[test]
fn soups_flip_as_simulated() {
    for seed in 0..rounds() {
        let (flat, bent) = meshes::soup(seed, 3 + seed as usize % 5, seed as usize / 5 % 23);
        // The software GPU runs a tenth of them.
        let backends = [Backend::Cpu, Backend::Gpu];
        let backends = &backends[..1 + usize::from(seed % 10 == 0)];
        assert_simulated(&format!("soup {seed}"), &flat, 10.0, backends);
        for beta in [0.0, 40.0, 180.0] {
            assert_simulated(&format!("bent soup {seed}"), &bent, beta, backends);
        }
    }
}

#[test]
fn a_capped_run_stops_after_a_complete_iteration() {
    let mesh = edgeflip::families::by_name("random 12").unwrap();
    let want = simulate(&mesh, 10.0, Some(2));
    for backend in [Backend::Cpu, Backend::Gpu] {
        let capped = Options { max_iterations: Some(2), ..options(backend, 10.0) };
        let outcome = unwatched(&mesh, &capped).unwrap();
        assert_eq!((outcome.status, outcome.iterations), (Status::Stopped, 2));
        assert_eq!((&outcome.triangles, outcome.remaining), (&want.triangles, want.remaining));
        let stopped =
            edgeflip::make_delaunay(&mesh, &options(Backend::Cpu, 10.0), |_, _| ControlFlow::Break(()));
        assert_eq!(stopped.unwrap().status, Status::Stopped);
    }
}
