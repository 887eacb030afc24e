//! Runs that the parity matrix lacks: random dirty meshes, and capped runs.
#![cfg(feature = "gpu")]

use crate::meshes;
use crate::runs::{options, rounds, unwatched, watched};
use crate::simulation::simulate;
use edgeflip::{Backend, Mesh, Options, Status};
use std::ops::ControlFlow;

fn assert_simulated(name: &str, mesh: &Mesh, beta: f64, backends: &[Backend]) {
    let want = simulate(mesh, beta, None);
    for &backend in backends {
        let run = watched(mesh, &options(backend, beta)).unwrap();
        assert_eq!(run, want, "{name} at β = {beta}, {backend:?}");
    }
}

#[test]
fn soups_flip_as_simulated() {
    for seed in 0..rounds(200) {
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
